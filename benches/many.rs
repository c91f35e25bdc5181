//! How the time of a path grows from 8 spheres to a million, by loop and by hierarchy, in
//! turns and as medians: `cargo bench --bench many [-- --rounds N --most N --device NAME]`;
//! `-- --ablate N` says what each part of the way through the hierarchy of N spheres takes.
//!
//! The scene is the uniform volume: diffuse spheres that fill 5 % of a cube under a sky, two
//! bounces, `implicit`. Segments are counted on the device. Ratios are of processor time, which
//! others on the machine hardly change. Markdown on stdout.

#![allow(clippy::cast_precision_loss, reason = "rates and ratios for show")]

#[path = "support/ablations.rs"]
mod ablations;
#[path = "support/counted.rs"]
mod counted;
#[path = "support/options.rs"]
mod options;
#[path = "support/processor.rs"]
mod processor;
#[path = "support/turns.rs"]
mod turns;
#[path = "support/volume.rs"]
mod volume;

use candor::bound::sample_scale;
use candor::effects::{Effect, Effects};
use candor::gpu::{Adapter, GpuTracer};
use candor::hierarchy::{Bounds, Hierarchy};
use candor::kernel::{self, Kernel, Packed};
use candor::scene::{ImageSize, Scene};
use candor::tracer::Tracer;
use candor::viewpoint::Viewpoint;
use counted::{Counted, counted};
use processor::{Took, timed};
use turns::{Middle, median};

/// Numbers of spheres.
const COUNTS: [usize; 11] = [8, 16, 32, 64, 80, 100, 200, 1000, 10_000, 100_000, 1_000_000];

/// More of them are not gone through in a loop: it would come near lavapipe's limit.
const MOST_LOOPED: usize = 1000;

/// What the way through a hierarchy is called.
const HIERARCHY: &str = "hierarchy";

/// Pixels of a side.
const SIDE: u32 = 256;

/// Least seconds of one measurement.
const LEAST: f64 = 0.2;

fn main() {
    let rounds = options::count("--rounds").unwrap_or(9);
    let most = options::count("--most").map_or(usize::MAX, whole);
    let adapter = options::adapter();
    println!("{} ({}), {rounds} rounds\n", adapter.name(), adapter.driver());
    if let Some(count) = options::count("--ablate").map(whole) {
        return ablations::print(&volume(count), &adapter, rounds);
    }
    let counts = || COUNTS.into_iter().filter(|&count| count <= most);
    let mut ways: Vec<Way> = counts().flat_map(|count| ways(count, &adapter)).collect();
    for round in 0..ways.len() * whole(rounds) {
        let at = (round + round / ways.len()) % ways.len();
        ways[at].measure();
    }
    print_ways(&ways);
    print_preparation(counts(), whole(rounds));
}

fn whole(count: u64) -> usize {
    usize::try_from(count).expect("a count that memory holds")
}

fn volume(count: usize) -> Scene {
    volume::scene(count, ImageSize::new(SIDE, SIDE).expect("a size"))
}

/// One way through the spheres of a scene.
struct Way {
    spheres: usize,
    name: &'static str,
    /// Whether candor renders the scene so.
    is_own: bool,
    tracer: GpuTracer,
    counted: Counted,
    spp: u64,
    traced: u64,
    took: Vec<Took>,
}

/// The ways through so many spheres.
fn ways(count: usize, adapter: &Adapter) -> Vec<Way> {
    let scene = volume(count);
    let viewpoint = Viewpoint::of(&scene);
    let own = Effects::of(&scene, &viewpoint);
    let counted = count_in(&scene, &viewpoint, own, adapter);
    let choices = [own.without(Effect::Hierarchy), own.with(Effect::Hierarchy)];
    let possible = choices.into_iter().skip(usize::from(count > MOST_LOOPED));
    possible
        .map(|effects| {
            let packed = kernel::pack(&scene, &viewpoint, effects, sample_scale(&scene));
            let kernel = Kernel::of(&scene, effects, &packed);
            let name = match (&kernel.written, packed.nodes.is_empty()) {
                (Some(_), _) => "written out",
                (None, true) => "loop",
                (None, false) => HIERARCHY,
            };
            let way = (count, name, effects == own);
            Way::new(way, counted, tracer(&scene, adapter, &packed, &kernel.wgsl()))
        })
        .collect()
}

/// What rays look at; hits are the same by any way.
fn count_in(scene: &Scene, viewpoint: &Viewpoint, effects: Effects, adapter: &Adapter) -> Counted {
    let effects = effects.with(Effect::Hierarchy);
    let packed = kernel::pack(scene, viewpoint, effects, sample_scale(scene));
    let wgsl = Kernel::of(scene, effects, &packed).wgsl();
    counted(&wgsl, |wgsl| tracer(scene, adapter, &packed, wgsl))
}

/// A tracer with the text of a kernel.
fn tracer(scene: &Scene, adapter: &Adapter, packed: &Packed, wgsl: &str) -> GpuTracer {
    let tracer = GpuTracer::with_kernel(scene, options::open(adapter), packed, wgsl);
    tracer.expect("the device takes the scene")
}

impl Way {
    /// With as many samples a round as take long enough.
    fn new(
        (spheres, name, is_own): (usize, &'static str, bool),
        counted: Counted,
        tracer: GpuTracer,
    ) -> Self {
        let mut way =
            Self { spheres, name, is_own, tracer, counted, spp: 1, traced: 0, took: Vec::new() };
        loop {
            way.measure();
            if way.took.pop().is_some_and(|took| took.wall > LEAST) {
                return way;
            }
            way.spp *= 2;
        }
    }

    fn measure(&mut self) {
        let samples = self.traced..self.traced + self.spp;
        self.traced = samples.end;
        self.took.push(timed(|| self.tracer.add_samples(samples).expect("samples")));
    }

    /// Nanoseconds a segment, by the clock and of processors, round by round.
    fn nanoseconds(&self) -> [Vec<f64>; 2] {
        let segments = (self.spp * u64::from(SIDE * SIDE)) as f64 * self.counted.segments;
        let each = |part: fn(&Took) -> f64| {
            self.took.iter().map(|took| part(took) * 1e9 / segments).collect()
        };
        [each(|took| took.wall), each(|took| took.processor)]
    }
}

fn print_ways(ways: &[Way]) {
    println!(
        "| spheres | way | ns a sample | segments a sample | ns a segment | processor, ns a segment \
         | to 8 spheres | to the loop | nodes a segment | spheres a segment |\n\
         |---|---|---|---|---|---|---|---|---|---|"
    );
    let first = &ways[0].nanoseconds()[1];
    for (at, way) in ways.iter().enumerate() {
        let [wall, processor] = way.nanoseconds();
        let beside = at.checked_sub(1).map(|at| &ways[at]);
        let beside = beside.filter(|beside| beside.spheres == way.spheres);
        let to_loop = beside.map_or_else(String::new, |beside| {
            ratio(&processor, &beside.nanoseconds()[1]).to_string()
        });
        let looked_at = if way.name == HIERARCHY {
            format!("{:.1} | {:.2}", way.counted.nodes, way.counted.spheres)
        } else {
            " | ".to_owned()
        };
        let name = if way.is_own { format!("**{}**", way.name) } else { way.name.to_owned() };
        println!(
            "| {} | {name} | {:.1} | {:.2} | {} | {} | {} | {to_loop} | {looked_at} |",
            way.spheres,
            median(&wall) * way.counted.segments,
            way.counted.segments,
            Middle::of(&wall),
            Middle::of(&processor),
            ratio(&processor, first),
        );
    }
    println!("\nIn bold what candor renders the scene with. A node has four boxes.");
}

fn ratio(values: &[f64], reference: &[f64]) -> Middle {
    let ratios: Vec<f64> = std::iter::zip(values, reference).map(|(a, b)| a / b).collect();
    Middle::of(&ratios)
}

/// What comes before the first sample: seconds, and bytes on the device.
fn print_preparation(counts: impl Iterator<Item = usize>, rounds: usize) {
    println!(
        "\n| spheres | packed with a hierarchy, ms | the hierarchy alone, ms | nodes | MB on the \
         device |\n|---|---|---|---|---|"
    );
    for count in counts {
        let scene = volume(count);
        let viewpoint = Viewpoint::of(&scene);
        let effects = Effects::of(&scene, &viewpoint).with(Effect::Hierarchy);
        let pack = || kernel::pack(&scene, &viewpoint, effects, sample_scale(&scene));
        let boxes: Vec<Bounds> = volume::centers(count)
            .into_iter()
            .map(|center| Bounds::of_sphere(center, volume::radius(count)))
            .collect();
        let milliseconds = |work: &dyn Fn()| {
            let times: Vec<f64> = (0..rounds).map(|_| 1e3 * timed(work).wall).collect();
            Middle::of(&times)
        };
        let packed = pack();
        let bytes = size_of_val(&packed.spheres[..]) + size_of_val(&packed.nodes[..]);
        println!(
            "| {count} | {} | {} | {} | {:.3} |",
            milliseconds(&|| drop(std::hint::black_box(pack()))),
            milliseconds(&|| drop(std::hint::black_box(Hierarchy::build(&boxes)))),
            packed.nodes.len(),
            bytes as f64 / 1e6,
        );
    }
}
