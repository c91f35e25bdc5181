//! What a film says about the picture: means, standard errors, and how sure they are.
//!
//! One module of statistics serves the renderer, `verify`, `diff` and the tests.

mod ceiling;
mod compare;
mod difference;
mod group;
mod looks;
mod measured;
mod normal;
mod pair;
mod pixel;
mod summary;

pub use ceiling::Spread;
pub use compare::{Comparison, Deviation, compare, compare_pictures};
pub use difference::{
    Difference, DifferenceMap, MapUnit, RELATIVE_MSE_EPSILON, difference, difference_map,
};
pub use looks::{FIRST_LOOK, is_look, next_look};
pub use measured::{Bars, Measured};
pub use normal::{p_value, z_limit};
pub use pair::{Paired, pair};
pub use pixel::{PixelEstimate, estimate};
pub use summary::{Summary, summarize};
