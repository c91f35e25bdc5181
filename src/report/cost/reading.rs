//! A study in sentences: the questions that it is made for, and its answers.

use crate::cost::{
    CONFIDENCE, EXPECTED, EstimatorCost, MATTERS, MIN_VARYING, RATIO_MATTERS, Study,
    WARNING_CONFIDENCE,
};
use crate::units::{rounded_percent, short_time, significant};
use std::ops::RangeInclusive;

/// A question and what a study says about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// The question.
    pub question: &'static str,
    /// The answer, in sentences.
    pub text: String,
    /// Whether something is wrong.
    pub warning: bool,
}

/// A bias below this share of the smallest target is too small to matter.
const NEGLIGIBLE: f64 = 0.1;

/// Predictions hold where measured times are in this range of them: half as long again at
/// most, or the other way round.
const HOLDS: RangeInclusive<f64> = 0.67..=1.5;

pub(super) fn answers(study: &Study) -> Vec<Answer> {
    let mut answers = vec![which_estimator(study)];
    answers.extend(study.cheapest().map(next_digit));
    answers.extend(error_bars(study));
    answers.extend(predictions(study));
    answers.extend(bounce_limit(study));
    answers.push(trust(study));
    answers
}

fn calm(question: &'static str, text: String) -> Answer {
    Answer { question, text, warning: false }
}

fn which_estimator(study: &Study) -> Answer {
    let question = "Which estimator?";
    let Some(best) = study.cheapest() else {
        let text = "Unproven: too few samples met light to know any estimator's error. Give more \
                    --budget, or a smaller --size.";
        return Answer { question, text: text.to_owned(), warning: true };
    };
    let mut others: Vec<&EstimatorCost> =
        study.estimators.iter().filter(|cost| cost.estimator != best.estimator).collect();
    others.sort_by(|a, b| {
        let key = |cost: &EstimatorCost| cost.price().unwrap_or(f64::INFINITY);
        key(a).total_cmp(&key(b))
    });
    let others = others.iter().map(|cost| {
        let name = cost.estimator.name();
        match (cost.price(), cost.beside_cheapest) {
            (None, _) => format!("{name} is unproven"),
            (Some(_), None) if best.is_noiseless() && cost.is_noiseless() => {
                format!("{name} has none either, but is slower")
            }
            (Some(_), None) => format!("{name} has some"),
            (Some(_), Some(ratio)) if ratio.low > 1.0 => {
                format!("{name} takes {} times as long", significant(ratio.value, 2))
            }
            _ => format!("{name} may be as good"),
        }
    });
    let others = others.collect::<Vec<_>>().join(", ");
    let name = best.estimator.name();
    let sense = if best.is_noiseless() { "It has no noise;" } else { "For the same error" };
    calm(question, format!("{name}. {sense} {others}."))
}

fn next_digit(best: &EstimatorCost) -> Answer {
    let question = "What does the next digit cost?";
    if best.is_noiseless() {
        let text = format!(
            "Nothing: with {} all {} samples of each pixel were alike. There is no noise, and the \
             fewest samples do.",
            best.estimator.name(),
            best.samples,
        );
        return calm(question, text);
    }
    let times: Vec<String> = best
        .predictions
        .iter()
        .map(|p| format!("{} in {}", rounded_percent(p.target, 1), short_time(p.seconds.value)))
        .collect();
    calm(
        question,
        format!(
            "A tenth of the error takes a hundred times the time. With {}: {}.",
            best.estimator.name(),
            times.join(", ")
        ),
    )
}

/// Whether the error falls as it must, and is as large as stated.
fn error_bars(study: &Study) -> Option<Answer> {
    let question = "Are the stated errors true?";
    let checked: Vec<&EstimatorCost> =
        study.estimators.iter().filter(|cost| cost.agreement.is_some()).collect();
    let mut faults = Vec::new();
    for cost in &checked {
        let name = cost.estimator.name();
        if let Some(slope) = cost.slope.filter(|slope| slope.suspect) {
            faults.push(format!(
                "with {name} the slope of error against samples is {:.3}, not {EXPECTED}",
                slope.slope.value
            ));
        }
        if let Some(agreement) = cost.agreement.filter(|agreement| agreement.suspect) {
            faults.push(format!(
                "with {name} realised errors are {:.2} of the stated ones",
                agreement.ratio.value
            ));
        }
    }
    if !faults.is_empty() {
        let text = format!(
            "No: {}. Samples depend on each other, or have no finite variance; predicted times \
             are not to be trusted.",
            faults.join("; ")
        );
        return Some(Answer { question, text, warning: true });
    }
    let noisy =
        study.estimators.iter().filter(|cost| cost.price().is_some_and(|price| price > 0.0));
    let few = noisy.filter(|cost| cost.varying_pixels < MIN_VARYING);
    let few: Vec<&str> = few.map(|cost| cost.estimator.name()).collect();
    if !few.is_empty() {
        let text = format!(
            "Too few pixels vary to tell, with {}: the noise must be spread over {MIN_VARYING} \
             pixels or more. Give a larger --size.",
            few.join(", ")
        );
        return Some(calm(question, text));
    }
    let ratios = checked.iter().filter_map(|cost| Some(cost.agreement?.ratio.value));
    let (low, high) =
        ratios.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), r| (low.min(r), high.max(r)));
    (!checked.is_empty()).then(|| {
        let text = format!(
            "Yes: differences between halves of each picture are {low:.2} to {high:.2} of what the \
             error says, and no slope is off {EXPECTED} by more than {MATTERS} for sure."
        );
        calm(question, text)
    })
}

fn predictions(study: &Study) -> Option<Answer> {
    let predictions = study.estimators.iter().flat_map(|cost| &cost.predictions);
    let tests: Vec<(f64, f64)> = predictions
        .filter_map(|p| Some((p.seconds.value, p.measured? / p.seconds.value)))
        .collect();
    let ratios = || tests.iter().map(|&(_, ratio)| ratio);
    let smallest = ratios().reduce(f64::min)?;
    let largest = ratios().reduce(f64::max)?;
    let off = tests.iter().filter(|(_, ratio)| !HOLDS.contains(ratio));
    let longest = off.map(|&(predicted, _)| predicted).reduce(f64::max);
    let count = tests.len();
    let tested = if count == 1 { "1 was".to_owned() } else { format!("{count} were") };
    let verdict = if longest.is_some() { "No" } else { "Yes" };
    let which = longest.map_or(String::new(), |longest| {
        let longest = short_time(longest);
        format!(
            " The longest prediction that failed is {longest}; short runs pay for the start of \
             every call, long ones for a machine that others use."
        )
    });
    Some(Answer {
        question: "Do the predictions hold?",
        text: format!(
            "{verdict}: {tested} put to the test with other random numbers; measured times were \
             {smallest:.2} to {largest:.2} of the predicted ones.{which}"
        ),
        warning: longest.is_some(),
    })
}

fn bounce_limit(study: &Study) -> Option<Answer> {
    let own = study.ladder.iter().find(|rung| rung.bounces == study.bounces)?;
    let deepest = study.ladder.last()?;
    let question = "What does the bounce limit cost?";
    if study.ladder.iter().all(|rung| rung.missing.is_none()) {
        let text =
            format!("Unproven: too little light was found with {} bounces.", deepest.bounces);
        return Some(calm(question, text));
    }
    let Some(missing) = &own.missing else {
        return (own == deepest && own.seconds_to_one_percent.is_some()).then(|| {
            calm(question, format!("{} bounces are the most that were measured.", own.bounces))
        });
    };
    let slower = deepest.seconds_per_sample.value / own.seconds_per_sample.value;
    let (own, deepest) = (own.bounces, deepest.bounces);
    let share = 100.0 * missing.value;
    let half = 50.0 * (missing.high - missing.low);
    let found = if missing.low > 0.0 {
        format!(
            "{own} bounces miss {share:.2} ± {half:.2} % of the light that {deepest} bounces find, \
             and no number of samples brings it back"
        )
    } else {
        format!(
            "None measurable: {own} bounces miss {share:.2} ± {half:.2} % of the light that \
             {deepest} bounces find"
        )
    };
    Some(calm(
        question,
        format!(
            "{found}; {deepest} bounces take {} times as long for a sample. What lies beyond \
             {deepest} is not in these numbers.",
            significant(slower, 2),
        ),
    ))
}

fn trust(study: &Study) -> Answer {
    let question = "Can f32 be trusted?";
    let Some(twin) = &study.twin else {
        let reason = study.left_out.iter().find(|left_out| left_out.what.contains("f64"));
        let reason = reason.map_or("interrupted before", |left_out| left_out.why.as_str());
        return calm(question, format!("Not measured: {reason}."));
    };
    let slower =
        format!("The f64 answer takes {} times as long.", significant(twin.slowdown.value, 2));
    let Some(bias) = twin.largest_bias() else {
        let text = format!(
            "Unproven: in {} samples per pixel no light was found, and there is nothing to \
             compare. {slower}",
            twin.samples
        );
        return Answer { question, text, warning: true };
    };
    let target = crate::cost::TARGETS.into_iter().fold(f64::INFINITY, f64::min);
    let verdict = if bias <= NEGLIGIBLE * target {
        format!("Yes, to {} and beyond:", rounded_percent(target, 1))
    } else {
        format!("Only down to errors of about {}:", rounded_percent(bias / NEGLIGIBLE, 1))
    };
    let differs = if bias == 0.0 {
        "is the f64 one in each channel".to_owned()
    } else {
        format!("differs from the f64 one by less than {} of it in each channel", tiny(bias))
    };
    calm(
        question,
        format!(
            "{verdict} on the same {} samples per pixel the image mean {differs}. {slower} (`candor verify` tests more.)",
            twin.samples,
        ),
    )
}

/// A share that may be far below a per cent.
fn tiny(share: f64) -> String {
    if share < 1e-6 { format!("{share:.0e}") } else { rounded_percent(share, 2) }
}

/// What the numbers mean, for those who want to know.
pub(super) fn notes() -> [String; 5] {
    [
        format!(
            "Intervals are two-sided at {} and cover this run's noise alone: rounds take turns, \
             so that drift of the machine hits all estimators alike and their ratios are known \
             better than each alone; another machine, or this one on a busy day, has other times.",
            rounded_percent(CONFIDENCE, 2)
        ),
        "The error is the relative RMS error: the root of the pixels' mean squared standard \
         error, over the picture's mean luminance. The variance is its square at one sample per \
         pixel; efficiency is 1/(variance × seconds per sample)."
            .to_owned(),
        "Points are realised errors, not stated ones: a picture is off by about half the \
         difference between two pictures of half its samples. No two points of a line share \
         samples. Lines are predicted from the variance."
            .to_owned(),
        format!(
            "A warning comes where a slope is not {EXPECTED} or realised errors are not the stated \
             ones at a confidence of {}, and off by more than {MATTERS} or {}, which would change \
             predicted times by about a tenth. The noise must be spread over {MIN_VARYING} pixels or \
             more for one.",
            rounded_percent(WARNING_CONFIDENCE, 3),
            rounded_percent(RATIO_MATTERS, 1),
        ),
        "Measured times end when a run's own stated error is at the target; the compilation of the \
         kernel is not in them. Unproven pixels have met no light yet: what they hide is in no \
         error."
            .to_owned(),
    ]
}
