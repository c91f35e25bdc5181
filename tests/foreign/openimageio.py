"""Checks candor's films with OpenImageIO's tools: openimageio.py FOLDER CANDOR."""

import copy
import json
import re
import sys

import numpy
from checks import Checks
from film import COLOURS, WORDS
from tools import Tools

# oiiotool prints means with six decimals, and so many digits of its own arithmetic in f64.
PRINTED = 0.5e-6 + 1e-9
# Of the root mean square that idiff prints: six digits.
RMS_PRINTED = 1e-5


def faults_of_info(tools, film):
    """Whether oiiotool shows the same channels, types and attributes."""
    said = tools.ok("oiiotool", "--info", "-v", "film.exr")
    shown = dict(re.findall(r'^ +candor\.(\w+): "(.*)"$', said, re.MULTILINE))
    (listed,) = re.findall(r"channel list: (.*)", said)
    types = dict(re.fullmatch(r"(.+) \((\w+)\)", part).groups() for part in listed.split(", "))
    expected = dict.fromkeys(COLOURS, "float") | dict.fromkeys(WORDS, "uint")
    faults = [name for name, value in film.attributes().items() if shown.get(name) != value]
    return faults + ["channels"] * (types != expected) + ["size"] * ("  96 x   72" not in said)


def faults_of_stats(tools, film):
    """Whether oiiotool finds the means that Python finds; it shows u32 as 0 to 1."""
    said = tools.ok("oiiotool", "--stats", "film.exr")
    (printed,) = re.findall(r"Stats Avg: ([-0-9. einfa]+) \(", said)
    means = {}
    for name in [*COLOURS, *sorted(WORDS)]:
        values = film.pixels[name].astype("float64")
        whole = 2.0**32 - 1 if name in WORDS else 1.0
        means[name] = values[numpy.isfinite(values)].mean() / whole
    pairs = zip(means.items(), map(float, printed.split()), strict=True)
    return [f"{name} {shown}" for (name, mean), shown in pairs if abs(shown - mean) > PRINTED]


def check_pictures(checks, tools, film):
    """Whether others can make pictures of it, and agree with `candor diff` about them."""
    tools.ok("oiiotool", "film.exr", "--ch", "R,G,B", "-o", "film.png")
    said = tools.ok("iinfo", "film.png")
    checks.hold("oiiotool: makes a PNG", [] if "  96 x   72, 3 channel, uint8" in said else [said])
    tools.ok("oiiotool", "film.exr", "--ch", "R,G,B", "-d", "half", "-o", "half.exr")
    half = tools.film("half.exr")
    faults = [c for c in "RGB" if (half.pixels[c] != film.pixels[c].astype("float16")).any()]
    checks.hold("oiiotool: makes an EXR in half floats, each the nearest", faults)

    code, said = tools.candor("diff", "half.exr", "film.exr", "--json", "--quiet")
    ours = json.loads(said)["channel_rmse"]
    tools.ok("oiiotool", "film.exr", "--ch", "R,G,B", "-o", "single.exr")
    _, said = tools.run("idiff", "-fail", "0", "half.exr", "single.exr")
    theirs = float(re.search(r"RMS error = (\S+)", said)[1])
    faults = ["exit code"] * (code != 0) + [f"{ours} {theirs}"] * (
        abs(ours - theirs) > RMS_PRINTED * theirs)
    checks.hold("idiff: the RMS error that candor diff states", faults)
    return half


def check_differences(checks, tools):
    """Whether idiff and `candor diff` say the same of which films are equal."""
    verdicts = {}
    for name in ("film", "merged", "gap"):
        code, _ = tools.run("idiff", "-fail", "0", "film.exr", f"{name}.exr")
        _, said = tools.candor("diff", "film.exr", f"{name}.exr", "--json", "--quiet")
        verdicts[name] = (code == 0, json.loads(said)["verdict"] == "identical")
    expected = {"film": (True, True), "merged": (True, True), "gap": (False, False)}
    checks.hold("idiff and candor diff: film equals itself and the merged one, not that with a gap",
                [] if verdicts == expected else [verdicts])


def check_faults(checks, tools, film):
    """Whether the checks with OpenImageIO tell what is wrong."""
    undetected = []
    wrong = copy.copy(film)
    wrong.header = film.header | {"candor.seed": "8"}
    undetected += ["attribute"] * (not faults_of_info(tools, wrong))
    for name, change in {"R": 2e-6, "stderr.L": 2e-6, "sum.R.1": 8600}.items():
        wrong = copy.copy(film)
        values = film.pixels[name]
        wrong.pixels = film.pixels | {name: values + values.dtype.type(change)}
        undetected += [name] * (not faults_of_stats(tools, wrong))
    checks.rejected("an attribute, and means off by two printed digits", undetected)


def main(folder, candor):
    """Checks the film of a folder."""
    checks, tools = Checks(), Tools(folder, candor)
    film = tools.film("film.exr")
    checks.hold("oiiotool --info: the same channels, types and attributes",
                faults_of_info(tools, film))
    checks.hold("oiiotool --stats: the same means", faults_of_stats(tools, film))
    check_faults(checks, tools, film)
    check_pictures(checks, tools, film)
    check_differences(checks, tools)
    return checks.exit_code()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
