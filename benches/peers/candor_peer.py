"""Runs candor's program and reads what it wrote."""

import json
import subprocess
from pathlib import Path

import numpy

from classic import ROOT, as_toml
from image import Image


class Candor:
    """candor on one scene; every run is a process of its own."""

    def __init__(self, scene, folder, threads):
        self.binary = ROOT / "target" / "release" / "candor"
        self.threads = threads
        self.film = Path(folder) / "film.exr"
        self.scene = Path(folder) / "classic.toml"
        self.scene.write_text(as_toml(scene), encoding="utf-8")
        self.device = None

    def version(self):
        """Name and version, as the program tells them."""
        return self.call("--version").strip()

    def render(self, estimator, spp, seed, quiet=True, device="gpu"):
        """An image; its seconds are the program's own, with the kernel's compilation.

        `device` is what renders; "cpu" is the f64 twin. Without `quiet` the program looks
        at its error while it renders, as for a user.
        """
        options = ["--estimator", estimator, "--spp", str(spp), "--seed", str(seed)]
        options += ["--threads", str(self.threads), "--device", device, "--json", "--force"]
        options += ["--quiet"] if quiet else []
        told = json.loads(self.call("render", str(self.scene), *options, "-o", str(self.film)))
        self.device = f"{told['device']}, {told['driver']}"
        if told["invalid_samples"] != 0:
            raise RuntimeError(f"candor met {told['invalid_samples']} invalid samples")
        return Image(read(self.film), spp, told["seconds"], told["relative_error"])

    def call(self, *arguments):
        """What the program says on stdout; an error shows what it says on stderr."""
        command = [str(self.binary), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(command)} failed:\n{done.stderr}")
        return done.stdout


def read(film):
    """Linear RGB of an EXR file, height x width x 3."""
    import mitsuba  # after its variant is chosen

    layers = dict(mitsuba.Bitmap(str(film)).split())
    return numpy.array(layers["<root>"], dtype=numpy.float32)
