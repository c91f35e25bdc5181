"""What is rendered in which order, so that every row meets the same machine."""

import math
from dataclasses import dataclass, field
from typing import Callable

from image import Error, Image, Reference, agreement, error_of, luminance, variance_by_pair

# The relative RMS error to reach.
TARGET = 0.01

# Samples a pixel by which the first renders find rate and variance.
PILOT_SPP = 64


@dataclass
class Row:
    """One renderer in one setting, and its images."""

    renderer: str
    setting: str
    # From spp and seed to an image.
    render: Callable[[int, int], Image]
    # The group that its images belong to.
    group: str
    # Whether they are good enough to be part of its mean.
    counts: bool = True
    spp: int = PILOT_SPP
    # One per turn.
    images: list[Image] = field(default_factory=list)


class Comparison:
    """The rows, the references and all that is measured."""

    def __init__(self, candor, mitsuba, rungs, tell):
        self.seed = 0
        self.tell = tell
        # An image is measured against the means of the two groups that it is not in.
        self.groups = {name: Reference() for name in ("candor", "independent", "multijitter")}

        def of_candor(setting, estimator, counts=True, quiet=True):
            def render(spp, seed):
                return candor.render(estimator, spp, seed, quiet)

            return Row("candor", setting, render, "candor", counts)

        def of_mitsuba(setting, sampler, passes=1):
            def render(spp, seed):
                return mitsuba.render(sampler, spp, seed, passes)

            return Row("Mitsuba", setting, render, sampler)

        self.mis = of_candor("mis", "mis")
        # The same with the looks at the error that a user gets.
        self.shown = of_candor("mis, error shown", "mis", quiet=False)
        self.independent = of_mitsuba("path, independent", "independent")
        self.paced = [
            self.mis,
            self.shown,
            self.independent,
            of_candor("explicit", "explicit"),
            of_candor("cosine", "cosine", counts=False),
            of_candor("implicit", "implicit", counts=False),
        ]
        # The stratified sampler in several settings, and the one that is best.
        self.rungs = []
        for strata, passes in rungs:
            name = f"{passes} × {strata}" if passes > 1 else f"{strata}"
            row = of_mitsuba(f"path, multijitter {name} spp", "multijitter", passes)
            row.spp = strata * passes
            self.rungs.append(row)
        self.stratified = self.rungs[-1]
        # What the rungs showed, each rendered once.
        self.climbed = []
        # Images with as many samples as 1 % takes, each rendered once.
        self.direct = {}

    def render(self, row, spp):
        """An image with a seed that no other has."""
        self.seed += 1
        image = row.render(spp, self.seed)
        if row.counts:
            self.groups[row.group].add(image)
        return image

    def error(self, row, image):
        """The error of one of a row's images."""
        others = [group for name, group in self.groups.items() if name != row.group]
        return error_of(image, *others)

    def brightness(self):
        """The mean luminance of all groups."""
        groups = self.groups.values()
        return sum(luminance(group.rgb()).mean() for group in groups) / len(groups)

    def target(self):
        """The squared error to reach."""
        return (TARGET * self.brightness()) ** 2

    def agreement(self):
        """How far candor and Mitsuba show the same picture."""
        return agreement(self.groups["candor"].rgb(), self.mitsuba_rgb())

    def mitsuba_rgb(self):
        """The mean of Mitsuba's two groups, weighed by samples."""
        both = [self.groups["independent"], self.groups["multijitter"]]
        return sum(group.total for group in both) / sum(group.samples for group in both)

    def images(self, row):
        """All that a row rendered with a time to count."""
        return row.images + [image for name, image in self.direct.items() if name == row.setting]

    def variance(self, row):
        """A pixel's variance times spp, of all of a row's samples alike: rare bright ones
        make up much of it, so a median over images would come out too small."""
        images = self.images(row)
        errors = [self.error(row, image) for image in images]
        shares = [image.spp**2 / sum(image.spp for image in images) for image in images]
        squared = sum(error.squared * share for error, share in zip(errors, shares))
        doubt = math.hypot(*(error.doubt * share for error, share in zip(errors, shares)))
        return Error(squared, doubt)

    def pace(self, seconds):
        """Gives every row as many samples as take `seconds`. The first run compiles."""
        for row in self.paced:
            self.tell(f"pilot of {row.renderer} {row.setting}")
            self.render(row, 1)
            pilot = self.render(row, PILOT_SPP)
            row.spp = max(1, round(seconds * pilot.rate() / pilot.pixels()))

    def reach_target(self):
        """Renders once with as many samples as the target takes by a pilot's variance."""
        for row in (self.mis, self.independent):
            pair = [self.render(row, PILOT_SPP) for _ in range(2)]
            variance, brightness = variance_by_pair(*pair)
            spp = round(variance / (TARGET * brightness) ** 2)
            self.tell(f"{row.renderer} {row.setting} to {TARGET * 100:g} %: {spp} spp")
            self.direct[row.setting] = self.render(row, spp)

    def climb(self):
        """Renders every rung once, and keeps the one that reaches the target in the least
        time, or the last if none does."""
        for row in self.rungs:
            self.tell(f"{row.renderer} {row.setting}")
            self.climbed.append(self.render(row, row.spp))
        seconds = {
            image.seconds: row
            for row, image in zip(self.rungs, self.climbed)
            if self.error(row, image).squared <= self.target()
        }
        if seconds:
            self.stratified = seconds[min(seconds)]

    def turn(self, number):
        """Renders every row once, beginning with another one in every turn."""
        rows = [*self.paced, self.stratified]
        first = number % len(rows)
        for row in rows[first:] + rows[:first]:
            self.tell(f"turn {number + 1}: {row.renderer} {row.setting}, {row.spp} spp")
            row.images.append(self.render(row, row.spp))

    def seconds_to_target(self, row):
        """For each turn, the seconds in which the row reaches the target. Those of
        independent samples follow from their variance, as the squared error falls as
        1/spp; the stratified sampler is taken at a setting that reaches it."""
        if row is self.stratified:
            return [image.seconds for image in row.images]
        spp = self.variance(row).squared / self.target()
        return [image.seconds / image.spp * spp for image in row.images]
