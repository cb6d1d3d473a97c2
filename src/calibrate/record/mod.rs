//! Synthetic recordings: what a rig's sensors would show of the machine as it is, effects of its scenario included, which
//! the rig that lies beside them does not declare.

mod pace;
mod page;
mod run;

pub use pace::passed;
pub use run::clean;

use super::results::result::{CalibrateError, control, publish, refuse, to_json};
use super::sensed::charts::{DrawnRun, of_run};
use super::sensed::errors::{self, mean};
use super::sensed::predict::Along;
use super::sensed::recording::Recording;
use super::sensed::simulate::noisy;
use super::sensed::start::machine;
use super::sensed::thresholds::PREDICTING;
use super::values::errors::ChannelError;
use crate::mechanism::Mechanism;
use crate::report::{Picture, Style};
use crate::results::{Folder, Forecast, PAGE_FILE, RunError};
use crate::scenario::{self, Law, Scenario};
use crate::simulate::{Machine, Provenance};
use run::timed;
pub(super) use run::{RecordingSetup, like};
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant as Clock;

/// The JSON file by which recordings are known.
pub const RECORD_FILE: &str = "record.json";

/// The rig as declared: the scenario without its effects.
pub const RIG_FILE: &str = "rig.toml";

/// The scenario with its effects: what a calibration of the rig should find.
const TRUTH_FILE: &str = "truth.toml";

/// Both recordings: one to calibrate on and one to validate on, with the pace at which each follows the motion. A
/// second pace makes other inertial forces, so that values fitted to the first are held against something new.
pub const RUNS: [(&str, f64); 2] = [("run-a.csv", 1.0), ("run-b.csv", 0.8)];

const CAPTION: &str = "Measured: the synthetic recording. As declared: the rig without what is hidden. As it is: the \
                       machine that was recorded, without noise.";

/// Most numbers of a recording, time not counted: the file stays far below what `calibrate` reads
/// (`measure::bounded::TABLE`).
const MOST: f64 = 1e7;

/// How many rows recordings have.
///
/// [`prepare`](prepare()) has an example.
#[derive(Clone, Copy, Debug)]
pub struct RowCount {
    /// Rows a second.
    pub rate: f64,
    /// Length of each recording in s.
    pub duration: f64,
}

impl RowCount {
    /// What is wrong with recordings of so many columns, made before anything is.
    fn too_many(self, columns: usize) -> Option<String> {
        let RowCount { rate, duration } = self;
        let numbers = rate * duration * columns as f64;
        (numbers > MOST).then(|| {
            format!(
                "a recording of {duration:e} s at {rate:e} rows a second, from {columns} sensors, holds {numbers:.1e} \
                 numbers; expected at most {MOST:.0e}: give a smaller --rate or --duration"
            )
        })
    }
}

/// `record.json`.
#[derive(Clone, Debug, Serialize)]
pub struct RecordReport {
    /// Program, versions, scenario.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Seed of the sensors' noise.
    pub seed: u64,
    /// The recordings' files.
    pub runs: Vec<String>,
    /// Rows a second.
    #[serde(rename = "rate_Hz")]
    pub rate: f64,
    /// Length of each in s.
    pub duration_s: f64,
    /// What the rig does not declare.
    pub hidden: Vec<String>,
    /// Errors by channel: `before` of the rig as declared (null where nothing is hidden), `after` of the machine as it
    /// is, `floor` what sensor noise and rattle leave to any model.
    pub errors: Vec<ChannelError>,
    /// What is hidden, in floors, in the channel that shows it best: √(before² − after²)/floor. Null where nothing is.
    pub shows_floors: Option<f64>,
    /// That channel.
    pub shows_in: Option<String>,
    /// Simulations that a floor was taken from: more than one where the machine rattles by more than its sensors see.
    pub replicas: usize,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
}

impl RecordReport {
    /// Whether the sensors show what is hidden, in one sentence.
    pub fn verdict(&self) -> String {
        let hidden = self.hidden.join(", ");
        match (self.shows_floors, &self.shows_in) {
            (Some(floors), Some(channel)) => {
                let floors_in_words = crate::report::number(floors);
                let answer = if floors >= 1.0 { "shows" } else { "does not show" };
                format!(
                    "{hidden}: {answer}; at most {floors_in_words} × what noise and rattle leave, in {channel}."
                )
            }
            _ => "Nothing is hidden: the rig is the machine that was recorded.".to_owned(),
        }
    }
}

/// Finished recordings.
#[derive(Debug)]
pub struct FinishedRecordings {
    /// What they came to.
    pub recorded: RecordReport,
    /// The text of `record.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}

/// A scenario that can be recorded.
#[derive(Debug)]
pub struct PreparedRecord {
    truth: Scenario,
    rig: Scenario,
    rows: RowCount,
    likes: Vec<Recording>,
}

/// Makes sure that a scenario can be recorded; `machine` is what it was put together as.
///
/// ```
/// use freeplay::calibrate::record::{RowCount, prepare};
/// use freeplay::prelude::*;
///
/// let sets = ["sensors.pose_std=4e-6", "sensors.force_std=0.15"].map(str::to_owned);
/// let scenario = Scenario::load(None, &sets)?;
/// let rows = RowCount { rate: 500.0, duration: 1.0 };
/// let prepared = prepare(&scenario, &assemble(&scenario)?, rows)?;
/// assert!(prepared.forecast()?.bytes > 1e4, "a thousand numbers and more");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// What speaks against it.
pub fn prepare(
    scenario: &Scenario,
    assembled: &Machine,
    rows: RowCount,
) -> Result<PreparedRecord, CalibrateError> {
    let mut wrong = Vec::new();
    let mechanism = &assembled.mechanism;
    if mechanism.sensors.is_empty() {
        let message = "is missing: nobody knows what is recorded";
        let help = match scenario.mechanism {
            scenario::Mechanism::ThreeRpr(_) => {
                "add [sensors], such as --set sensors.pose_std=4e-6 --set sensors.force_std=0.15"
            }
            _ => {
                "add a [[sensor]] for each column; `freeplay init four-bar --rig` prints a rig that has them, and \
                 so does every other kind"
            }
        };
        wrong.push(scenario.problem("sensor", message, help).to_string());
    }
    if scenario.contact.law == Law::Native {
        let help = "write law = \"hertz-step\": recordings are made with a contact law whose error is known";
        wrong.push(scenario.problem("contact.law", "is \"native\"", help).to_string());
    }
    wrong.extend(rows.too_many(mechanism.sensors.len()));
    refuse(wrong)?;
    let mut rig = scenario.clone();
    rig.effects.clear();
    let declared = crate::model::assemble(&rig)?.mechanism;
    let likes = RUNS.map(|(name, pace)| {
        let made =
            RecordingSetup { name, interval: 1.0 / rows.rate, duration: rows.duration, pace };
        like(&declared, made)
    });
    // What cannot stand at a first row is told before anything is simulated.
    for recording in &likes {
        refuse(recording.wrong().into_iter().collect())?;
        machine(scenario, &[], recording)?;
    }
    Ok(PreparedRecord { truth: scenario.clone(), rig, rows, likes: likes.to_vec() })
}

/// First seconds of a recording that tell what all of it will take: a machine has come to full speed by then.
const JUDGED: f64 = 0.5;

/// Bytes that a number takes in a recording, with the comma behind it.
const BYTES: f64 = 12.0;

impl PreparedRecord {
    /// What recording will cost at most, judged by its beginning: as many simulations as where joints rattle.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub fn forecast(&self) -> Result<Forecast, CalibrateError> {
        let PreparedRecord { truth, rows, likes, .. } = self;
        let judged = rows.duration.min(JUDGED);
        let first = first(truth, &likes[0])?;
        let [let_go, recorded] = timed(truth, &first, &likes[0].first(judged), control(truth))
            .map_err(CalibrateError::from)?;
        let models = if truth.effects.is_empty() { 1 } else { 2 };
        let simulations = RUNS.len() * (1 + models * PREDICTING);
        let at_once = rayon::current_num_threads().min(PREDICTING);
        let columns = crate::model::parts_of(truth)?.sensors.len() + 1;
        let numbers = rows.rate * rows.duration * (columns * RUNS.len()) as f64;
        // A machine is let go once for all that is recorded from there, which takes as long however long that is.
        let let_go = let_go * (RUNS.len() * (1 + models)) as f64;
        let recorded = recorded * rows.duration / judged * simulations as f64 / at_once as f64;
        let seconds = Some(let_go + recorded);
        Ok(Forecast { seconds, bytes: BYTES * numbers })
    }
}

/// The rows that say where a machine is let go: the first one alone of a machine that nothing drives.
fn first(truth: &Scenario, like: &Recording) -> Result<Recording, CalibrateError> {
    Ok(if without_drives(truth)? { like.first(like.interval) } else { like.clone() })
}

/// One recording, and what is said of it.
struct One {
    noisy: Recording,
    errors: Vec<ChannelError>,
    pictures: Vec<Picture>,
    replicas: usize,
}

/// Records and writes everything about it into `folder`. `tell` hears what is being done.
///
/// # Errors
/// A machine that cannot be simulated, files that cannot be written; the folder is left as it was.
pub fn into_folder(
    prepared: &PreparedRecord,
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<FinishedRecordings, CalibrateError> {
    let started = Clock::now();
    let PreparedRecord { truth, rig, rows, likes } = prepared;
    let mut all = Vec::new();
    for (index, like) in likes.iter().enumerate() {
        tell(&format!("recording {}", like.name));
        all.push(recorded(prepared, index, like)?);
    }
    tell("writing");
    let pictures: Vec<&Picture> = all.iter().flat_map(|one| &one.pictures).collect();
    let errors: Vec<ChannelError> = all.iter().flat_map(|one| one.errors.clone()).collect();
    let best = errors
        .iter()
        .filter(|e| e.before.is_finite())
        .map(|e| (((e.before.powi(2) - e.after.powi(2)).max(0.0).sqrt() / e.floor), e))
        .filter(|(floors, _)| floors.is_finite())
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let texts = [RECORD_FILE, RIG_FILE, TRUTH_FILE, PAGE_FILE].into_iter();
    let names = texts.chain(RUNS.map(|(name, _)| name)).map(str::to_owned);
    let recorded = RecordReport {
        provenance: Provenance::of(truth),
        seed: truth.seed,
        runs: RUNS.map(|(name, _)| name.to_owned()).to_vec(),
        rate: rows.rate,
        duration_s: rows.duration,
        hidden: truth.effects.iter().map(ToString::to_string).collect(),
        shows_floors: best.map(|(floors, _)| floors),
        shows_in: best.map(|(_, e)| format!("{} of {}", e.channel, e.run)),
        errors,
        replicas: all.iter().map(|one| one.replicas).max().unwrap_or(1),
        wall_s: started.elapsed().as_secs_f64(),
        files: names.chain(pictures.iter().map(|picture| picture.file.clone())).collect(),
    };
    let json = to_json(&recorded);
    let sensors = crate::model::parts_of(truth)?.sensors;
    let logs: Vec<(&str, String)> =
        RUNS.iter().zip(&all).map(|((name, _), one)| (*name, one.noisy.to_csv(&sensors))).collect();
    let (rig, truth) = (rig.to_toml(), truth.to_toml());
    let page = page::page(&recorded, &pictures);
    let mut texts =
        vec![(RECORD_FILE, &json), (RIG_FILE, &rig), (TRUTH_FILE, &truth), (PAGE_FILE, &page)];
    texts.extend(logs.iter().map(|(name, text)| (*name, text)));
    let folder = publish(folder, &texts, pictures.iter().copied())?;
    Ok(FinishedRecordings { recorded, json, folder })
}

fn recorded(
    prepared: &PreparedRecord,
    index: usize,
    like: &Recording,
) -> Result<One, CalibrateError> {
    let PreparedRecord { truth, rig, .. } = prepared;
    let first = first(truth, like)?;
    let clean =
        clean((truth, &[]), &first, like, control(truth), 1).map_err(CalibrateError::from)?;
    let at = |model: &Scenario, like: &Recording| machine(model, &[], like);
    let true_machine = at(truth, &clean[0])?;
    let noisy = noisy(&clean[0], &true_machine, (truth.seed << 1) + index as u64);
    let seen = |model: &Scenario| -> Result<Vec<Recording>, CalibrateError> {
        let along = Along { model, recording: &noisy, like: &noisy };
        Ok(along.predicted(&at(model, &noisy)?)?.0)
    };
    let after = seen(truth)?;
    let before = if truth.effects.is_empty() { None } else { Some(seen(rig)?) };
    let reference = before.as_deref().unwrap_or(&after);
    let role = "recording";
    let mut errors = errors::of_run(&true_machine, &noisy, role, reference, &after);
    if before.is_none() {
        errors.iter_mut().for_each(|error| error.before = f64::NAN);
    }
    let count = true_machine.sensors.len();
    let [as_is, declared] = [&after[..], reference].map(|logs| mean(logs, count));
    let mut models = vec![("as it is", Style::Solid, &as_is)];
    models.extend(before.is_some().then_some(("as declared", Style::Reference, &declared)));
    let drawn = DrawnRun { index, role, caption: CAPTION };
    let pictures = of_run(&true_machine, &noisy, drawn, &models).map_err(RunError::from)?;
    Ok(One { noisy, errors, pictures, replicas: after.len() })
}

/// Whether nothing drives a scenario's machine: it is let go where its first row says.
fn without_drives(scenario: &Scenario) -> Result<bool, CalibrateError> {
    let parts: Mechanism = crate::model::parts_of(scenario)?;
    Ok(parts.actuators.is_empty())
}
