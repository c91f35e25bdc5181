"""candor and Mitsuba among ever more spheres, on the same cores, in turns.

Run it through `benches/peers/run many`, which makes what it needs. Markdown on stdout, progress
on stderr. Exit codes: 0 done; 1 the two show different pictures; 2 something is missing;
130 interrupted.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy

from candor_peer import Candor
from classic import ROOT
from machine import keep_to_cores, processor, system, tell
from mean import Mean

COUNTS = [1000, 100_000, 1_000_000]

# Mitsuba takes so many bytes for each `sphere` of a scene, measured at 100,000.
BYTES_PER_SPHERE = 20_000

# Renders of each, their side and samples a pixel.
TURNS = 4
SIDE = 256
SPP = 16

# The image means must agree within so many standard errors of their difference.
AGREES = 5.0

SKY = 8.0
ALBEDO = 0.5


def main():
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    threads = keep_to_cores()
    with tempfile.TemporaryDirectory(prefix="candor-many-") as folder:
        # Mitsuba keeps compiled kernels under HOME; a run leaves none.
        os.environ["HOME"] = os.environ["XDG_CACHE_HOME"] = folder
        import drjit
        import mitsuba

        mitsuba.set_variant("llvm_ad_rgb")
        drjit.set_thread_count(threads)
        print(
            f"{processor()}, {system()}; {TURNS} renders of {SIDE}×{SIDE} at {SPP} spp a row\n\n"
            "| spheres | renderer | ready after, s | Msamples/s | lowest..highest | to Mitsuba "
            "| mean of green |\n|---|---|---|---|---|---|---|"
        )
        alike = [compared(count, folder, threads) for count in COUNTS]
    if not all(alike):
        print("candor and Mitsuba show different pictures", file=sys.stderr)
        return 1
    return 0


def scene():
    """The uniform volume's scene without the spheres of the cloud."""
    return {
        "camera": {
            "position": [1.5, 1.2, 3.5],
            "look_at": [0.0, 0.0, 0.0],
            "up": [0.0, 1.0, 0.0],
            "vertical_fov": 40.0,
        },
        "image": {"width": SIDE, "height": SIDE},
        "render": {"bounces": 2},
        "materials": {"grey": {"diffuse": [ALBEDO] * 3}},
        "spheres": [{"center": [0.0] * 3, "radius": SKY, "emission": [1.0] * 3}],
    }


def compared(count, folder, threads):
    """Prints the rows of so many spheres; whether the two show the same picture."""
    tell(f"{count} spheres")
    data = Path(folder) / "volume.csv"
    with open(data, "wb") as file:
        generator = ROOT / "target" / "release" / "examples" / "volume"
        subprocess.run([generator, str(count)], stdout=file, check=True)
    candor = Candor(scene(), folder, threads)
    with open(candor.scene, "a", encoding="utf-8") as file:
        file.write(f'[[clouds]]\nfile = "{data.name}"\nmaterial = "grey"\n')
    render = {
        "candor, `cosine`": lambda seed: candor.render("cosine", SPP, seed),
        "candor, `mis`": lambda seed: candor.render("mis", SPP, seed),
    }
    ready = dict.fromkeys(render, seconds_to_first(candor))
    if count * BYTES_PER_SPHERE < free_memory():
        started = time.perf_counter()
        peer = mitsuba_with(data)
        peer.render("independent", 1, 0)
        ready["Mitsuba, `path`"] = time.perf_counter() - started
        render["Mitsuba, `path`"] = lambda seed: peer.render("independent", SPP, seed)
    else:
        gigabytes = count * BYTES_PER_SPHERE / 1e9
        tell(f"{count} spheres take {gigabytes:.0f} GB in Mitsuba, more than is free")
    images = {name: [] for name in render}
    for turn in range(TURNS):
        names = list(render)
        for name in names[turn % len(names) :] + names[: turn % len(names)]:
            images[name].append(render[name](turn + 1))
    return report(count, images, ready)


def seconds_to_first(candor):
    """Seconds from the start of the program to the picture of one sample a pixel."""
    started = time.perf_counter()
    candor.render("cosine", 1, 0)
    return time.perf_counter() - started


def free_memory():
    """Bytes that a program may still take."""
    with open("/proc/meminfo", encoding="utf-8") as lines:
        sizes = dict(line.split(":", 1) for line in lines)
    return 1024 * int(sizes["MemAvailable"].split()[0])


def mitsuba_with(data):
    """The scene in Mitsuba, with a `sphere` for each row. Its `ellipsoids`, which would load a
    million at once, show another picture: rays that leave small ones meet or miss them by
    rounding."""
    import mitsuba
    from mitsuba_peer import Mitsuba, objects, rgb

    rows = numpy.loadtxt(data, delimiter=",", skiprows=1)
    grey = mitsuba.load_dict({"type": "diffuse", "reflectance": rgb([ALBEDO] * 3)})
    world = objects(scene())
    world["sphere0"]["flip_normals"] = True
    for number, (*center, radius) in enumerate(rows.tolist(), start=1):
        world[f"sphere{number}"] = {
            "type": "sphere",
            "center": center,
            "radius": radius,
            "bsdf": grey,
        }
    return Mitsuba(scene(), world)


def report(count, images, ready):
    """Prints rows; whether the means agree."""
    means = {name: green(found) for name, found in images.items()}
    yardstick = images.get("Mitsuba, `path`")
    alike = True
    for name, found in images.items():
        rates = [image.rate() / 1e6 for image in found]
        ratio = ""
        if yardstick:
            ratios = [ours.rate() / theirs.rate() for ours, theirs in zip(found, yardstick)]
            ratio = f"{statistics.median(ratios):.2f}"
            theirs = means["Mitsuba, `path`"]
            alike &= found is yardstick or not means[name].bias(theirs).differs(AGREES)
        print(
            f"| {count} | {name} | {ready[name]:.1f} | {statistics.median(rates):.2f} "
            f"| {min(rates):.2f}..{max(rates):.2f} | {ratio} "
            f"| {means[name].value:.5f} ± {means[name].error:.5f} |",
            flush=True,
        )
    return alike


def green(images):
    """The image mean of green over independent renders."""
    return Mean.of([image.rgb[..., 1].astype(numpy.float64).mean() for image in images])


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
    except (OSError, ImportError, RuntimeError, subprocess.CalledProcessError) as problem:
        print(f"benches/peers: {problem}", file=sys.stderr)
        sys.exit(2)
