"""candor and Mitsuba on the same cores, the same scene and the same error, in turns.

Run it through benches/peers/run, which makes what it needs. Markdown on stdout, progress
on stderr. Exit codes: 0 done; 1 the two show different pictures, so that their times
cannot be compared; 2 something is missing; 130 interrupted.
"""

import argparse
import datetime
import os
import sys
import tempfile
import time

import tables
from classic import WALL_RADIUS, classic
from machine import keep_to_cores, processor, system, tell

# Settings of Mitsuba's stratified sampler: strata of a pixel, and passes. Powers of four
# are much its fastest; 361 is 19 by 19.
RUNGS = [(64, 1), (256, 1), (361, 1), (256, 2)]

# Seconds of one render, turns, and settings.
FULL = (3.0, 5, RUNGS)
QUICK = (2.0, 2, RUNGS[-1:])


def main():
    options = arguments()
    seconds, turns, rungs = QUICK if options.quick else FULL
    turns = options.turns or turns
    threads = keep_to_cores()
    started = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="candor-peers-") as folder:
        # Both keep compiled kernels under HOME; a run starts without any.
        os.environ["HOME"] = os.environ["XDG_CACHE_HOME"] = folder
        candor, mitsuba, starts = start(folder, threads)
        comparison = measured(candor, mitsuba, seconds, turns, rungs, options.quick)
    found = comparison.agreement()
    minutes = (time.perf_counter() - started) / 60.0
    report(comparison, found, heading(candor, threads, turns, minutes), starts)
    if not found.holds():
        print("candor and Mitsuba show different pictures", file=sys.stderr)
        return 1
    return 0


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--turns", type=positive, help="times that every row is measured")
    parser.add_argument(
        "--quick", action="store_true", help="short renders, two turns, no direct check"
    )
    return parser.parse_args()


def positive(text):
    """A whole number from 1."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError("expected a whole number from 1")
    return int(text)


def start(folder, threads):
    """Both renderers, and the time that each takes to its first image, cold."""
    from candor_peer import Candor

    scene = classic()
    started = time.perf_counter()
    import mitsuba

    mitsuba.set_variant("llvm_ad_rgb")
    import drjit

    drjit.set_thread_count(threads)
    from mitsuba_peer import Mitsuba

    theirs = Mitsuba(scene)
    theirs.render("independent", 1, 0)
    their_start = time.perf_counter() - started

    ours = Candor(scene, folder, threads)
    started = time.perf_counter()
    first = ours.render("mis", 1, 0)
    our_start = time.perf_counter() - started
    starts = [
        f"- From nothing to one sample per pixel: candor {our_start:.2f} s, Mitsuba "
        f"{their_start:.2f} s, both with what they load and compile; candor's kernel and its "
        f"samples take {first.seconds:.2f} s of that, compiling Mitsuba's kernel "
        f"{theirs.compiling['independent']:.2f} s."
    ]
    return ours, theirs, starts


def measured(candor, mitsuba, seconds, turns, rungs, quick):
    from measure import Comparison

    comparison = Comparison(candor, mitsuba, rungs, tell)
    comparison.pace(seconds)
    if not quick:
        comparison.reach_target()
    comparison.climb()
    for number in range(turns):
        comparison.turn(number)
    return comparison


def heading(candor, threads, turns, minutes):
    """What was compared, where and when."""
    import drjit
    import mitsuba

    llvm = ".".join(str(part) for part in drjit.detail.llvm_version())
    return [
        "## Against Mitsuba",
        "",
        f"`benches/peers/run` — `scenes/two-spheres.toml` with walls of radius {WALL_RADIUS:g}, "
        f"turns: {turns}; {minutes:.1f} min.",
        "",
        f"{threads} cores of {processor()}, {system()}, {candor.version()} on {candor.device}; "
        f"Mitsuba {mitsuba.__version__} `{mitsuba.variant()}`, Dr.Jit {drjit.__version__}, "
        f"LLVM {llvm}; {datetime.date.today()}.",
        "",
    ]


def report(comparison, found, head, starts):
    parts = [head, tables.speed(comparison), [""], tables.ladder(comparison), [""]]
    if comparison.direct:
        parts += [tables.direct(comparison), [""]]
    parts += [
        tables.look_cost(comparison),
        tables.stated(comparison),
        starts,
        tables.pictures(comparison, found),
    ]
    for lines in parts:
        print("\n".join(lines))


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
    except (OSError, ImportError, RuntimeError) as problem:
        print(f"benches/peers: {problem}", file=sys.stderr)
        sys.exit(2)
