//! Scenes whose radiance is known in closed form, on the device.

mod support {
    #[allow(dead_code, reason = "the table's own test uses the rest")]
    pub mod closed_form;
    pub mod closed_form_cases;
    pub mod closed_form_scenes;
    pub mod gpu;
    pub mod judge;
}

use candor::gpu::GpuTracer;
use candor::scene::Estimator;
use support::closed_form_cases::check_closed_forms;

fn check(estimator: Estimator) {
    check_closed_forms(estimator, &|scene| {
        Box::new(GpuTracer::new(scene, support::gpu::open()).expect("the device takes the scene"))
    });
}

#[test]
fn implicit_agrees_with_closed_forms() {
    check(Estimator::Implicit);
}

#[test]
fn cosine_agrees_with_closed_forms() {
    check(Estimator::Cosine);
}

#[test]
fn explicit_agrees_with_closed_forms() {
    check(Estimator::Explicit);
}

#[test]
fn mis_agrees_with_closed_forms() {
    check(Estimator::Mis);
}
