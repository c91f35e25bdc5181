//! A tracer whose device is lost at calls that the test chooses, and the twin behind it.

use super::tracers::twin;
use candor::cpu::CpuTracer;
use candor::film::{Film, add_words};
use candor::scene::Scene;
use candor::tracer::{Description, Ledger, TraceError, Tracer};
use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

/// What is called, of all tracers that are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Call {
    Make,
    Add,
    Restore,
    Film,
    Ledger,
}

/// Says of the call with this number, from 0, whether it fails.
pub type Plan = Box<dyn FnMut(usize, Call) -> bool>;

/// What was called so far, and what fails.
pub struct Faults {
    pub calls: Vec<Call>,
    pub plan: Plan,
}

impl Faults {
    pub fn new(plan: impl FnMut(usize, Call) -> bool + 'static) -> Rc<RefCell<Self>> {
        Rc::new(RefCell::new(Self { calls: Vec::new(), plan: Box::new(plan) }))
    }

    fn call(&mut self, call: Call) -> Result<(), TraceError> {
        self.calls.push(call);
        if (self.plan)(self.calls.len() - 1, call) {
            return Err(match call {
                Call::Make => TraceError::Device("it is busy".to_owned()),
                _ => TraceError::DeviceLost(format!("at call {}", self.calls.len())),
            });
        }
        Ok(())
    }
}

/// A mistake that one may make with a lost device; the tests tell each by the film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mistake {
    None,
    /// Starts from nothing.
    ForgetsAll,
    /// Claims the samples that it had, without their sums.
    ForgetsSums,
    /// Goes on from the film with a new ledger.
    ForgetsLedger,
    /// Has all samples twice that it traces again.
    AddsTwice,
}

pub struct Faulty {
    twin: CpuTracer,
    /// Each sample of a pixel counts as an invalid one, so that the ledger says whose it is.
    ledger: Ledger,
    faults: Rc<RefCell<Faults>>,
    mistake: Mistake,
    is_first: bool,
}

impl Faulty {
    pub fn new(
        scene: &Scene,
        faults: &Rc<RefCell<Faults>>,
        mistake: Mistake,
    ) -> Result<Self, TraceError> {
        let is_first = faults.borrow().calls.is_empty();
        let mut tracer = Self {
            twin: twin(scene),
            ledger: Ledger::default(),
            faults: Rc::clone(faults),
            mistake,
            is_first,
        };
        tracer.call(Call::Make)?;
        Ok(tracer)
    }

    fn call(&mut self, call: Call) -> Result<(), TraceError> {
        self.faults.borrow_mut().call(call)
    }

    /// The sums of everything once more.
    fn double(&mut self) {
        let mut film = self.twin.film().expect("the twin has a film");
        for words in film.pixels_mut() {
            let once = *words;
            add_words(words, &once);
        }
        self.twin.restore(&film, &Ledger::default()).expect("the film is its own");
    }
}

impl Tracer for Faulty {
    /// A device that is lost has traced a part of the range.
    fn add_samples(&mut self, range: Range<u64>) -> Result<(), TraceError> {
        if let Err(error) = self.call(Call::Add) {
            self.twin.add_samples(range.start..(range.start + range.end).div_ceil(2))?;
            return Err(error);
        }
        self.ledger.count += range.end - range.start;
        self.twin.add_samples(range)?;
        if self.mistake == Mistake::AddsTwice && !self.is_first {
            self.double();
        }
        Ok(())
    }

    fn restore(&mut self, film: &Film, ledger: &Ledger) -> Result<(), TraceError> {
        film.check_fits(self.twin.film()?.size(), film.scale())?;
        self.call(Call::Restore)?;
        let empty = Film::awaiting(film.size(), film.scale(), film.samples().clone());
        match self.mistake {
            Mistake::ForgetsAll => return Ok(()),
            Mistake::ForgetsSums => self.twin.restore(&empty, ledger)?,
            _ => self.twin.restore(film, ledger)?,
        }
        if self.mistake != Mistake::ForgetsLedger {
            self.ledger = ledger.clone();
        }
        Ok(())
    }

    fn film(&mut self) -> Result<Film, TraceError> {
        self.call(Call::Film)?;
        self.twin.film()
    }

    fn ledger(&mut self) -> Result<Ledger, TraceError> {
        self.call(Call::Ledger)?;
        Ok(self.ledger.clone())
    }

    fn describe(&self) -> Description {
        self.twin.describe()
    }
}
