//! The three ways through a calibration, each from what was prepared to a folder.

use super::outcome::calibrate;
use super::page;
use super::report::{Report, effects, limit, noises, ranking, residuals, summary};
use super::written::{Made, SensedCalibration, names_of_files};
use crate::calibrate::results::report::{RattleReport, Seeds};
use crate::calibrate::results::result::stem_of;
use crate::calibrate::results::result::{CalibrateError, control};
use crate::calibrate::results::unnamed_picture;
use crate::calibrate::results::verdict::Verdict;
use crate::calibrate::sensed::events::found::sentence;
use crate::calibrate::sensed::events::picture::pictures as events_drawn;
use crate::calibrate::sensed::held;
use crate::calibrate::sensed::intake::prepare::{CalibratedAs, Prepared};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Stopped};
use crate::calibrate::sensed::windows::report::into_folder as by_windows;
use crate::results::{Folder, RunError};
use crate::scenario::Scenario;
use crate::simulate::Provenance;
use std::time::Instant as Clock;

/// Calibrates and writes everything about it into `folder`. `tell` hears what is being tried.
///
/// # Errors
/// A rig that cannot be simulated, files that cannot be written; the folder is left as it was.
pub fn into_folder(
    prepared: Prepared,
    without: &[&str],
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<SensedCalibration, CalibrateError> {
    let Prepared { rig, recordings, fits, way } = prepared;
    match way {
        CalibratedAs::Windows => by_windows(&rig, recordings, fits, without, folder, tell),
        CalibratedAs::Held => held::report::into_folder(&rig, recordings, without, folder, tell),
        CalibratedAs::Residuals => by_residuals(rig, recordings, without, tell)?.written(folder),
    }
}

/// Calibrates by residuals and simulations. `tell` hears what is being tried.
///
/// # Errors
/// A rig that cannot be simulated.
fn by_residuals(
    rig: Scenario,
    recordings: Vec<Recording>,
    without: &[&str],
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Made, CalibrateError> {
    let started = Clock::now();
    let control = control(&rig);
    let mut problem = RigProblem::new(rig, recordings, control)?;
    let outcome = calibrate(&mut problem, without, tell)?;
    tell("drawing and writing");
    let mut pictures = page::pictures(&problem, &outcome).map_err(RunError::from)?;
    let settings = outcome.effects.iter().map(|(effect, _)| effect);
    pictures.extend(unnamed_picture::pictures(settings).map_err(RunError::from)?);
    pictures.extend(events_drawn(&outcome.events).map_err(RunError::from)?);
    let sensors = &problem.declared.sensors;
    let mut files: Vec<(String, String)> = Vec::new();
    for (run, predicted) in problem.runs.iter().zip(&outcome.predicted) {
        let stem = stem_of(&run.recording.name);
        files.push((format!("predicted-{stem}.csv"), predicted.to_csv(sensors)));
    }
    let report = Report {
        provenance: Provenance::of(&problem.rig),
        verdict: outcome.verdict,
        summary: format!(
            "{}{}{}{}",
            summary(&outcome),
            cut_short(&problem, outcome.verdict),
            sentence(&outcome.events),
            noises(&outcome.noises)
        ),
        effects: effects(&outcome),
        errors: outcome.errors.clone(),
        ranking: ranking(&outcome),
        noises: outcome.noises.clone(),
        limits: outcome.limits.iter().map(limit).collect(),
        residuals: residuals(&outcome.before, &outcome.after),
        rattle: RattleReport {
            chaotic: problem.replicas > 1,
            difference: outcome.rattle,
            replicas: problem.replicas,
        },
        without: without.iter().map(|kind| (*kind).to_owned()).collect(),
        tolerance_m_s: control.tolerance().unwrap_or(f64::NAN),
        seeds: Seeds {
            scenario: problem.rig.seed,
            replicas: (0..problem.replicas as u64).collect(),
        },
        simulations: problem.simulations(),
        wall_s: started.elapsed().as_secs_f64(),
        files: names_of_files(&files, &pictures),
        windows: None,
    };
    let mut calibrated = problem.rig.clone();
    calibrated.effects = outcome.effects.iter().map(|(effect, _)| effect.clone()).collect();
    Ok(Made { report, calibrated, files, pictures })
}

/// What is to be said where something may be left that was not looked for.
fn cut_short(problem: &RigProblem, verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Unexplained if problem.is_worn_out() => {
            " The search ended before it had tried everything: this machine takes too many steps. A coarser \
             simulation.tolerance or shorter recordings allow more of it."
        }
        _ => "",
    }
}

impl From<Stopped> for CalibrateError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Model(problem) => problem.into(),
            Stopped::Halted(halt) => halt.into(),
            Stopped::Mistaken(errors) => {
                Self::Input(errors.iter().map(ToString::to_string).collect())
            }
        }
    }
}
