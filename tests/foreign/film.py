"""A film of candor's as OpenEXR's own Python module reads it, and what must hold of it.

Nothing here shares code with candor: the sums are joined to Python's integers, which are exact
and have no bounds, and DESIGN.md (sections 8 and 9) is written down a second time.
"""

import math
import zlib

import numpy
import OpenEXR

COLOURS = {"R": OpenEXR.FLOAT, "G": OpenEXR.FLOAT, "B": OpenEXR.FLOAT, "stderr.L": OpenEXR.FLOAT}
WORDS = [f"sum.{sum_}.{word}" for sum_, words in (("R", 3), ("G", 3), ("B", 3), ("L2", 4))
         for word in range(words)]
REC_709 = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)
# Rec. 709 luminance in units of 2^-16.
WEIGHTS = {"R": 13_933, "G": 46_871, "B": 4_732}
# Below a mean of so many steps, what truncation may hide is charged to the variance.
COARSE = 1_000_000
# Relative roundings to f64, candor's and those here together, before both round to f32. A mean:
# the sum, the division; here the division: 3 * 2^-53. An error: 7 roundings of the variance,
# halved by the root, and the root; here the division, halved, and the root: 6 * 2^-53.
MEAN_ROUNDING = 2.0**-51
ERROR_ROUNDING = 2.0**-50


class Film:
    """Channels and header of a file; both may be changed, to see what is found."""

    def __init__(self, path):
        with OpenEXR.File(str(path), separate_channels=True) as file:
            self.header = dict(file.header())
            channels = file.channels()
            self.types = {name: channel.type() for name, channel in channels.items()}
            self.sampling = {(c.xSampling, c.ySampling) for c in channels.values()}
            self.pixels = {name: channel.pixels.copy() for name, channel in channels.items()}

    def said(self, name):
        """An attribute of candor's."""
        return self.header[f"candor.{name}"]

    def attributes(self):
        """All attributes of candor's, without the prefix."""
        own = {key: value for key, value in self.header.items() if key.startswith("candor.")}
        return {key.removeprefix("candor."): value for key, value in own.items()}

    def write(self, path):
        """Writes it anew, as any program may that copies all channels and attributes."""
        # OpenEXR counts the chunks itself, and changes what it is given.
        header = {key: value for key, value in self.header.items() if key != "chunkCount"}
        OpenEXR.File(header, dict(self.pixels)).write(str(path))

    def sum_of(self, name):
        """A sum of every pixel, as Python's integers."""
        words = [self.pixels[word] for word in WORDS if word.startswith(f"sum.{name}.")]
        return sum(word.astype(object) << 32 * place for place, word in enumerate(words))

    def weighted(self):
        """The sum of luminances in steps, times 2^16."""
        return sum(weight * self.sum_of(name) for name, weight in WEIGHTS.items())

    def checksum(self):
        """CRC-32 of the words, little-endian, pixel by pixel from the top left."""
        words = numpy.stack([self.pixels[word] for word in WORDS], axis=-1)
        return zlib.crc32(words.astype("<u4").tobytes())

    def header_checksum(self):
        """CRC-32 of the other attributes of candor's, in the order of their names."""
        lines = [f"candor.{name}={value}\n" for name, value in sorted(self.attributes().items())
                 if name != "headerChecksum"]
        return zlib.crc32("".join(lines).encode())

    def means(self, name):
        """Mean radiance, each the f64 next to the exact quotient."""
        mean = self.sum_of(name) / int(self.said("spp"))
        return mean.astype("float64") * 2.0 ** -int(self.said("filmShift"))

    def is_coarse(self):
        """Which pixels have a mean that is small beside the step, but not 0."""
        weighted = self.weighted()
        return (weighted > 0) & (weighted < COARSE * int(self.said("spp")) << 16)

    def variances(self):
        """Squared standard errors of the mean luminance, each the f64 next to the exact one."""
        n, weighted = int(self.said("spp")), self.weighted()
        # All times 2^32, so that everything is whole.
        spread = (n * self.sum_of("L2") << 64) - weighted**2
        hidden = (n * (n - 1) << 64) + (n - 1) * weighted * 2**17
        spread = numpy.maximum(spread, 0) + self.is_coarse() * hidden
        squared = spread / (n * n * (n - 1) << 32)
        return squared.astype("float64") * 4.0 ** -int(self.said("filmShift"))

    def errors(self):
        """Standard errors: infinite where no sample has contributed, 0 where nothing shines."""
        if self.said("dark") == "true":
            return numpy.zeros(self.pixels["R"].shape)
        if int(self.said("spp")) < 2:
            return numpy.full(self.pixels["R"].shape, math.inf)
        return numpy.where(self.weighted() == 0, math.inf, numpy.sqrt(self.variances()))


def is_rounded(stored, exact, rounding):
    """Whether f32 values are the nearest to values within a relative `rounding` of the exact."""
    least, most = ((exact * factor).astype("float32") for factor in (1 - rounding, 1 + rounding))
    return (least <= stored) & (stored <= most)


def faults_of_channels(film, with_sums=True):
    """What is wrong with the names and types of the channels."""
    expected = COLOURS | (dict.fromkeys(WORDS, OpenEXR.UINT) if with_sums else {})
    if film.types != expected:
        return [f"channels {film.types}"]
    return [f"subsampled by {film.sampling}"] * (film.sampling != {(1, 1)})


def faults_of_pixels(film):
    """What is wrong with means, standard errors and words."""
    faults = []
    for name in WEIGHTS:
        good = is_rounded(film.pixels[name], film.means(name), MEAN_ROUNDING)
        faults += [f"{name} of {(~good).sum()} pixels"] * (not good.all())
    good = is_rounded(film.pixels["stderr.L"], film.errors(), ERROR_ROUNDING)
    faults += [f"stderr.L of {(~good).sum()} pixels"] * (not good.all())
    return faults + ["checksum"] * (str(film.checksum()) != film.said("checksum"))


def faults_of_window(film, width, height):
    """What is wrong with what every program reads of a header."""
    header = film.header
    windows = [numpy.ravel(header[name]).tolist() for name in ("dataWindow", "displayWindow")]
    faults = ["windows"] * (windows != [[0, 0, width - 1, height - 1]] * 2)
    primaries = numpy.allclose(header["chromaticities"], REC_709, rtol=2.0**-24, atol=0)
    faults += ["chromaticities"] * (not primaries)
    return faults + ["software"] * (header["software"] != f"candor {header.get('candor.version')}")


def faults_of_counts(film):
    """What is wrong with attributes that follow from other ones and the sums."""
    of, n, dark = film.said, int(film.said("spp")), film.said("dark") == "true"
    black = 0 if dark else (film.weighted() == 0).sum()
    ranges = [tuple(map(int, part.split(".."))) for part in of("samples").split(",")]
    coarse = 0 if dark else film.is_coarse().sum()
    true = {
        "samples": all(a < b for a, b in ranges) and sum(b - a for a, b in ranges) == n,
        "filmShift": int(of("filmShift")) == 64 - math.frexp(float(of("sampleBound")))[1],
        "unprovenPixels": int(of("unprovenPixels")) == black,
        "coarsePixels": int(of("coarsePixels")) == coarse,
        "headerChecksum": of("headerChecksum") == str(film.header_checksum()),
        "seconds": 0 <= float(of("seconds")) < math.inf and (dark or float(of("seconds")) > 0),
    }
    stated = film.attributes().get("relativeError")
    if dark or n >= 2:
        # A sum of so many roundings as there are pixels, twice.
        rounding = 2 * (film.weighted().size + 16) * 2.0**-53
        relative = 0.0 if dark else relative_error(film)
        true["relativeError"] = math.isclose(float(stated), relative, rel_tol=rounding)
    else:
        true["relativeError"] = stated is None
    return [f"{name} {film.attributes().get(name)}" for name, good in true.items() if not good]


def relative_error(film):
    """The root of the mean variance, over the mean luminance."""
    mean = sum(weight * film.means(name) for name, weight in WEIGHTS.items()).mean() / 65_536
    return math.sqrt(film.variances().mean()) / mean


def faults_of_attributes(film, expected):
    """Attributes that are missing, unknown or not as expected: an exact value, or a test of it."""
    found, faults = film.attributes(), []
    for name in sorted(found.keys() | expected.keys()):
        if name not in found or name not in expected:
            faults.append(f"{name} {'missing' if name in expected else 'unknown'}")
        elif not (expected[name](found[name]) if callable(expected[name])
                  else found[name] == expected[name]):
            faults.append(f"{name} is {found[name]!r}, not {expected[name]!r}")
    return faults
