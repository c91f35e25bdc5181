//! The picture strip: one picture at growing counts of samples, the source's figure of
//! convergence.

use super::estimators::by_name;
use super::stopwatch::{Slot, Timed};
use super::{CostError, MakeTracer, Watch};
use crate::estimate::summarize;
use crate::film::Film;
use crate::scene::{Estimator, ImageSize, Scene};
use serde::Serialize;

/// Samples of every pixel in the pictures.
pub const STRIP_COUNTS: [u64; 6] = [1, 4, 16, 64, 256, 1024];

/// Longest side of the strip's pictures, in pixels.
pub const STRIP_SIDE: u32 = 144;

/// Pictures of one estimator.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Strip {
    /// The estimator.
    #[serde(serialize_with = "by_name")]
    pub estimator: Estimator,
    /// The pictures, as many as the budget allowed.
    pub pictures: Vec<StripPicture>,
}

/// One picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StripPicture {
    /// Samples of every pixel.
    pub samples: u64,
    /// Seconds for the whole picture at the strip's size.
    pub seconds: f64,
    /// Relative RMS error; `None` with one sample, or without light.
    pub relative_error: Option<f64>,
    /// What was recorded.
    #[serde(skip)]
    pub film: Film,
}

/// The picture's size, made smaller so that its longer side is at most [`STRIP_SIDE`].
pub(super) fn strip_size(size: ImageSize) -> ImageSize {
    let longer = size.width().max(size.height());
    if longer <= STRIP_SIDE {
        return size;
    }
    let scaled = |side: u32| (side * STRIP_SIDE).div_ceil(longer).max(1);
    ImageSize::new(scaled(size.width()), scaled(size.height())).unwrap_or(size)
}

/// Takes the pictures of one estimator, as many as fit into the slot.
pub(super) fn strip(
    scene: &Scene,
    device: MakeTracer,
    mut slot: Slot,
    watch: &mut Watch,
) -> Result<Strip, CostError> {
    let scene = scene.clone().with_size(strip_size(scene.size()));
    let mut timed = Timed::new(device(&scene)?, &scene);
    let mut pictures = Vec::new();
    for samples in STRIP_COUNTS {
        #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
        let expected = timed.pace() * (samples - timed.done()) as f64;
        if timed.done() > 1 && expected > slot.left() {
            break;
        }
        while timed.done() < samples {
            timed.trace_to(samples.min(4 * timed.done().max(1)))?;
            slot.report(watch)?;
        }
        if samples == 1 {
            // The first picture compiled the kernel, and its time says nothing about the next.
            slot = slot.restarted();
        }
        let film = timed.tracer().film()?;
        let relative_error = summarize(&film).relative_error;
        pictures.push(StripPicture { samples, seconds: timed.seconds(), relative_error, film });
    }
    Ok(Strip { estimator: scene.settings().estimator(), pictures })
}

#[cfg(test)]
mod tests {
    use super::strip_size;
    use crate::scene::ImageSize;

    #[test]
    fn the_strip_keeps_the_shape_and_enlarges_nothing() {
        for ((w, h), expected) in
            [((512, 512), (144, 144)), ((64, 48), (64, 48)), ((65535, 1), (144, 1))]
        {
            let size = strip_size(ImageSize::new(w, h).expect("a size"));
            assert_eq!((size.width(), size.height()), expected);
        }
    }
}
