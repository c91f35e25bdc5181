"""Images that were measured, and how far from the truth they are."""

import math
from dataclasses import dataclass

import numpy

# Rec. 709, of linear RGB.
LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])

# Tiles that are compared have so many pixels a side.
TILE = 16


@dataclass(eq=False)
class Image:
    """Linear RGB (height x width x 3) of `spp` samples a pixel, and what it took."""

    rgb: numpy.ndarray
    spp: int
    # Rendering alone.
    seconds: float
    # The relative RMS error that the renderer states, if it states one.
    claimed: float | None = None

    def pixels(self):
        """How many pixels it has."""
        return self.rgb.shape[0] * self.rgb.shape[1]

    def rate(self):
        """Samples per second."""
        return self.pixels() * self.spp / self.seconds


class Reference:
    """The mean of all samples of independent images."""

    def __init__(self):
        self.total = 0.0
        self.samples = 0

    def add(self, image):
        """Counts an image in."""
        self.total = self.total + image.rgb.astype(numpy.float64) * image.spp
        self.samples += image.spp

    def rgb(self):
        """Linear RGB."""
        return self.total / self.samples


def luminance(rgb):
    """Luminance of linear RGB, in f64."""
    return rgb.astype(numpy.float64) @ LUMINANCE


@dataclass(frozen=True)
class Error:
    """How far an image is from the truth: the mean over pixels of the squared error of
    luminance, and the standard error of that."""

    squared: float
    doubt: float


def error_of(image, one, two):
    """The error of an image against two references, without anybody's claim about noise.

    The references and the image are independent and have the same mean, the truth. So
    the product of the image's differences from the one and from the other has the squared
    error as its mean: what is subtracted elsewhere as the reference's own variance does
    not enter at all.
    """
    own = luminance(image.rgb)
    products = (own - luminance(one.rgb())) * (own - luminance(two.rgb()))
    return Error(products.mean(), products.std() / math.sqrt(products.size))


def variance_by_pair(one, two):
    """The variance of a pixel's luminance for one sample, and the mean luminance, from
    two independent images of equal spp."""
    a, b = luminance(one.rgb), luminance(two.rgb)
    return ((a - b) ** 2).mean() / 2.0 * one.spp, (a.mean() + b.mean()) / 2.0


@dataclass(frozen=True)
class Agreement:
    """Whether two renderers show the same picture."""

    # Per channel: the difference of the image means, and its standard error.
    difference: numpy.ndarray
    uncertainty: numpy.ndarray
    # The difference of the tiles' luminance in its standard errors.
    rms_z: float
    worst_z: float
    tiles: int

    def holds(self):
        """No channel is off by 5 standard errors (by chance: 2e-6), and the tiles spread
        as they should: the mean of n squared z has a standard error of sqrt(2/n) if they
        are normal; 8 of those leave room for those that are not quite."""
        channels = numpy.abs(self.difference) <= 5.0 * self.uncertainty
        return bool(channels.all()) and self.rms_z**2 <= 1.0 + 8.0 * math.sqrt(2.0 / self.tiles)


def agreement(ours, theirs):
    """Compares the linear RGB of two independent images, in sides a multiple of TILE."""
    difference = ours.astype(numpy.float64) - theirs
    pixels = difference.shape[0] * difference.shape[1]
    # Pixels are independent, so their own spread says how sure the mean is.
    uncertainty = difference.std(axis=(0, 1)) / math.sqrt(pixels)
    rows, columns = (side // TILE for side in difference.shape[:2])
    tiles = luminance(difference).reshape(rows, TILE, columns, TILE).swapaxes(1, 2)
    tiles = tiles.reshape(rows * columns, TILE * TILE)
    # A tile inside the light has no noise, and differs by rounding.
    tiles = tiles[tiles.std(axis=1) > 1e-6]
    z = tiles.mean(axis=1) / (tiles.std(axis=1, ddof=1) / TILE)
    rms, worst = math.sqrt((z**2).mean()), float(numpy.abs(z).max())
    return Agreement(difference.mean(axis=(0, 1)), uncertainty, rms, worst, len(z))
