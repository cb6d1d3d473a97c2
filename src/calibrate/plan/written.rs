//! From what was prepared to a folder with the plan, its motion, the rig with that motion and a page.

use super::motions::motion::rounded;
use super::outcome::{PlanOutcome, plan};
use super::page;
use super::prepare::PreparedPlan;
use super::report::{
    MOTION_FILE, PLAN_FILE, PLANNED_FILE, Planned, QuestionReport, SensorReport, drives,
    is_answered, question, summary,
};
use crate::calibrate::results::result::{CalibrateError, publish, to_json};
use crate::calibrate::sensed::start::machine;
use crate::mechanism::{Imposed, Mechanism, Tracker, angle_near};
use crate::results::{Folder, PAGE_FILE, RunError};
use crate::scenario::{self, Scenario};
use crate::simulate::Provenance;
use std::path::PathBuf;
use std::time::Instant as Clock;

/// A finished plan.
#[derive(Debug)]
pub struct FinishedPlan {
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
    prepared: &PreparedPlan,
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<FinishedPlan, CalibrateError> {
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
    Ok(FinishedPlan { planned, json, folder })
}

/// The motion as a table that scenarios and machines read: `t`, `q_JOINT` of each drive, and the pose `x,y,phi` of the
/// output body that these make, which is how a template of a platform is told to move.
fn motion_csv(prepared: &PreparedPlan, outcome: &PlanOutcome) -> Result<String, CalibrateError> {
    let PreparedPlan { described, interval, samples, .. } = prepared;
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
fn planned_scenario(prepared: &PreparedPlan) -> Scenario {
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
