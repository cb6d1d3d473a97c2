//! Wear of bearing rings: where journals rub in a run, and what rings become over many cycles.
//!
//! Archard's law: of a ring of axial length L a journal removes the volume `V = k ∫ F_N |ds|`, k the dimensionless wear
//! coefficient over the hardness of the softer surface, in 1/Pa (J. F. Archard, J. Appl. Phys. 24 (1953) 981–988).
//! A run says how much force times sliding there is in a cycle, and where ([`Work::rubbed`](crate::engine::Work::rubbed));
//! [`Play`] grows by it; `jumps.rs` takes as many cycles at once as their error allows.

mod around;
mod files;
mod jumps;
mod page;
mod request;
mod result;
mod rings;
mod stage;

pub use files::WEAR_PREDICTED_FILE;
pub use request::WearRequest;
pub use result::{JointWear, RingWear, WearSummary};
pub use stage::Stage;

pub(super) use around::{WEAR_FILE, wear_csv, wear_picture, wearing};

use super::watch::Watch;
use crate::contact::Play;
use crate::engine;
use crate::model::{Machine, assemble, expand};
use crate::results::Folder;
use crate::results::{PAGE_FILE, SCENARIO_FILE, to_json};
use crate::results::{RunError, refused};
use crate::scenario::Scenario;
use crate::study::StudyError;
use files::{SHAPES_FILE, STAGES_FILE, WORN_FILE};
use rings::Ring;
use std::fs;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant as Clock;

/// A finished prediction and its files.
#[derive(Debug)]
pub struct PredictedWear {
    /// All figures.
    pub summary: WearSummary,
    /// The text of [`WEAR_PREDICTED_FILE`].
    pub json: String,
    /// Where the files are.
    pub folder: PathBuf,
}

/// Time in s of one cycle of a scenario's motion, where the motion says it: a circle's period, a turn of the one joint
/// that turns at a constant rate.
///
/// ```
/// use freeplay::scenario::Scenario;
/// use freeplay::study::wear::period_of;
///
/// let circle = Scenario::load(None, &["motion.period=2".to_owned()])?;
/// assert_eq!(period_of(&circle), Some(2.0));
/// # Ok::<(), freeplay::scenario::Problems>(())
/// ```
pub fn period_of(scenario: &Scenario) -> Option<f64> {
    rings::period(scenario)
}

/// Predicts wear and writes everything about it into `folder`. `watch` sees the cycles reached.
///
/// # Errors
/// [`StudyError`]; the folder is left as it was.
pub fn wear(
    scenario: &Scenario,
    request: WearRequest,
    folder: Folder,
    watch: &Watch,
) -> Result<PredictedWear, StudyError> {
    let started = Clock::now();
    let expanded = expand(scenario)?;
    let machine = assemble(scenario)?;
    let rings = rings::of(scenario, &expanded, &machine)?;
    let start = rings.iter().map(|ring| ring.play(&machine.mechanism)).collect();
    let mut rub = |plays: &[Play], cycles: f64| {
        let rubbed = rubbed(scenario, &machine, &rings, plays, request.period, watch);
        watch.ended()?;
        rubbed.map_err(|reason| StudyError::Halted { cycles, reason })
    };
    let stages = jumps::predict(&rings, start, request, &mut rub, &|cycles| watch.come(cycles))?;
    let mut summary = result::summary(scenario, &rings, request, &stages);
    let pictures = page::pictures(&rings, &stages)?;
    let texts =
        [WEAR_PREDICTED_FILE, STAGES_FILE, SHAPES_FILE, SCENARIO_FILE, WORN_FILE, PAGE_FILE];
    let drawn = pictures.iter().map(|picture| picture.file.clone());
    summary.files = texts.map(str::to_owned).into_iter().chain(drawn).collect();
    summary.wall_s = started.elapsed().as_secs_f64();
    let json = to_json(&summary);
    let write = |name: &str, text: &str| fs::write(folder.file(name), text).map_err(refused(name));
    write(WEAR_PREDICTED_FILE, &json)?;
    write(STAGES_FILE, &result::stages_csv(&rings, &stages))?;
    write(SHAPES_FILE, &result::shapes_csv(&rings, &stages))?;
    write(SCENARIO_FILE, &scenario.to_toml())?;
    write(WORN_FILE, &rings::worn(&expanded, &rings, &stages).to_toml())?;
    for picture in &pictures {
        write(&picture.file, &picture.svg)?;
    }
    write(PAGE_FILE, &page::page(&summary, &pictures))?;
    let folder = folder.finish().map_err(RunError::from)?;
    Ok(PredictedWear { summary, json, folder })
}

/// Force times sliding of each ring in J per cycle, in a run with rings that leave these rooms. The start that is left out of a run's figures is left out here, too.
fn rubbed(
    scenario: &Scenario,
    machine: &Machine,
    rings: &[Ring],
    plays: &[Play],
    period: f64,
    watch: &Watch,
) -> Result<Vec<Vec<f64>>, String> {
    let mut mechanism = machine.mechanism.clone();
    for (ring, play) in rings.iter().zip(plays) {
        mechanism.revolutes[ring.joint].out_of_round = play.shape(ring.clearance);
    }
    let settle = scenario.simulation.settle() * (1.0 - 1e-9);
    let mut before: Option<(f64, Vec<Vec<f64>>)> = None;
    let (control, schedule) = (machine.control, machine.schedule);
    let begun = Clock::now();
    let work = engine::run_balanced(&mechanism, control, schedule, watch.stop(), &mut |instant| {
        watch.come_in_one_run(begun, instant.t / schedule.duration);
        if before.is_none() && instant.t >= settle {
            before = instant.rubbed.map(|rubbed| (instant.t, rubbed.to_vec()));
        }
        ControlFlow::Continue(())
    })
    .map_err(|halt| halt.to_string())?;
    let (Some(after), Some((from, before))) = (work.rubbed, before) else {
        return Err("the run ended before a cycle was counted".to_owned());
    };
    let per_cycle = period / (work.reached - from);
    let of = |ring: &Ring| {
        let pairs = after[ring.joint].iter().zip(&before[ring.joint]);
        pairs.map(|(after, before)| (after - before) * per_cycle).collect()
    };
    Ok(rings.iter().map(of).collect())
}
