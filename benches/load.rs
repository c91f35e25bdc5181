//! How long a scene with a million rows of data takes to load: `cargo bench --bench load
//! [-- --rows N --rounds N]`, as medians with the least and the most.

#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "rates for show")]

#[path = "support/options.rs"]
mod options;

use candor::scene;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::Instant;

const SCENE: &str = r#"
camera = { position = [0, 0, 3], look_at = [0, 0, 0], vertical_fov = 40 }
image = { width = 64, height = 64 }
clouds = [{ file = "DATA" }]
"#;

fn main() {
    let rows = options::count("--rows").map_or(1_000_000, |rows| rows as usize);
    let rounds = options::count("--rounds").unwrap_or(9).max(1);
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, data) in [("points.csv", csv(rows)), ("atoms.xyz", xyz(rows))] {
        fs::write(folder.path().join(name), &data).expect("the data can be written");
        let path = folder.path().join(name).with_extension("toml");
        fs::write(&path, SCENE.replace("DATA", name)).expect("the scene can be written");
        let mut seconds: Vec<f64> = (0..rounds).map(|_| load(&path, rows)).collect();
        seconds.sort_by(f64::total_cmp);
        println!(
            "{name:<11} {rows} rows, {:>5.1} MB: {:.3} s ({:.3} to {:.3}, {rounds} rounds)",
            data.len() as f64 / 1e6,
            seconds[seconds.len() / 2],
            seconds[0],
            seconds[seconds.len() - 1],
        );
    }
}

/// Seconds to load the scene.
fn load(path: &Path, rows: usize) -> f64 {
    let start = Instant::now();
    let scene = scene::load(path).expect("a scene");
    let seconds = start.elapsed().as_secs_f64();
    assert_eq!(scene.spheres().len(), rows, "no sphere is in the place of another");
    seconds
}

/// Rows with radius and colour, 17 digits each as programs write them.
fn csv(rows: usize) -> String {
    let mut random = Random(1);
    let mut text = "x,y,z,radius,r,g,b\n".to_owned();
    for _ in 0..rows {
        let [x, y, z] = [0; 3].map(|_| random.next() * 2.0 - 1.0);
        let radius = 1e-3 + 1e-3 * random.next();
        let [red, green, blue] = [0; 3].map(|_| random.next());
        writeln!(text, "{x},{y},{z},{radius},{red},{green},{blue}")
            .expect("a string takes every write");
    }
    text
}

fn xyz(rows: usize) -> String {
    let mut random = Random(2);
    let mut text = format!("{rows}\n\n");
    for index in 0..rows {
        let element = ["C", "H", "O", "N"][index % 4];
        let [x, y, z] = [0; 3].map(|_| random.next() * 100.0);
        writeln!(text, "{element} {x:12.6} {y:12.6} {z:12.6}").expect("a string takes it");
    }
    text
}

/// Numbers in [0, 1) from Knuth's generator (MMIX).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
