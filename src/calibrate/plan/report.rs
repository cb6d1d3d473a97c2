//! `plan.json`, `motion.csv` and the folder of results.

use super::limits::{Limit, units};
use super::motion::rounded;
use super::outcome::{Answer, Answered, Outcome, chance, plan};
use super::page;
use super::prepare::Prepared;
use super::separation::Posed;
use crate::calibrate::report::ActsOn;
use crate::calibrate::result::{CalibrateError, publish, to_json};
use crate::calibrate::sensed::start::machine;
use crate::effects::Setting;
use crate::mechanism::{Imposed, Mechanism, Tracker, angle_near};
use crate::report::number;
use crate::scenario::{self, Scenario};
use crate::simulate::Provenance;
use crate::study::{Folder, PAGE_FILE, RunError};
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant as Clock;

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
    pub effects: Vec<EffectReport>,
    /// Standard deviations that answer it.
    pub wanted_sigma: f64,
    /// On the present motion, if there is one.
    pub before: Option<AnswerReport>,
    /// On the planned one.
    pub after: AnswerReport,
}

/// An effect with its values.
#[derive(Clone, Debug, Serialize)]
pub struct EffectReport {
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
    pub limit: Limit,
    /// Lowest and highest coordinate of the motion.
    pub used_stroke: [f64; 2],
    /// Its largest rate.
    pub used_speed: f64,
    /// Its largest acceleration.
    pub used_acceleration: f64,
    /// Largest force or torque of the drive in the simulated recording; null where nobody measures it.
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

/// A finished plan.
#[derive(Debug)]
pub struct Done {
    /// What it came to.
    pub planned: Planned,
    /// The text of `plan.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}

/// Plans a motion and writes everything about it into `folder`. `tell` hears what is being done.
///
/// # Errors
/// Limits that leave no motion, effects that no sensor can see, files that cannot be written; the folder is left as it
/// was.
pub fn into_folder(
    prepared: &Prepared,
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Done, CalibrateError> {
    let started = Clock::now();
    let outcome = plan(prepared, tell)?;
    tell("drawing and writing");
    let pictures = page::pictures(prepared, &outcome)?;
    let texts = [PLAN_FILE, MOTION_FILE, PLANNED_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    let questions: Vec<QuestionReport> = outcome.answers.iter().map(question).collect();
    let open = outcome.answers.iter().filter(|answered| !is_answered(answered));
    let open: Vec<String> = open.map(|answered| answered.posed.words()).collect();
    let without = outcome.answers.iter().map(|a| a.after.sigma / a.posed.wanted());
    let without = without.fold(f64::INFINITY, f64::min);
    let sensors = outcome.instruments.iter().map(|ranked| SensorReport {
        sensor: ranked.instrument.name.clone(),
        sigma: ranked.sigma.clone(),
        gain: ranked.worth / without,
    });
    let mut planned = Planned {
        provenance: Provenance::of(&prepared.rig),
        summary: summary(&questions, &open, outcome.motion.is_present()),
        seed: prepared.seed,
        questions,
        present: prepared.present.as_ref().map(|present| present.name.clone()),
        duration_s: (prepared.samples - 1) as f64 * prepared.interval,
        interval_s: prepared.interval,
        drives: drives(prepared, &outcome),
        largest_gain: prepared.gain,
        sensors: sensors.collect(),
        open,
        candidates: outcome.candidates,
        wall_s: 0.0,
        files: texts.chain(pictures.iter().map(|picture| picture.file.clone())).collect(),
    };
    let motion = motion_csv(prepared, &outcome)?;
    // The only file that it reads: drives that take forces from files are refused.
    let scenario = planned_scenario(prepared).to_toml_with_files(&[MOTION_FILE.to_owned()]);
    planned.wall_s = started.elapsed().as_secs_f64();
    let (json, page) = (to_json(&planned), page::page(&planned, &pictures));
    let texts =
        [(PLAN_FILE, &json), (MOTION_FILE, &motion), (PLANNED_FILE, &scenario), (PAGE_FILE, &page)];
    let folder = publish(folder, &texts, &pictures)?;
    Ok(Done { planned, json, folder })
}

/// Whether the planned motion answers a question.
fn is_answered(answered: &Answered) -> bool {
    answered.after.sigma >= answered.posed.wanted()
}

fn question(answered: &Answered) -> QuestionReport {
    let Answered { posed, before, after } = answered;
    let effect = |effect: &Setting| EffectReport {
        kind: effect.kind.name,
        on: ActsOn::of(effect),
        params: effect.values().map(|(name, value)| (name.to_owned(), value.into())).collect(),
    };
    let answer = |answer: &Answer| AnswerReport {
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
        Posed::Between { pairs, .. } => {
            ("between", pairs.iter().take(1).flatten().map(effect).collect())
        }
        Posed::Detect { ways, .. } => ("detect", ways.iter().take(1).map(effect).collect()),
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

fn summary(questions: &[QuestionReport], open: &[String], same: bool) -> String {
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

fn drives(prepared: &Prepared, outcome: &Outcome) -> Vec<DriveReport> {
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

/// The motion as a table that scenarios and machines read: `t`, `q_JOINT` of each drive, and the pose `x,y,phi` of the
/// output body that these make, which is how a template of a platform is told to move.
fn motion_csv(prepared: &Prepared, outcome: &Outcome) -> Result<String, CalibrateError> {
    let Prepared { described, interval, samples, .. } = prepared;
    let machine = machine(described, &[], &outcome.like)?;
    let names: Vec<String> = machine
        .actuators
        .iter()
        .map(|drive| format!("q_{}", machine.joint_name(drive.joint)))
        .collect();
    let poses = poses(&machine, *interval, *samples);
    let mut text = format!("t,{},x,y,phi\n", names.join(","));
    for (row, pose) in poses.iter().enumerate() {
        let t = row as f64 * interval;
        let commands = outcome.motion.drives.iter().map(|series| rounded(series.at(t)[0]));
        let cells: Vec<String> =
            commands.map(|q| format!("{q:.9}")).chain(pose.map(|p| format!("{p:.12}"))).collect();
        text += &format!("{t:.6},{}\n", cells.join(","));
    }
    Ok(text)
}

/// Poses of the output body of the machine without clearance along its commands, x, y (m) and angle (rad).
fn poses(machine: &Mechanism, interval: f64, samples: usize) -> Vec<[f64; 3]> {
    let ideal = machine.without_clearance();
    let starts = ideal.bodies.iter().map(|body| body.start).collect();
    let mut found = Vec::with_capacity(samples);
    // The search has followed this motion.
    let Ok(mut tracker) = Tracker::new(ideal, Imposed::Drives, starts, 0.0) else { return found };
    let mut angle = machine.bodies[machine.output].angle;
    for row in 0..samples {
        if tracker.advance(row as f64 * interval).is_err() {
            break;
        }
        let state = tracker.mechanism().output_state(tracker.states());
        angle = angle_near(state.rotation, angle);
        found.push([state.position.x, state.position.y, angle]);
    }
    found
}

/// The rig with the planned motion: of a platform by its pose, else by the coordinates of its joints.
fn planned_scenario(prepared: &Prepared) -> Scenario {
    let by_pose = matches!(prepared.rig.mechanism, scenario::Mechanism::ThreeRpr(_));
    let mut planned = if by_pose { prepared.rig.clone() } else { prepared.described.clone() };
    if !by_pose {
        planned.target = None;
    }
    planned.motion = scenario::Motion::Table(scenario::Table { file: MOTION_FILE.to_owned() });
    planned.simulation.duration = (prepared.samples - 1) as f64 * prepared.interval;
    planned
}

impl From<crate::report::ReportError> for CalibrateError {
    fn from(error: crate::report::ReportError) -> Self {
        RunError::from(error).into()
    }
}
