//! `candor replay`: one sample traced again, on the device and on the twin.

use super::args::{DeviceChoice, EstimatorChoice, ReplayArgs, SamplingArgs};
use super::choose::{self, Chosen};
use super::replay_table::table;
use super::{DONE, Refusal, refuse, replay_json, setup, streams};
use crate::bound::sample_scale;
use crate::cpu::{self, PreparedScene, SampleKey};
use crate::gpu::{Gpu, Replayer};
use crate::replay::{Parting, parting};
use crate::scene::{ImageSize, Scene};
use crate::tracer::Description;
use crate::trail::Trail;
use crate::viewpoint::Viewpoint;

pub(super) fn run(args: &ReplayArgs) -> Result<u8, Refusal> {
    if args.estimator == Some(EstimatorChoice::Auto) {
        return refuse("replay traces one estimator's sample; --estimator auto is for render");
    }
    let sampling = SamplingArgs { spp: None, estimator: args.estimator };
    let (scene, source) = setup::load(&args.scene, &args.common, &sampling)?;
    let pixel = pixel_number(args.pixel, scene.size())?;
    let chosen = choose::choose(&args.common.device, args.common.threads)?;
    setup::check_range(&scene, &source, &[chosen.arithmetic()])?;
    let replayed = Replayed::of(args, scene, pixel, &chosen)?;
    if replayed.device.is_none() && args.common.device != DeviceChoice::Cpu && !args.common.quiet {
        streams::message("no Vulkan, Metal or DX12 device opens here; the twin's path alone");
    }
    let report = if args.common.json { replay_json::json(&replayed) } else { table(&replayed) };
    streams::results(&report)?;
    Ok(DONE)
}

/// A sample that was traced again.
pub(super) struct Replayed {
    pub file: String,
    pub scene: Scene,
    /// Column and row, from the top left.
    pub pixel: (u32, u32),
    pub sample: u64,
    /// Largest value of a valid sample.
    pub bound: f32,
    pub device: Option<(Description, Trail)>,
    pub twin: Trail,
    /// Where the two part, if they do.
    pub parting: Option<Parting>,
}

impl Replayed {
    fn of(args: &ReplayArgs, scene: Scene, pixel: u32, chosen: &Chosen) -> Result<Self, Refusal> {
        let device = match chosen {
            Chosen::Twin(_) => None,
            Chosen::Adapter(adapter) => {
                let gpu = Gpu::open(adapter)?;
                let trail = Replayer::new(&scene, &gpu)?.replay(pixel, args.sample)?;
                Some((adapter.describe(), trail))
            }
        };
        let key = SampleKey { pixel, index: args.sample };
        let twin = cpu::replay(&PreparedScene::new(&scene), key);
        let viewpoint = Viewpoint::of(&scene);
        Ok(Self {
            file: args.scene.display().to_string(),
            pixel: args.pixel,
            sample: args.sample,
            bound: sample_scale(&scene).bound(),
            parting: device.as_ref().and_then(|(_, trail)| parting(trail, &twin, &viewpoint)),
            device,
            twin,
            scene,
        })
    }
}

/// The number of a pixel, row by row from the top.
fn pixel_number((column, row): (u32, u32), size: ImageSize) -> Result<u32, Refusal> {
    let (width, height) = (size.width(), size.height());
    if column >= width || row >= height {
        return refuse(format_args!(
            "--pixel {column},{row} is not in the picture of {width}x{height} pixels: columns go \
             from 0 to {}, rows from 0 at the top to {}",
            width - 1,
            height - 1
        ));
    }
    Ok(row * width + column)
}
