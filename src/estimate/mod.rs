//! What a film says about the picture: means, standard errors, and how sure they are.
//!
//! One module of statistics serves the renderer, `verify` and the tests.

mod compare;
mod pixel;
mod summary;

pub use compare::{Comparison, Deviation, Paired, compare, p_value, pair, z_limit};
pub use pixel::{PixelEstimate, estimate};
pub use summary::{Summary, summarize};
