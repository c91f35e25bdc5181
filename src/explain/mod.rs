//! What a scene's kernel is made of and why, what was left out of it, and what that saves.
//!
//! The kernel that a scene calls for is held against the general one, which has every effect
//! under the same estimator. An [`Explanation`] needs no device; [`measure`] does.

mod facts;
mod measure;
mod saving;

pub use facts::{Account, Explanation, Facts, NAMED, Version};
pub use measure::{ExplainError, Measured, Step, measure};
pub use saving::{Agreement, Saving};
