"""Markdown of a finished comparison."""

import math
import statistics

from measure import TARGET

# The image mean of green by a path tracer in f64, and its standard error.
TRUE_GREEN, TRUE_GREEN_ERROR = 0.32660, 2e-5


def spread(values, digits):
    """Median, and lowest..highest, as two cells."""
    middle = f"{statistics.median(values):.{digits}f}"
    return f"{middle} | {min(values):.{digits}f}..{max(values):.{digits}f}"


def speed(comparison):
    """Every row's way to the target."""
    lines = [
        "| renderer | estimator | Msamples/s | pixel variance × spp "
        f"| seconds to {TARGET * 100:g} % | lowest..highest | ratio to Mitsuba, independent |",
        "|---|---|---|---|---|---|---|",
    ]
    yardstick = comparison.seconds_to_target(comparison.independent)
    shown = [row for row in comparison.paced if row is not comparison.shown]
    for row in [*shown, comparison.stratified]:
        rate = statistics.median(image.rate() for image in row.images) / 1e6
        variance = comparison.variance(row)
        seconds = comparison.seconds_to_target(row)
        ratio = statistics.median(ours / theirs for ours, theirs in zip(seconds, yardstick))
        lines.append(
            f"| {row.renderer} | {row.setting} | {rate:.2f} "
            f"| {variance.squared:.4f} ± {variance.doubt:.4f} | {spread(seconds, 1)} | {ratio:.2f} |"
        )
    return lines


def ladder(comparison):
    """The stratified sampler, setting by setting."""
    lines = [
        "| Mitsuba, rendered once | Msamples/s | relative RMS error | seconds |",
        "|---|---|---|---|",
    ]
    for row, image in zip(comparison.rungs, comparison.climbed):
        error = percent(comparison, row, image)
        lines.append(
            f"| {row.setting} | {image.rate() / 1e6:.2f} | {error} | {image.seconds:.1f} |"
        )
    return lines


def direct(comparison):
    """The renders with as many samples as the target takes."""
    lines = [
        "| rendered once | spp | seconds | relative RMS error, measured | as stated by the renderer |",
        "|---|---|---|---|---|",
    ]
    for row in (comparison.mis, comparison.independent):
        image = comparison.direct[row.setting]
        stated = "—" if image.claimed is None else f"{image.claimed * 100:.3f} %"
        lines.append(
            f"| {row.renderer}, {row.setting} | {image.spp} | {image.seconds:.1f} "
            f"| {percent(comparison, row, image)} | {stated} |"
        )
    return lines


def percent(comparison, row, image):
    """An image's relative error with its own standard error."""
    error, brightness = comparison.error(row, image), comparison.brightness()
    if error.squared <= error.doubt:
        return f"below {math.sqrt(3.0 * error.doubt) / brightness * 100.0:.2g} %"
    root = math.sqrt(error.squared)
    relative, doubt = root / brightness, error.doubt / (2.0 * root) / brightness
    return f"{relative * 100.0:.3f} ± {doubt * 100.0:.3f} %"


def look_cost(comparison):
    """What it costs that candor looks at its error while it renders."""
    pairs = zip(comparison.shown.images, comparison.mis.images)
    costs = [(quiet.rate() / shown.rate() - 1.0) * 100.0 for shown, quiet in pairs]
    return [
        "- Looking at the error while rendering costs "
        f"{statistics.median(costs):.1f} % of the time "
        f"({min(costs):.1f}..{max(costs):.1f} in {len(costs)} turns)."
    ]


def stated(comparison):
    """How candor's own error compares with the measured one."""
    images = comparison.images(comparison.mis)
    samples = sum(image.spp for image in images)
    # Weighed as the measured variance is.
    claimed = sum((image.claimed * image.spp) ** 2 for image in images) / samples
    measured = comparison.variance(comparison.mis)
    ratio = math.sqrt(claimed / measured.squared) * comparison.brightness()
    doubt = ratio * measured.doubt / measured.squared / 2.0
    return [f"- candor's stated error is {ratio:.3f} ± {doubt:.3f} of the measured one (`mis`)."]


def pictures(comparison, found):
    """How far the pictures agree."""
    names = ("red", "green", "blue")
    channels = [
        f"{name} {mean:.5f} and {other:.5f}, off by {off:+.1e} ± {sure:.0e}"
        for name, mean, other, off, sure in zip(
            names,
            comparison.groups["candor"].rgb().mean(axis=(0, 1)),
            comparison.mitsuba_rgb().mean(axis=(0, 1)),
            found.difference,
            found.uncertainty,
        )
    ]
    return [
        f"- Image means, candor and Mitsuba: {'; '.join(channels)}. "
        f"The truth for green is {TRUE_GREEN:.5f} ± {TRUE_GREEN_ERROR:.0e}.",
        f"- Difference of {found.tiles} tiles in standard errors: rms {found.rms_z:.3f}, "
        f"worst {found.worst_z:.1f}.",
    ]
