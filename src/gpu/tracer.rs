//! Traces on a device: one invocation per pixel sample, sums in bands of the film.

use super::bands::{self, Band};
use super::device::Gpu;
use super::iterations::check_iterations;
use super::pace::Pace;
use super::pipeline::Pipeline;
use super::scene::{Binding, SceneBuffers, WRITTEN};
use crate::bound::sample_scale;
use crate::effects::Effects;
use crate::film::{Film, FilmError, SampleRanges, SampleScale};
use crate::kernel::{self, Kernel, Packed, Tile, layout};
use crate::scene::{ImageSize, Scene};
use crate::tracer::{Description, InvalidReason, InvalidSample, Ledger, TraceError, Tracer};
use crate::viewpoint::Viewpoint;
use std::ops::Range;
use std::time::{Duration, Instant};

/// The device counts invalid samples in 32 bits, so its ledger is taken to the host before it
/// can have met that many: after this many samples and one more dispatch, which is shorter.
const MAX_UNREAD: u64 = 1 << 31;

/// Workgroups along one dimension of a dispatch, WebGPU's default limit.
const MAX_WORKGROUPS: u32 = 65_535;

/// A scene on a device.
#[derive(Debug)]
pub struct GpuTracer {
    gpu: Gpu,
    size: ImageSize,
    scale: SampleScale,
    tile: Tile,
    samples: SampleRanges,
    /// Bytes of the scene's buffers.
    scene_bytes: u64,
    pipeline: wgpu::ComputePipeline,
    /// What making it took.
    compiling: Duration,
    work: wgpu::Buffer,
    ledger: wgpu::Buffer,
    /// What was taken from the device's ledger so far.
    invalid: Ledger,
    /// Samples since then.
    unread: u64,
    bands: Vec<(Band, wgpu::BindGroup)>,
    pace: Pace,
}

impl GpuTracer {
    /// Puts a scene on a device, with the kernel that the scene calls for.
    ///
    /// # Errors
    /// If scene or picture do not fit the device.
    pub fn new(scene: &Scene, gpu: Gpu) -> Result<Self, TraceError> {
        let viewpoint = Viewpoint::of(scene);
        Self::seen_from(&viewpoint, scene, gpu, Effects::of(scene, &viewpoint))
    }

    /// The same with a kernel for more effects than the scene calls for.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_effects(scene: &Scene, gpu: Gpu, effects: Effects) -> Result<Self, TraceError> {
        Self::seen_from(&Viewpoint::of(scene), scene, gpu, effects)
    }

    fn seen_from(
        viewpoint: &Viewpoint,
        scene: &Scene,
        gpu: Gpu,
        effects: Effects,
    ) -> Result<Self, TraceError> {
        let packed = kernel::pack(scene, viewpoint, effects, sample_scale(scene));
        check_iterations(scene, effects, &packed)?;
        Self::with_kernel(scene, gpu, &packed, &Kernel::of(scene, effects, &packed).wgsl())
    }

    /// Puts a packed scene and the text of a kernel on the device; the tests use it to
    /// run kernels that are wrong on purpose.
    ///
    /// # Errors
    /// If scene, kernel or picture do not fit the device.
    pub fn with_kernel(
        scene: &Scene,
        gpu: Gpu,
        packed: &Packed,
        wgsl: &str,
    ) -> Result<Self, TraceError> {
        let device = gpu.device();
        let buffers = SceneBuffers::new(&gpu, packed)?;
        let work = buffer::<layout::Dispatch>(
            device,
            "work",
            wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        );
        let ledger = buffer::<layout::Ledger>(
            device,
            "ledger",
            wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST,
        );
        let bands = bands::allocate(&gpu, scene.size())?;
        let bindings = |band: &Band| {
            let own = [
                Binding::new(1, wgpu::BufferBindingType::Uniform, &work),
                Binding::new(2, WRITTEN, &band.buffer),
                Binding::new(3, WRITTEN, &ledger),
            ];
            [buffers.bindings(), &own].concat()
        };
        let started = Instant::now();
        let pipeline = Pipeline::new(device, wgsl, "render", &bindings(&bands[0]));
        gpu.check()?;
        let compiling = started.elapsed();
        let groups: Vec<wgpu::BindGroup> =
            bands.iter().map(|band| pipeline.bind(device, &bindings(band))).collect();
        gpu.check()?;
        Ok(Self {
            size: scene.size(),
            scale: sample_scale(scene),
            tile: Tile::of(scene.size()),
            samples: SampleRanges::default(),
            scene_bytes: buffers.bytes(),
            pipeline: pipeline.compute,
            compiling,
            work,
            ledger,
            invalid: Ledger::default(),
            unread: 0,
            bands: bands.into_iter().zip(groups).collect(),
            pace: Pace::after(0),
            gpu,
        })
    }

    /// With smaller dispatches, for a device that was lost `losses` times in a row: a quarter for
    /// each of them.
    #[must_use]
    pub fn paced_for(self, losses: u32) -> Self {
        Self { pace: Pace::after(losses), ..self }
    }

    /// How long it took to make the pipeline from the kernel's text. Some drivers compile it only
    /// when it is dispatched first.
    #[must_use]
    pub fn compiling(&self) -> Duration {
        self.compiling
    }

    /// Bytes of the buffers on the device, the one for reading back included.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        let films: u64 = self.bands.iter().map(|(band, _)| band.buffer.size()).sum();
        let dispatches = self.work.size() + self.ledger.size();
        films + bands::staging_bytes(films) + self.scene_bytes + dispatches
    }

    fn bands(&self) -> Vec<&Band> {
        self.bands.iter().map(|(band, _)| band).collect()
    }

    /// Traces `count` samples from `first` on, of the given rows of a band.
    fn dispatch(
        &mut self,
        band: usize,
        rows: Range<u32>,
        first: u64,
        count: u32,
    ) -> Result<(), TraceError> {
        let (band, group) = &self.bands[band];
        #[expect(clippy::cast_possible_truncation, reason = "takes the two words apart")]
        let work = layout::Dispatch {
            first_sample_low: first as u32,
            first_sample_high: (first >> 32) as u32,
            sample_count: count,
            band_start: band.rows.start,
            row_start: rows.start,
            row_end: rows.end,
        };
        let started = Instant::now();
        self.gpu.queue().write_buffer(&self.work, 0, bytemuck::bytes_of(&work));
        let mut encoder =
            self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.dispatch_workgroups(
                self.size.width().div_ceil(self.tile.width),
                (rows.end - rows.start).div_ceil(self.tile.height),
                count.div_ceil(self.tile.samples),
            );
        }
        self.gpu.run(encoder)?;
        let samples =
            u64::from(self.size.width()) * u64::from(rows.end - rows.start) * u64::from(count);
        self.pace.learn(samples, started.elapsed());
        self.unread += samples;
        if self.unread >= MAX_UNREAD { self.take_ledger() } else { Ok(()) }
    }

    /// Moves what the device's ledger holds to the host's.
    fn take_ledger(&mut self) -> Result<(), TraceError> {
        let bytes = bands::read_buffer(&self.gpu, &self.ledger)?;
        let ledger: layout::Ledger = bytemuck::pod_read_unaligned(&bytes);
        let records = ledger.records.as_chunks().0.iter().take(ledger.count as usize);
        self.invalid.append(Ledger {
            count: u64::from(ledger.count),
            records: records.map(|record| invalid_sample(record, self.scale.bound())).collect(),
        });
        self.unread = 0;
        let mut encoder =
            self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(&self.ledger, 0, None);
        self.gpu.run(encoder)
    }

    /// Samples of every pixel that one round of dispatches traces, at most `left`.
    fn round(&self, left: u64) -> u32 {
        let frame = u64::from(self.size.width()) * self.bands[0].0.rows.len() as u64;
        let most = u64::from(MAX_WORKGROUPS * self.tile.samples).min(left);
        least((self.pace.samples() / frame).max(1), most)
    }

    /// Rows of one dispatch that traces `count` samples of each pixel, at most `left`.
    fn rows(&self, count: u32, left: u32) -> u32 {
        let row = u64::from(self.size.width()) * u64::from(count);
        let tiles = self.pace.samples() / row / u64::from(self.tile.height);
        least(tiles.max(1) * u64::from(self.tile.height), u64::from(left))
    }
}

impl Tracer for GpuTracer {
    fn add_samples(&mut self, range: Range<u64>) -> Result<(), TraceError> {
        let mut samples = self.samples.clone();
        samples.insert(range.clone()).map_err(FilmError::from)?;
        let mut first = range.start;
        while first < range.end {
            let count = self.round(range.end - first);
            for band in 0..self.bands.len() {
                let Range { mut start, end } = self.bands[band].0.rows.clone();
                while start < end {
                    let rows = self.rows(count, end - start);
                    self.dispatch(band, start..start + rows, first, count)?;
                    start += rows;
                }
            }
            first += u64::from(count);
        }
        self.samples = samples;
        Ok(())
    }

    fn restore(&mut self, film: &Film, ledger: &Ledger) -> Result<(), TraceError> {
        film.check_fits(self.size, self.scale)?;
        self.take_ledger()?;
        bands::write(&self.gpu, &self.bands(), film.pixels())?;
        self.samples = film.samples().clone();
        self.invalid = ledger.clone();
        Ok(())
    }

    fn film(&mut self) -> Result<Film, TraceError> {
        let mut film = Film::awaiting(self.size, self.scale, self.samples.clone());
        bands::read(&self.gpu, &self.bands(), film.pixels_mut())?;
        Ok(film)
    }

    fn ledger(&mut self) -> Result<Ledger, TraceError> {
        self.take_ledger()?;
        Ok(self.invalid.clone())
    }

    fn describe(&self) -> Description {
        self.gpu.description().clone()
    }
}

/// A record of the device's ledger, and what its bits say of the reason.
fn invalid_sample(record: &[u32; layout::RECORD_WORDS], bound: f32) -> InvalidSample {
    let &[pixel, low, high, finished, r, g, b, _] = record;
    let wrong = InvalidReason::of([r, g, b].map(f32::from_bits), bound);
    InvalidSample {
        pixel,
        index: u64::from(high) << 32 | u64::from(low),
        reason: match wrong {
            _ if finished == 0 => InvalidReason::Unfinished,
            Some(reason) => reason,
            None => InvalidReason::AboveBound,
        },
    }
}

pub(super) fn buffer<T>(
    device: &wgpu::Device,
    label: &str,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size_of::<T>() as u64,
        usage,
        mapped_at_creation: false,
    })
}

fn least(a: u64, b: u64) -> u32 {
    u32::try_from(a.min(b)).expect("both are counts of rows or of samples in one dispatch")
}
