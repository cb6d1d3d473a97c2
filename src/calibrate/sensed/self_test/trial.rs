//! A trial, and what became of it.

use crate::calibrate::results::verdict::Verdict;
use serde::{Deserialize, Serialize};

/// What is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Case {
    /// Nothing.
    Nothing,
    /// One effect of the machine.
    One,
    /// Two of them.
    Two,
    /// One that is no candidate.
    Withheld,
    /// A wrong instrument.
    Instrument,
}

/// One rig to be understood. All of it follows from its seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Everything random follows from it.
    pub seed: u64,
    /// Which family of machines.
    pub machine: String,
    /// Its lengths in those of the family's.
    pub size: f64,
    /// Masses go with this power of the size.
    pub mass_exponent: f64,
    /// Radial play of its joints in m.
    pub clearance_m: f64,
    /// Coefficient of friction in joints with play.
    pub friction: f64,
    /// Whether it stands upright.
    pub gravity: bool,
    /// Noise of all sensors in that of the family's, as declared.
    pub noise: f64,
    /// Length of a run in s.
    pub duration_s: f64,
    /// Rows in a second.
    #[serde(rename = "rate_Hz")]
    pub rate: f64,
    /// Columns of measured quantities.
    pub columns: Vec<String>,
    /// What is hidden.
    pub case: Case,
    /// The kinds of hidden effects, or [`NOISE`].
    pub hidden: Vec<String>,
    /// By how much each of them should show: largest error of the declared model in floors.
    pub wanted: Vec<f64>,
}

/// What a wrong instrument is called whose noise is larger than declared.
pub const NOISE: &str = "noise";

/// What became of a trial: a row of the self-test's table.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TriedTrial {
    /// The trial.
    #[serde(flatten)]
    pub trial: Trial,
    /// Version of the program.
    pub version: String,
    /// Why nothing was asked, if so: no size of what was drawn shows as it should, or the machine breaks down.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unasked: Option<String>,
    /// What was hidden and what was answered.
    #[serde(flatten)]
    pub answer: Option<TrialAnswer>,
}

/// What was hidden in a trial, and what the method said.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TrialAnswer {
    /// Hidden effects with their targets and values, in words.
    pub lacks: String,
    /// The verdict.
    pub verdict: Verdict,
    /// Effects found, in words; of an unexplained one what was tried and what it left.
    pub found: String,
    /// Whether verdict and names are right.
    pub right: bool,
    /// Whether an explanation names what is not hidden.
    pub wrong_name: bool,
    /// Whether what is hidden was held for as good as what was found.
    pub as_good: bool,
    /// Hidden values that were found by name.
    pub values: Vec<HiddenValue>,
    /// Largest error of the declared model on the validation run, in floors of the true model.
    pub floors: f64,
    /// The same of the hidden effect that shows least; none of a single effect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub least: Option<f64>,
    /// Largest error of the calibrated model on the validation run, in floors of its own.
    pub worst_ratio: f64,
    /// Largest difference of two replicas of the declared machine, in units of noise.
    pub rattle: f64,
    /// Simulations that the calibration took.
    pub simulations: usize,
    /// Time in s that it took, beside whatever else the computer did.
    pub seconds: f64,
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
