//! The method held against what it should find: known effects of random size, hidden in synthetic
//! recordings.

mod hidden;
mod rates;
mod rig;

pub(in crate::calibrate) use rates::{covered, is_phase, near, share};
pub use rig::recorded;

use super::results::outcome::{LegsOutcome, Verdict, calibrate};
use super::rounds::way::names;
use super::values::model::SearchError;
use crate::effects::Setting;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// One rig to be understood.
#[derive(Clone, Debug, PartialEq)]
pub struct LegsTrial {
    /// Hidden effects by name; none in a rig that lacks nothing.
    pub hidden: Vec<String>,
    /// Their size, in units of about three floors.
    pub size: f64,
    /// Whether gravity keeps the joints loaded.
    pub gravity: bool,
    /// Whether the hidden effects are no candidates.
    pub withheld: bool,
    /// Everything random follows from it.
    pub seed: u64,
}

/// What became of a trial.
#[derive(Clone, Debug)]
pub struct LegsTried {
    /// Verdict.
    pub verdict: Verdict,
    /// Effects found, in words.
    pub found: String,
    /// Whether the verdict and the names are right.
    pub right: bool,
    /// Hidden values that were found by name.
    pub values: Vec<HiddenValue>,
    /// How large what is hidden is: the declared model's largest error on the validation run, in floors.
    pub floors: f64,
    /// The same of the calibrated model.
    pub worst_ratio: f64,
}

/// A hidden value and its estimate, in SI units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct HiddenValue {
    /// `effect.parameter`.
    pub name: String,
    /// As hidden.
    pub truth: f64,
    /// As found.
    pub value: f64,
    /// Its standard deviation, if the fit says one.
    pub std: Option<f64>,
}

/// Hides, calibrates, compares.
///
/// # Errors
/// A rig that cannot be simulated.
pub fn run(trial: &LegsTrial) -> Result<LegsTried, SearchError> {
    let (case, hidden) = recorded(trial)?;
    let hidden_names: Vec<&str> = trial.hidden.iter().map(String::as_str).collect();
    let without = if trial.withheld { &hidden_names[..] } else { &[] };
    let outcome = calibrate(&case, without, &|_| {})?;
    Ok(judge(trial, &hidden, &outcome))
}

fn judge(trial: &LegsTrial, hidden: &[Setting], outcome: &LegsOutcome) -> LegsTried {
    let found: Vec<Setting> = outcome.effects.iter().map(|(effect, _)| effect.clone()).collect();
    let named = || outcome.effects.iter().filter(|(effect, _)| effect.efforts().is_none());
    let right = if trial.withheld {
        outcome.verdict == Verdict::Unexplained
    } else if hidden.is_empty() {
        outcome.verdict == Verdict::NothingMissing
    } else {
        outcome.verdict == Verdict::Explained
            && named().count() == hidden.len()
            && hidden.iter().all(|h| named().any(|(effect, _)| effect.is(h)))
    };
    let mut values = Vec::new();
    for lacking in hidden {
        let Some((_, estimates)) = named().find(|(effect, _)| effect.is(lacking)) else {
            continue;
        };
        for (name, truth) in lacking.values() {
            if let Some(e) = estimates.iter().find(|e| e.name == name) {
                // Phases on both sides of a whole turn are near each other.
                let turns = match name {
                    "phase_rad" => ((e.value - truth) / TAU).round(),
                    _ => 0.0,
                };
                let name = format!("{}.{name}", lacking.kind.name);
                let std = Some(e.std).filter(|std| std.is_finite());
                values.push(HiddenValue { name, truth, value: e.value - turns * TAU, std });
            }
        }
    }
    let validation = || outcome.errors.iter().filter(|error| error.role == "validation");
    LegsTried {
        verdict: outcome.verdict,
        found: if found.is_empty() { "nothing".to_owned() } else { names(&found) },
        right,
        values,
        floors: validation().map(|e| e.before / e.floor).fold(0.0, f64::max),
        worst_ratio: validation().map(|e| e.after / e.floor).fold(0.0, f64::max),
    }
}
