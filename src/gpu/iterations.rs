//! Refuses paths whose loops a driver may cut short.

use crate::effects::{Effect, Effects};
use crate::kernel::Packed;
use crate::light_tree::most_iterations;
use crate::scene::Scene;
use crate::tracer::TraceError;

/// lavapipe leaves a loop without a word after this many iterations, counted over all
/// loops of an invocation group (`LP_MAX_TGSI_LOOP_ITERATIONS` in Mesa).
const MAX_ITERATIONS: u64 = 65_535;

/// Refuses more bounces than fit. Every vertex takes a turn of the loop over bounces and a
/// search for what the ray meets; one that samples lights takes a second search, for what
/// hides the light, and loops over lights. A replay takes one vertex more than a render.
///
/// A loop that is cut short all the same makes its sample invalid.
pub(super) fn check_iterations(
    scene: &Scene,
    effects: Effects,
    packed: &Packed,
) -> Result<(), TraceError> {
    let connects = effects.has(Effect::Connections);
    let searches = if connects { 2 } else { 1 };
    let lights = if connects { packed.lights.len() } else { 0 };
    let vertex = 1 + searches * search(packed) + most_iterations(lights);
    let most = (MAX_ITERATIONS / vertex).saturating_sub(1);
    let (bounces, spheres) = (scene.settings().bounces(), packed.spheres.len());
    if u64::from(bounces) < most {
        return Ok(());
    }
    let among = if connects { format!(" with {lights} lights") } else { String::new() };
    let allowed = match most {
        0 => "not even 0 bounces here".to_owned(),
        1 => "0 bounces here".to_owned(),
        most => format!("fewer than {most} bounces here"),
    };
    Err(TraceError::Device(format!(
        "{bounces} bounces among {spheres} spheres{among} are more than the {} estimator traces \
         on a device in one go; it takes {allowed} (--device cpu takes any)",
        scene.settings().estimator().name()
    )))
}

/// Iterations of one search: through the hierarchy, and one loop for each form of the spheres
/// outside of it; leaving a loop may count as one.
fn search(packed: &Packed) -> u64 {
    let outside = packed.scene.sphere_count - packed.scene.hierarchy_count;
    packed.turns + 1 + u64::from(outside) + 2
}
