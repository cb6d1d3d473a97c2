//! What is written of a calibration of a machine that sampled controllers hold.

use super::bench::{Broken, HeldBench};
use super::search::{Failed, HeldEffect, HeldOutcome, search};
use crate::calibrate::results::report::{ActsOn, EffectReport, Ranked, RattleReport, Seeds};
use crate::calibrate::results::result::stem_of;
use crate::calibrate::results::result::{CalibrateError, control};
use crate::calibrate::results::verdict::Verdict;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::results::charts::{DrawnRun, of_run};
use crate::calibrate::sensed::results::report::Report;
use crate::calibrate::sensed::results::written::{SensedCalibration, names_of_files, written};
use crate::calibrate::sensed::thresholds::MET;
use crate::calibrate::sensed::values::errors;
use crate::calibrate::values::errors::{ChannelError, judged};
use crate::effects::Setting;
use crate::report::{Picture, Style};
use crate::results::{Folder, RunError};
use crate::scenario::Scenario;
use crate::simulate::Provenance;
use std::time::Instant as Clock;

impl From<Broken> for CalibrateError {
    fn from(broken: Broken) -> Self {
        match broken {
            Broken::Start(start) => start.into(),
            Broken::Halted(halt) => halt.into(),
        }
    }
}

impl From<Failed> for CalibrateError {
    fn from(failed: Failed) -> Self {
        match failed {
            Failed::Model(problem) => problem.into(),
            Failed::Broken(broken) => broken.into(),
        }
    }
}

const CAPTION: &str = "Declared: the rig as its file has it. Calibrated: with the effects found.";

/// Calibrates on the first recording, judges on the others (or each half of one by the other), and writes everything
/// about it into `folder`.
///
/// # Errors
/// Recordings that do not tell values apart, a rig that cannot be simulated, files that cannot be written.
pub fn into_folder(
    rig: &Scenario,
    recordings: Vec<Recording>,
    without: &[&str],
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<SensedCalibration, CalibrateError> {
    let started = Clock::now();
    let control = control(rig);
    let bench = HeldBench::new(rig, recordings, control, false)?;
    let outcome = search(&bench, without, tell)?;
    let sought: Vec<Setting> = match outcome.effects.is_empty() {
        true => bench.declared.clone(),
        false => outcome.effects.iter().map(|found| found.effect.clone()).collect(),
    };
    let mut listed: Vec<ChannelError> = Vec::new();
    let mut pictures: Vec<Picture> = Vec::new();
    let mut files: Vec<(String, String)> = Vec::new();
    for (index, run) in bench.runs.iter().enumerate() {
        tell(&format!("predicting {}", run.recording.name));
        let role = if index == 0 { "calibration" } else { "validation" };
        let before = bench.simulated(index, &bench.declared)?;
        let after = bench.simulated(index, &sought)?;
        let models =
            [("declared", Style::Reference, &before), ("calibrated", Style::Solid, &after)];
        let drawn = DrawnRun { index, role, caption: CAPTION };
        let own = of_run(&bench.machine, &run.recording, drawn, &models);
        pictures.extend(own.map_err(RunError::from)?);
        let name = format!("predicted-{}.csv", stem_of(&run.recording.name));
        files.push((name, after.to_csv(&bench.machine.sensors)));
        let (before, after) = ([before], [after]);
        listed.extend(errors::of_run(&bench.sensing(index), &run.recording, role, &before, &after));
    }
    tell("drawing and writing");
    let verdict = verdict(&listed, &outcome);
    let report = Report {
        provenance: Provenance::of(rig),
        verdict,
        summary: summary(verdict, &outcome),
        effects: outcome.effects.iter().map(effect).collect(),
        errors: listed,
        ranking: ranking(&outcome),
        noises: Vec::new(),
        limits: Vec::new(),
        residuals: Vec::new(),
        rattle: RattleReport { chaotic: false, difference: 0.0, replicas: 1 },
        without: without.iter().map(|kind| (*kind).to_owned()).collect(),
        tolerance_m_s: control.tolerance().unwrap_or(f64::NAN),
        seeds: Seeds { scenario: rig.seed, replicas: vec![0] },
        simulations: bench.simulations(),
        wall_s: started.elapsed().as_secs_f64(),
        files: names_of_files(&files, &pictures),
        windows: None,
    };
    let mut calibrated = bench.rig.clone();
    calibrated.effects.extend(sought);
    written(report, &calibrated, &files, &pictures, folder)
}

/// On data not used for fits where there are any: whether every column is at its noise.
fn verdict(errors: &[ChannelError], outcome: &HeldOutcome) -> Verdict {
    if !judged(errors).iter().all(|e| e.after <= MET * e.floor) {
        Verdict::Unexplained
    } else if outcome.lacking.is_empty() {
        Verdict::NothingMissing
    } else {
        Verdict::Explained
    }
}

fn summary(verdict: Verdict, outcome: &HeldOutcome) -> String {
    let list = outcome.lacking.join(", ");
    match (verdict, list.is_empty()) {
        (Verdict::NothingMissing, _) => {
            "The declared model explains the recordings to within noise: nothing is missing.".to_owned()
        }
        (Verdict::Explained, _) => format!(
            "The declared model lacks {list}. With it the recordings are explained to within noise."
        ),
        (Verdict::Unexplained, true) => {
            "What the declared model misses stands above noise, and nothing that is tried here makes it certainly \
             less."
                .to_owned()
        }
        (Verdict::Unexplained, false) => format!(
            "The declared model certainly lacks {list}. More is missing: what remains stands above noise, and \
             nothing else that is tried here makes it certainly less."
        ),
    }
}

fn effect(found: &HeldEffect) -> EffectReport {
    EffectReport {
        kind: found.effect.kind.name,
        on: ActsOn::of(&found.effect),
        depends_on: None,
        params: found.params.clone(),
        evidence: found.evidence.clone(),
        as_good: Vec::new(),
        not_ruled_out: Vec::new(),
        equation: found.effect.kind.equation,
    }
}

fn ranking(outcome: &HeldOutcome) -> Vec<Ranked> {
    let tried = outcome.tried.iter().map(|tried| Ranked {
        kind: tried.kind.name,
        on: ActsOn::at(&tried.target),
        validation_score: tried.share,
        kept: tried.kept,
        round: tried.round,
        simulated: tried.kept,
        gain: tried.gain,
    });
    tried.collect()
}
