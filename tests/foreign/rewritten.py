"""Writes a film anew with other programs and has candor go on from it.

rewritten.py FOLDER CANDOR
"""

import copy
import sys

import numpy
import OpenEXR
from checks import Checks
from tools import Tools

# All of OpenEXR's that candor reads. Those that lose digits of floats keep 32-bit integers.
COMPRESSIONS = ["NO", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"]


def different(a, b):
    """Channels of two films that differ in any bit."""
    return [name for name, values in a.pixels.items()
            if values.tobytes() != b.pixels[name].tobytes()]


def variant(film, pixels=(), **header):
    """A copy of a film with some other channels and attributes."""
    other = copy.copy(film)
    other.pixels, other.header = film.pixels | dict(pixels), film.header | header
    return other


def resumed(tools, name):
    """What `render --resume` says of a copy of this film, and the film that it makes."""
    (tools.folder / "resumed.exr").write_bytes((tools.folder / name).read_bytes())
    code, said = tools.candor("render", "a folder/two-spheres.toml", "--size", "96x72", "--seed",
                              "7", "--spp", "68", "--device", "gpu", "--quiet", "--resume", "-o",
                              "resumed.exr")
    return code, said, tools.film("resumed.exr")


def check_resumed(checks, tools, film):
    """Whether candor goes on from copies as from the film itself."""
    film.write(tools.folder / "openexr.exr")
    tools.ok("iconvert", "film.exr", "iconvert.exr")
    _, _, straight = resumed(tools, "film.exr")
    for name in ("openexr.exr", "iconvert.exr"):
        code, said, longer = resumed(tools, name)
        faults = [said] * (code != 0) + different(straight, longer)
        faults += [longer.said("samples")] * (longer.said("samples") != "0..68")
        checks.hold(f"written anew as {name}: resumed to the same bits", faults)
    checks.rejected("the film instead of the resumed one", ["all channels"] * (
        not different(film, straight)))


def check_merged(checks, tools, film):
    """Whether candor takes the words however a file holds them."""
    compression = {name: variant(film, compression=getattr(OpenEXR, f"{name}_COMPRESSION"))
                   for name in COMPRESSIONS}
    corners = numpy.array([[-10, 20], [85, 91]], "int32")
    values = film.pixels["R"]
    others = compression | {
        "window": variant(film, dataWindow=tuple(corners)),
        "channels": variant(film, {"Z": values.copy(), "albedo.R": values.astype("float16")}),
        "dim": variant(film, {"R": values / 2}),
    }
    faults = []
    for name, other in others.items():
        other.write(tools.folder / f"{name}.exr")
        code, said = tools.candor("merge", f"{name}.exr", "-o", "whole.exr", "--force", "--quiet")
        faults += [f"{name}: {said}"] * (code != 0)
        faults += [f"{name}: {fault}" for fault in different(film, tools.film("whole.exr"))]
    checks.hold(f"written anew in {len(compression)} compressions, with another data window, with "
                "more channels, with R halved: merged to the film's bits", faults)
    tools.ok("iconvert", "--tile", "32", "32", "film.exr", "tiles.exr")
    code, said = tools.candor("merge", "tiles.exr", "-o", "whole.exr", "--force", "--quiet")
    faults = [said] * (code != 0) or different(film, tools.film("whole.exr"))
    checks.hold("written anew in tiles: merged to the film's bits", faults)


def check_refused(checks, tools, film):
    """Whether what is no film any more is refused with the reason, and left as it is."""
    tools.ok("oiiotool", "film.exr", "-o", "oiiotool.exr")
    tools.ok("oiiotool", "film.exr", "-d", "uint32", "-o", "integers.exr")
    word = film.pixels["sum.G.1"].copy()
    word[36, 48] ^= 1
    variant(film, {"sum.G.1": word}).write(tools.folder / "torn.exr")
    variant(film, **{"candor.samples": "0..128"}).write(tools.folder / "samples.exr")
    plain = copy.copy(film)
    plain.header = {k: v for k, v in film.header.items() if not k.startswith("candor.")}
    plain.write(tools.folder / "plain.exr")
    for name, reason in {
        "oiiotool.exr": "holds no exact sums",
        "integers.exr": "its sums have the checksum",
        "torn.exr": "its sums have the checksum",
        "samples.exr": "its header does not have the checksum",
        "picture.exr": "holds no exact sums",
        "half.exr": "holds no exact sums",
        "plain.exr": "is no film of this program",
    }.items():
        before = (tools.folder / name).read_bytes()
        code, said = tools.candor("merge", name, "-o", name, "--force", "--quiet")
        faults = [said] * (code != 2 or f"{name}: " not in said or reason not in said)
        faults += ["not left as it was"] * ((tools.folder / name).read_bytes() != before)
        checks.hold(f"{name}: refused, {reason} …", faults)


def main(folder, candor):
    """Checks copies of the film of a folder."""
    checks, tools = Checks(), Tools(folder, candor)
    film = tools.film("film.exr")
    check_resumed(checks, tools, film)
    check_merged(checks, tools, film)
    check_refused(checks, tools, film)
    return checks.exit_code()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
