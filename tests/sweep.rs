//! The scale sweep of `candor verify --hard` on the software device, and faults that it
//! finds.

mod support {
    pub mod gpu;
    pub mod scenes;
    pub mod tracers;
}

use candor::cpu::CpuTracer;
use candor::range::{Arithmetic, check};
use candor::scene::{Estimator, Scene};
use candor::sweep::{Case, Row, cases, measure};
use candor::tracer::{TraceError, Tracer};
use candor::viewpoint::Viewpoint;
use std::sync::atomic::AtomicBool;
use support::tracers::{mutant, on_device};

/// How a device is made.
type Device<'a> = &'a dyn Fn(&Scene) -> Result<Box<dyn Tracer>, TraceError>;

fn all() -> Vec<Case> {
    cases().expect("the classic scene is valid")
}

fn case(group: &str, value: &str) -> Case {
    let wanted = |case: &Case| case.group == group && case.value == value;
    all().into_iter().find(wanted).expect("it is in the table")
}

fn found(case: &Case, estimator: Estimator, device: Device<'_>) -> Row {
    let twin = |scene: &Scene| -> Result<Box<dyn Tracer>, TraceError> {
        Ok(Box::new(CpuTracer::new(scene, None)?))
    };
    let row = measure(case, estimator, device, &twin, &AtomicBool::new(false));
    row.expect("both trace").expect("nobody interrupts")
}

/// What the sweep shows is inside of the range that it is to vouch for.
#[test]
fn every_row_is_in_range() {
    for case in all() {
        for (scene, arithmetic) in
            [(&case.scene, Arithmetic::Single), (&case.reference, Arithmetic::Double)]
        {
            let found = check(scene, &Viewpoint::of(scene), arithmetic);
            assert!(found.is_ok(), "{} {}: {found:?}", case.group, case.value);
        }
    }
}

#[test]
fn the_device_is_right_in_every_row() {
    for case in all() {
        let row =
            found(
                &case,
                Estimator::Mis,
                &|scene| Ok(Box::new(on_device(scene)) as Box<dyn Tracer>),
            );
        let (bias, error) = row.worst();
        println!("{} {}: {:+.2} ± {:.2} ppm", case.group, case.value, 1e6 * bias, 1e6 * error);
        assert!(row.is_right() && !row.is_wrong(), "{} {}: {row:?}", case.group, case.value);
    }
}

/// What other renderers do, and the row that shows it.
#[test]
fn faults_are_found() {
    let faults = [
        // The sphere's function in textbook form, about its centre.
        (
            "walls by their centres",
            Estimator::Implicit,
            ("wall radius", "1e7"),
            "let c = dot(gradient + g, ray.origin) + 2.0 * offset;",
            "let f = ray.origin + gradient / curvature;\n    \
             let c = curvature * (dot(f, f) - 1.0 / (curvature * curvature));",
        ),
        (
            "all rays from the axis",
            Estimator::Implicit,
            ("camera away", "1e6"),
            "scene.approach * offset",
            "0.0 * offset",
        ),
        (
            "1 - cos of a cone, which cancels",
            Estimator::Mis,
            ("light radius", "1e-4"),
            "min(sine2, 1.0) / (1.0 + sqrt(max(cosine2, 0.0)))",
            "1.0 - sqrt(max(cosine2, 0.0))",
        ),
    ];
    for (fault, estimator, (group, value), from, to) in faults {
        let row = found(&case(group, value), estimator, &|scene| {
            Ok(Box::new(mutant(scene, from, to)) as Box<dyn Tracer>)
        });
        println!("{fault}: {:?}", row.paired);
        assert!(row.is_wrong() && !row.is_right(), "{fault}: {row:?}");
    }
}
