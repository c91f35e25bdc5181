//! The CPU twin: the kernel's paths once more, in `f64`, written file for file with
//! `shaders/` and sharing nothing with it but the scene and the random integers. It
//! is the reference that devices are verified against, and renders where there is no
//! Vulkan at all.

mod blind;
mod connected;
mod interior;
mod light;
pub mod material;
pub mod nearest;
mod pick;
mod replay;
pub mod rng;
pub mod sampling;
mod scene;
pub mod sphere;
mod trace;
mod tree;
mod walk;

pub use replay::replay;
pub use rng::SampleKey;
pub use scene::{PreparedScene, Search};
pub use trace::{camera_ray, trace};

use crate::bound::sample_scale;
use crate::film::{Film, PixelSums, PixelWords, SampleScale};
use crate::scene::Scene;
use crate::tracer::{
    Description, InvalidReason, InvalidSample, LEDGER_RECORDS, Ledger, TraceError, Tracer,
};
use glam::Vec3;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::num::NonZeroUsize;
use std::ops::Range;

/// Traces on this machine's processor, in `f64`.
pub struct CpuTracer {
    scene: PreparedScene,
    film: Film,
    ledger: Ledger,
    pool: ThreadPool,
}

impl CpuTracer {
    /// Prepares a scene for `threads` threads; without a number, for as many as the
    /// machine runs at once.
    ///
    /// # Errors
    /// If the operating system refuses the threads.
    pub fn new(scene: &Scene, threads: Option<NonZeroUsize>) -> Result<Self, TraceError> {
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads.map_or(0, NonZeroUsize::get))
            .build()
            .map_err(|error| TraceError::Device(format!("cannot start the threads: {error}")))?;
        Ok(Self {
            scene: pool.install(|| PreparedScene::new(scene)),
            film: Film::new(scene.size(), sample_scale(scene)),
            ledger: Ledger::default(),
            pool,
        })
    }
}

impl Tracer for CpuTracer {
    fn add_samples(&mut self, range: Range<u64>) -> Result<(), TraceError> {
        self.film.claim(range.clone())?;
        let (scale, pixels) = (self.film.scale(), 0..self.film.size().pixels());
        let (scene, words) = (&self.scene, self.film.pixels_mut());
        let invalid = self.pool.install(|| {
            (pixels, words)
                .into_par_iter()
                .map(|(pixel, words)| add_to_pixel(scene, scale, pixel, range.clone(), words))
                .reduce(Ledger::default, merge)
        });
        self.ledger.append(invalid);
        Ok(())
    }

    fn restore(&mut self, film: &Film, ledger: &Ledger) -> Result<(), TraceError> {
        film.check_fits(self.film.size(), self.film.scale())?;
        self.film = film.clone();
        self.ledger = ledger.clone();
        Ok(())
    }

    fn film(&mut self) -> Result<Film, TraceError> {
        Ok(self.film.clone())
    }

    fn ledger(&mut self) -> Result<Ledger, TraceError> {
        Ok(self.ledger.clone())
    }

    fn describe(&self) -> Description {
        let threads = self.pool.current_num_threads();
        let plural = if threads == 1 { "" } else { "s" };
        Description {
            device: format!("CPU twin (f64, {threads} thread{plural})"),
            driver: concat!("candor ", env!("CARGO_PKG_VERSION")).to_owned(),
            software: true,
        }
    }
}

/// Adds the samples `range` of one pixel to its words; returns those that are invalid.
fn add_to_pixel(
    scene: &PreparedScene,
    scale: SampleScale,
    pixel: u32,
    range: Range<u64>,
    words: &mut PixelWords,
) -> Ledger {
    let mut invalid = Ledger::default();
    let mut sums = PixelSums::of(words);
    for index in range {
        let radiance = trace(scene, SampleKey { pixel, index }).as_vec3();
        if radiance == Vec3::ZERO {
            continue;
        }
        let radiance = radiance.to_array();
        if scale.admits(radiance) {
            sums.add(radiance, scale);
        } else if let Some(reason) = InvalidReason::of(radiance, scale.bound()) {
            record_invalid(&mut invalid, InvalidSample { pixel, index, reason });
        }
    }
    *words = sums.words();
    invalid
}

fn record_invalid(ledger: &mut Ledger, sample: InvalidSample) {
    ledger.count += 1;
    if ledger.records.len() < LEDGER_RECORDS {
        ledger.records.push(sample);
    }
}

/// Both ledgers of one range of samples together. Of the records the smallest addresses stay,
/// so that they do not depend on which thread came first.
fn merge(mut ours: Ledger, theirs: Ledger) -> Ledger {
    ours.count += theirs.count;
    ours.records.extend(theirs.records);
    ours.records.sort_unstable_by_key(|record| (record.pixel, record.index));
    ours.records.truncate(LEDGER_RECORDS);
    ours
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, ImageSize, Radiance, RenderSettings, Sphere, Surface};
    use glam::DVec3;

    /// Inside a light of radiance 10, so that every sample is 10.
    fn tracer(bound: f64, threads: usize) -> CpuTracer {
        let camera = Camera::new(DVec3::ZERO, DVec3::X, DVec3::Z, 60.0).expect("a camera");
        let light = Surface::Emitter(Radiance::new(DVec3::splat(10.0)).expect("a radiance"));
        let spheres = vec![Sphere::new(DVec3::ZERO, 1.0, light).expect("a sphere")];
        let size = ImageSize::new(9, 7).expect("a size");
        let scene = Scene::new(camera, size, RenderSettings::default(), spheres);
        let mut tracer = CpuTracer::new(&scene, NonZeroUsize::new(threads)).expect("threads");
        tracer.film = Film::new(size, SampleScale::from_bound(bound));
        tracer
    }

    #[test]
    fn invalid_samples_are_counted_and_the_first_addresses_kept() {
        for threads in [1, 2, 3] {
            let mut tracer = tracer(9.0, threads);
            tracer.add_samples(5..10).expect("samples");
            tracer.add_samples(0..5).expect("samples");
            assert_eq!(tracer.ledger.count, 9 * 7 * 10);
            let addresses: Vec<_> =
                tracer.ledger.records.iter().map(|r| (r.pixel, r.index)).collect();
            // Those of the first call, pixel by pixel.
            let first: Vec<_> = (0..16).map(|i| (i / 5, u64::from(5 + i % 5))).collect();
            assert_eq!(addresses, first);
            assert!(tracer.film.pixels().iter().flatten().all(|&word| word == 0));
            assert_eq!(tracer.film.samples().count(), 10);
        }
    }

    #[test]
    fn a_sample_at_the_bound_is_valid() {
        let mut tracer = tracer(10.0, 2);
        tracer.add_samples(0..3).expect("samples");
        assert_eq!(tracer.ledger.count, 0);
    }
}
