//! A render that is killed a hundred times, on a disk that fills up, over a film that tears.

use super::program::Folder;
use candor::film::Film;
use candor::report::StoredFilm;
use std::time::{Duration, Instant};

const KILLS: u64 = 100;

/// Kills come at random moments up to so many milliseconds after the start.
const LATEST: u64 = 1500;

const RENDER: &str = "render scene.toml --device gpu --size 256x192 --quiet";

/// Independent uniform numbers (splitmix64, Steele et al. 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % end
    }
}

fn stored(folder: &Folder, name: &str) -> Option<StoredFilm> {
    let path = folder.path(name);
    path.exists().then(|| StoredFilm::open(&path).unwrap_or_else(|error| panic!("{error}")))
}

fn film(folder: &Folder, name: &str) -> Film {
    let stored = stored(folder, name).unwrap_or_else(|| panic!("{name} is not there"));
    stored.read().unwrap_or_else(|error| panic!("{error}"))
}

/// Goes on with the render and kills it; returns how long it ran.
fn kill(folder: &Folder, after: Duration, disk_is_full: bool) -> f64 {
    let endless =
        format!("{RENDER} -o film.exr --resume --spp 4294967296 --checkpoint-every 100ms");
    let started = Instant::now();
    let mut child = folder.start(&endless, disk_is_full.then_some(8));
    std::thread::sleep(after);
    assert!(child.try_wait().expect("it is our child").is_none(), "ended: {}", folder.said());
    child.kill().expect("SIGKILL is sent");
    child.wait().expect("it is our child");
    started.elapsed().as_secs_f64()
}

/// Cuts the film anywhere. It must be refused as it is; then it is put back.
fn tear(folder: &Folder, random: &mut Random) {
    let path = folder.path("film.exr");
    let whole = std::fs::read(&path).expect("the film is there");
    let length = random.below(whole.len() as u64 - 1) + 1;
    let torn = &whole[..usize::try_from(length).expect("a length")];
    std::fs::write(&path, torn).expect("it can be written");
    let status = folder.run(&format!("{RENDER} -o film.exr --resume --spp 4294967296"));
    assert_eq!(status.code(), Some(2), "a film cut at {length} was not refused");
    assert!(std::fs::read(&path).is_ok_and(|now| now == torn), "a torn film was changed");
    std::fs::write(&path, whole).expect("it can be written");
}

/// Time from the start of the program to its first sample, about: the middle of five.
fn start_up(folder: &Folder) -> f64 {
    let mut times: Vec<f64> = (0..5)
        .map(|_| {
            let started = Instant::now();
            folder.run(&format!("{RENDER} --spp 1 --no-state --force -o start.exr"));
            started.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[2]
}

/// Whether the film that survived is that of a render which nothing interrupted.
#[expect(clippy::cast_precision_loss, reason = "a count of kills")]
pub fn survived() -> bool {
    let folder = Folder::new();
    let mut random = Random(6);
    let start_up = start_up(&folder);
    let (mut there, mut ran, mut torn, mut full) = (0, 0.0, 0, 0);
    for number in 0..KILLS {
        if number % 10 == 5 && there > 0 {
            tear(&folder, &mut random);
            torn += 1;
        }
        let disk_is_full = number % 10 == 8;
        full += u32::from(disk_is_full);
        let after = Duration::from_millis(random.below(LATEST));
        ran += kill(&folder, after, disk_is_full);
        let now = stored(&folder, "film.exr").map_or(0, |film| film.provenance.samples.count());
        assert!(now >= there, "kill {number} has lost samples: {now} of {there}");
        there = now;
    }
    let held = stored(&folder, "film.exr").map_or(0.0, |film| film.provenance.spent.seconds);
    let spp = there + 1;
    folder.run(&format!("{RENDER} -o film.exr --resume --spp {spp}"));
    folder.run(&format!("{RENDER} -o whole.exr --spp {spp}"));
    let same = film(&folder, "film.exr") == film(&folder, "whole.exr");
    let verdict = if same { "the same to the bit" } else { "ANOTHER FILM" };
    println!("| kills | full disks | torn films | spp | final film |\n|---|---|---|---|---|");
    println!("| {KILLS} | {full} | {torn} | {spp} | {verdict} |\n");
    let starts = KILLS as f64 * start_up;
    let twice = (ran - starts - held).max(0.0);
    println!(
        "The killed runs took {ran:.1} s: {held:.1} s of tracing that are in the film, about \
         {starts:.1} s of starting ({:.0} ms each), and {twice:.1} s ({:.0} ms for each kill) for \
         samples that were traced twice.\n",
        1e3 * start_up,
        1e3 * twice / KILLS as f64
    );
    same
}
