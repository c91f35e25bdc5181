"""Tests of the wall table: `target/peers-venv/bin/python -B -m unittest discover benches/peers`.

Seeds are fixed, so each outcome is too; the bounds are standard errors of the noise that
the tests put in.
"""

import math
import unittest

import numpy

from classic import PLANES, classic
from mean import Mean
from walls import AGREES, LARGEST_OBJECT, RENDERS, median_distance


def renders(seed, mean):
    """Means of renders whose own standard error is 1e-3."""
    return Mean.of(numpy.random.default_rng(seed).normal(mean, 1e-3, RENDERS))


class Bias(unittest.TestCase):
    def test_same_means_have_none(self):
        for seed in range(100):
            bias = renders(2 * seed, 0.33).bias(renders(2 * seed + 1, 0.33))
            self.assertFalse(bias.differs(AGREES))

    def test_lost_light_is_found(self):
        # 1 % of 0.33 is 9 standard errors of the difference of two means of 16 renders.
        for seed in range(100):
            bias = renders(2 * seed, 0.99 * 0.33).bias(renders(2 * seed + 1, 0.33))
            self.assertTrue(bias.differs(AGREES))
            self.assertLess(abs(bias.value + 0.01), 5.0 * bias.error)

    def test_its_error_is_its_spread(self):
        # The spread of 400 biases is known to 1/sqrt(800) = 3.5 %; five of these.
        biases = [renders(2 * s, 0.25).bias(renders(2 * s + 1, 0.5)) for s in range(400)]
        spread = numpy.std([bias.value for bias in biases], ddof=1)
        stated = math.sqrt(numpy.mean([bias.error**2 for bias in biases]))
        self.assertLess(abs(stated / spread - 1.0), 5.0 / math.sqrt(800.0))


class Walls(unittest.TestCase):
    def test_stay_where_they_are(self):
        for radius in (1e2, 1e6, PLANES):
            walls = [s for s in classic(radius)["spheres"] if s["radius"] > LARGEST_OBJECT]
            # The nearest points of the walls to the middle of the room.
            places = [math.hypot(*s["center"]) - s["radius"] for s in walls]
            self.assertEqual(places, [3.0, 3.0, 3.0, 3.0, 4.0])

    def test_distance_is_to_the_nearest(self):
        spheres = [{"center": [0.0, 0.0, 0.0], "radius": 1.0}]
        spheres += [{"center": [10.0, 0.0, 0.0], "radius": 2.0}]
        points = numpy.array([[0.0, 1.25, 0.0], [7.5, 0.0, 0.0], [0.0, 0.0, 0.75]])
        self.assertEqual(median_distance(points, spheres), 0.25)


if __name__ == "__main__":
    unittest.main()
