//! The probe with diffuse surfaces that scatter as under `implicit`.

use candor::kernel::probe_source;

/// The probe is composed for `mis`, where diffuse surfaces are sampled by their cosine; what
/// `implicit` has in its place needs nothing else.
///
/// # Panics
/// If that is not in the probe.
pub fn uniform_probe() -> String {
    let cosine = include_str!("../../shaders/diffuse_cosine.wgsl");
    let uniform = concat!(
        include_str!("../../shaders/hemisphere_uniform.wgsl"),
        include_str!("../../shaders/diffuse_uniform.wgsl")
    );
    let text = probe_source();
    assert_eq!(text.matches(cosine).count(), 1);
    text.replace(cosine, uniform)
}
