//! The Rust mirrors of the WGSL structs against naga and through the device.

mod support {
    pub mod gpu;
}

use bytemuck::{Pod, Zeroable};
use candor::effects::Effects;
use candor::gpu::probe::{Probe, Row};
use candor::kernel::{
    Kernel, Packed, SPHERE_CAPACITY, hierarchy_probe_source, layout, probe_source, validate,
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
            hierarchy_count
        }),
        mirror!(Node { origin, kinds, low, first_node, high, first_sphere }),
        mirror!(LightNode { center, radius, brightness, everywhere, light, padding }),
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
        written: None,
        stored: false,
        light: 0,
        stack: 8,
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
        (
            "Scene",
            "approach: f32,\n    hierarchy_count: u32,",
            "hierarchy_count: u32,\n    approach: f32,",
        ),
        ("Scene", "origin: vec3<f32>,\n    seed: u32,", "seed: u32,\n    origin: vec3<f32>,"),
        ("Node", "low: vec3<u32>,\n    first_node: u32,", "first_node: u32,\n    low: vec3<u32>,"),
        ("LightNode", "    brightness: f32,", "    more: u32,\n    brightness: f32,"),
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

/// Values whose every word is another one, from `first` on; as floats they are all normal.
fn distinct<T: Pod>(count: usize, first: u32) -> Vec<T> {
    let mut values = vec![T::zeroed(); count];
    for (word, value) in bytemuck::cast_slice_mut(&mut values).iter_mut().zip(first..) {
        *word = value;
    }
    values
}

fn row(vector: [f32; 3], last: u32) -> Row {
    let [x, y, z] = vector.map(f32::to_bits);
    [x, y, z, last]
}

/// What `probe_echo_scene` writes.
fn scene_rows(scene: &layout::Scene) -> Vec<Row> {
    vec![
        row(scene.origin, scene.seed),
        row(scene.forward, scene.factored_count),
        row(scene.right, scene.film_shift.cast_unsigned()),
        row(scene.up, scene.bound_bits),
        [scene.sphere_count, scene.light_count, scene.approach.to_bits(), scene.hierarchy_count],
    ]
}

fn sphere_rows(s: &layout::Sphere) -> [Row; 3] {
    let last = [s.offset.to_bits(), s.index, s.kind, s.inside];
    [row(s.position, s.size.to_bits()), row(s.color, s.exponent.to_bits()), last]
}

fn light_node_rows(n: &layout::LightNode) -> [Row; 2] {
    let last = [n.brightness.to_bits(), n.everywhere.to_bits(), n.light, 0];
    [row(n.center, n.radius.to_bits()), last]
}

fn node_rows(n: &layout::Node) -> [Row; 3] {
    let words = |[x, y, z]: [u32; 3], w| [x, y, z, w];
    [row(n.origin, n.kinds), words(n.low, n.first_node), words(n.high, n.first_sphere)]
}

/// What the entry points must write, by their names.
fn echoes(packed: &Packed) -> Vec<(&'static str, Vec<Row>)> {
    let mut echoes = vec![
        ("probe_echo_scene", scene_rows(&packed.scene)),
        ("probe_echo_spheres", packed.spheres.iter().flat_map(sphere_rows).collect()),
        ("probe_echo_lights", packed.lights.iter().map(|&place| [place, 0, 0, 0]).collect()),
        ("probe_echo_light_tree", packed.light_tree.iter().flat_map(light_node_rows).collect()),
    ];
    if !packed.nodes.is_empty() {
        let nodes = packed.nodes.iter().flat_map(node_rows).collect();
        echoes.push(("probe_echo_nodes", nodes));
    }
    echoes
}

/// As many spheres as a uniform buffer holds, or more, with nodes.
fn scene_of_distinct_words(stored: bool) -> Packed {
    let spheres = if stored { 2 * SPHERE_CAPACITY } else { SPHERE_CAPACITY };
    Packed {
        scene: distinct(1, 0x3f80_0000)[0],
        spheres: distinct(spheres, 0x3f90_0000),
        lights: distinct(spheres, 0x3fa0_0000),
        nodes: if stored { distinct(300, 0x3fb0_0000) } else { Vec::new() },
        stack: 1,
        turns: 0,
        light_tree: distinct(300, 0x3fc0_0000),
        forms: Vec::new(),
    }
}

#[test]
fn the_device_reads_every_field_as_it_was_written() {
    let gpu = support::gpu::open();
    for stored in [false, true] {
        let packed = scene_of_distinct_words(stored);
        let text = if stored { hierarchy_probe_source(packed.stack) } else { probe_source() };
        let probe = Probe::with_source(&gpu, &packed, text).expect("the probe compiles");
        // Two fields of one type exchanged, far from each other and side by side.
        let mut faulty = packed.clone();
        std::mem::swap(&mut faulty.scene.factored_count, &mut faulty.scene.seed);
        let last = faulty.spheres.last_mut().expect("a sphere");
        std::mem::swap(&mut last.kind, &mut last.inside);
        faulty.lights.swap(2, 3);
        let last = faulty.light_tree.last_mut().expect("a node");
        std::mem::swap(&mut last.brightness, &mut last.everywhere);
        if let Some(node) = faulty.nodes.last_mut() {
            std::mem::swap(&mut node.low, &mut node.high);
        }
        for ((entry, expected), (_, fault)) in echoes(&packed).into_iter().zip(echoes(&faulty)) {
            let rows = probe.run(entry, &[], expected.len()).expect("the device runs");
            assert_eq!(rows, expected, "{entry}");
            assert_ne!(rows, fault, "{entry}");
        }
    }
}

#[test]
fn the_probe_is_valid_and_a_fault_is_not() {
    validate(&probe_source()).expect("a valid probe");
    validate(&hierarchy_probe_source(8)).expect("a valid probe");
    let fault = general_kernel().replace("2.0 * polar.y", "2u * polar.y");
    validate(&fault).expect_err("u32 times f32");
    let fault = general_kernel().replace("@group(0) @binding(3)", "@group(0) @binding(2)");
    // Two variables of one binding only clash where an entry point uses both.
    validate(&fault).expect_err("two buffers in one place");
}
