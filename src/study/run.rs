//! One run into a folder.

use super::chaos::{self, Chaos, ComparedRow};
use super::film::RunFilm;
use super::pictures::Gallery;
use super::run_page::page;
use super::wear::{WEAR_FILE, wear_csv, wear_picture, wearing};
use crate::engine::{self, Instant};
use crate::mechanism::Mechanism;
use crate::report::{Picture, ReportError};
use crate::results::Beginning;
use crate::results::Folder;
use crate::results::{PAGE_FILE, PLAYER_FILE, keep_scenario, scenario_files, to_json};
use crate::results::{RunError, refused};
use crate::scenario::Scenario;
use crate::simulate::{Machine, Recorder, Summary, TimeSeries};
use std::fs::{self, File};
use std::io::BufWriter;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant as Clock;

/// The JSON file of a run, by which its folder is known.
pub const SUMMARY_FILE: &str = "summary.json";

pub(super) const TIME_SERIES_FILE: &str = "timeseries.csv";
const ANIMATION_FILE: &str = "animation.svg";

/// What a run came to.
#[derive(Debug)]
pub struct RunOutcome {
    /// The main figures, and what the pictures show.
    pub recorded: Recorded,
    /// The text of `summary.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
    /// Simulated time in s that was asked for.
    pub duration: f64,
}

/// Under which conditions a run goes on.
#[derive(Clone, Copy, Debug)]
pub struct Terms<'a> {
    /// Once true, the run ends.
    pub stop: &'a AtomicBool,
    /// However long it takes, and however much it writes.
    pub at_any_cost: bool,
}

/// A run in memory: its figures, and what its pictures are drawn from.
#[derive(Debug)]
pub struct Recorded {
    /// The main figures; `files` is empty.
    pub summary: Summary,
    /// Normal force times sliding distance in J round the ring of each joint, where journals rub.
    pub rubbed: Option<Vec<Vec<f64>>>,
    gallery: Gallery,
    film: RunFilm,
}

impl Recorded {
    /// The pictures, in the order of the page.
    ///
    /// # Errors
    /// [`ReportError`] if one cannot be drawn.
    pub fn pictures(&self) -> Result<Vec<Picture>, ReportError> {
        self.gallery.draw()
    }

    /// The start of the run as a picture that moves (SVG).
    pub fn animation(&self) -> String {
        self.film.animation()
    }

    /// The page that plays the run.
    pub fn player(&self) -> String {
        self.film.player()
    }
}

/// Simulates a machine and writes no file. `observe` sees each row, and may end the run there; so does `stop` between
/// any two steps once it is true.
///
/// ```
/// use freeplay::prelude::*;
/// use freeplay::study::recorded;
/// use std::{ops::ControlFlow, sync::atomic::AtomicBool};
///
/// let sets = ["simulation.duration=0.01", "simulation.settle=0"].map(str::to_owned);
/// let scenario = Scenario::load(None, &sets)?;
/// let stop = AtomicBool::new(false);
/// let run = recorded(&scenario, &mut assemble(&scenario)?, &stop, &mut |_, _| ControlFlow::Continue(()));
/// assert_eq!(run.summary.simulated_s, 0.01);
/// assert!(run.pictures()?.iter().any(|picture| picture.file == "orbits.svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn recorded(
    scenario: &Scenario,
    machine: &mut Machine,
    stop: &AtomicBool,
    observe: &mut dyn FnMut(&Mechanism, &Instant) -> ControlFlow<()>,
) -> Recorded {
    let started = Clock::now();
    let mechanism = &machine.mechanism;
    let mut recorder = Recorder::new(mechanism, scenario.simulation.settle());
    let mut gallery = Gallery::new(mechanism, machine.schedule);
    let mut film = RunFilm::new(&scenario.name, mechanism, &machine.layout);
    let mut looks = Vec::new();
    let mut left = false;
    let ideal = &mut machine.ideal;
    let (control, schedule) = (machine.control, machine.schedule);
    let ended = engine::run_balanced(mechanism, control, schedule, stop, &mut |instant| {
        let ideal = recorder.ideal_at(mechanism, ideal, instant.t);
        recorder.row(mechanism, instant, &ideal);
        gallery.row(mechanism, instant, &ideal);
        film.row(mechanism, instant, &ideal);
        if instant.t <= chaos::WINDOW {
            looks.push(ComparedRow::at(mechanism, instant));
        }
        let go_on = observe(mechanism, instant);
        left = go_on.is_break();
        go_on
    });
    let (work, halted) = match ended {
        Ok(work) => (work, None),
        Err(halt) => {
            let reason = halt.to_string();
            (*halt.work, Some(reason))
        }
    };
    let wall = started.elapsed().as_secs_f64();
    let rubbed = recorder.rubbed(&work).filter(|_| !wearing(mechanism).is_empty());
    let mut summary = recorder.finish(scenario, machine, &work, wall, halted, Vec::new());
    summary.interrupted |= stop.load(Ordering::Relaxed);
    if summary.halted.is_none() && !summary.interrupted && !left {
        look_back(&mut summary, machine, &looks, stop);
    }
    Recorded { summary, rubbed, gallery, film }
}

/// Simulates a machine and writes everything about it into `folder`. `observe` sees each row. A run that breaks down is
/// written up to there; its summary says so in `halted`. So is one that ends because it was told to stop, as
/// `interrupted`, unless an earlier result would be lost to it.
///
/// ```
/// use freeplay::prelude::*;
/// use freeplay::results::Folder;
/// use freeplay::study::{SUMMARY_FILE, Terms};
/// use std::sync::atomic::AtomicBool;
///
/// let sets = ["simulation.duration=0.01", "simulation.settle=0"].map(str::to_owned);
/// let scenario = Scenario::load(None, &sets)?;
/// let place = tempfile::tempdir()?;
/// let folder = Folder::prepare(&place.path().join("result"), SUMMARY_FILE, false)?;
/// let terms = Terms { stop: &AtomicBool::new(false), at_any_cost: false };
/// let done = freeplay::study::run(&scenario, &mut assemble(&scenario)?, folder, terms, &mut |_, _| ())?;
/// assert!(done.folder.join(SUMMARY_FILE).exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`]; the folder is left as it was. A file that cannot be written ends the run at once.
pub fn run(
    scenario: &Scenario,
    machine: &mut Machine,
    folder: Folder,
    terms: Terms,
    observe: &mut dyn FnMut(&Mechanism, &Instant),
) -> Result<RunOutcome, RunError> {
    let recorded = run_into(scenario, machine, &folder, terms, observe)?;
    if recorded.summary.interrupted && folder.replaces() {
        return Err(RunError::Dropped);
    }
    let json = to_json(&recorded.summary);
    let duration = scenario.simulation.duration;
    Ok(RunOutcome { recorded, json, folder: folder.finish()?, duration })
}

/// The run, all of its files written.
fn run_into(
    scenario: &Scenario,
    machine: &mut Machine,
    folder: &Folder,
    terms: Terms,
    observe: &mut dyn FnMut(&Mechanism, &Instant),
) -> Result<Recorded, RunError> {
    let file = File::create(folder.file(TIME_SERIES_FILE)).map_err(refused(TIME_SERIES_FILE))?;
    let mut series = TimeSeries::new(BufWriter::new(file), &machine.mechanism, &machine.layout)
        .map_err(refused(TIME_SERIES_FILE))?;
    let mut beginning = Beginning::new(machine.schedule);
    let mut written = Ok(());
    let mut recorded = recorded(scenario, machine, terms.stop, &mut |mechanism, instant| {
        observe(mechanism, instant);
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
    let mechanism = &machine.mechanism;
    let rubbed = recorded.rubbed.take();
    let mut pictures = recorded.pictures()?;
    if let Some(rubbed) = &rubbed {
        pictures.push(wear_picture(mechanism, rubbed)?);
    }
    let texts = [TIME_SERIES_FILE, SUMMARY_FILE, PAGE_FILE, PLAYER_FILE, ANIMATION_FILE];
    let summary = &mut recorded.summary;
    summary.files = texts
        .into_iter()
        .map(str::to_owned)
        .chain(scenario_files(scenario))
        .chain(rubbed.as_ref().map(|_| WEAR_FILE.to_owned()))
        .chain(pictures.iter().map(|picture| picture.file.clone()))
        .collect();

    let write = |name: &str, text: &str| fs::write(folder.file(name), text).map_err(refused(name));
    write(SUMMARY_FILE, &to_json(summary))?;
    keep_scenario(scenario, folder)?;
    if let Some(rubbed) = &rubbed {
        write(WEAR_FILE, &wear_csv(mechanism, rubbed))?;
    }
    for picture in &pictures {
        write(&picture.file, &picture.svg)?;
    }
    write(PAGE_FILE, &page(summary, &mechanism.bodies[mechanism.output].name, &pictures))?;
    write(PLAYER_FILE, &recorded.player())?;
    write(ANIMATION_FILE, &recorded.animation())?;
    Ok(recorded)
}

/// Adds what shorter runs beside a finished one say of it: its own error, and chaos.
fn look_back(summary: &mut Summary, machine: &Machine, looks: &[ComparedRow], stop: &AtomicBool) {
    let (mechanism, control, schedule) = (&machine.mechanism, machine.control, machine.schedule);
    let Some(own) = chaos::own_error(mechanism, control, schedule, looks, stop) else { return };
    summary.watched.compared(own);
    let chaos = Chaos::of(mechanism, schedule, own, 0.0, stop);
    if let Some(chaos) = chaos {
        summary.lyapunov_exponent_1_s = chaos.lyapunov;
        summary.predictability_horizon_s = chaos.horizon();
    }
}
