//! `plan.json`, `motion.csv` and the folder of results.

use super::motions::limits::{DriveLimits, units};
use super::outcome::{Answered, PlanOutcome, chance};
use super::prepare::PreparedPlan;
use super::questions::answer::MotionAnswer;
use super::questions::separation::PosedQuestion;
use crate::calibrate::results::report::ActsOn;
use crate::effects::Setting;
use crate::report::number;
use crate::simulate::Provenance;
use serde::Serialize;

/// The JSON file by which a plan is known.
pub const PLAN_FILE: &str = "plan.json";

/// The motion as a table.
pub const MOTION_FILE: &str = "motion.csv";

/// The rig with that motion: a scenario like any other.
pub const PLANNED_FILE: &str = "planned.toml";

/// `plan.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Planned {
    /// Program, versions, rig.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What it comes to, in a sentence or two.
    pub summary: String,
    /// Seed of the search and of the sensors' noise.
    pub seed: u64,
    /// What was asked, with its answers.
    pub questions: Vec<QuestionReport>,
    /// What the present motion is; none where there is no other.
    pub present: Option<String>,
    /// Length of the planned motion.
    pub duration_s: f64,
    /// Time between two of its rows.
    pub interval_s: f64,
    /// Limits of each drive and what the motion takes of them.
    pub drives: Vec<DriveReport>,
    /// Largest gain from a drive's error to the machine's fastest point that poses may have.
    pub largest_gain: f64,
    /// One more sensor, the one that helps most first.
    pub sensors: Vec<SensorReport>,
    /// Questions that the planned motion does not answer either.
    pub open: Vec<String>,
    /// Motions that were tried.
    pub candidates: usize,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
}

/// A question with its answers.
#[derive(Clone, Debug, Serialize)]
pub struct QuestionReport {
    /// In words.
    pub question: String,
    /// `between` or `detect`.
    pub kind: &'static str,
    /// The models that are held against each other, at these values.
    pub effects: Vec<PlannedEffect>,
    /// Standard deviations that answer it.
    pub wanted_sigma: f64,
    /// On the present motion, if there is one.
    pub before: Option<AnswerReport>,
    /// On the planned one.
    pub after: AnswerReport,
}

/// An effect with its values.
#[derive(Clone, Debug, Serialize)]
pub struct PlannedEffect {
    /// Its name.
    pub kind: &'static str,
    /// What it acts on.
    #[serde(flatten)]
    pub on: ActsOn,
    /// Its values.
    pub params: serde_json::Map<String, serde_json::Value>,
}

/// How far apart models are on a motion.
#[derive(Clone, Debug, Serialize)]
pub struct AnswerReport {
    /// Standard deviations.
    pub sigma: f64,
    /// Chance that a calibration is right.
    pub chance: f64,
    /// Smallest size of an effect that would be named; null of rivals and where no size shows.
    pub smallest: Option<f64>,
    /// Residuals that carry it, with their shares of its square.
    pub carried_by: Vec<CarriedReport>,
}

/// A residual and its share.
#[derive(Clone, Debug, Serialize)]
pub struct CarriedReport {
    /// Name of the residual.
    pub residual: String,
    /// Its share of the square of the separation.
    pub share: f64,
}

/// A drive: limits, and what the motion takes of them.
#[derive(Clone, Debug, Serialize)]
pub struct DriveReport {
    /// Its limits.
    #[serde(flatten)]
    pub limit: DriveLimits,
    /// Lowest and highest coordinate of the motion.
    pub used_stroke: [f64; 2],
    /// Its largest rate.
    pub used_speed: f64,
    /// Its largest acceleration.
    pub used_acceleration: f64,
    /// Largest force or torque of the drive in the simulated recording, of the present motion in its own; null where nobody
    /// measures it.
    pub used_force: Option<f64>,
    /// Unit of that.
    pub force_unit: &'static str,
}

/// One more sensor.
#[derive(Clone, Debug, Serialize)]
pub struct SensorReport {
    /// What it is.
    pub sensor: String,
    /// Standard deviations with it on the planned motion, question by question.
    pub sigma: Vec<f64>,
    /// The least of them over what answers its question, as a multiple of that without the sensor.
    pub gain: f64,
}

/// Whether the planned motion answers a question.
pub(super) fn is_answered(answered: &Answered) -> bool {
    answered.after.sigma >= answered.posed.wanted()
}

pub(super) fn question(answered: &Answered) -> QuestionReport {
    let Answered { posed, before, after } = answered;
    let effect = |effect: &Setting| PlannedEffect {
        kind: effect.kind.name,
        on: ActsOn::of(effect),
        params: effect.values().map(|(name, value)| (name.to_owned(), value.into())).collect(),
    };
    let answer = |answer: &MotionAnswer| AnswerReport {
        sigma: answer.sigma,
        chance: chance(posed, answer.sigma),
        smallest: answer.smallest,
        carried_by: answer
            .carried
            .iter()
            .map(|(residual, share)| CarriedReport { residual: residual.clone(), share: *share })
            .collect(),
    };
    let (kind, effects) = match posed {
        // The pair that comes nearer.
        PosedQuestion::Between { pairs, .. } => {
            ("between", pairs.iter().take(1).flatten().map(effect).collect())
        }
        PosedQuestion::Detect { ways, .. } => ("detect", ways.iter().take(1).map(effect).collect()),
    };
    QuestionReport {
        question: posed.words(),
        kind,
        effects,
        wanted_sigma: posed.wanted(),
        before: before.as_ref().map(answer),
        after: answer(after),
    }
}

pub(super) fn summary(questions: &[QuestionReport], open: &[String], same: bool) -> String {
    let one = |question: &QuestionReport| {
        let after = number(question.after.sigma);
        let wanted = number(question.wanted_sigma);
        match &question.before {
            Some(before) => format!(
                "{}: {after} standard deviations, {} with the present motion; {wanted} answer it.",
                question.question,
                number(before.sigma)
            ),
            None => {
                format!("{}: {after} standard deviations; {wanted} answer it.", question.question)
            }
        }
    };
    let all: Vec<String> = questions.iter().map(one).collect();
    let open = match open {
        [] => String::new(),
        open => format!(" Not answered by a new motion within these limits: {}.", open.join("; ")),
    };
    // A present motion of another length is no candidate.
    let better = |question: &QuestionReport| {
        question.before.as_ref().is_some_and(|before| before.sigma > question.after.sigma)
    };
    let kept = match same || questions.iter().all(better) {
        true => " The present motion does better than any other that was found: keep it.",
        false => "",
    };
    all.join(" ") + &open + kept
}

pub(super) fn drives(prepared: &PreparedPlan, outcome: &PlanOutcome) -> Vec<DriveReport> {
    let drives = prepared.limits.iter().zip(&outcome.motion.drives).enumerate();
    drives
        .map(|(place, (limit, series))| {
            let extremes = series.extremes();
            let (_, force_unit) = units(prepared.declared.actuators[place].joint);
            DriveReport {
                limit: limit.clone(),
                used_stroke: extremes.reach,
                used_speed: extremes.speed,
                used_acceleration: extremes.acceleration,
                used_force: outcome.forces[place],
                force_unit,
            }
        })
        .collect()
}
