//! One study from start to end: the phases in their order, and what came of them.

use super::estimators::{EstimatorCost, by_name, cheapest, pilot};
use super::ladder::{Ladder, Rung, ladder};
use super::plan::{Phase, Plan};
use super::race::race;
use super::stopwatch::{Slot, Timed};
use super::strip::{Strip, strip, strip_size};
use super::twin::{TwinCost, compare};
use super::{CostError, MakeTracer, Tracers, Watch};
use crate::bound;
use crate::scene::{Estimator, Invalid, Scene};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Seconds of a turn in the probe.
const PROBE: f64 = 0.02;

/// What accuracy costs, as far as it was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Study {
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// Most scatterings of one path.
    pub bounces: u32,
    /// Seed of the pilot.
    pub seed: u32,
    /// The budget, in seconds.
    pub budget_seconds: f64,
    /// What was spent of it, in seconds.
    pub seconds: f64,
    /// Whether the study was stopped from outside; what was not measured then is missing.
    pub interrupted: bool,
    /// The estimators, the source's first.
    pub estimators: Vec<EstimatorCost>,
    /// The estimator that ladder, twin and strip use: the cheapest for its error, or the
    /// scene's own where no error is known.
    #[serde(serialize_with = "by_name")]
    pub used: Estimator,
    /// The bounce ladder, ascending.
    pub ladder: Vec<Rung>,
    /// The device against the twin; `None` where the twin is the device.
    pub twin: Option<TwinCost>,
    /// Pictures at growing counts of samples: of the scene's estimator and of the cheapest.
    pub strips: Vec<Strip>,
    /// What was not measured, and why.
    pub left_out: Vec<LeftOut>,
}

/// Something that was not measured.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// What.
    pub what: String,
    /// Why not.
    pub why: String,
}

impl Study {
    /// The estimator that is cheapest for its error, where any error is known.
    #[must_use]
    pub fn cheapest(&self) -> Option<&EstimatorCost> {
        cheapest(&self.estimators).map(|place| &self.estimators[place])
    }

    fn leave_out(&mut self, what: impl Into<String>, why: &impl ToString) {
        self.left_out.push(LeftOut { what: what.into(), why: why.to_string() });
    }
}

/// The scene with its own estimator where the film resolves that one's samples, and else with
/// the last one that is resolved, which looks for light wherever it goes.
///
/// # Errors
/// If none is resolved; what each of them would take.
pub fn resolvable(scene: Scene) -> Result<Scene, Invalid> {
    if bound::check(&scene).is_ok() {
        return Ok(scene);
    }
    let (estimators, left_out) = resolved(&scene);
    let Some(&estimator) = estimators.last() else {
        let why = left_out.iter().map(|left_out| format!("{}: {}", left_out.what, left_out.why));
        return Err(Invalid(why.collect::<Vec<_>>().join("; ")));
    };
    let settings = scene.settings().with_estimator(estimator);
    Ok(scene.with_settings(settings))
}

/// Studies a [`resolvable`] scene that has lights within a budget. Interrupted after the pilot, it returns
/// what is complete.
///
/// # Errors
/// If a tracer fails, samples are invalid, the budget is too short for a pilot, or the study
/// is interrupted before the pilot is over.
pub fn study(
    scene: &Scene,
    tracers: Tracers,
    plan: &Plan,
    watch: &mut Watch,
) -> Result<Study, CostError> {
    let started = Instant::now();
    let mut study = empty(scene, plan);
    let slot = Slot::new(Phase::Pilot, plan.length(Phase::Pilot));
    let (estimators, left_out) = resolved(scene);
    study.left_out = left_out;
    probe(scene, estimators.len(), tracers.device, &slot)?;
    study.estimators = pilot(scene, &estimators, tracers.device, &slot, watch)?;
    study.used = study.cheapest().map_or(study.used, |cost| cost.estimator);
    match continue_study(&mut study, scene, tracers, (plan, started), watch) {
        Err(CostError::Interrupted) => study.interrupted = true,
        ended => ended?,
    }
    study.seconds = started.elapsed().as_secs_f64();
    Ok(study)
}

fn empty(scene: &Scene, plan: &Plan) -> Study {
    let settings = scene.settings();
    Study {
        width: scene.size().width(),
        height: scene.size().height(),
        bounces: settings.bounces(),
        seed: settings.seed(),
        budget_seconds: plan.budget().as_secs_f64(),
        seconds: 0.0,
        interrupted: false,
        estimators: Vec::new(),
        used: settings.estimator(),
        ladder: Vec::new(),
        twin: None,
        strips: Vec::new(),
        left_out: Vec::new(),
    }
}

/// Refuses a picture that is far too large for the budget before it is traced even once,
/// going by a small picture of the same scene. Each estimator needs five samples at least: two
/// to warm up, and three rounds.
#[expect(clippy::cast_precision_loss, reason = "a handful of estimators")]
fn probe(
    scene: &Scene,
    estimators: usize,
    device: MakeTracer,
    slot: &Slot,
) -> Result<(), CostError> {
    let small = scene.clone().with_size(strip_size(scene.size()));
    let mut timed = Timed::new(device(&small)?, &small);
    timed.warm_up(PROBE)?;
    let enlarged = f64::from(scene.size().pixels()) / f64::from(small.size().pixels());
    slot.restarted().check(5.0 * estimators as f64 * enlarged * timed.pace())
}

/// The estimators whose samples the film resolves, and why it does not resolve the others.
fn resolved(scene: &Scene) -> (Vec<Estimator>, Vec<LeftOut>) {
    let (mut estimators, mut left_out) = (Vec::new(), Vec::new());
    for estimator in Estimator::ALL {
        let settings = scene.settings().with_estimator(estimator);
        match bound::check(&scene.clone().with_settings(settings)) {
            Ok(()) => estimators.push(estimator),
            Err(error) => left_out.push(LeftOut {
                what: format!("estimator {}", estimator.name()),
                why: error.to_string(),
            }),
        }
    }
    (estimators, left_out)
}

/// What follows the pilot, with the cheapest estimator.
fn continue_study(
    study: &mut Study,
    scene: &Scene,
    tracers: Tracers,
    (plan, started): (&Plan, Instant),
    watch: &mut Watch,
) -> Result<(), CostError> {
    let best = scene.clone().with_settings(scene.settings().with_estimator(study.used));
    let slot = Slot::new(Phase::Ladder, plan.length(Phase::Ladder));
    match ladder(&best, tracers.device, &slot, watch) {
        Err(error @ CostError::Short { .. }) => study.leave_out("bounce ladder", &error),
        measured => {
            let Ladder { rungs, refused } = measured?;
            study.ladder = rungs;
            for (bounces, error) in refused {
                study.leave_out(format!("{bounces} bounces"), &error);
            }
        }
    }
    if let Some(twin) = tracers.twin {
        let slot = Slot::new(Phase::Twin, plan.length(Phase::Twin));
        match compare(&best, tracers.device, twin, &slot, watch) {
            Err(error @ CostError::Short { .. }) => study.leave_out("f64 twin", &error),
            measured => study.twin = Some(measured?),
        }
    } else {
        study.leave_out("device against f64", &"the f64 twin itself is the device");
    }
    take_pictures(study, scene, &best, tracers, plan, watch)?;
    let left = plan.budget().saturating_sub(started.elapsed());
    let slot = Slot::new(Phase::Race, left.max(Duration::from_millis(1)));
    race(scene, &mut study.estimators, tracers.device, &slot, watch)
}

/// The strip of the scene's own estimator, and that of the cheapest if it is another.
fn take_pictures(
    study: &mut Study,
    scene: &Scene,
    best: &Scene,
    tracers: Tracers,
    plan: &Plan,
    watch: &mut Watch,
) -> Result<(), CostError> {
    let mut scenes = vec![scene];
    if best.settings().estimator() != scene.settings().estimator() {
        scenes.push(best);
    }
    let share = plan.length(Phase::Strip).div_f64(if scenes.len() == 1 { 1.0 } else { 2.0 });
    for scene in scenes {
        let slot = Slot::new(Phase::Strip, share);
        study.strips.push(strip(scene, tracers.device, slot, watch)?);
    }
    Ok(())
}
