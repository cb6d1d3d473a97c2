//! One run into a folder.

use super::chaos::{self, Chaos, Look};
use super::film::Film;
use super::folder::{Folder, FolderError};
use super::forecast::{Beginning, Forecast};
use super::pictures::Gallery;
use super::run_page::page;
use crate::engine;
use crate::report::ReportError;
use crate::scenario::Scenario;
use crate::simulate::{Machine, Recorder, Summary, TimeSeries};
use serde::Serialize;
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant as Clock;

/// The JSON file of a run, by which its folder is known.
pub const SUMMARY_FILE: &str = "summary.json";

const TIME_SERIES_FILE: &str = "timeseries.csv";
pub(super) const SCENARIO_FILE: &str = "scenario.toml";
pub(crate) const PAGE_FILE: &str = "index.html";
pub(super) const PLAYER_FILE: &str = "player.html";
const ANIMATION_FILE: &str = "animation.svg";

/// What a run came to.
#[derive(Debug)]
pub struct Outcome {
    /// The main figures.
    pub summary: Summary,
    /// The text of `summary.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
    /// Simulated time in s that was asked for.
    pub duration: f64,
}

/// Why a run has no files.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A file cannot be written.
    #[error("cannot write {file}: {source}")]
    File {
        /// Its name.
        file: String,
        /// Why.
        source: io::Error,
    },
    /// It was told to stop, and an earlier result is worth more than the part of a new one.
    #[error("the run was interrupted; the earlier result stands")]
    Dropped,
    /// It would take long or write much, and nobody said that this is meant.
    #[error(
        "the run would {0}, judged by its beginning; say --yes if that is meant, or change --duration, \
         simulation.output_interval (rows) or simulation.tolerance (steps)"
    )]
    TooMuch(Forecast),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Picture(#[from] ReportError),
    /// The folder cannot get its name.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// What becomes of an error of the file system about `file`.
pub(crate) fn refused(file: &str) -> impl FnOnce(io::Error) -> RunError {
    let file = file.to_owned();
    |source| RunError::File { file, source }
}

/// Under which conditions a run goes on.
#[derive(Clone, Copy, Debug)]
pub struct Terms<'a> {
    /// Once true, the run ends.
    pub stop: &'a AtomicBool,
    /// However long it takes, and however much it writes.
    pub at_any_cost: bool,
}

/// Simulates a machine and writes everything about it into `folder`. `progress` is told the time
/// reached, in s. A run that breaks down is written up to there; its summary says so in `halted`. So is
/// one that ends because it was told to stop, as `interrupted`, unless an earlier result would be lost
/// to it.
///
/// # Errors
/// [`RunError`]; the folder is left as it was. A file that cannot be written ends the run at once.
pub fn run(
    scenario: &Scenario,
    machine: &mut Machine,
    folder: Folder,
    terms: Terms,
    progress: &mut dyn FnMut(f64),
) -> Result<Outcome, RunError> {
    let (summary, json) = run_into(scenario, machine, &folder, terms, progress)?;
    if summary.interrupted && folder.replaces() {
        return Err(RunError::Dropped);
    }
    let duration = scenario.simulation.duration;
    Ok(Outcome { summary, json, folder: folder.finish()?, duration })
}

/// The summary, and the text of its file.
fn run_into(
    scenario: &Scenario,
    machine: &mut Machine,
    folder: &Folder,
    terms: Terms,
    progress: &mut dyn FnMut(f64),
) -> Result<(Summary, String), RunError> {
    let started = Clock::now();
    let mechanism = &machine.mechanism;
    let mut recorder = Recorder::new(mechanism, scenario.simulation.settle());
    let mut gallery = Gallery::new(mechanism, machine.schedule);
    let mut film = Film::new(&scenario.name, mechanism, &machine.layout);

    let file = File::create(folder.file(TIME_SERIES_FILE)).map_err(refused(TIME_SERIES_FILE))?;
    let mut series = TimeSeries::new(BufWriter::new(file), mechanism, &machine.layout)
        .map_err(refused(TIME_SERIES_FILE))?;
    let mut beginning = Beginning::new(machine.schedule);
    let mut written = Ok(());
    let mut looks = Vec::new();
    let ideal = &mut machine.ideal;
    let (control, schedule, stop) = (machine.control, machine.schedule, terms.stop);
    let ended = engine::run_balanced(mechanism, control, schedule, stop, &mut |instant| {
        let ideal = ideal.at(instant.t);
        recorder.row(mechanism, instant, &ideal);
        gallery.row(mechanism, instant, &ideal);
        film.row(mechanism, instant, &ideal);
        if instant.t <= chaos::WINDOW {
            looks.push(Look::at(mechanism, instant));
        }
        progress(instant.t);
        written = series.row(mechanism, instant).map_err(refused(TIME_SERIES_FILE));
        if let Some(forecast) = beginning.too_much(instant.t, series.bytes())
            && !terms.at_any_cost
        {
            written = Err(RunError::TooMuch(forecast));
        }
        if written.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    written?;
    series.finish().map_err(refused(TIME_SERIES_FILE))?;
    let (work, halted) = match ended {
        Ok(work) => (work, None),
        Err(halt) => (*halt.work, Some(halt.to_string())),
    };
    let wall = started.elapsed().as_secs_f64();

    let pictures = gallery.draw()?;
    let texts =
        [TIME_SERIES_FILE, SUMMARY_FILE, SCENARIO_FILE, PAGE_FILE, PLAYER_FILE, ANIMATION_FILE];
    let files: Vec<String> = texts
        .into_iter()
        .map(str::to_owned)
        .chain(pictures.iter().map(|picture| picture.file.clone()))
        .collect();
    let mut summary = recorder.finish(scenario, machine, work, wall, halted, files);
    summary.interrupted |= stop.load(Ordering::Relaxed);
    if summary.halted.is_none() && !summary.interrupted {
        look_back(&mut summary, machine, &looks, stop);
    }

    let write = |name: &str, text: &str| fs::write(folder.file(name), text).map_err(refused(name));
    let json = to_json(&summary);
    write(SUMMARY_FILE, &json)?;
    write(SCENARIO_FILE, &scenario.to_toml())?;
    for picture in &pictures {
        write(&picture.file, &picture.svg)?;
    }
    write(PAGE_FILE, &page(&summary, &mechanism.bodies[mechanism.output].name, &pictures))?;
    write(PLAYER_FILE, &film.player())?;
    write(ANIMATION_FILE, &film.animation())?;
    Ok((summary, json))
}

/// Adds what shorter runs beside a finished one say of it: its own error, and chaos.
fn look_back(summary: &mut Summary, machine: &Machine, looks: &[Look], stop: &AtomicBool) {
    let (mechanism, control, schedule) = (&machine.mechanism, machine.control, machine.schedule);
    let Some(own) = chaos::own_error(mechanism, control, schedule, looks, stop) else { return };
    summary.watched.compared(own);
    let chaos = Chaos::of(mechanism, schedule, own, 0.0, stop);
    if let Some(chaos) = chaos {
        summary.lyapunov_exponent_1_s = chaos.lyapunov;
        summary.predictability_horizon_s = chaos.horizon();
    }
}

/// Pretty JSON with a line break at the end.
pub(super) fn to_json(result: &impl Serialize) -> String {
    // No input makes this fail: results have only names for keys, and NaN becomes null.
    let text = serde_json::to_string_pretty(result).expect("numbers, texts and lists are JSON");
    text + "\n"
}
