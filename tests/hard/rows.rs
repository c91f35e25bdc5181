//! Cases that are rows of a table, through single functions of the kernel on the device.

use crate::support::bare::{bare, nothing};
use crate::support::chi_square::{lobe_p_value, p_limit};
use crate::support::gpu;
use crate::support::hits::{Case, Side};
use crate::support::rays::{Ray, draw, on_sphere, trace};
use crate::support::scenes::{diffuse, emitter, packed, seen, size, sphere};
use crate::support::uniform_probe::uniform_probe;
use crate::{Line, Verdict};
use bytemuck::Zeroable;
use candor::gpu::probe::{Probe, Row};
use candor::kernel::{Packed, layout};
use glam::{DVec3, Vec3};

/// How far from unit length, or from a right angle, `f32` directions may be.
const UNIT: f64 = 1e-6;

/// The largest number that a path can get.
const LAST: f32 = 1.0 - f32::EPSILON / 2.0;

fn run(entry: &str, scene: &Packed, rows: &[Row], results: usize) -> Vec<[f32; 4]> {
    let gpu = gpu::open();
    let probe = Probe::with_source(&gpu, scene, uniform_probe()).expect("the probe compiles");
    let rows = probe.run(entry, rows, results).expect("the device runs");
    rows.into_iter().map(|row| row.map(f32::from_bits)).collect()
}

fn row(v: Vec3, w: f32) -> Row {
    [v.x, v.y, v.z, w].map(f32::to_bits)
}

/// What the worst of some errors says against a limit.
fn at_most(worst: f64, limit: f64) -> Verdict {
    Verdict { accepts: worst <= limit, found: format!("{worst:.1e}") }
}

/// Rays that graze a sphere of radius 1e6 within 1e-4 of tangent, from ten units away.
fn tangents() -> Vec<Case> {
    let ray = |angle: i32, height: i32| {
        let turn = 1e-6 * f64::from(angle);
        let direction = DVec3::new(turn.cos(), turn.sin(), 0.0).as_vec3();
        let origin = DVec3::new(-10.0, 1e-4 * f64::from(height), 0.0).as_vec3();
        let (side, position) = (Side::Entry, Vec3::Y);
        Case {
            radius: 1e6,
            anchored: true,
            side,
            origin,
            direction,
            position,
            size: 1e-6,
            offset: 0.0,
        }
    };
    let heights = |angle| (0..=10).map(move |height| ray(angle, height));
    (-100..=100).flat_map(heights).collect()
}

/// Centre and radius in `f32`.
fn textbook(case: &Case) -> f32 {
    let (centre, radius) = (Vec3::new(0.0, -1e6, 0.0), 1e6_f32);
    let f = case.origin - centre;
    let b = f.dot(case.direction);
    let discriminant = b * b - (f.dot(f) - radius * radius);
    if b < 0.0 && discriminant >= 0.0 { (-b - discriminant.sqrt()).max(0.0) } else { 3.0e38 }
}

/// 1: hit and miss are right wherever rounding does not decide, and so are distances.
fn tangent_rays() -> Line {
    let cases = tangents();
    let rows: Vec<Row> = cases
        .iter()
        .flat_map(|case| {
            [
                row(case.origin, 1.0),
                row(case.direction, 0.0),
                row(case.position, case.size),
                row(Vec3::ZERO, 0.0),
            ]
        })
        .collect();
    let found = run("probe_hit", &nothing(), &rows, cases.len());
    let judge = |distances: &mut dyn Iterator<Item = f32>| {
        let judged = cases.iter().zip(distances);
        let wrong = judged.filter(|(case, found)| case.judge(*found).is_none()).count();
        Verdict { accepts: wrong == 0, found: format!("{wrong} of {} wrong", cases.len()) }
    };
    Line {
        case: 1,
        place: "tangent rays, R = 1e6, ±1e-4 rad".to_owned(),
        expected: "hit and miss as in f64".to_owned(),
        right: judge(&mut found.iter().map(|row| row[0])),
        fault: "centre and radius in f32",
        wrong: judge(&mut cases.iter().map(textbook)),
    }
}

/// 3: the normal of a wall whose centre lies 1e7 off the axes.
fn far_centre() -> Line {
    let (toward, radius) = (DVec3::new(0.6, -0.64, 0.48), 1e7);
    let center = radius * toward;
    let wall = sphere(center, radius, diffuse(0.5));
    let lamp = sphere([0.0, 8.0, 0.0], 1.0, emitter([1.0; 3]));
    let position = DVec3::new(-6.0, 6.0, -5.0);
    let scene = seen(position, DVec3::ZERO, size(1, 1), 1, vec![wall, lamp]);
    let packed = packed(&scene);
    let units = candor::kernel::KernelUnits::of(&candor::viewpoint::Viewpoint::of(&scene));
    let origin = Vec3::from_array(packed.scene.origin);
    let ray = |index| {
        let across = 40.0 * toward.cross(on_sphere(draw(index, 1)));
        let direction = (units.point(across) - origin.as_dvec3()).normalize().as_vec3();
        Ray { origin, direction, leaving: layout::NO_SPHERE }
    };
    let rays: Vec<Ray> = (0..4096).map(ray).collect();
    let found = trace(&packed, &rays);
    let wall = packed.spheres.iter().position(|s| s.index == 0).expect("the wall");
    let on_wall = || found.iter().filter(|hit| hit.sphere as usize == wall);
    assert!(on_wall().count() > 3000, "most rays meet the wall");
    let scaled = units.length(1.0);
    let truth =
        |p: Vec3| (p.as_dvec3() / scaled + units_origin(&units, scaled) - center).normalize();
    let worst = |normal: &dyn Fn(&crate::support::rays::Found) -> DVec3| {
        on_wall().map(|hit| normal(hit).distance(truth(hit.position))).fold(0.0, f64::max)
    };
    let flat = Vec3::from_array(packed.spheres[wall].position).as_dvec3().normalize();
    Line {
        case: 3,
        place: "normal of a wall centred 1e7 off-axis".to_owned(),
        expected: format!("within {UNIT:e}"),
        right: at_most(worst(&|hit| hit.normal.as_dvec3()), UNIT),
        fault: "the wall taken for flat",
        wrong: at_most(worst(&|_| flat), UNIT),
    }
}

/// The origin of kernel units in the scene's.
fn units_origin(units: &candor::kernel::KernelUnits, scaled: f64) -> DVec3 {
    -units.point(DVec3::ZERO) / scaled
}

/// 6: the cone of a light of radius 1e-6 in 1e4, and of ones ever nearer to subnormal.
fn nearly_subnormal() -> Line {
    let radii = [1e-6_f32, 1e-9, 1e-12, 1e-14];
    let rows: Vec<Row> = radii
        .iter()
        .flat_map(|&r| [row(Vec3::ZERO, 0.0), row(1e4 * Vec3::Y, r), row(Vec3::ZERO, 0.0)])
        .collect();
    let found = run("probe_cone", &nothing(), &rows, radii.len());
    // 1 - √(1 - s²) is s²/2 to 1 + s²/4.
    let truth = |r: f32| (f64::from(r) / 1e4).powi(2) / 2.0;
    let worst = |height: &dyn Fn(usize) -> f32| {
        let off = |(i, &r): (usize, &f32)| (f64::from(height(i)) / truth(r) - 1.0).abs();
        radii.iter().enumerate().map(off).fold(0.0, f64::max)
    };
    // A quotient (5 of 2^-24), its square, and the last quotient, whose divisor is 2.
    let limit = 20.0 / f64::from(1 << 24);
    let cancelling = |i: usize| {
        let sine = radii[i] / 1e4;
        1.0 - (1.0 - sine * sine).sqrt()
    };
    Line {
        case: 6,
        place: "cone of r = 1e-6 at 1e4, and smaller".to_owned(),
        expected: format!("within {limit:.1e}"),
        right: at_most(worst(&|i| found[i][3]), limit),
        fault: "1 less the cosine",
        wrong: at_most(worst(&cancelling), limit),
    }
}

/// 16: the distribution of 1 - cosα, in logarithmic bins.
fn narrow_lobes() -> impl Iterator<Item = Line> {
    let on_device = |points: &[[f32; 2]], exponent: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "the kernel takes f32")]
        let row = |&[u, v]: &[f32; 2]| [u, v, exponent as f32, 0.0].map(f32::to_bits);
        let rows: Vec<Row> = points.iter().map(row).collect();
        let found = run("probe_phong", &nothing(), &rows, rows.len());
        found.into_iter().map(|[x, y, z, _]| Vec3::new(x, y, z).as_dvec3()).collect()
    };
    let by_power = |points: &[[f32; 2]], exponent: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "the fault that is shown")]
        let direction = |&[u, v]: &[f32; 2]| {
            let cosine = (1.0 - u).powf(1.0 / (exponent as f32 + 1.0));
            let (sine, turn) = ((1.0 - cosine * cosine).sqrt(), std::f32::consts::TAU * v);
            Vec3::new(sine * turn.cos(), sine * turn.sin(), cosine).as_dvec3()
        };
        points.iter().map(direction).collect()
    };
    let limit = p_limit(2);
    [1e7, 1e10].into_iter().map(move |exponent| {
        let judge = |p: f64| Verdict { accepts: p > limit, found: format!("p = {p:.1e}") };
        Line {
            case: 16,
            place: format!("χ² of the lobe of exponent {exponent:e}"),
            expected: format!("p > {limit:.0e}"),
            right: judge(lobe_p_value(&on_device, exponent)),
            fault: "pow(1 - u, 1/(n + 1)) in f32",
            wrong: judge(lobe_p_value(&by_power, exponent)),
        }
    })
}

/// Glossy surfaces of these exponents; the last one is diffuse.
fn surfaces(exponents: &[f32]) -> Packed {
    let surface = |kind, exponent| layout::Sphere { kind, exponent, ..layout::Sphere::zeroed() };
    let glossy = exponents.iter().map(|&exponent| surface(layout::KIND_GLOSSY, exponent));
    let diffuse = surface(layout::KIND_DIFFUSE, 0.0);
    bare(layout::Scene::zeroed(), glossy.chain([diffuse]).collect())
}

/// Direction and weight for each (normal, incoming direction, surface, u).
fn scatter(scene: &Packed, events: &[(Vec3, Vec3, u32, [f32; 2])]) -> Vec<(DVec3, f32)> {
    let rows: Vec<Row> = events
        .iter()
        .flat_map(|&(normal, incoming, surface, [u, v])| {
            let [x, y, z, _] = row(incoming, 0.0);
            [row(normal, 0.0), [x, y, z, surface], row(Vec3::new(u, v, 0.0), 0.0)]
        })
        .collect();
    let found = run("probe_scatter", scene, &rows, events.len());
    found.into_iter().map(|[x, y, z, w]| (Vec3::new(x, y, z).as_dvec3(), w)).collect()
}

/// 19: seen along the surface, half of every lobe lies under it and is worth nothing.
fn half_a_lobe() -> Line {
    const EXPONENTS: [f32; 3] = [0.0, 1.0, 1e3];
    const EACH: usize = 1 << 16;
    let event = |i: usize| {
        #[expect(clippy::cast_possible_truncation, reason = "24 bits fit")]
        let [u, v] = [0, 1].map(|place| draw(i, 7)[place] as f32);
        (Vec3::Y, Vec3::X, u32::try_from(i % 3).expect("a few"), [u, v])
    };
    let events: Vec<_> = (0..3 * EACH).map(event).collect();
    let found = scatter(&surfaces(&EXPONENTS), &events);
    #[expect(clippy::cast_precision_loss, reason = "a count of 2^16")]
    let judge = |is_dark: &dyn Fn(&(DVec3, f32)) -> bool| {
        let of = |kind| found.iter().skip(kind).step_by(3).filter(|hit| is_dark(hit)).count();
        // Standard deviations of a binomial of one half; 5.3 fail one in 1e7 times three.
        let z = |kind| (of(kind) as f64 - EACH as f64 / 2.0) / (EACH as f64 / 4.0).sqrt();
        let worst = (0..3).map(|kind| z(kind).abs()).fold(0.0, f64::max);
        Verdict { accepts: worst < 5.3, found: format!("half within {worst:.1} σ") }
    };
    Line {
        case: 19,
        place: "lobes seen along the surface".to_owned(),
        expected: "half of the weights 0".to_owned(),
        right: judge(&|hit| hit.1 == 0.0),
        fault: "an absolute cosine for a weight",
        wrong: judge(&|hit| hit.0.y.abs() == 0.0),
    }
}

/// 29: the ends of every random number give directions of unit length.
fn ends_of_numbers() -> Line {
    const EXPONENTS: [f32; 5] = [0.0, 1.0, 1e4, 1e7, 1e10];
    let normals = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_Z, Vec3::new(0.6, 0.0, -0.8)];
    let judge = |low: f32, high: f32| {
        let ends = [[low, low], [low, high], [high, low], [high, high]];
        let events: Vec<_> = (0..=5)
            .flat_map(|surface| normals.map(|normal| (normal, surface)))
            .flat_map(|(normal, surface)| ends.map(|u| (normal, -normal, surface, u)))
            .collect();
        let found = scatter(&surfaces(&EXPONENTS), &events);
        let off = |hit: &(DVec3, f32)| {
            let is_number = hit.0.is_finite() && hit.1.is_finite();
            if is_number { (hit.0.length() - 1.0).abs() } else { f64::INFINITY }
        };
        at_most(found.iter().map(off).fold(0.0, f64::max), UNIT)
    };
    Line {
        case: 29,
        place: "directions from u = 0 and 1 - 2^-24".to_owned(),
        expected: format!("unit length to {UNIT:e}"),
        right: judge(0.0, LAST),
        fault: "u rounded up past 1",
        wrong: judge(0.0, 1.0 + f32::EPSILON),
    }
}

/// Axes along ±z and beside them, with zeros of either sign.
fn axes() -> Vec<Vec3> {
    let zeros = [[0.0, 0.0], [-0.0, 0.0], [0.0, -0.0], [-0.0, -0.0], [1e-4, 0.0], [-1e-7, 1e-6]];
    let poles =
        zeros.iter().flat_map(|&[x, y]| [1.0, -1.0].map(|z| Vec3::new(x, y, z).normalize()));
    let equator =
        [Vec3::new(1.0, 0.0, -0.0), Vec3::new(0.0, -1.0, 0.0), Vec3::new(-0.6, 0.8, -0.0)];
    poles.chain(equator).collect()
}

/// 31: the frame around an axis is orthonormal.
fn frames() -> Line {
    // With u = 0 a uniform direction lies in the surface: these are the frame's own axes.
    let events: Vec<_> = axes()
        .into_iter()
        .flat_map(|axis| [0.0, 0.25].map(|v| (axis, -axis, 0, [0.0, v])))
        .collect();
    let found = scatter(&surfaces(&[]), &events);
    let off = |frame: [DVec3; 3]| {
        let [a, b, c] = frame;
        let lengths = frame.map(|v| (v.length() - 1.0).abs());
        let angles = [a.dot(b), b.dot(c), c.dot(a)].map(f64::abs);
        // NaN compares as nothing: it must not pass for zero.
        let worst = lengths.into_iter().chain(angles).fold(0.0, f64::max);
        let is_number = frame.iter().all(|v| v.is_finite());
        if is_number { worst } else { f64::INFINITY }
    };
    let framed = axes().into_iter().zip(found.as_chunks::<2>().0);
    let worst = framed.map(|(n, [t, b])| off([n.as_dvec3(), t.0, b.0])).fold(0.0, f64::max);
    // Frisvad 2012 without his branch, which Duff et al. mend.
    let frisvad = |n: Vec3| {
        let a = 1.0 / (1.0 + n.z);
        let b = -n.x * n.y * a;
        let (t, s) =
            (Vec3::new(1.0 - n.x * n.x * a, b, -n.x), Vec3::new(b, 1.0 - n.y * n.y * a, -n.y));
        [n, t, s].map(Vec3::as_dvec3)
    };
    Line {
        case: 31,
        place: "frames around ±z, zeros of either sign".to_owned(),
        expected: format!("orthonormal to {UNIT:e}"),
        right: at_most(worst, UNIT),
        fault: "1/(1 + z) without a sign",
        wrong: at_most(axes().into_iter().map(|n| off(frisvad(n))).fold(0.0, f64::max), UNIT),
    }
}

/// Every table, judged.
pub fn lines() -> Vec<Line> {
    let mut lines =
        vec![tangent_rays(), far_centre(), nearly_subnormal(), half_a_lobe(), ends_of_numbers()];
    lines.push(frames());
    lines.extend(narrow_lobes());
    lines
}
