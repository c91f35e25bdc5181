//! What films cost on disk: a checkpoint's time, the rate and memory of merging, bytes per pixel.

use super::program::{Cost, Folder};
use candor::report::{Picture, StoredFilm, Sums, write_exr};
use exr::meta::MetaData;
use exr::meta::attribute::AttributeValue;
use std::collections::BTreeMap;
use std::path::Path;

const SIZE: &str = "1920x1080";
const PIXELS: f64 = 1920.0 * 1080.0;
/// Bytes of a film of that size in memory.
const FILM: f64 = 52.0 * PIXELS;

/// Films that are merged.
const PARTS: usize = 100;

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    f64::midpoint(values[(n - 1) / 2], values[n / 2])
}

/// A checkpoint every two seconds against none, the same samples in turns. The film at the end is
/// the same and costs both the same.
#[expect(clippy::cast_precision_loss, reason = "counts of threads")]
pub fn checkpoints(turns: u32, spp: u64) {
    let folder = Folder::new();
    let render = |every: &str| {
        let arguments = format!(
            "render scene.toml --device gpu --size {SIZE} --quiet --force -o film.exr --spp {spp} \
             --checkpoint-every {every}"
        );
        let _ = std::fs::remove_file(folder.path("film.exr"));
        folder.measure(&arguments, "film.exr")
    };
    let mut rows = Vec::new();
    for turn in 0..turns {
        let (with, without) = if turn % 2 == 0 {
            let with = render("2s");
            (with, render("1h"))
        } else {
            let without = render("1h");
            (render("2s"), without)
        };
        rows.push((with, without));
    }
    let cores = std::thread::available_parallelism().map_or(1.0, |n| n.get() as f64);
    // The last time that the file is replaced, if that was seen, is by the final film.
    let written = |with: &Cost, without: &Cost| {
        f64::from(with.replaced.saturating_sub(without.replaced).max(1))
    };
    let each = |what: fn(&Cost) -> f64| {
        median(rows.iter().map(|(a, b)| (what(a) - what(b)) / written(a, b)).collect())
    };
    let (wall, processor) = (each(|cost| cost.wall), each(|cost| cost.processor));
    let counts = median(rows.iter().map(|(a, b)| written(a, b)).collect());
    let length = median(rows.iter().map(|(_, without)| without.wall).collect());
    println!("| renders | checkpoints in each | a checkpoint | every 60 s |\n|---|---|---|---|");
    println!(
        "| {turns} pairs of {length:.1} s | {counts:.0} | {:.0} ms of time, {:.0} ms of processor \
         | {:.2} % of the time, {:.2} % of {cores} cores |\n",
        1e3 * wall,
        1e3 * processor,
        wall / 0.6,
        processor / (0.6 * cores)
    );
}

/// A hundred films of one sample each, under the estimator that leaves the fewest zeros in them.
/// Only the time matters here, so that one film's sums stand for all: its header is given other
/// samples.
#[expect(clippy::cast_precision_loss, reason = "for show")]
pub fn merging() {
    let folder = Folder::new();
    let needed = PARTS as u64 * 80_000_000;
    let free = folder.free();
    assert!(free > needed, "the parts take up to {needed} bytes of disk, {free} are free");
    let render = format!("render scene.toml --device gpu --quiet --estimator mis --size {SIZE}");
    folder.run(&format!("{render} --samples 100..101 -o 100.exr"));
    let first = std::fs::read(folder.path("100.exr")).expect("the film is there");
    let texts = texts(&folder.path("100.exr"));
    let mut films = Vec::new();
    for part in (100..999).step_by(2) {
        if let Some(bytes) = renumbered(&first, &texts, part).filter(|_| films.len() < PARTS) {
            films.push(format!("{part}.exr"));
            std::fs::write(folder.path(&films[films.len() - 1]), bytes).expect("written");
        }
    }
    let cost = folder.measure(&format!("merge --quiet {} -o sum.exr", films.join(" ")), "sum.exr");
    let stored = StoredFilm::open(&folder.path("sum.exr")).expect("a film");
    assert_eq!(stored.provenance.samples.count(), PARTS as u64);
    let memory = cost.memory as f64 / FILM;
    println!("| films of {SIZE} | time | rate | processor | peak memory |\n|---|---|---|---|---|");
    println!(
        "| {PARTS} | {:.1} s | {:.1} Mpixel/s | {:.1} s | {memory:.2} films of {:.0} MB |\n",
        cost.wall,
        PARTS as f64 * PIXELS / 1e6 / cost.wall,
        cost.processor,
        FILM / 1e6
    );
}

/// candor's texts in a film's header.
fn texts(film: &Path) -> BTreeMap<String, String> {
    let meta = MetaData::read_from_file(film, false).expect("a film");
    let own = meta.headers.into_iter().flat_map(|part| part.own_attributes.other);
    own.filter_map(|(name, value)| match value {
        AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
        _ => None,
    })
    .collect()
}

/// The film's bytes with the samples `part..part + 1` in its header in place of 100..101, where
/// the header's checksum (docs/film.md) has as many digits then.
fn renumbered(film: &[u8], texts: &BTreeMap<String, String>, part: u32) -> Option<Vec<u8>> {
    let samples = format!("{part}..{}", part + 1);
    let line = |(name, text): (&String, &String)| match name.as_str() {
        "candor.headerChecksum" => String::new(),
        "candor.samples" => format!("{name}={samples}\n"),
        _ => format!("{name}={text}\n"),
    };
    let lines: String =
        texts.iter().filter(|(name, _)| name.starts_with("candor.")).map(line).collect();
    let checksum = crc32fast::hash(lines.as_bytes()).to_string();
    let mut bytes = film.to_vec();
    let changes =
        [(&texts["candor.samples"], samples), (&texts["candor.headerChecksum"], checksum)];
    for (from, to) in changes {
        let at = film.windows(from.len()).position(|window| window == from.as_bytes())?;
        (from.len() == to.len()).then_some(())?;
        bytes[at..at + to.len()].copy_from_slice(to.as_bytes());
    }
    Some(bytes)
}

/// Bytes per pixel of the classic scene's files.
#[expect(clippy::cast_precision_loss, reason = "sizes of files")]
pub fn sizes() {
    const SMALL: (u32, u32) = (192, 108);
    let folder = Folder::new();
    println!("| estimator | spp | checkpoint | film | `--no-state` |\n|---|---|---|---|---|");
    for estimator in ["implicit", "mis"] {
        for spp in [16, 256, 4096] {
            let render = format!("render scene.toml --device gpu --quiet --estimator {estimator}");
            let name = format!("{estimator}.exr");
            let size = format!("{}x{}", SMALL.0, SMALL.1);
            folder.run(&format!("{render} --size {size} --spp {spp} --resume -o {name}"));
            let stored = StoredFilm::open(&folder.path(&name)).expect("a film");
            let film = stored.read().expect("a whole film");
            let picture = Picture::develop(&film, false);
            let [checkpoint, kept, flat] =
                [Sums::Quick(&film), Sums::Compact(&film), Sums::LeftOut].map(|sums| {
                    let path = folder.path("size.exr");
                    write_exr(&path, &picture, sums, &stored.provenance).expect("written");
                    let length = path.metadata().expect("it is there").len();
                    length as f64 / f64::from(SMALL.0 * SMALL.1)
                });
            println!("| {estimator} | {spp} | {checkpoint:.1} | {kept:.1} | {flat:.1} |");
        }
    }
    println!();
}
