//! Writes `scenes/particles.csv`, a spiral galaxy of particles that do not touch:
//! `cargo run --release --example particles`.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::io;
use std::path::Path;

/// How many there are.
const COUNT: usize = 12_000;
/// Where the arms start, and how far out they reach.
const INNER: f64 = 0.5;
const OUTER: f64 = 3.3;
/// Angle between the arms and circles around the middle, of a wide-open spiral.
const PITCH: f64 = 14.0 * PI / 180.0;
/// Least space between two particles: more than the last decimal that is written.
const GAP: f64 = 0.002;

fn main() -> io::Result<()> {
    std::fs::write(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/particles.csv"), csv())
}

/// The table: positions and radii in a unit of their own, and linear albedos.
#[must_use]
pub fn csv() -> String {
    let mut random = Random(20_261_125);
    let mut particles: Vec<Particle> = Vec::with_capacity(COUNT);
    while particles.len() < COUNT {
        let next = if random.uniform() < 0.22 { bulge(&mut random) } else { arm(&mut random) };
        if next.distance([0.0; 3]) > INNER && !particles.iter().any(|other| other.touches(&next)) {
            particles.push(next);
        }
    }
    let mut text = "x,y,z,radius,r,g,b\n".to_owned();
    for Particle { center, radius, rgb } in particles {
        let [x, y, z] = center;
        let [red, green, blue] = rgb;
        let _ = writeln!(text, "{x:.4},{y:.4},{z:.4},{radius:.4},{red:.3},{green:.3},{blue:.3}");
    }
    text
}

struct Particle {
    center: [f64; 3],
    radius: f64,
    rgb: [f64; 3],
}

impl Particle {
    fn distance(&self, point: [f64; 3]) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.center[axis] - point[axis]);
        (x * x + y * y + z * z).sqrt()
    }

    fn touches(&self, other: &Self) -> bool {
        self.distance(other.center) < self.radius + other.radius + GAP
    }
}

/// Old stars: a flattened ball around the middle, yellow.
fn bulge(random: &mut Random) -> Particle {
    let [x, y, z] = [0.55, 0.30, 0.55].map(|width| width * random.normal());
    let radius = 0.010 + 0.012 * random.uniform();
    Particle { center: [x, y, z], radius, rgb: mixed([0.95, 0.72, 0.42], [0.9, 0.55, 0.3], random) }
}

/// One of two arms, logarithmic spirals: young stars, blue, with pink clouds among them.
fn arm(random: &mut Random) -> Particle {
    let out = random.uniform().powf(0.8);
    let r = INNER + (OUTER - INNER) * out;
    let side = if random.uniform() < 0.5 { 0.0 } else { PI };
    // Arms fray towards their ends.
    let across = (0.10 + 0.16 * out) * random.normal();
    let angle = side + (r / INNER).ln() / PITCH.tan() + across * INNER.max(1.0) / r.sqrt();
    let lift = (0.08 - 0.045 * out) * random.normal();
    let center = [r * angle.cos(), lift, r * angle.sin()];
    let young = out.min(1.0);
    if random.uniform() < 0.05 {
        let radius = 0.022 + 0.018 * random.uniform();
        return Particle {
            center,
            radius,
            rgb: mixed([0.95, 0.10, 0.28], [0.95, 0.25, 0.40], random),
        };
    }
    let radius = 0.010 + 0.022 * random.uniform().powi(3);
    let near = [0.85, 0.80, 0.72];
    let far = [0.14, 0.34, 0.92];
    let rgb = [0, 1, 2].map(|c| near[c] + (far[c] - near[c]) * young);
    Particle { center, radius, rgb: mixed(rgb, [0.55, 0.68, 0.95], random) }
}

/// A colour somewhere between two.
fn mixed(a: [f64; 3], b: [f64; 3], random: &mut Random) -> [f64; 3] {
    let share = random.uniform();
    [0, 1, 2].map(|channel| a[channel] + (b[channel] - a[channel]) * share)
}

/// Knuth's linear congruential generator (MMIX), of which the upper bits are used.
struct Random(u64);

impl Random {
    /// In [0, 1).
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
    fn uniform(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normal with variance 1 (Box and Muller 1958).
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }
}
