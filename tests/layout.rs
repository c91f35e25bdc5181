//! The Rust mirrors of the WGSL structs against naga and through the device, and every
//! kernel that can be composed.

mod support {
    pub mod gpu;
}

use bytemuck::Zeroable;
use candor::effects::Effects;
use candor::gpu::probe::{Probe, Row};
use candor::kernel::{
    Form, Kernel, Lights, Nearest, SPHERE_CAPACITY, Tile, layout, probe_source, validate,
};
use candor::scene::{Estimator, ImageSize};
use candor::tracer::LEDGER_RECORDS;
use std::mem::offset_of;

/// One struct as somebody lays it out.
#[derive(Debug, Clone, PartialEq)]
struct Layout {
    name: &'static str,
    size: usize,
    /// Name, offset and size of each field.
    fields: Vec<(&'static str, usize, usize)>,
}

/// Size of the field that an accessor reads.
fn size_of_field<S, T>(_: impl Fn(&S) -> T) -> usize {
    size_of::<T>()
}

/// The layout of a mirror. Naming every field in a pattern without `..` keeps the list
/// complete; fields that spell out padding are not WGSL's.
macro_rules! mirror {
    ($name:ident { $($field:ident),* }) => {{
        let layout::$name { $($field: _),* } = layout::$name::zeroed();
        let fields = vec![$((
            stringify!($field),
            offset_of!(layout::$name, $field),
            size_of_field(|s: &layout::$name| s.$field),
        )),*];
        Layout {
            name: stringify!($name),
            size: size_of::<layout::$name>(),
            fields: fields.into_iter().filter(|field| field.0 != "padding").collect(),
        }
    }};
}

fn mirrors() -> Vec<Layout> {
    vec![
        mirror!(Sphere { position, size, color, exponent, offset, index, kind, inside }),
        mirror!(Scene {
            origin,
            seed,
            forward,
            factored_count,
            right,
            film_shift,
            up,
            bound_bits,
            sphere_count,
            light_count,
            approach,
            padding,
            lights,
            spheres
        }),
        mirror!(Dispatch {
            first_sample_low,
            first_sample_high,
            sample_count,
            band_start,
            row_start,
            row_end
        }),
        mirror!(Ledger { count, records }),
    ]
}

/// Those that only the replay has.
fn replay_mirrors() -> [Layout; 2] {
    [
        mirror!(Request { pixel, index_low, index_high }),
        mirror!(Replay {
            origin,
            reached,
            direction,
            sphere,
            position,
            distance,
            normal,
            light,
            throughput,
            visible,
            radiance,
            goes_on,
            sample,
            finished
        }),
    ]
}

/// What naga makes of the struct, against the mirror.
fn compare(module: &naga::Module, mirror: &Layout) -> Result<(), String> {
    let (_, found) = module
        .types
        .iter()
        .find(|(_, t)| t.name.as_deref() == Some(mirror.name))
        .ok_or_else(|| format!("no struct {}", mirror.name))?;
    let naga::TypeInner::Struct { members, span } = &found.inner else {
        return Err(format!("{} is no struct", mirror.name));
    };
    let size =
        |member: &naga::StructMember| module.types[member.ty].inner.size(module.to_ctx()) as usize;
    let theirs: Vec<_> = members
        .iter()
        .map(|m| (m.name.as_deref().unwrap_or_default(), m.offset as usize, size(m)))
        .collect();
    if theirs == mirror.fields && *span as usize == mirror.size {
        return Ok(());
    }
    Err(format!("{}: {theirs:?} in {span} bytes, the mirror is {mirror:?}", mirror.name))
}

/// The value of a WGSL constant.
fn constant(module: &naga::Module, name: &str) -> Option<u32> {
    let (_, found) = module.constants.iter().find(|(_, c)| c.name.as_deref() == Some(name))?;
    match module.global_expressions[found.init] {
        naga::Expression::Literal(naga::Literal::U32(value)) => Some(value),
        _ => None,
    }
}

fn general_kernel() -> String {
    general().wgsl()
}

fn general() -> Kernel {
    let size = ImageSize::new(8, 8).expect("a size");
    Kernel {
        size,
        bounces: 2,
        estimator: Estimator::Mis,
        effects: Effects::ALL,
        nearest: Nearest::Loop,
        lights: Lights::Many { huge: true },
    }
}

#[test]
fn mirrors_have_nagas_layout() {
    let (module, _) = validate(&general_kernel()).expect("a valid kernel");
    for mirror in mirrors() {
        compare(&module, &mirror).expect("the same layout");
    }
    let replay = general().replay_wgsl();
    let (module, _) = validate(&replay).expect("a valid kernel");
    for mirror in replay_mirrors() {
        compare(&module, &mirror).expect("the same layout");
    }
    assert_eq!(constant(&module, "UNFINISHED"), Some(layout::UNFINISHED));
    let (from, to) =
        ("visible: u32,\n    radiance: vec3<f32>,", "radiance: vec3<f32>,\n    visible: u32,");
    assert_eq!(replay.matches(from).count(), 1);
    let module = naga::front::wgsl::parse_str(&replay.replace(from, to)).expect("it parses");
    compare(&module, &replay_mirrors()[1]).expect_err(from);
}

#[test]
fn a_wrong_layout_is_rejected() {
    // One row per struct: fields in another order, or of another type.
    let faults = [
        ("Sphere", "index: u32,\n    kind: u32,", "kind: u32,\n    index: u32,"),
        ("Scene", "lights: array<vec4<u32>, LIGHT_VECTORS>", "lights: array<vec4<u32>, 127u>"),
        ("Scene", "origin: vec3<f32>,\n    seed: u32,", "seed: u32,\n    origin: vec3<f32>,"),
        ("Dispatch", "row_start: u32,\n    row_end: u32,", "row_end: u32,\n    row_start: u32,"),
        ("Ledger", "array<u32, LEDGER_RECORDS * RECORD_WORDS>", "array<u32, 129>"),
    ];
    let kernel = general_kernel();
    for (name, from, to) in faults {
        assert_eq!(kernel.matches(from).count(), 1, "{from}");
        let module = naga::front::wgsl::parse_str(&kernel.replace(from, to)).expect("it parses");
        let mirror = mirrors().into_iter().find(|m| m.name == name).expect("a mirror");
        compare(&module, &mirror).expect_err(from);
    }
}

#[test]
fn constants_are_the_kernels() {
    let (module, _) = validate(&general_kernel()).expect("a valid kernel");
    let constants = [
        ("SPHERE_CAPACITY", u32::try_from(SPHERE_CAPACITY).expect("a small number")),
        ("LEDGER_RECORDS", u32::try_from(LEDGER_RECORDS).expect("a small number")),
        ("RECORD_WORDS", u32::try_from(layout::RECORD_WORDS).expect("a small number")),
        ("FILM_WORDS", u32::try_from(candor::film::WORDS).expect("a small number")),
        ("NO_SPHERE", layout::NO_SPHERE),
        ("KIND_EMITTER", layout::KIND_EMITTER),
        ("KIND_DIFFUSE", layout::KIND_DIFFUSE),
        ("KIND_GLOSSY", layout::KIND_GLOSSY),
    ];
    for (name, value) in constants {
        assert_eq!(constant(&module, name), Some(value), "{name}");
    }
    assert_eq!(constant(&module, "KIND_VELVET"), None);
}

/// A scene whose every word is another one, each a normal float.
fn scene_of_distinct_words() -> layout::Scene {
    let mut scene = layout::Scene::zeroed();
    for (word, value) in
        bytemuck::cast_slice_mut(std::slice::from_mut(&mut scene)).iter_mut().zip(0x3f80_0000..)
    {
        *word = value;
    }
    scene
}

/// The rows that `probe_echo` writes.
fn echo_of(scene: &layout::Scene) -> Vec<Row> {
    let row = |v: [f32; 3], w: u32| [v[0].to_bits(), v[1].to_bits(), v[2].to_bits(), w];
    let mut rows = vec![
        row(scene.origin, scene.seed),
        row(scene.forward, scene.factored_count),
        row(scene.right, scene.film_shift.cast_unsigned()),
        row(scene.up, scene.bound_bits),
        [scene.sphere_count, scene.light_count, scene.approach.to_bits(), 0],
    ];
    rows.extend(scene.lights.as_chunks().0);
    for s in &scene.spheres {
        rows.push(row(s.position, s.size.to_bits()));
        rows.push(row(s.color, s.exponent.to_bits()));
        rows.push([s.offset.to_bits(), s.index, s.kind, s.inside]);
    }
    rows
}

#[test]
fn the_device_reads_every_field_as_it_was_written() {
    let gpu = support::gpu::open();
    let scene = scene_of_distinct_words();
    let probe = Probe::new(&gpu, &scene).expect("the probe compiles");
    let count = 5 + SPHERE_CAPACITY / 4 + 3 * SPHERE_CAPACITY;
    let rows = probe.run("probe_echo", &[], count).expect("the device runs");
    assert_eq!(rows, echo_of(&scene));
    // Two fields of one type exchanged, far from each other and side by side.
    let mut exchanged = scene;
    std::mem::swap(&mut exchanged.factored_count, &mut exchanged.seed);
    assert_ne!(rows, echo_of(&exchanged));
    let mut exchanged = scene;
    let last = &mut exchanged.spheres[SPHERE_CAPACITY - 1];
    std::mem::swap(&mut last.kind, &mut last.inside);
    assert_ne!(rows, echo_of(&exchanged));
}

/// Forms of `factored` and `anchored` spheres, mixed.
fn forms(factored: usize, anchored: usize) -> Nearest {
    let mut forms = vec![Form::Factored; factored];
    (0..anchored).for_each(|i| forms.insert((2 * i).min(forms.len()), Form::Anchored));
    Nearest::Unrolled(forms)
}

#[test]
fn every_composition_is_valid() {
    let sides = [1, 2, 3, 5, 64];
    let unrolled = [(0, 0), (1, 0), (0, 1), (3, 5), (16, 0), (0, 16), (9, 7)];
    let searches = unrolled.map(|(factored, anchored)| forms(factored, anchored));
    let mut turn = 0;
    for (width, height) in sides.iter().flat_map(|&w| sides.map(|h| (w, h))) {
        let size = ImageSize::new(width, height).expect("a size");
        let tile = Tile::of(size);
        assert_eq!(tile.width * tile.height * tile.samples, Tile::INVOCATIONS, "{tile:?}");
        for nearest in std::iter::once(&Nearest::Loop).chain(&searches) {
            for flags in 0..8 {
                let [diffuse, glossy, interior] = [1, 2, 4].map(|flag| flags & flag != 0);
                let effects = Effects { diffuse, glossy, interior };
                let nearest = nearest.clone();
                // The estimators and kinds of lights take turns over the compositions.
                let estimator = Estimator::ALL[turn % 4];
                let huge = turn / 12 % 2 == 0;
                let lights = match turn / 4 % 3 {
                    0 => Lights::None,
                    1 => Lights::One { place: 0, huge },
                    _ => Lights::Many { huge },
                };
                turn += 1;
                let bounces = flags * 9;
                let kernel = Kernel { size, bounces, estimator, effects, nearest, lights };
                for text in [kernel.wgsl(), kernel.replay_wgsl()] {
                    if let Err(message) = validate(&text) {
                        panic!("{kernel:?}: {message}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_probe_is_valid_and_a_fault_is_not() {
    validate(&probe_source()).expect("a valid probe");
    let fault = general_kernel().replace("2.0 * polar.y", "2u * polar.y");
    validate(&fault).expect_err("u32 times f32");
    let fault = general_kernel().replace("@group(0) @binding(3)", "@group(0) @binding(2)");
    // Two variables of one binding only clash where an entry point uses both.
    validate(&fault).expect_err("two buffers in one place");
}
