"""What candor and Mitsuba lose of the light of the classic scene as its walls grow.

Run it through `benches/peers/run walls`, which makes what it needs. Markdown on stdout,
progress on stderr. Exit codes: 0 done; 1 Mitsuba shows another scene than candor; 2 something
is missing, or candor fails its own sweep; 130 interrupted.
"""

import argparse
import copy
import datetime
import json
import os
import sys
import tempfile
import time
from dataclasses import dataclass

import numpy

from candor_peer import Candor
from classic import PLANES, classic
from machine import keep_to_cores, processor, system, tell
from mean import Mean

# As the sweep of `candor verify --hard` names them, with their radii. Mitsuba has squares for
# the planes: the control, since nothing else is another there.
RADII = {"1e2": 1e2, "1e3": 1e3, "1e4": 1e4, "1e5": 1e5, "1e6": 1e6, "planes": PLANES}

# Everything of the scene that is no wall is smaller.
LARGEST_OBJECT = 10.0

# Independent renders of one row. They are small: the image mean has the same expectation
# at any size.
RENDERS = 16
SIDE = 256
SPP = 32

# At the smallest radius Mitsuba's mean must be the twin's within so many standard errors.
# Chance alone goes further in at most 2e-4 of runs (Student's t, 15 degrees of freedom).
AGREES = 5.0

GREEN = 1


@dataclass(frozen=True)
class Row:
    """What was found for one wall radius. Relative biases of the image mean of green."""

    radius: str
    truth: Mean
    # By estimator.
    candor: dict[str, Mean]
    mitsuba: Mean
    # Mitsuba's hit points off their wall: the median, in units of the scene.
    off: float
    # The share of rays leaving a wall that Mitsuba sees meet it again.
    again: float


def main():
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    threads = keep_to_cores()
    started = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="candor-walls-") as folder:
        # Mitsuba keeps compiled kernels under HOME; a run leaves none.
        os.environ["HOME"] = os.environ["XDG_CACHE_HOME"] = folder
        import drjit
        import mitsuba

        mitsuba.set_variant("llvm_ad_rgb")
        drjit.set_thread_count(threads)
        tell("candor's sweep")
        candor = Candor(classic(), folder, threads)
        told = json.loads(candor.call("verify", "--hard", "--json", "--quiet", "--device", "gpu"))
        rows = [measured(name, folder, threads, told["rows"]) for name in RADII]
    minutes = (time.perf_counter() - started) / 60.0
    report(rows, f"{candor.version()} on {told['device']}, {told['driver']}", minutes)
    if rows[0].mitsuba.bias(rows[0].truth).differs(AGREES):
        print("candor and Mitsuba show different scenes", file=sys.stderr)
        return 1
    return 0


def measured(name, folder, threads, sweep):
    """One row of the table."""
    scene = classic(RADII[name])
    scene["image"] |= {"width": SIDE, "height": SIDE}
    tell(f"wall radius {name}: the twin")
    twin = Candor(scene, folder, threads)
    truth = green(lambda seed: twin.render("mis", SPP, seed, device="cpu"))
    tell(f"wall radius {name}: Mitsuba")
    from mitsuba_peer import Mitsuba

    peer = Mitsuba(scene)
    mean = green(lambda seed: peer.render("independent", SPP, seed))
    return Row(name, truth, device_bias(name, sweep), mean, *hits(scene))


def green(render):
    """The image mean of green over all renders."""
    images = (render(seed) for seed in range(RENDERS))
    return Mean.of([image.rgb[..., GREEN].astype(numpy.float64).mean() for image in images])


def device_bias(name, sweep):
    """candor's device against its twin on the same random numbers, by estimator."""
    return {
        row["estimator"]: Mean(row["bias"][GREEN], row["bias_error"][GREEN])
        for row in sweep
        if row["group"] == "wall radius" and row["value"] == name
    }


def hits(scene):
    """How far camera rays' hits are off the walls in Mitsuba, and the share of rays leaving
    there that meet the wall that they leave. Outside a sphere none does."""
    import drjit
    import mitsuba
    from mitsuba_peer import camera, objects

    walls = copy.deepcopy(scene)
    walls["spheres"] = [s for s in scene["spheres"] if s["radius"] > LARGEST_OBJECT]
    # Optimised, squares of one material would become one mesh, and a ray from one to another
    # would seem to meet its own again.
    world = mitsuba.load_dict(objects(walls), optimize=False)
    sensor = mitsuba.load_dict(camera(walls, "independent", 1))
    sampler = sensor.sampler()
    sampler.seed(0, SIDE * SIDE)
    ray, _ = sensor.sample_ray(0.0, 0.5, sampler.next_2d(), mitsuba.Point2f(0.5))
    hit = world.ray_intersect(ray)
    leaving = mitsuba.warp.square_to_cosine_hemisphere(sampler.next_2d())
    next_hit = world.ray_intersect(hit.spawn_ray(hit.to_world(leaving)))
    found = hit.is_valid()
    again = found & next_hit.is_valid() & (next_hit.shape == hit.shape)
    share = drjit.count(again)[0] / drjit.count(found)[0]
    points = numpy.array(hit.p, dtype=numpy.float64).T[numpy.array(found)]
    return median_distance(points, walls["spheres"]), share


def median_distance(points, spheres):
    """The median distance of points (n x 3) to the nearest surface."""
    distances = [
        numpy.abs(numpy.linalg.norm(points - numpy.array(s["center"]), axis=1) - s["radius"])
        for s in spheres
    ]
    return float(numpy.median(numpy.min(distances, axis=0)))


def report(rows, candor, minutes):
    import drjit
    import mitsuba

    llvm = ".".join(str(part) for part in drjit.detail.llvm_version())
    print(
        "## Huge walls, with Mitsuba beside\n\n"
        f"`benches/peers/run walls` — `scenes/two-spheres.toml` with walls of other radii; "
        f"{RENDERS} renders of {SIDE}×{SIDE} at {SPP} spp a row; {minutes:.1f} min.\n\n"
        f"{processor()}, {system()}, {candor}; Mitsuba {mitsuba.__version__} "
        f"`{mitsuba.variant()}`, Dr.Jit {drjit.__version__}, LLVM {llvm}; "
        f"{datetime.date.today()}.\n\n"
        "| wall radius | truth | candor's bias, `implicit` | candor's bias, `mis` | Mitsuba "
        "| Mitsuba's bias | its hits off the wall | its rays that meet the wall they leave |\n"
        "|---|---|---|---|---|---|---|---|"
    )
    for row in rows:
        bias = row.mitsuba.bias(row.truth)
        off = f"{row.off:.1e}" if row.off > 0.0 else "0"
        ours = " | ".join(tiny(row.candor[name]) for name in ("implicit", "mis"))
        print(
            f"| {row.radius} | {mean(row.truth)} | {ours} | {mean(row.mitsuba)} "
            f"| {100.0 * bias.value:+.3f} ± {100.0 * bias.error:.3f} % "
            f"| {off} | {100.0 * row.again:.1f} % |"
        )


def mean(found):
    """An image mean with its error."""
    return f"{found.value:.5f} ± {found.error:.5f}"


def tiny(bias):
    """A bias too small for five decimals, in percent."""
    return f"{100.0 * bias.value:+.1e} ± {100.0 * bias.error:.0e} %"


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
    except (OSError, ImportError, RuntimeError) as problem:
        print(f"benches/peers: {problem}", file=sys.stderr)
        sys.exit(2)
