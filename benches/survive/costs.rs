//! What films cost on disk: a checkpoint's time, the rate and memory of merging, bytes per pixel.

use super::program::{Cost, Folder};
use candor::report::{Picture, StoredFilm, Sums, write_exr};

const SIZE: &str = "1920x1080";
const PIXELS: f64 = 1920.0 * 1080.0;
/// Bytes of a film of that size in memory.
const FILM: f64 = 52.0 * PIXELS;

/// Films that are merged.
const PARTS: u32 = 100;

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
pub fn merging() {
    let folder = Folder::new();
    let needed = u64::from(PARTS) * 80_000_000;
    let free = folder.free();
    assert!(free > needed, "the parts take up to {needed} bytes of disk, {free} are free");
    let render = format!("render scene.toml --device gpu --quiet --estimator mis --size {SIZE}");
    folder.run(&format!("{render} --samples 100..101 -o 100.exr"));
    let first = std::fs::read(folder.path("100.exr")).expect("the film is there");
    let found = first.windows(8).position(|bytes| bytes == b"100..101");
    let at = found.expect("the header says which samples these are");
    let films: Vec<String> = (100..100 + PARTS).map(|part| format!("{part}.exr")).collect();
    for (part, film) in (100..).zip(&films) {
        let mut bytes = first.clone();
        bytes[at..at + 8].copy_from_slice(format!("{part}..{}", part + 1).as_bytes());
        std::fs::write(folder.path(film), bytes).expect("it can be written");
    }
    let cost = folder.measure(&format!("merge --quiet {} -o sum.exr", films.join(" ")), "sum.exr");
    let stored = StoredFilm::open(&folder.path("sum.exr")).expect("a film");
    assert_eq!(stored.provenance.samples.to_string(), format!("100..{}", 100 + PARTS));
    #[expect(clippy::cast_precision_loss, reason = "for show")]
    let memory = cost.memory as f64 / FILM;
    println!("| films of {SIZE} | time | rate | processor | peak memory |\n|---|---|---|---|---|");
    println!(
        "| {PARTS} | {:.1} s | {:.1} Mpixel/s | {:.1} s | {memory:.2} films of {:.0} MB |\n",
        cost.wall,
        f64::from(PARTS) * PIXELS / 1e6 / cost.wall,
        cost.processor,
        FILM / 1e6
    );
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
