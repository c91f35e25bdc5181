//! Traces one sample again on a device and records what its path does.

use super::bands::read_buffer;
use super::device::Gpu;
use super::iterations::check_iterations;
use super::pipeline::Pipeline;
use super::scene::{Binding, SceneBuffers, WRITTEN};
use super::tracer::buffer;
use crate::bound::sample_scale;
use crate::effects::Effects;
use crate::kernel::{self, Kernel, KernelUnits, Packed, layout};
use crate::scene::Scene;
use crate::tracer::TraceError;
use crate::trail::{Connection, Ending, Segment, Trail, Vertex};
use crate::viewpoint::Viewpoint;
use glam::{DVec3, Vec3};

/// A scene on a device, ready to trace single samples again.
#[derive(Debug)]
pub struct Replayer<'a> {
    scene: &'a Scene,
    gpu: &'a Gpu,
    pipeline: wgpu::ComputePipeline,
    request: wgpu::Buffer,
    replayed: wgpu::Buffer,
    group: wgpu::BindGroup,
    back: BackToScene,
}

impl<'a> Replayer<'a> {
    /// Takes the scene to the device, with the text of the kernel that renders it.
    ///
    /// # Errors
    /// If the scene does not fit the device.
    pub fn new(scene: &'a Scene, gpu: &'a Gpu) -> Result<Self, TraceError> {
        let viewpoint = Viewpoint::of(scene);
        let effects = Effects::of(scene, &viewpoint);
        let packed = kernel::pack(scene, &viewpoint, effects, sample_scale(scene));
        check_iterations(scene, effects, &packed)?;
        Self::with_kernel(scene, gpu, &packed, &Kernel::of(scene, effects, &packed).replay_wgsl())
    }

    /// The same with a packed scene and the text of a kernel; the tests use it to replay
    /// kernels that are wrong on purpose.
    ///
    /// # Errors
    /// If the device does not take the kernel.
    pub fn with_kernel(
        scene: &'a Scene,
        gpu: &'a Gpu,
        packed: &Packed,
        wgsl: &str,
    ) -> Result<Self, TraceError> {
        let device = gpu.device();
        let buffers = SceneBuffers::new(gpu, packed)?;
        let request = buffer::<layout::Request>(
            device,
            "request",
            wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        );
        let segments = u64::from(scene.settings().bounces()) + 1;
        let replayed = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("replayed"),
            size: segments * size_of::<layout::Replay>() as u64,
            usage: wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let own = [
            Binding::new(1, wgpu::BufferBindingType::Uniform, &request),
            Binding::new(2, WRITTEN, &replayed),
        ];
        let bindings = [buffers.bindings(), &own].concat();
        let pipeline = Pipeline::new(device, wgsl, "replay", &bindings);
        gpu.check()?;
        let group = pipeline.bind(device, &bindings);
        gpu.check()?;
        let back = BackToScene::new(scene, packed);
        Ok(Self { scene, gpu, pipeline: pipeline.compute, request, replayed, group, back })
    }

    /// The path of the sample `index` of a pixel, which is numbered row by row from the top.
    ///
    /// # Errors
    /// If the device fails.
    pub fn replay(&self, pixel: u32, index: u64) -> Result<Trail, TraceError> {
        let records = self.record(pixel, index)?;
        let mut segments = Vec::new();
        for (bounce, record) in (0..).zip(records.iter().filter(|record| record.reached == 1)) {
            let segment = self.back.segment(record, bounce);
            segments.push(segment);
            if record.goes_on == 0 {
                let ending = self.ending(record, segment.vertex, bounce);
                return Ok(Trail::ended(segments, ending, record.sample));
            }
        }
        // The kernel had no more segments for a path that was still under way.
        let sample = records.first().map_or([0.0; 3], |record| record.sample);
        Ok(Trail::ended(segments, Ending::Unfinished, sample))
    }

    fn ending(&self, record: &layout::Replay, last: Option<Vertex>, bounce: u32) -> Ending {
        if record.finished == 0 || record.sphere == layout::UNFINISHED {
            return Ending::Unfinished;
        }
        let surface = last.map(|vertex| self.scene.spheres()[vertex.sphere].surface());
        let settings = self.scene.settings();
        Ending::at(surface, bounce, settings.bounces(), settings.estimator())
    }

    /// Records every segment that a path can have; zeros where this one has none.
    fn record(&self, pixel: u32, index: u64) -> Result<Vec<layout::Replay>, TraceError> {
        #[expect(clippy::cast_possible_truncation, reason = "takes the two words apart")]
        let request =
            layout::Request { pixel, index_low: index as u32, index_high: (index >> 32) as u32 };
        self.gpu.queue().write_buffer(&self.request, 0, bytemuck::bytes_of(&request));
        let mut encoder =
            self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(&self.replayed, 0, None);
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.dispatch_workgroups(self.scene.settings().bounces() + 1, 1, 1);
        }
        self.gpu.run(encoder)?;
        Ok(bytemuck::pod_collect_to_vec(&read_buffer(self.gpu, &self.replayed)?))
    }
}

/// The way from kernel units back to the scene's, in `f64`.
#[derive(Debug)]
struct BackToScene {
    /// Places among the scene's spheres, in the order of the packed ones.
    spheres: Vec<usize>,
    /// The camera, where the kernel starts its rays before the scene instead.
    far_camera: Option<DVec3>,
    /// Kernel units per scene unit.
    scale: f64,
    /// The scene's origin in kernel units.
    origin: DVec3,
}

impl BackToScene {
    fn new(scene: &Scene, packed: &Packed) -> Self {
        let viewpoint = Viewpoint::of(scene);
        let units = KernelUnits::of(&viewpoint);
        Self {
            spheres: packed.spheres.iter().map(|sphere| sphere.index as usize).collect(),
            far_camera: (viewpoint.approach() > 0.0).then(|| scene.camera().position()),
            scale: units.length(1.0),
            origin: units.point(DVec3::ZERO),
        }
    }

    fn point(&self, p: [f32; 3]) -> DVec3 {
        (Vec3::from(p).as_dvec3() - self.origin) / self.scale
    }

    /// A record in the scene's terms. The way from a far camera to where the kernel starts its
    /// rays counts to the first segment.
    fn segment(&self, record: &layout::Replay, bounce: u32) -> Segment {
        let direction = Vec3::from(record.direction).as_dvec3();
        let start = self.point(record.origin);
        let (origin, skipped) = match self.far_camera {
            Some(camera) if bounce == 0 => (camera, start.distance(camera)),
            _ => (start, 0.0),
        };
        Segment {
            origin,
            direction,
            vertex: self.place(record.sphere).map(|sphere| Vertex {
                sphere,
                distance: skipped + f64::from(record.distance) / self.scale,
                position: self.point(record.position),
                normal: Vec3::from(record.normal).as_dvec3(),
            }),
            connection: self
                .place(record.light)
                .map(|light| Connection { light, visible: record.visible == 1 }),
            weight: Vec3::from(record.throughput).as_dvec3(),
            radiance: Vec3::from(record.radiance).as_dvec3(),
        }
    }

    /// A place among the packed spheres, among the scene's spheres.
    fn place(&self, place: u32) -> Option<usize> {
        self.spheres.get(place as usize).copied()
    }
}
