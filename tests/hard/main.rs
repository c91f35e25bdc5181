//! The hard cases, where renderers go wrong: each of the 33 with what is expected of it and
//! a fault that it rejects. `-- --nocapture` prints the table.

mod pictures;
mod rows;
mod scenes;
#[path = "../support"]
mod support {
    pub mod bare;
    #[allow(dead_code, reason = "of all samplers, the lobe")]
    pub mod chi_square;
    #[allow(dead_code, reason = "each test uses some of the formulas")]
    pub mod closed_form;
    pub mod gpu;
    pub mod hits;
    #[allow(dead_code, reason = "of the quantities, the channels")]
    pub mod judge;
    pub mod rays;
    pub mod scenes;
    pub mod tracers;
    pub mod uniform_probe;
}

/// The cases are numbered from 1 to this.
const CASES: u32 = 33;

/// What a judge says of the kernel, or of a wrong one.
pub struct Verdict {
    /// Whether it is accepted.
    pub accepts: bool,
    /// What was found, in words.
    pub found: String,
}

/// One case, judged twice.
pub struct Line {
    /// Its number.
    pub case: u32,
    /// Scene file, or what is probed.
    pub place: String,
    /// What must be found.
    pub expected: String,
    /// The verdict on candor.
    pub right: Verdict,
    /// What is wrong on purpose.
    pub fault: &'static str,
    /// The verdict on that.
    pub wrong: Verdict,
}

impl Line {
    fn print(&self) {
        println!(
            "{:>2}  {:<40}{:<26}{:<26}{:<38}{}",
            self.case, self.place, self.expected, self.right.found, self.fault, self.wrong.found
        );
    }

    /// What is wrong with candor, or with the case.
    fn failures(&self) -> Vec<String> {
        let name = format!("case {}, {}", self.case, self.place);
        let mut failures = Vec::new();
        if !self.right.accepts {
            failures.push(format!("{name}: {}, not {}", self.right.found, self.expected));
        }
        if self.wrong.accepts {
            failures.push(format!("{name}: \"{}\" is accepted: {}", self.fault, self.wrong.found));
        }
        failures
    }
}

#[test]
fn every_hard_case_holds_and_rejects_its_fault() {
    let mut lines = scenes::lines();
    lines.extend(rows::lines());
    lines.extend(pictures::lines());
    lines.sort_by_key(|line| line.case);
    println!(
        "{:>2}  {:<40}{:<26}{:<26}{:<38}found under the fault",
        "", "where", "expected", "found", "fault"
    );
    lines.iter().for_each(Line::print);
    let failures: Vec<String> = lines.iter().flat_map(Line::failures).collect();
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    let missing: Vec<u32> =
        (1..=CASES).filter(|&case| lines.iter().all(|line| line.case != case)).collect();
    assert!(missing.is_empty(), "cases that nothing tests: {missing:?}");
}
