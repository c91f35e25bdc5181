//! A tracer that outlives its device. It stands between the tracers and whoever drives them:
//! what it has is copied to the host from time to time, and when the device is lost, another
//! tracer goes on from there.

use crate::film::Film;
use crate::tracer::{Description, Ledger, TraceError, Tracer};
use std::ops::Range;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Losses in a row, with no step forward between them, that are endured. The dispatches are a
/// thousandth of what they were by then (4⁵), so that they are not what is wrong.
const ENDURED: u32 = 5;

/// A device that does not open is tried again after these pauses: a driver that resets one takes
/// a moment.
const PAUSES: [Duration; 3] =
    [Duration::from_secs(1), Duration::from_secs(2), Duration::from_secs(4)];

/// A whole state is taken this often if nobody asks for one: what a loss costs at most.
const STEP: Duration = Duration::from_mins(1);

/// The same after a loss. Where one was, the next may be near, and a device that lasts for less
/// than a step never gets ahead.
const SHORT_STEP: Duration = Duration::from_secs(1);

/// Taking whole states may take this share of the time.
const SHARE: f64 = 0.01;

/// Makes a tracer of the scene, for a device that was lost so often in a row.
pub type Maker<'a> = Box<dyn FnMut(u32) -> Result<Box<dyn Tracer>, TraceError> + 'a>;

/// Is told what happens to the device.
pub type Listener<'a> = Box<dyn FnMut(&str) + 'a>;

/// A tracer that outlives its device, with the same bits: samples that were added since the last
/// whole state are traced again, in the same ranges and each once.
///
/// It counts the losses in a row and starts from none again at every step forward, which is a
/// whole state with more samples than the one before; that a device takes samples is none, as
/// they are lost with it.
pub struct Enduring<'a> {
    make: Maker<'a>,
    tell: Listener<'a>,
    description: Description,
    /// `None` from a loss until another one is made.
    tracer: Option<Box<dyn Tracer>>,
    /// Film and ledger of the same samples; `None` before the first.
    whole: Option<(Film, Ledger)>,
    /// Ranges that were added since.
    since: Vec<Range<u64>>,
    /// How many of them this tracer has.
    traced: usize,
    losses_in_a_row: u32,
    was_lost: bool,
    /// When the next whole state is taken.
    due: Instant,
}

impl<'a> Enduring<'a> {
    /// Makes the first tracer; a device that does not open now is no loss and is not waited for.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn new(mut make: Maker<'a>, tell: Listener<'a>) -> Result<Self, TraceError> {
        let tracer = make(0)?;
        Ok(Self {
            make,
            tell,
            description: tracer.describe(),
            tracer: Some(tracer),
            whole: None,
            since: Vec::new(),
            traced: 0,
            losses_in_a_row: 0,
            was_lost: false,
            due: Instant::now() + STEP,
        })
    }

    /// The last whole state: what there is still when the device was lost for good.
    #[must_use]
    pub fn last_whole(&self) -> Option<(Film, Ledger)> {
        self.whole.clone()
    }

    /// Brings a tracer up to everything that was added and calls it, until the answer is
    /// something else than that the device is lost.
    fn until_it_lasts(
        &mut self,
        mut call: impl FnMut(&mut Self) -> Result<(), TraceError>,
    ) -> Result<(), TraceError> {
        loop {
            match self.catch_up().and_then(|()| call(self)) {
                Err(TraceError::DeviceLost(reason)) => self.lose(&reason)?,
                answer => return answer,
            }
        }
    }

    /// Lets go of a tracer whose device is lost.
    fn lose(&mut self, reason: &str) -> Result<(), TraceError> {
        self.tracer = None;
        self.was_lost = true;
        self.losses_in_a_row += 1;
        if self.losses_in_a_row > ENDURED {
            let losses = std::mem::take(&mut self.losses_in_a_row);
            let text = format!("{losses} times without a step forward, in the end: {reason}");
            return Err(TraceError::DeviceLost(text));
        }
        (self.tell)(&format!("the device was lost ({reason}); opening it again"));
        Ok(())
    }

    /// Traces what was added and this tracer does not have.
    fn catch_up(&mut self) -> Result<(), TraceError> {
        self.tracer()?;
        while let Some(range) = self.since.get(self.traced).cloned() {
            self.tracer()?.add_samples(range)?;
            self.traced += 1;
            if Instant::now() >= self.due {
                self.take_whole()?;
            }
        }
        Ok(())
    }

    fn tracer(&mut self) -> Result<&mut dyn Tracer, TraceError> {
        let tracer = match self.tracer.take() {
            Some(tracer) => tracer,
            None => self.another()?,
        };
        Ok(self.tracer.insert(tracer).as_mut())
    }

    /// Another tracer, with the last whole state.
    fn another(&mut self) -> Result<Box<dyn Tracer>, TraceError> {
        let mut tracer = self.reopen()?;
        self.traced = 0;
        let mut from = "the start".to_owned();
        if let Some((film, ledger)) = &self.whole {
            tracer.restore(film, ledger)?;
            from = format!("{} samples per pixel", film.samples().count());
        }
        (self.tell)(&format!("it is open again: going on from {from}, with smaller dispatches"));
        self.due = Instant::now() + SHORT_STEP;
        Ok(tracer)
    }

    /// Makes a tracer, even if it takes some tries.
    fn reopen(&mut self) -> Result<Box<dyn Tracer>, TraceError> {
        let mut pauses = PAUSES.into_iter();
        loop {
            match ((self.make)(self.losses_in_a_row), pauses.next()) {
                (Ok(tracer), _) => return Ok(tracer),
                (Err(_), Some(pause)) => sleep(pause),
                (Err(error), None) => {
                    return Err(TraceError::Device(format!(
                        "the device was lost and does not open again: {error}"
                    )));
                }
            }
        }
    }

    /// A tracer that failed may have a part of what it was asked for, and is let go; a film that
    /// refuses samples does so before anything is traced.
    fn unless_in_doubt(&mut self, answer: Result<(), TraceError>) -> Result<(), TraceError> {
        if !matches!(answer, Ok(()) | Err(TraceError::Film(_))) {
            self.tracer = None;
        }
        answer
    }

    /// Copies film and ledger, both or none: after a loss between the two, the old ones still
    /// belong together.
    fn take_whole(&mut self) -> Result<(), TraceError> {
        let started = Instant::now();
        let tracer = self.tracer()?;
        self.whole = Some((tracer.film()?, tracer.ledger()?));
        self.since.drain(..self.traced);
        self.traced = 0;
        self.losses_in_a_row = 0;
        let step = if self.was_lost { SHORT_STEP } else { STEP };
        self.due = Instant::now() + started.elapsed().div_f64(SHARE).max(step);
        Ok(())
    }

    /// Film and ledger with everything added so far.
    fn current(&mut self) -> Result<(Film, Ledger), TraceError> {
        loop {
            match &self.whole {
                Some(whole) if self.since.is_empty() => return Ok(whole.clone()),
                _ => self.until_it_lasts(Self::take_whole)?,
            }
        }
    }
}

impl Tracer for Enduring<'_> {
    fn add_samples(&mut self, range: Range<u64>) -> Result<(), TraceError> {
        self.since.push(range);
        let added = self.until_it_lasts(|_| Ok(()));
        if added.is_err() {
            self.since.pop();
        }
        self.unless_in_doubt(added)
    }

    fn restore(&mut self, film: &Film, ledger: &Ledger) -> Result<(), TraceError> {
        let restored = self.until_it_lasts(|this| this.tracer()?.restore(film, ledger));
        self.unless_in_doubt(restored)?;
        self.whole = Some((film.clone(), ledger.clone()));
        self.since.clear();
        self.traced = 0;
        Ok(())
    }

    fn film(&mut self) -> Result<Film, TraceError> {
        Ok(self.current()?.0)
    }

    fn ledger(&mut self) -> Result<Ledger, TraceError> {
        Ok(self.current()?.1)
    }

    fn describe(&self) -> Description {
        self.description.clone()
    }
}
