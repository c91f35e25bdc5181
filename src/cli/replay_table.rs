//! Two paths side by side, as people read them.

use super::replay::Replayed;
use crate::replay::{Cause, Parting};
use crate::scene::{Scene, Surface};
use crate::trail::{Ending, Segment, Trail, Vertex};
use glam::DVec3;

/// Characters of a label and of one path's column.
const LABEL: usize = 12;
const COLUMN: usize = 35;

/// What is said of a sample, in lines of fewer than 100 characters.
pub(super) fn table(replayed: &Replayed) -> String {
    let mut lines = heading(replayed);
    let trails = [replayed.device.as_ref().map(|(_, trail)| trail), Some(&replayed.twin)];
    let names = [trails[0].map_or("", |_| "device"), "twin"].map(str::to_owned);
    let difference = if trails[0].is_some() { "difference" } else { "" };
    lines.push(String::new());
    lines.push(line("", &names, trails[0].is_some(), difference));
    let rows = Rows { scene: &replayed.scene, trails, parting: replayed.parting, lines };
    lines = rows.all(replayed.bound);
    lines.push(String::new());
    lines.push(reading(replayed));
    lines.join("\n")
}

fn heading(replayed: &Replayed) -> Vec<String> {
    let settings = replayed.scene.settings();
    let (column, row) = replayed.pixel;
    let device = match &replayed.device {
        Some((found, _)) => format!("{} ({})", found.device, found.driver),
        None => "none".to_owned(),
    };
    let fact = |label: &str, text: String| format!("{label:<LABEL$}{text}");
    let size = replayed.scene.size();
    let sample = format!("{} of pixel {column},{row}, {}", replayed.sample, replayed.file);
    let how = format!(
        "{}, bounces {}, seed {}, {} pixels",
        settings.estimator().name(),
        settings.bounces(),
        settings.seed(),
        size
    );
    vec![
        fact("sample", sample),
        fact("", how),
        fact("device", device),
        fact("twin", "on the processor, in f64".to_owned()),
    ]
}

/// One line: a label, one or two columns, and what differs.
fn line(label: &str, cells: &[String; 2], both: bool, difference: &str) -> String {
    let [device, twin] = cells.each_ref().map(|cell| shortened(cell));
    let columns =
        if both { format!("{device:<COLUMN$} {twin:<COLUMN$} {difference}") } else { twin };
    format!("{label:<LABEL$}{columns}").trim_end().to_owned()
}

/// A cell that fits its column.
fn shortened(text: &str) -> String {
    if text.chars().count() <= COLUMN {
        return text.to_owned();
    }
    text.chars().take(COLUMN - 1).chain(['…']).collect()
}

/// What a line says of a path, where that is a vector.
type Value<'a> = &'a dyn Fn(&Trail) -> Option<DVec3>;

struct Rows<'a> {
    scene: &'a Scene,
    trails: [Option<&'a Trail>; 2],
    parting: Option<Parting>,
    lines: Vec<String>,
}

impl Rows<'_> {
    fn all(mut self, bound: f32) -> Vec<String> {
        self.heading("camera", 0, |_| String::new());
        self.vectors("  position", 0, |segment| Some(segment.origin));
        self.vectors("  direction", 0, |segment| Some(segment.direction));
        let longest = self.trails.iter().flatten().map(|trail| trail.segments.len()).max();
        for i in 0..longest.unwrap_or(0) {
            self.vertex(i);
        }
        let radiance = |trail: &Trail| Some(DVec3::from_array(trail.radiance.map(f64::from)));
        self.lines.push(String::new());
        self.row("radiance", |trail| vector(radiance(trail)), Some(&radiance));
        self.row("valid", |trail| verdict(trail, bound), None);
        self.lines
    }

    /// What the segments `i` ended with.
    fn vertex(&mut self, i: usize) {
        let scene = self.scene;
        self.heading(&format!("vertex {}", i + 1), i + 1, move |trail| {
            let segment = trail.segments.get(i);
            segment.map_or_else(String::new, |segment| match segment.vertex {
                Some(vertex) => sphere_label(scene, vertex.sphere),
                None => "nothing".to_owned(),
            })
        });
        let met = |segment: &Segment, of: fn(&Vertex) -> DVec3| segment.vertex.as_ref().map(of);
        if self.any(i, |segment| segment.vertex.is_some()) {
            let distance = |trail: &Trail| {
                let vertex = trail.segments.get(i).and_then(|segment| segment.vertex);
                vertex.map(|vertex| DVec3::splat(vertex.distance))
            };
            let shown = |trail: &Trail| distance(trail).map_or(String::new(), |d| cell(d.x));
            self.row("  distance", shown, Some(&distance));
            self.vectors("  position", i, |segment| met(segment, |vertex| vertex.position));
            self.vectors("  normal", i, |segment| met(segment, |vertex| vertex.normal));
        }
        self.light(i);
        if self.any(i, |segment| segment.vertex.is_some()) {
            self.vectors("  weight", i, |segment| segment.vertex.map(|_| segment.weight));
        }
        if self.trails.iter().flatten().any(|trail| trail.segments.len() > i + 1) {
            self.vectors("  direction", i + 1, |segment| Some(segment.direction));
        }
        if self.trails.iter().flatten().any(|trail| trail.segments.len() == i + 1) {
            let ends = |trail: &Trail| {
                if trail.segments.len() == i + 1 {
                    ending(trail.ending).to_owned()
                } else {
                    String::new()
                }
            };
            self.row("  end", ends, None);
        }
    }

    /// The light that was sampled from the vertex, and what it or the light that was hit brought.
    fn light(&mut self, i: usize) {
        let scene = self.scene;
        let light = |trail: &Trail| {
            let found = trail.segments.get(i).and_then(|segment| segment.connection);
            found.map_or(String::new(), |found| {
                let seen = if found.visible { "visible" } else { "hidden" };
                format!("{}, {seen}", short_label(scene, found.light))
            })
        };
        if self.any(i, |segment| segment.connection.is_some()) {
            self.row("  light", light, None);
        }
        let emits = |vertex: Vertex| scene.spheres()[vertex.sphere].emits();
        let brings =
            |segment: &Segment| segment.connection.is_some() || segment.vertex.is_some_and(emits);
        let brought = |trail: &Trail| {
            let segment = trail.segments.get(i).filter(|&segment| brings(segment))?;
            Some(segment.radiance - before(trail, i))
        };
        if self.any(i, brings) {
            self.row("  brings", |trail| vector(brought(trail)), Some(&brought));
        }
    }

    fn any(&self, i: usize, holds: impl Fn(&Segment) -> bool) -> bool {
        self.trails.iter().flatten().any(|trail| trail.segments.get(i).is_some_and(&holds))
    }

    /// A line that begins a vertex, and says so where the paths part.
    fn heading(&mut self, label: &str, vertex: usize, cell: impl Fn(&Trail) -> String) {
        let parted = self.parting.is_some_and(|parting| parting.vertex == vertex);
        let note = if parted { "THEY PART" } else { "" };
        let cells = self.trails.map(|trail| trail.map_or(String::new(), &cell));
        self.lines.push(line(label, &cells, self.trails[0].is_some(), note));
    }

    fn vectors(&mut self, label: &str, i: usize, of: impl Fn(&Segment) -> Option<DVec3>) {
        let value = |trail: &Trail| trail.segments.get(i).and_then(&of);
        self.row(label, |trail| vector(value(trail)), Some(&value));
    }

    /// A line of two cells, and the largest difference of the values behind them.
    fn row(&mut self, label: &str, cell: impl Fn(&Trail) -> String, value: Option<Value<'_>>) {
        let cells = self.trails.map(|trail| trail.map_or(String::new(), &cell));
        let difference = match (self.trails, value) {
            ([Some(device), Some(twin)], Some(value)) => difference(value(device), value(twin)),
            _ => String::new(),
        };
        self.lines.push(line(label, &cells, self.trails[0].is_some(), &difference));
    }
}

/// Radiance before the segment `i`.
pub(super) fn before(trail: &Trail, i: usize) -> DVec3 {
    i.checked_sub(1).and_then(|i| trail.segments.get(i)).map_or(DVec3::ZERO, |s| s.radiance)
}

fn difference(a: Option<DVec3>, b: Option<DVec3>) -> String {
    match (a, b) {
        (Some(a), Some(b)) if a == b => "0".to_owned(),
        (Some(a), Some(b)) => match (a - b).abs().to_array() {
            apart if apart.iter().any(|x| x.is_nan()) => "-".to_owned(),
            apart => format!("{:.1e}", apart.into_iter().fold(0.0, f64::max)),
        },
        _ => String::new(),
    }
}

fn vector(value: Option<DVec3>) -> String {
    value.map_or(String::new(), |v| v.to_array().map(cell).join(" "))
}

fn cell(x: f64) -> String {
    format!("{:>11}", number(x))
}

/// Six significant digits.
fn number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    // Rounding to the digits shown may add one before the point.
    let size = format!("{:.5e}", x.abs()).parse().unwrap_or(x.abs());
    if !(1e-3..1e5).contains(&size) {
        return format!("{x:.3e}");
    }
    let limits = [1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4];
    let before = limits.iter().filter(|&&limit| size >= limit).count();
    format!("{x:.*}", 8 - before)
}

/// The kind of a surface.
pub(super) fn kind(surface: Surface) -> &'static str {
    match surface {
        Surface::Emitter(_) => "light",
        Surface::Diffuse(_) => "diffuse",
        Surface::Glossy(..) => "glossy",
    }
}

/// A sphere's name, or its place in the file, counted from 1.
fn short_label(scene: &Scene, sphere: usize) -> String {
    scene.spheres()[sphere].label()
}

/// The same with its kind.
fn sphere_label(scene: &Scene, sphere: usize) -> String {
    let kind = kind(scene.spheres()[sphere].surface());
    format!("{} ({kind})", short_label(scene, sphere))
}

fn ending(ending: Ending) -> &'static str {
    match ending {
        Ending::Light => "on a light",
        Ending::Escaped => "escaped",
        Ending::Limit => "at the limit of bounces",
        Ending::Absorbed => "absorbed: drawn below the surface",
        Ending::Unfinished => "unfinished: a loop was cut short",
    }
}

/// Whether the film takes the sample.
fn verdict(trail: &Trail, bound: f32) -> String {
    match trail.invalid(bound) {
        None => format!("yes, not above {}", number(bound.into())),
        Some(reason) => format!("NO: {reason}"),
    }
}

/// What the table comes to.
fn reading(replayed: &Replayed) -> String {
    let text = match (&replayed.device, replayed.parting) {
        (None, _) => "the twin's path alone; there is no device to compare it with".to_owned(),
        (Some(_), None) => "the same path on both, up to rounding".to_owned(),
        (Some(_), Some(Parting { vertex: 0, .. })) => "they part at the camera".to_owned(),
        (Some(_), Some(Parting { vertex, cause })) => {
            format!("they part at vertex {vertex}: {}", difference_in(cause))
        }
    };
    format!("{:<LABEL$}{text}", "reading")
}

fn difference_in(cause: Cause) -> &'static str {
    match cause {
        Cause::Sphere => "they hit different things",
        Cause::Position => "at another place of the same sphere",
        Cause::Normal => "with another normal",
        Cause::Light => "they sample different lights",
        Cause::Visibility => "only one sees the light",
        Cause::Radiance => "the light brings something else",
        Cause::Weight => "another weight",
        Cause::Ending => "they end in different ways",
        Cause::Direction => "they go on in different directions",
    }
}

#[cfg(test)]
mod tests {
    use super::{number, table};
    use crate::cli::replay::Replayed;
    use crate::cpu::{PreparedScene, SampleKey, replay};
    use crate::replay::parting;
    use crate::scene::{Albedo, Camera, Estimator, ImageSize, Radiance, RenderSettings, Scene};
    use crate::scene::{Sphere, Surface};
    use crate::tracer::Description;
    use crate::trail::Ending;
    use crate::viewpoint::Viewpoint;
    use glam::DVec3;

    #[test]
    fn numbers_have_six_digits() {
        let table = [
            (0.0, "0"),
            (0.999_999_9, "1.00000"),
            (-0.009_855_31, "-0.00985531"),
            (99_999.96, "1.000e5"),
            (-12_345.67, "-12345.7"),
            (2.0e-8, "2.000e-8"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ];
        for (x, shown) in table {
            assert_eq!(number(x), shown);
        }
    }

    fn scene() -> Scene {
        let camera = Camera::new(DVec3::new(0.0, 1.0, 5.0), DVec3::Y, DVec3::Y, 60.0);
        let grey = Surface::Diffuse(Albedo::new(DVec3::splat(0.5)).expect("an albedo"));
        let light = Surface::Emitter(Radiance::new(DVec3::ONE).expect("a radiance"));
        let sphere = |y, radius, surface| {
            Sphere::new(DVec3::new(0.0, y, 0.0), radius, surface).expect("a sphere")
        };
        let name = "a floor with a name that is far too long for its column";
        let spheres = vec![sphere(-100.0, 100.0, grey).named(name), sphere(9.0, 5.0, light)];
        let size = ImageSize::new(8, 6).expect("a size");
        let settings = RenderSettings::default().with_estimator(Estimator::Mis);
        Scene::new(camera.expect("a camera"), size, settings, spheres)
    }

    /// A device that loses a path after its second vertex, with a NaN.
    #[test]
    fn what_differs_is_seen() {
        let scene = scene();
        let prepared = PreparedScene::new(&scene);
        let mut twins = (0..64).map(|index| replay(&prepared, SampleKey { pixel: 44, index }));
        let twin = twins.find(|trail| trail.segments.len() == 2 && trail.ending == Ending::Light);
        let twin = twin.expect("some path finds the light by itself");
        let mut device = twin.clone();
        device.segments[1].vertex = None;
        device.segments[1].radiance.y = f64::NAN;
        device.ending = Ending::Unfinished;
        device.radiance[1] = f32::NAN;
        let description = Description { device: "d".into(), driver: "e".into(), software: true };
        let text = table(&Replayed {
            file: "s.toml".to_owned(),
            pixel: (4, 5),
            sample: 0,
            bound: 2.0,
            parting: parting(&device, &twin, &Viewpoint::of(&scene)),
            device: Some((description, device)),
            twin,
            scene,
        });
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
        let parted: Vec<&str> = text.lines().filter(|line| line.contains("THEY PART")).collect();
        assert!(parted.len() == 1 && parted[0].starts_with("vertex 2"), "{text}");
        assert!(text.ends_with("they part at vertex 2: they hit different things"), "{text}");
        let valid = text.lines().find(|line| line.starts_with("valid")).unwrap_or_default();
        assert!(valid.contains("NO: the driver cut a loop short "), "{text}");
        assert!(valid.ends_with(" yes, not above 2.00000"), "{text}");
        assert!(text.contains("a floor with a name that is far to… a floor"), "{text}");
    }
}
