//! Traces one sample again on a device and records what its path does.

use super::bands::read_buffer;
use super::device::Gpu;
use super::tracer::{bind, buffer, check_iterations, pipeline};
use crate::bound::sample_scale;
use crate::kernel::{self, Kernel, KernelUnits, Packed, layout};
use crate::scene::Scene;
use crate::tracer::TraceError;
use crate::trail::{Connection, Ending, Segment, Trail, Vertex};
use crate::viewpoint::Viewpoint;
use glam::{DVec3, Vec3};
use wgpu::util::DeviceExt;

/// The path of the sample `index` of a pixel (its number, row by row from the top), traced with
/// the text of the kernel that renders the scene.
///
/// # Errors
/// If the device fails or does not fit the scene.
pub fn replay(scene: &Scene, gpu: &Gpu, pixel: u32, index: u64) -> Result<Trail, TraceError> {
    let viewpoint = Viewpoint::of(scene);
    let packed = kernel::pack(scene, &viewpoint, sample_scale(scene))
        .map_err(|error| TraceError::Device(error.to_string()))?;
    let kernel = Kernel::of(scene, &viewpoint, &packed);
    check_iterations(scene, &packed)?;
    replay_with_kernel(scene, gpu, &packed, &kernel.replay_wgsl(), pixel, index)
}

/// The same with a packed scene and the text of a kernel; the tests use it to replay kernels
/// that are wrong on purpose.
///
/// # Errors
/// If the device fails or does not take the kernel.
pub fn replay_with_kernel(
    scene: &Scene,
    gpu: &Gpu,
    packed: &Packed,
    wgsl: &str,
    pixel: u32,
    index: u64,
) -> Result<Trail, TraceError> {
    let recorder = Recorder::new(gpu, &packed.scene, wgsl)?;
    let back = BackToScene::new(scene, packed);
    let mut segments = Vec::new();
    for bounce in 0..=scene.settings().bounces() {
        let record = recorder.record(pixel, index, bounce)?;
        if record.reached == 0 {
            break;
        }
        let segment = back.segment(&record, bounce);
        segments.push(segment);
        let surface = segment.vertex.map(|vertex| scene.spheres()[vertex.sphere].surface());
        let ending = if record.finished == 0 || record.sphere == layout::UNFINISHED {
            Ending::Unfinished
        } else {
            let settings = scene.settings();
            Ending::at(surface, bounce, settings.bounces(), settings.estimator())
        };
        if record.goes_on == 0 {
            return Ok(Trail::ended(segments, ending, record.sample));
        }
    }
    // The path was still under way when the kernel's segments were over.
    let sample = recorder.record(pixel, index, layout::NO_SPHERE)?.sample;
    Ok(Trail::ended(segments, Ending::Unfinished, sample))
}

/// The replay kernel on a device.
struct Recorder<'gpu> {
    gpu: &'gpu Gpu,
    pipeline: wgpu::ComputePipeline,
    request: wgpu::Buffer,
    replayed: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl<'gpu> Recorder<'gpu> {
    fn new(gpu: &'gpu Gpu, scene: &layout::Scene, wgsl: &str) -> Result<Self, TraceError> {
        let device = gpu.device();
        let pipeline = pipeline(device, wgsl, "replay");
        gpu.check()?;
        let scene = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("scene"),
            contents: bytemuck::bytes_of(scene),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let request = buffer::<layout::Request>(
            device,
            "request",
            wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        );
        let replayed = buffer::<layout::Replay>(
            device,
            "replayed",
            wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST,
        );
        let layout = pipeline.get_bind_group_layout(0);
        let group = bind(device, &layout, &[&scene, &request, &replayed]);
        gpu.check()?;
        Ok(Self { gpu, pipeline, request, replayed, group })
    }

    /// Traces the sample once and records one segment; zeros where the path does not reach it.
    fn record(&self, pixel: u32, index: u64, segment: u32) -> Result<layout::Replay, TraceError> {
        #[expect(clippy::cast_possible_truncation, reason = "takes the two words apart")]
        let request = layout::Request {
            pixel,
            index_low: index as u32,
            index_high: (index >> 32) as u32,
            segment,
        };
        self.gpu.queue().write_buffer(&self.request, 0, bytemuck::bytes_of(&request));
        let mut encoder =
            self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(&self.replayed, 0, None);
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.dispatch_workgroups(1, 1, 1);
        }
        self.gpu.run(encoder)?;
        Ok(bytemuck::pod_read_unaligned(&read_buffer(self.gpu, &self.replayed)?))
    }
}

/// The way from kernel units back to the scene's, in `f64`.
struct BackToScene<'a> {
    packed: &'a layout::Scene,
    /// The camera, where the kernel starts its rays before the scene instead.
    far_camera: Option<DVec3>,
    /// Kernel units per scene unit.
    scale: f64,
    /// The scene's origin in kernel units.
    origin: DVec3,
}

impl<'a> BackToScene<'a> {
    fn new(scene: &Scene, packed: &'a Packed) -> Self {
        let viewpoint = Viewpoint::of(scene);
        let units = KernelUnits::of(&viewpoint);
        Self {
            packed: &packed.scene,
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
            Some(camera) if bounce == 0 => (camera, (start - camera).dot(direction)),
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

    /// A place in the uniform buffer among the scene's spheres.
    fn place(&self, place: u32) -> Option<usize> {
        let sphere = self.packed.spheres[..self.packed.sphere_count as usize].get(place as usize);
        sphere.map(|sphere| sphere.index as usize)
    }
}
