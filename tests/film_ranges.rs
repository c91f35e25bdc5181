//! Which samples a film holds: ranges against a model, and films that must not be added.

use candor::cpu::rng::{SampleKey, random_bits};
use candor::film::{Film, FilmError, MAX_SAMPLE_INDEX, RangeError, SampleRanges, SampleScale};
use candor::scene::ImageSize;
use std::ops::Range;

/// Ranges of a model world of 64 samples, a bit each.
fn mask(range: &Range<u64>) -> u64 {
    (range.start..range.end).fold(0, |mask, index| mask | 1 << index)
}

fn model(ranges: &SampleRanges) -> u64 {
    ranges.as_slice().iter().fold(0, |bits, range| bits | mask(range))
}

/// Ascending, not empty, and joined where they touch.
fn is_normal(ranges: &SampleRanges) -> bool {
    let slice = ranges.as_slice();
    slice.iter().all(|r| r.start < r.end) && slice.windows(2).all(|w| w[0].end < w[1].start)
}

#[test]
fn ranges_are_sets_of_samples() {
    for world in 0..2000 {
        let mut ranges = SampleRanges::default();
        let mut bits = 0_u64;
        for step in 0..24 {
            let [a, b, ..] = random_bits(SampleKey { pixel: world, index: step }, 0, 0);
            let start = u64::from(a % 64);
            let range = start..(start + u64::from(b % 9)).min(64);
            let before = ranges.clone();
            let refused = ranges.insert(range.clone());
            if bits & mask(&range) == 0 {
                assert!(refused.is_ok(), "{before} and {range:?}");
                bits |= mask(&range);
            } else {
                let Err(RangeError::Overlap(shared)) = refused else {
                    panic!("{before} took {range:?} twice");
                };
                // The part that is named is in both.
                assert!(!shared.is_empty() && mask(&shared) & !(bits & mask(&range)) == 0);
                assert_eq!(ranges, before, "changed by a refusal");
            }
            assert!(is_normal(&ranges), "{ranges}");
            assert_eq!((model(&ranges), ranges.count()), (bits, u64::from(bits.count_ones())));
        }
    }
}

#[test]
fn unions_do_not_depend_on_order() {
    let some = |world: u32| {
        let mut ranges = SampleRanges::default();
        for step in 0..6 {
            let [a, b, ..] = random_bits(SampleKey { pixel: world, index: step }, 1, 0);
            let start = u64::from(a % 60);
            // An overlap is refused, which leaves the others.
            let _ = ranges.insert(start..start + 1 + u64::from(b % 4));
        }
        ranges
    };
    let mut disjoint = 0;
    for world in 0..2000 {
        let (a, b) = (some(2 * world), some(2 * world + 1));
        let shared = model(&a) & model(&b);
        match (a.union(&b), b.union(&a)) {
            (Ok(ab), Ok(ba)) => {
                assert_eq!((&ab, model(&ab), shared), (&ba, model(&a) | model(&b), 0));
                disjoint += 1;
            }
            (Err(_), Err(_)) => assert_ne!(shared, 0, "{a} and {b} share nothing"),
            other => panic!("{a} and {b}: {other:?}"),
        }
    }
    assert!((100..1900).contains(&disjoint), "both cases are tried: {disjoint}");
}

#[test]
fn a_film_takes_no_more_than_2_to_the_32_samples() {
    let mut ranges = SampleRanges::default();
    ranges.insert(5..(1 << 32) + 4).expect("one fewer than the most");
    assert_eq!(ranges.insert(0..2), Err(RangeError::TooMany((1 << 32) + 1)));
    ranges.insert(0..1).expect("the last");
    assert_eq!(ranges.insert(7..8), Err(RangeError::TooMany((1 << 32) + 1)));
    assert_eq!(ranges.count(), 1 << 32);
    let mut far = SampleRanges::default();
    far.insert(MAX_SAMPLE_INDEX - 1..MAX_SAMPLE_INDEX).expect("the last index");
    let beyond = MAX_SAMPLE_INDEX..MAX_SAMPLE_INDEX + 1;
    assert_eq!(far.insert(beyond), Err(RangeError::TooFar(MAX_SAMPLE_INDEX + 1)));
}

#[test]
fn films_of_other_pictures_are_refused() {
    let size = |w, h| ImageSize::new(w, h).expect("a size");
    let film = |size, bound, range| {
        let mut film = Film::new(size, SampleScale::from_bound(bound));
        film.claim(range).expect("new samples");
        film.pixels_mut()[0][0] = 1;
        film
    };
    let ours = film(size(3, 2), 10.0, 0..4);
    let refused = |other: Film| {
        let mut merged = ours.clone();
        let error = merged.merge(&other).expect_err("films that do not belong together");
        assert_eq!(merged, ours, "changed by a refusal");
        error
    };
    let differs = |error: &FilmError, what: &str| {
        assert!(matches!(error, FilmError::Differs(found) if found.field == what), "{error}");
    };
    differs(&refused(film(size(2, 3), 10.0, 4..8)), "size");
    differs(&refused(film(size(3, 2), 100.0, 4..8)), "scale");
    let overlap = refused(film(size(3, 2), 10.0, 3..8));
    assert_eq!(overlap, FilmError::Range(RangeError::Overlap(3..4)));
    let mut merged = ours.clone();
    merged.merge(&film(size(3, 2), 10.0, 4..8)).expect("the same picture");
    assert_eq!((merged.samples().count(), merged.pixels()[0][0]), (8, 2));
}

/// Ranges read back as they are written, and share exactly the samples that both sets hold.
#[test]
fn ranges_are_read_back_and_compared() {
    let mut last = SampleRanges::default();
    for world in 0..500 {
        let mut ranges = SampleRanges::default();
        for step in 0..6 {
            let [a, b, ..] = random_bits(SampleKey { pixel: world, index: step }, 0, 1);
            let start = u64::from(a % 64);
            // What is already there is refused, which is tested above.
            let _ = ranges.insert(start..(start + u64::from(b % 9)).min(64));
        }
        if ranges.count() > 0 {
            assert_eq!(ranges.to_string().parse(), Ok(ranges.clone()));
        }
        let common = model(&ranges) & model(&last);
        match ranges.shared(&last) {
            None => assert_eq!(common, 0, "{ranges} and {last}"),
            Some(range) => assert_eq!(mask(&range) & !common, 0, "{ranges} and {last}: {range:?}"),
        }
        last = ranges;
    }
    for bad in ["", "3", "3..", "5..3", "4..4", "0..4,", "0..4,2..6", "a..b", "0..4 5..6"] {
        assert!(bad.parse::<SampleRanges>().is_err(), "\"{bad}\"");
    }
}
