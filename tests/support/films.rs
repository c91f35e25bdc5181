//! Films of synthetic samples, whose statistics are known.

use candor::film::{Film, PixelSums, SampleScale};
use candor::scene::ImageSize;

/// Independent uniform numbers (splitmix64, Steele et al. 2014), for synthetic samples.
pub struct Uniform(pub u64);

impl Uniform {
    /// In [0, 1).
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A film whose pixels get the samples that `sample` makes for (pixel, index).
pub fn film(width: u32, height: u32, n: u64, mut sample: impl FnMut(u32, u64) -> [f32; 3]) -> Film {
    let size = ImageSize::new(width, height).expect("a size");
    let scale = SampleScale::from_bound(64.0);
    let mut film = Film::new(size, scale);
    film.claim(0..n).expect("an empty film");
    for (pixel, words) in (0..).zip(film.pixels_mut()) {
        let mut sums = PixelSums::of(words);
        for index in 0..n {
            let rgb = sample(pixel, index);
            assert!(scale.admits(rgb));
            sums.add(rgb, scale);
        }
        *words = sums.words();
    }
    film
}

/// Bernoulli hits of brightness 8 with probability `p`, grey.
pub fn hits(seed: u64, side: u32, n: u64, p: impl Fn(u32) -> f64) -> Film {
    let mut random = Uniform(seed);
    film(side, side, n, |pixel, _| [if random.next() < p(pixel) { 8.0 } else { 0.0 }; 3])
}
