//! Prints the uniform volume of so many spheres as the data of `[[clouds]]`:
//! `cargo run --release --example volume -- 1000000 > volume.csv`.

#[path = "../benches/support/volume.rs"]
mod volume;

use std::io::{self, BufWriter, Write as _};

fn main() -> io::Result<()> {
    let count = std::env::args().nth(1).and_then(|word| word.parse().ok());
    let Some(count) = count.filter(|count| (1..=10_000_000).contains(count)) else {
        return Err(io::Error::other("it takes a number of spheres, from 1 to 10000000"));
    };
    let radius = volume::radius(count);
    let mut out = BufWriter::new(io::stdout().lock());
    writeln!(out, "x,y,z,radius")?;
    for center in volume::centers(count) {
        writeln!(out, "{},{},{},{radius}", center.x, center.y, center.z)?;
    }
    out.flush()
}
