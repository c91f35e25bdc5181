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
use support::closed_form_cases::check_closed_forms;

#[test]
fn the_device_agrees_with_closed_forms() {
    check_closed_forms(&|scene| {
        Box::new(GpuTracer::new(scene, support::gpu::open()).expect("the device takes the scene"))
    });
}
