//! candor: a headless path tracer for scenes of spheres that states its own error.
//!
//! Data flows one way, and no module knows what stands to its right:
//!
//! [`scene`] → [`viewpoint`] → [`hierarchy`], [`light_tree`] → [`effects`], [`bound`], [`range`] →
//! [`film`] → [`tracer`], [`trail`] → [`kernel`] → [`gpu`] or [`cpu`] (both a tracer) →
//! [`enduring`] → [`estimate`] → [`watch`], [`pilot`], [`render`], [`verify`], [`cost`],
//! [`replay`] → [`explain`] → [`report`] → [`cli`]
//!
//! A scene is read and validated, the effects that it calls for are decided, a kernel is
//! composed of those and nothing else, a tracer adds samples to an exact film, and
//! everything that is said about the picture comes from the film's sums.

pub mod bound;
pub mod cli;
pub mod cost;
pub mod cpu;
pub mod effects;
pub mod enduring;
pub mod estimate;
pub mod explain;
pub mod film;
pub mod gpu;
pub mod hierarchy;
pub mod kernel;
pub mod light_tree;
pub mod pilot;
pub mod range;
pub mod render;
pub mod replay;
pub mod report;
pub mod scene;
pub mod sweep;
pub mod tracer;
pub mod trail;
mod units;
pub mod verify;
pub mod viewpoint;
pub mod watch;
