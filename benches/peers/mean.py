"""Means of independent renders, and biases between them, with their standard errors."""

import math
from dataclasses import dataclass

import numpy


@dataclass(frozen=True)
class Mean:
    """A mean and its standard error."""

    value: float
    error: float

    @staticmethod
    def of(renders):
        """The mean of at least two independent values of the same expectation."""
        values = numpy.array(renders, dtype=numpy.float64)
        return Mean(values.mean(), values.std(ddof=1) / math.sqrt(len(values)))

    def bias(self, truth):
        """How far this is from an independent mean, relative to that.

        The error is that of the quotient to first order in both errors.
        """
        ratio = self.value / truth.value
        return Mean(ratio - 1.0, math.hypot(self.error, ratio * truth.error) / truth.value)

    def differs(self, standard_errors):
        """Whether this is further from zero than so many standard errors."""
        return abs(self.value) > standard_errors * self.error
