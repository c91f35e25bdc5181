//! How a study spends its budget.

use crate::scene::Invalid;
use std::time::Duration;

/// Shortest budget: below it the rounds are shorter than a device's own start.
pub const MIN_BUDGET: Duration = Duration::from_secs(5);

/// A part of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// All estimators in turns: speed, variance, slope, predictions.
    Pilot,
    /// More and more bounces.
    Ladder,
    /// The device against the twin.
    Twin,
    /// Pictures at growing counts of samples.
    Strip,
    /// Every estimator to the errors that it was predicted to reach, with another seed.
    Race,
}

impl Phase {
    /// All of them in their order; the race comes last and takes what time is left.
    pub const ALL: [Self; 5] = [Self::Pilot, Self::Ladder, Self::Twin, Self::Strip, Self::Race];

    /// What it does, in a few words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pilot => "estimators in turns",
            Self::Ladder => "bounce ladder",
            Self::Twin => "device against f64",
            Self::Strip => "picture strip",
            Self::Race => "race to the predictions",
        }
    }

    /// Per cent of the budget.
    fn percent(self) -> u32 {
        match self {
            Self::Pilot => 25,
            Self::Ladder => 15,
            Self::Twin => 8,
            Self::Strip => 14,
            Self::Race => 38,
        }
    }
}

/// A budget and its parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    budget: Duration,
}

impl Plan {
    /// Divides a budget.
    ///
    /// # Errors
    /// If it is shorter than [`MIN_BUDGET`].
    pub fn new(budget: Duration) -> Result<Self, Invalid> {
        if budget < MIN_BUDGET {
            return Err(Invalid(format!("a time of at least {}s", MIN_BUDGET.as_secs())));
        }
        Ok(Self { budget })
    }

    /// All of it.
    #[must_use]
    pub fn budget(&self) -> Duration {
        self.budget
    }

    /// The time that a phase may take.
    #[must_use]
    pub fn length(&self, phase: Phase) -> Duration {
        self.budget * phase.percent() / 100
    }

    /// The budget whose share for `phase` is `length`.
    pub(super) fn budget_for(phase: Phase, length: Duration) -> Duration {
        length * 100 / phase.percent()
    }
}

#[cfg(test)]
mod tests {
    use super::{MIN_BUDGET, Phase, Plan};
    use std::time::Duration;

    #[test]
    fn the_phases_share_the_whole_budget() {
        let plan = Plan::new(Duration::from_mins(1)).expect("long enough");
        let total: Duration = Phase::ALL.iter().map(|&phase| plan.length(phase)).sum();
        assert_eq!(total, plan.budget());
        for phase in Phase::ALL {
            assert_eq!(Plan::budget_for(phase, plan.length(phase)), plan.budget());
        }
        assert!(Plan::new(MIN_BUDGET).is_ok());
        assert!(Plan::new(MIN_BUDGET.mul_f64(0.999)).is_err());
    }
}
