"""Tests of the judge: `target/peers-venv/bin/python -B -m unittest discover benches/peers`.

Seeds are fixed, so each outcome is too; the bounds are standard errors of the noise that
the tests put in.
"""

import math
import tomllib
import unittest

import numpy

from classic import as_toml, classic
from image import Image, Reference, agreement, error_of, variance_by_pair

SHAPE = (128, 128, 3)


def picture():
    """A truth that is not flat."""
    return 0.2 + numpy.linspace(0.0, 1.0, SHAPE[0] * SHAPE[1] * 3).reshape(SHAPE)


def noisy(seed, spp, bias=0.0):
    """A grey error of variance 0.04/spp in every pixel."""
    noise = numpy.random.default_rng(seed).normal(bias, 0.2 / math.sqrt(spp), SHAPE[:2])
    return Image((picture() + noise[..., None]).astype(numpy.float32), spp, 1.0)


def reference(seeds, spp):
    made = Reference()
    for seed in seeds:
        made.add(noisy(seed, spp))
    return made


class Errors(unittest.TestCase):
    def test_a_known_error_is_found_with_references_as_noisy_as_the_image(self):
        error = error_of(noisy(5, 16), reference([1], 16), reference([3], 16))
        # The products of a normal error with two others as large have the variance 5σ⁴.
        known = 0.04 / 16
        expected = math.sqrt(5.0) * known / SHAPE[0]
        self.assertLess(abs(error.squared - known), 4.0 * expected)
        self.assertAlmostEqual(error.doubt / expected, 1.0, delta=0.1)

    def test_a_reference_that_holds_the_image_is_noticed(self):
        error = error_of(noisy(5, 16), reference([5], 16), reference([3], 16))
        self.assertLess(error.squared, 0.1 * 0.04 / 16)

    def test_a_bias_counts_as_error(self):
        error = error_of(noisy(5, 1 << 20, bias=0.1), reference([1], 64), reference([2], 64))
        self.assertLess(abs(error.squared - 0.01), 4.0 * error.doubt)

    def test_the_variance_of_one_sample_comes_from_a_pair(self):
        variance, brightness = variance_by_pair(noisy(1, 64), noisy(2, 64))
        allowed = 4.0 * math.sqrt(2.0 / (SHAPE[0] * SHAPE[1]))
        self.assertLess(abs(variance / 0.04 - 1.0), allowed)
        self.assertAlmostEqual(brightness, 0.7, delta=4.0 * 0.2 / 8.0 / 128.0)


class Agreements(unittest.TestCase):
    def test_two_images_of_one_truth_agree(self):
        self.assertTrue(agreement(noisy(1, 64).rgb, noisy(2, 64).rgb).holds())

    def test_a_channel_that_is_off_is_seen(self):
        off = noisy(2, 64).rgb + numpy.array([0.0, 0.0, 0.01])
        self.assertFalse(agreement(noisy(1, 64).rgb, off).holds())

    def test_light_that_moved_within_the_picture_is_seen(self):
        moved = noisy(2, 64).rgb.copy()
        moved[:64] += 0.02
        moved[64:] -= 0.02
        found = agreement(noisy(1, 64).rgb, moved)
        self.assertLess(abs(found.difference[1]), 5.0 * found.uncertainty[1])
        self.assertFalse(found.holds())


class Scene(unittest.TestCase):
    def test_walls_stay_where_they_are(self):
        walls = [s for s in classic()["spheres"] if s["name"].endswith(("wall", "floor"))]
        for wall in walls + [classic()["spheres"][4]]:
            reach = max(abs(x) for x in wall["center"]) - wall["radius"]
            self.assertIn(reach, (3.0, 4.0))
            self.assertEqual(wall["radius"], 100.0)

    def test_the_written_scene_reads_the_same(self):
        self.assertEqual(tomllib.loads(as_toml(classic())), classic())


if __name__ == "__main__":
    unittest.main()
