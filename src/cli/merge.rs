//! `candor merge`: adds films.

use super::args::MergeArgs;
use super::output::{Outputs, Wishes};
use super::progress::bar;
use super::render::summary;
use super::render_report::{FilmJson, error_text, facts};
use super::{DONE, Refusal, memory, on_terminal, refuse, streams};
use crate::estimate::Summary;
use crate::film::{Film, SampleRanges};
use crate::report::{Picture, Provenance, Spent, StoredFilm};
use crate::tracer::Ledger;
use serde::Serialize;
use std::path::PathBuf;

pub(super) fn run(args: &MergeArgs) -> Result<u8, Refusal> {
    let parts = args.films.iter().map(|path| StoredFilm::open(path));
    let parts = parts.collect::<Result<Vec<_>, _>>()?;
    let samples = check(&parts)?;
    let outputs = Outputs::new(&args.output, None, Wishes::of(&args.write, args.quiet))?;
    let identity = &parts[0].provenance.origin.identity;
    outputs.check_films(Some(identity), &samples)?;
    memory::check_merge(identity.size)?;
    warn(args, &parts, &samples);
    let merged = Merged::of(&parts, args.quiet)?;
    let picture = Picture::develop(&merged.film, merged.provenance.origin.dark);
    let (files, failed) = outputs.write(&picture, &merged.film, &merged.provenance, None)?;
    if failed.is_none() || !files.is_empty() {
        streams::results(&merged.report(args, &files))?;
    }
    failed.map_or(Ok(DONE), Err)
}

/// All samples, if every film is of the same picture and none holds a sample of another.
fn check(parts: &[StoredFilm]) -> Result<SampleRanges, Refusal> {
    let mut all = SampleRanges::default();
    for (number, part) in parts.iter().enumerate() {
        let (path, first) = (part.path().display(), parts[0].path().display());
        let theirs = &part.provenance.origin.identity;
        if let Err(difference) = parts[0].provenance.origin.identity.check(theirs) {
            let why = difference.between(&format!("in {first}"), &format!("in {path}"));
            return refuse(format_args!("{path}: cannot be added to {first}: the {why}"));
        }
        let samples = &part.provenance.samples;
        for other in &parts[..number] {
            if let Some(shared) = samples.shared(&other.provenance.samples) {
                return refuse(format_args!(
                    "{path}: samples {}..{} are in {} too, and would count twice",
                    shared.start,
                    shared.end,
                    other.path().display()
                ));
            }
        }
        all = all.union(samples)?;
    }
    Ok(all)
}

/// The samples below the last that no film holds.
fn gaps(samples: &SampleRanges) -> Option<String> {
    let end = samples.as_slice().last().map_or(0, |range| range.end);
    let missing = samples.missing(&(0..end));
    (missing.count() > 0).then(|| missing.to_string())
}

/// Says what the user should know before trusting the whole.
fn warn(args: &MergeArgs, parts: &[StoredFilm], samples: &SampleRanges) {
    if args.quiet {
        return;
    }
    if let Some(gaps) = gaps(samples) {
        streams::message(&format!("warning: samples {gaps} are in none of the films"));
    }
    let first = &parts[0].provenance.origin.tracer;
    let other = parts.iter().find(|part| part.provenance.origin.tracer != *first);
    if let Some(other) = other {
        let tracer = &other.provenance.origin.tracer;
        streams::message(&format!(
            "warning: {} was made on {} ({}), {} on {} ({}); samples may differ between them by \
             rounding",
            parts[0].path().display(),
            first.device,
            first.driver,
            other.path().display(),
            tracer.device,
            tracer.driver
        ));
    }
}

/// A film of all samples.
struct Merged {
    film: Film,
    summary: Summary,
    provenance: Provenance,
}

impl Merged {
    /// Adds the films, of which two at a time are in memory.
    fn of(parts: &[StoredFilm], quiet: bool) -> Result<Self, Refusal> {
        let bar = (!quiet && on_terminal()).then(bar);
        let first = &parts[0].provenance;
        let mut film = Film::new(first.origin.identity.size, first.origin.identity.scale);
        let (mut tracer, mut ledger) = (first.origin.tracer.clone(), Ledger::default());
        let mut seconds = 0.0;
        for (number, part) in parts.iter().enumerate() {
            if let Some(bar) = &bar {
                bar.set_position(1000 * number as u64 / parts.len() as u64);
                bar.set_message(part.path().display().to_string());
            }
            film.merge(&part.read()?)?;
            let Provenance { origin, spent, .. } = &part.provenance;
            tracer = tracer.and(&origin.tracer);
            ledger.append(spent.ledger.clone());
            seconds += spent.seconds;
        }
        if let Some(bar) = bar {
            bar.finish_and_clear();
        }
        let mut origin = first.origin.clone();
        origin.tracer = tracer;
        let summary = if origin.dark {
            Summary::of_darkness(film.samples().count())
        } else {
            let mut summary = summary(&film, &ledger, false);
            // Which films are added may have been chosen by what they show: nothing but the first
            // samples, at one of the fixed counts, is a look that the confidence is spread over.
            let is_first = film.samples().missing(&(0..summary.samples)).count() == 0;
            summary.error_bound = summary.error_bound.filter(|_| is_first);
            summary
        };
        let spent = Spent { ledger, seconds, next_look: None };
        let provenance = Provenance::new(origin, spent, &film, &summary);
        Ok(Self { film, summary, provenance })
    }

    fn report(&self, args: &MergeArgs, outputs: &[PathBuf]) -> String {
        if args.json {
            let film = FilmJson::of(&self.provenance, outputs);
            let json = Json { film, missing: gaps(&self.provenance.samples) };
            return serde_json::to_string(&json).expect("plain values serialize");
        }
        let error = error_text(self.summary.relative_error);
        let facts = facts(&self.provenance, error, None);
        let written = outputs.iter().map(|file| format!("wrote {}", file.display()));
        written.chain([format!("merged: {}", facts.join(", "))]).collect::<Vec<_>>().join("\n")
    }
}

/// The `--json` object.
#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    film: FilmJson<'a>,
    /// The ranges of samples that no film holds.
    missing: Option<String>,
}
