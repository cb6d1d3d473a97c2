//! The free swings of one arm: what its authors' viscous model lacks, by the way of every machine that nothing
//! holds ([`windows`](crate::calibrate::sensed::windows)).

use super::{Missing, ResultsTable};
use crate::calibrate::sensed::recording::Recording;
use crate::calibrate::sensed::windows::outcome::{Certain, JudgedRun, calibrate};
use crate::calibrate::sensed::windows::{bench::Bench, plausible, score::Score};
use crate::model::parts_of;
use crate::scenario::Scenario;
use std::path::Path;

/// The machine as its authors declare it and the columns of its recording, as a scenario.
pub const RIG: &str = include_str!("../../../assets/pendulum-declared.toml");

/// The recording is six equal pieces, of which the first four are for fitting.
const PIECES: [usize; 2] = [4, 6];

/// Length in s of the windows that models are judged by, the start of each fitted to its first quarter second.
const WINDOW: f64 = 2.5;

/// What may be sought beside inertia and the encoder's zero, model by model, and the kinds that are left out for that.
const MODELS: [(&str, &[&str]); 3] = [
    ("friction as declared", &["joint-friction", "air-drag"]),
    ("friction of the pivot", &["air-drag"]),
    ("friction of the pivot and drag of the air", &[]),
];

/// Reads the recording of a rig: the larger swings, to fit to, and the smaller ones that follow.
///
/// # Errors
/// A file that is not there or not what it should be.
pub fn read(path: &Path, rig: &Scenario) -> Result<[Recording; 2], Missing> {
    if !path.is_file() {
        return Err(Missing::Absent(path.to_owned()));
    }
    let wrong = |problem: crate::scenario::Problem| Missing::Wrong(problem.to_string());
    let machine = parts_of(rig).map_err(wrong)?;
    let whole = Recording::read_with_time(path, &machine.sensors, true, rig.time_column())?;
    let bench = Bench::new(rig, vec![whole.clone()]).map_err(wrong)?;
    if let Some(first) = plausible::wrong(rig, &bench).into_iter().next() {
        return Err(Missing::Wrong(first));
    }
    let cut = whole.samples * PIECES[0] / PIECES[1];
    let mut parts = [whole.part(0..cut), whole.part(cut..whole.samples)];
    for (part, name) in parts.iter_mut().zip(["id", "val"]) {
        part.name = name.to_owned();
    }
    Ok(parts)
}

/// A model, fitted to the larger swings.
#[derive(Clone, Debug)]
pub struct PendulumModel {
    /// What was sought.
    pub name: &'static str,
    /// What was found.
    pub effects: Vec<Certain>,
    /// Root mean square error in rad on the larger swings.
    pub id: f64,
    /// The same on the smaller ones, which it was not fitted to.
    pub val: f64,
    /// Predicted less recorded angle in rad over the smaller swings, with the time in s.
    pub missed: Vec<(f64, f64)>,
}

/// What the study comes to.
#[derive(Clone, Debug)]
pub struct PendulumOutcome {
    /// The authors' numbers as they are.
    pub declared: PendulumModel,
    /// Model by model; the last one may have everything.
    pub steps: Vec<PendulumModel>,
}

/// With a capital.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Does the study; `tell` hears what is being done.
///
/// # Errors
/// A rig that cannot be put together, recordings too short for a window.
pub fn study(
    rig: &Scenario,
    [id, val]: &[Recording; 2],
    tell: &(dyn Fn(&str) + Sync),
) -> Result<PendulumOutcome, Missing> {
    let short = || Missing::Wrong(format!("{}: expected {WINDOW} s of swings at least", id.path));
    let (mut declared, mut steps) = (None, Vec::new());
    for (name, without) in MODELS {
        tell(name);
        let runs = vec![id.clone(), val.clone()];
        let (_, outcome) = calibrate(rig, runs, 1, without, tell)
            .map_err(|problem| Missing::Wrong(problem.to_string()))?;
        let judged = |run| {
            let of = |j: &&JudgedRun| j.run == run && j.horizon.window_s == WINDOW;
            outcome.judged.iter().find(of).ok_or_else(short)
        };
        let (on_id, on_val) = (judged(0)?, judged(1)?);
        let step = |name, effects, [id, other]: [&Score; 2]| PendulumModel {
            name,
            effects,
            id: id.errors[0],
            val: other.errors[0],
            missed: missed(val, &other.predicted[0]),
        };
        declared.get_or_insert_with(|| {
            step("as declared", Vec::new(), [&on_id.before, &on_val.before])
        });
        steps.push(step(name, outcome.effects.clone(), [&on_id.after, &on_val.after]));
    }
    Ok(PendulumOutcome { declared: declared.ok_or_else(short)?, steps })
}

/// Predicted less recorded values, where something was predicted.
fn missed(recording: &Recording, predicted: &[f64]) -> Vec<(f64, f64)> {
    let recorded = recording.get(0).unwrap_or_default();
    let pairs = predicted.iter().zip(recorded).enumerate();
    pairs
        .map(|(row, (p, r))| (recording.start + row as f64 * recording.interval, p - r))
        .filter(|(_, off)| off.is_finite())
        .collect()
}

impl PendulumOutcome {
    /// The model that may have everything.
    fn last(&self) -> &PendulumModel {
        self.steps.last().unwrap_or(&self.declared)
    }

    /// The result in words.
    pub fn lead(&self) -> String {
        let last = self.last();
        format!(
            "{}, found on the larger swings, predict the smaller ones with {:.0} % of the error that the authors' \
             numbers leave ({:.2} instead of {:.2} mrad).",
            sentence(last.name),
            100.0 * last.val / self.declared.val,
            1e3 * last.val,
            1e3 * self.declared.val,
        )
    }

    /// What the last model was given.
    pub fn numbers(&self) -> ResultsTable {
        let rows = self.last().effects.iter().flat_map(|certain| {
            certain.params.iter().map(|(name, fitted)| {
                let [low, high] = fitted.ci95.map(|end| format!("{end:.4e}"));
                let effect = certain.effect.to_string();
                vec![
                    effect,
                    (*name).to_owned(),
                    format!("{:.4e}", fitted.value),
                    format!("{low} to {high}"),
                ]
            })
        });
        let header = ["effect", "parameter", "value", "95 % interval"];
        ResultsTable { header: header.map(str::to_owned).to_vec(), rows: rows.collect() }
    }

    /// Errors model by model.
    pub fn table(&self) -> ResultsTable {
        let mrad = |x: f64| format!("{:.2} mrad", 1e3 * x);
        let rows = [&self.declared].into_iter().chain(&self.steps).map(|step| {
            let found: Vec<String> = step.effects.iter().map(|c| c.effect.to_string()).collect();
            vec![
                step.name.to_owned(),
                found.join(", "),
                mrad(step.id),
                mrad(step.val),
                format!("{:.0} %", 100.0 * step.val / self.declared.val),
            ]
        });
        let header = ["sought", "found", "id", "val", "of the declared model's"];
        ResultsTable { header: header.map(str::to_owned).to_vec(), rows: rows.collect() }
    }
}
