pub mod bound;
pub mod effects;
pub mod film;
pub mod gpu;
pub mod kernel;
pub mod scene;
pub mod tracer;
pub mod viewpoint;
