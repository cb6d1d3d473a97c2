//! A calibration of a drive stage, and its folder of results.

use super::charts;
use super::drawn;
use super::noise::floors;
use super::prediction::errors;
use super::rows::predicted;
use super::simulated::{along, read};
use super::stage;
use crate::calibrate::errors::{ChannelError, judged};
use crate::calibrate::outcome::Verdict;
use crate::calibrate::recording::{stem, tell_apart};
use crate::calibrate::report::{EffectReport, Fitted};
use crate::calibrate::result::{CALIBRATED_FILE, CalibrateError, REPORT_FILE, publish, to_json};
use crate::identify::Recorded;
use crate::scenario::Scenario;
use crate::simulate::Provenance;
use crate::study::{Folder, PAGE_FILE, RunError, refused};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant as Clock;

/// `report.json`; keys as those of other machines, where they have a meaning here.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Which program made this of which rig.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What the calibration comes to.
    pub verdict: Verdict,
    /// The same in a sentence or two.
    pub summary: String,
    /// What the model has, declared or found.
    pub effects: Vec<EffectReport>,
    /// Numbers of the rig that were fitted with the effects.
    pub parameters: Vec<Adjusted>,
    /// Errors by run and channel.
    pub errors: Vec<ChannelError>,
    /// Candidates, round by round, the best first in each.
    pub ranking: Vec<Ranked>,
    /// Kinds of effects that were excluded by `--without`.
    pub without: Vec<String>,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
}

/// A number of the rig that was fitted.
#[derive(Clone, Debug, Serialize)]
pub struct Adjusted {
    /// Its path in the scenario.
    pub path: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// As declared.
    pub declared: f64,
    /// As fitted.
    pub value: f64,
    /// Standard deviation.
    pub std: f64,
    /// The interval that holds the true value 95 times in 100.
    pub ci95: [f64; 2],
}

impl Adjusted {
    /// A number of the rig at `path`, as declared and as fitted.
    pub(super) fn new(
        path: &'static str,
        unit: &'static str,
        declared: f64,
        Fitted { value, std, ci95 }: Fitted,
    ) -> Self {
        Self { path, unit, declared, value, std, ci95 }
    }
}

/// A candidate in a round.
#[derive(Clone, Debug, Serialize)]
pub struct Ranked {
    /// Kind of the effect.
    pub kind: &'static str,
    /// The joint.
    pub joint: Option<&'static str>,
    /// Which of its forms.
    pub what: String,
    /// Share of the residual's variance that it removes on data not used for its fit, 0…1; of what the
    /// rounds before left.
    pub validation_score: f64,
    /// Whether the calibrated model has it from this round.
    pub kept: bool,
    /// Round, from 1.
    pub round: usize,
    /// Geometric mean, over stretches that it was not fitted to, of the error with it over the error
    /// without.
    pub ratio: f64,
    /// Its 95 % interval.
    pub ratio_ci95: [f64; 2],
}

/// What a search comes to.
pub(super) struct Found {
    /// The rig with what was found.
    pub scenario: Scenario,
    pub effects: Vec<EffectReport>,
    pub parameters: Vec<Adjusted>,
    pub ranking: Vec<Ranked>,
    /// Names of what was added to what is declared.
    pub added: Vec<String>,
}

/// A rig and recordings that nothing speaks against.
#[derive(Debug)]
pub struct Prepared {
    rig: Scenario,
    /// The first to calibrate on, the others to validate on.
    runs: Vec<Recorded>,
}

/// Reads recordings of a rig, the first to calibrate on, the others to validate on.
///
/// # Errors
/// Everything that is wrong with them.
pub fn prepare(rig: Scenario, paths: &[&Path]) -> Result<Prepared, CalibrateError> {
    let (mut runs, mut wrong) = (Vec::<Recorded>::new(), Vec::new());
    for path in paths {
        match read(path, &rig, true) {
            Ok(recorded) => runs.push(recorded),
            Err(CalibrateError::Input(messages)) => wrong.extend(messages),
            Err(other) => return Err(other),
        }
    }
    if wrong.is_empty() {
        wrong.extend(stage::ready(&rig));
    }
    if !wrong.is_empty() {
        return Err(CalibrateError::Input(wrong));
    }
    tell_apart(runs.iter_mut().map(|run| (&mut run.log, run.path.as_str())).collect());
    Ok(Prepared { rig, runs })
}

/// A finished calibration.
#[derive(Debug)]
pub struct Calibrated {
    /// What it came to.
    pub report: Report,
    /// The text of `report.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}

/// How far an error may be above what noise leaves and still be noise: floors are known to a sixth, and
/// parameters that were fitted miss by a little themselves.
const NOISE: f64 = 1.5;

/// Calibrates a rig and writes everything about it into `folder`. `tell` hears what is being tried.
///
/// # Errors
/// Recordings that do not tell parameters apart, a rig that cannot be simulated, files that cannot be
/// written; the folder is left as it was.
pub fn into_folder(
    prepared: &Prepared,
    without: &[&str],
    folder: Folder,
    tell: &dyn Fn(&str),
) -> Result<Calibrated, CalibrateError> {
    let started = Clock::now();
    let Prepared { rig, runs } = prepared;
    let found = stage::search(rig, runs, without, tell)?;
    let (mut listed, mut pictures, mut files) = (Vec::new(), Vec::new(), Vec::new());
    for (i, run) in runs.iter().enumerate() {
        tell(&format!("simulating {}", run.log.name));
        let role = if i == 0 { "calibration" } else { "validation" };
        let before = along(rig, &run.log)?;
        let after = along(&found.scenario, &run.log)?;
        let floors = floors(&found.scenario, &run.log, &after);
        listed.extend(errors(run, role, [Some(&before), Some(&after)], &floors));
        let declared = Some(("declared", &before));
        let drawn = charts::of_run(&run.log, role, declared, ("calibrated", &after));
        pictures.extend(drawn.map_err(RunError::from)?);
        let name = format!("predicted-{}.csv", stem(&run.log));
        files.push((name.clone(), predicted(run, &after).map_err(refused(&name))?));
    }
    tell("drawing and writing");
    let verdict = verdict(&listed, !found.added.is_empty());
    let texts = [REPORT_FILE, CALIBRATED_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    let written = files.iter().map(|(name, _)| name.clone());
    let drawn = pictures.iter().map(|picture| picture.file.clone());
    let report = Report {
        provenance: Provenance::of(rig),
        verdict,
        summary: summary(verdict, &found.added),
        effects: found.effects,
        parameters: found.parameters,
        errors: listed,
        ranking: found.ranking,
        without: without.iter().map(|kind| (*kind).to_owned()).collect(),
        wall_s: started.elapsed().as_secs_f64(),
        files: texts.chain(written).chain(drawn).collect(),
    };
    let json = to_json(&report);
    let (model, page) = (found.scenario.to_toml(), drawn::calibration(&report, &pictures));
    let mut texts = vec![(REPORT_FILE, &json), (CALIBRATED_FILE, &model), (PAGE_FILE, &page)];
    texts.extend(files.iter().map(|(name, text)| (name.as_str(), text)));
    let folder = publish(folder, &texts, &pictures)?;
    Ok(Calibrated { report, json, folder })
}

/// On data not used for fits where there are any: whether every channel is at its noise.
fn verdict(errors: &[ChannelError], added: bool) -> Verdict {
    if !judged(errors).iter().all(|e| e.after <= NOISE * e.floor) {
        Verdict::Unexplained
    } else if added {
        Verdict::Explained
    } else {
        Verdict::NothingMissing
    }
}

fn summary(verdict: Verdict, added: &[String]) -> String {
    let list = added.join(", ");
    match (verdict, added.is_empty()) {
        (Verdict::NothingMissing, _) => {
            "The declared model explains the recordings to within noise: nothing is missing."
                .to_owned()
        }
        (Verdict::Explained, _) => format!(
            "The declared model lacks {list}. With it the recordings are explained to within noise."
        ),
        (Verdict::Unexplained, true) => {
            "What the declared model misses stands above noise, and nothing \
                                         that is tried here makes it certainly less."
                .to_owned()
        }
        (Verdict::Unexplained, false) => format!(
            "The declared model lacks {list}. More is missing: what remains stands above noise, and nothing \
             else that is tried here makes it certainly less."
        ),
    }
}
