"""Checks candor's films with OpenEXR's own Python module: openexr.py FOLDER FILM.md VERSION.

The folder holds what tests/foreign/run renders: NAME.exr, and NAME.json where the command said so.
"""

import contextlib
import copy
import io
import json
import re
import runpy
import sys
from pathlib import Path

import numpy
import OpenEXR
from checks import Checks
from film import (COLOURS, ERROR_ROUNDING, MEAN_ROUNDING, WORDS, Film, faults_of_attributes,
                  faults_of_channels, faults_of_counts, faults_of_pixels, faults_of_window,
                  is_rounded)

# File names are not English everywhere.
SPHERES, LIGHTLESS, COARSE = "two-spheres.toml", "sphère 球.toml", "coarse.toml"
# Scene, width, height and seed of each film.
FILMS = {
    "film": (SPHERES, 96, 72, "7"),
    "merged": (SPHERES, 96, 72, "7"),
    "gap": (SPHERES, 96, 72, "7"),
    "checkpoint": (SPHERES, 80, 60, "0"),
    "one": (SPHERES, 80, 60, "0"),
    "lightless": (LIGHTLESS, 16, 12, "0"),
    "coarse": (COARSE, 16, 12, "0"),
}
SAMPLES = {
    "film": "0..64", "merged": "0..64", "gap": "0..16,40..64", "one": "0..1",
    "lightless": "0..64", "coarse": "0..16",
}


def number(text):
    """Whether it is a number that is not negative."""
    return re.fullmatch(r"[0-9.e+-]+", text) is not None and float(text) >= 0


def is_from_zero(text):
    """Whether it is one range from 0 on."""
    return re.fullmatch(r"0\.\.[0-9]+", text) is not None


def exactly(value):
    """Tests for the number that a report in JSON has."""
    return lambda text: number(text) and float(text) == value


class Folder:
    """The films and reports of a folder."""

    def __init__(self, path, version):
        self.path, self.version = Path(path), version

    def film(self, name):
        """A film."""
        return Film(self.path / f"{name}.exr")

    def expected(self, name, twin):
        """Attributes that a film must have; `twin` has the same scene, rendered once more."""
        scene, _, _, seed = FILMS[name]
        same = {key: twin.said(key) for key in ("sceneHash", "sampleBound", "filmShift")}
        expected = same | {
            "version": self.version, "numbers": "1", "scene": scene, "estimator": "implicit",
            "bounces": "2", "seed": seed, "software": "true",
            "dark": "true" if scene == LIGHTLESS else "false", "invalidSamples": "0",
            "checksum": number, "headerChecksum": number,
        }
        if name == "checkpoint":
            return expected | {
                "device": twin.said("device"), "driver": twin.said("driver"),
                "samples": is_from_zero, "spp": number, "seconds": number,
                "unprovenPixels": number, "coarsePixels": number,
                "relativeError": number, "errorBound": number,
                "nextLook": lambda text: re.fullmatch(r"[0-9]+ for 0\.001", text) is not None,
            }
        report = json.loads((self.path / f"{name}.json").read_text())
        errors = {"relativeError": report["relative_error"], "errorBound": report["error_bound"]}
        return expected | {
            "device": report["device"], "driver": report["driver"], "samples": SAMPLES[name],
            "spp": str(report["spp"]), "seconds": f"{report['seconds']:.3f}",
            "unprovenPixels": str(report["unproven_pixels"]),
            "coarsePixels": str(report["coarse_pixels"]),
        } | {key: exactly(value) for key, value in errors.items() if value is not None}


def faults_of(film, name, expected):
    """All that is wrong with a film."""
    _, width, height, _ = FILMS[name]
    faults = faults_of_channels(film) + faults_of_window(film, width, height)
    faults += faults_of_attributes(film, expected)
    # The rest reads what these have checked.
    return faults or faults_of_pixels(film) + faults_of_counts(film)


def faults_of_hash(films):
    """Whether scenes are told apart by their hashes, sizes included."""
    hashes = {name: film.said("sceneHash") for name, film in films.items()}
    faults = [name for name, text in hashes.items() if not re.fullmatch("[0-9a-f]{64}", text)]
    distinct = {hashes[name] for name in ("film", "one", "lightless", "coarse")}
    return faults + ["equal for different scenes"] * (len(distinct) != 4)


def faults_of_kinds(films):
    """Whether the films have the pixels that they are here for."""
    film, one, coarse = films["film"], films["one"], films["coarse"]
    infinite = numpy.isinf(film.pixels["stderr.L"])
    unsure = numpy.isinf(one.pixels["stderr.L"])
    kinds = {
        "film: light that was found, and some that was not": infinite.any() and not infinite.all(),
        "one: light of unknown error": (one.pixels["R"][unsure] > 0).any(),
        "coarse: coarse pixels, and others": 0 < int(coarse.said("coarsePixels")) < (
            coarse.pixels["R"] > 0).sum(),
        "lightless: no error": not films["lightless"].pixels["stderr.L"].any(),
        "film: sums of more than 64 bits": film.pixels["sum.G.2"].any(),
    }
    return [kind for kind, there in kinds.items() if not there]


def different(a, b, names):
    """Channels that differ in any bit."""
    return [name for name in names if a.pixels[name].tobytes() != b.pixels[name].tobytes()]


def injected(film):
    """Copies of a film with one fault each, and what it is."""
    for key, value in film.attributes().items():
        other = copy.copy(film)
        last = "1" if value[-1] != "1" else "2"
        other.header = film.header | {f"candor.{key}": value[:-1] + last}
        yield f"{key} {value[:-1] + last}", other
        other = copy.copy(film)
        other.header = {k: v for k, v in film.header.items() if k != f"candor.{key}"}
        yield f"no {key}", other
    found = numpy.isfinite(film.pixels["stderr.L"]) & (film.pixels["R"] > 0)
    row, column = numpy.argwhere(found)[0]
    for name in WORDS:
        yield f"{name} one more", changed(film, name, row, column, numpy.uint32(1).__add__)
    for name in COLOURS:
        for end in (numpy.inf, 0):
            away = numpy.float32(end)
            step = changed(film, name, row, column, lambda x, away=away: numpy.nextafter(x, away))
            yield f"{name} one f32 towards {end}", step
    other = copy.copy(film)
    other.types = film.types | {"sum.R.0": OpenEXR.FLOAT}
    yield "sum.R.0 as float", other


def changed(film, name, row, column, change):
    """A copy with another value in one channel of a pixel."""
    other = copy.copy(film)
    values = film.pixels[name].copy()
    values[row, column] = change(values[row, column])
    other.pixels = film.pixels | {name: values}
    return other


def faults_of_example(text, path, film):
    """Runs the example of docs/film.md: what it computes must be in R, G, B and stderr.L."""
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    (path.parent / "example.py").write_text(code, "utf-8")
    sys.argv = ["example.py", str(path)]
    with contextlib.redirect_stdout(io.StringIO()) as said:
        names = runpy.run_path(str(path.parent / "example.py"))
    faults = [name for name, mean in zip("RGB", names["mean"])
              if not is_rounded(film.pixels[name], mean, MEAN_ROUNDING).all()]
    error = is_rounded(film.pixels["stderr.L"], names["error"], ERROR_ROUNDING)
    faults += ["prints nothing"] * (not said.getvalue().startswith("mean "))
    return faults + ["stderr.L"] * (not error.all())


def faults_of_table(text, films, picture):
    """Whether docs/film.md lists the attributes that there are."""
    listed = set(re.findall(r"^\| `candor\.(\w+)`", text, re.MULTILINE))
    found = {name for film in [*films.values(), picture] for name in film.attributes()}
    # No scene here has invalid samples.
    return sorted(listed.symmetric_difference(found | {"invalidRecords"}))


def check_others(checks, folder, films, text):
    """What is to be said of several films, or of one without sums."""
    film, picture = films["film"], folder.film("picture")
    checks.hold("unproven, coarse and lightless pixels, and large sums, are there",
                faults_of_kinds(films))
    checks.hold("sceneHash: 64 digits, others for other scenes", faults_of_hash(films))
    checks.hold("merged: every channel as of the single run", different(
        film, films["merged"], film.pixels))
    compressions = {name: str(f.header["compression"]).split(".")[-1] for name, f in films.items()}
    plain = [name for name, of in compressions.items() if of == "NO_COMPRESSION"]
    checks.hold("checkpoint: alone uncompressed", plain if plain != ["checkpoint"] else [])
    faults = faults_of_channels(picture, with_sums=False) or different(film, picture, COLOURS)
    faults += ["checksum without sums"] * ("checksum" in picture.attributes())
    checks.hold("--no-state: R, G, B and stderr.L alone, as with sums", faults)
    leaks = [path.name for path in folder.path.glob("*.exr")
             if str(folder.path).encode() in path.read_bytes()]
    checks.hold("no file holds a folder's name", leaks)
    path = folder.path / "film.exr"
    checks.hold("docs/film.md: the example computes R, G, B and stderr.L",
                faults_of_example(text, path, film))
    checks.hold("docs/film.md: all attributes, and no other",
                faults_of_table(text, films, picture))


def main(path, document, version):
    """Checks all films."""
    folder, checks = Folder(path, version), Checks()
    films = {name: folder.film(name) for name in FILMS}
    twins = {name: folder.film("picture") for name in ("film", "merged", "gap")}
    twins |= {"checkpoint": films["one"], "one": films["checkpoint"]}
    for name, film in films.items():
        expected = folder.expected(name, twins.get(name, film))
        checks.hold(f"{name}: {film.said('samples')}, channels, window, attributes, sums, means, "
                    "errors", faults_of(film, name, expected))
    check_others(checks, folder, films, Path(document).read_text("utf-8"))
    film, expected = films["film"], folder.expected("film", twins["film"])
    faulty = list(injected(film))
    undetected = [what for what, other in faulty if not faults_of(other, "film", expected)]
    checks.rejected(f"{len(faulty)} changes of one attribute, word or f32 each", undetected)
    return checks.exit_code()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
