//! What the drives of a machine are told: to carry a body or a point along a path, or joint by joint.

use super::built::build::{Built, located};
use super::built::names::joint_named;
use super::commands::{Each, NumberSource};
use super::motion;
use super::path::{self, NoTable};
use crate::mechanism::motion::Motion;
use crate::mechanism::{Attachment, Drive, Imposed, Mechanism, TelescopicLegs, angle_near};
use crate::scenario::{self, JointDrive, MotionTarget, Problem, Scenario};
use std::sync::Arc;

/// Where the commands of drives come from that carry a body or a point.
#[derive(Default)]
pub(super) struct Followed {
    /// Their closed form, of telescopic legs.
    pub legs: Option<TelescopicLegs>,
    /// The error of their table otherwise, see [`Machine::table_error`](super::Machine::table_error).
    pub table_error: Option<f64>,
}

/// Commands that carry a body or a point along a path: by the closed form of telescopic legs, else by a
/// table of the inverse kinematics, which Newton's method solves along the way.
pub(super) fn follow(
    scenario: &Scenario,
    built: &mut Built,
    target: &MotionTarget,
    path: &Arc<dyn Motion>,
) -> Result<Followed, Problem> {
    let (MotionTarget::Body(name) | MotionTarget::Point(name)) = target;
    let whole = matches!(target, MotionTarget::Body(_));
    let (point, angle) = located(&built.parts, name);
    let mechanism = &mut built.mechanism;
    let forces = mechanism.actuators.iter().filter(|a| a.drive == Drive::Effort).count();
    let followers = mechanism.actuators.len() - forces;
    let Attachment { body: Some(body), .. } = point else {
        let help = "a body that moves, or one of its points";
        return Err(scenario.problem("motion", format!("\"{name}\" is on the ground"), help));
    };
    let needed = if whole { 3 } else { 2 };
    if followers != needed || forces > 0 {
        let message = format!(
            "moves {} of \"{name}\", which takes {needed} drives that follow it; {followers} do",
            if whole { "x, y and phi" } else { "x and y" }
        );
        let help = "give it as many [[drive]]s, or move joints by [[motion]] joint = \"…\"";
        return Err(scenario.problem("motion", message, help));
    }
    if whole && angle == 0.0 {
        let legs = TelescopicLegs::of(mechanism, body, point.point, Arc::clone(path));
        if let Some(legs) = legs {
            mechanism.commands = Arc::new(legs.clone());
            return Ok(Followed { legs: Some(legs), table_error: None });
        }
    }
    let imposed =
        Imposed::Target { point, angle: whole.then_some(angle), motion: Arc::clone(path) };
    let simulated = scenario.simulation.duration;
    let (table, starts) =
        path::inverse_kinematics(mechanism, imposed, simulated).map_err(|none| {
            let (message, help) = no_table(name, &none);
            scenario.problem("motion", message, help)
        })?;
    let table_error = Some(table.error);
    mechanism.commands = Arc::new(table);
    for (body, state) in mechanism.bodies.iter_mut().zip(starts) {
        body.angle = angle_near(state.rotation, body.angle);
        body.start = state;
    }
    Ok(Followed { legs: None, table_error })
}

/// Why the drives cannot be told where to carry `name`, and what would be right.
fn no_table(name: &str, none: &NoTable) -> (String, &'static str) {
    match none {
        NoTable::Stuck(stuck) => (
            format!(
                "carries \"{name}\" out of reach at t = {:.4} s: no pose of the machine without clearance \
                 has it there",
                stuck.t
            ),
            "a smaller motion, or one elsewhere",
        ),
        NoTable::Turns { asked, most } => (
            format!(
                "carries \"{name}\" around {asked:.0} times, and a table of the inverse kinematics holds \
                 {most:.0} turns at most"
            ),
            "a slower motion, or a shorter run",
        ),
    }
}

/// Commands joint by joint: motions, tables, forces, and the coordinate of the start for drives of which
/// nothing is said. Returns the time up to which all is said.
pub(super) fn command(
    scenario: &Scenario,
    built: &mut Built,
    described: &scenario::Described,
) -> Result<f64, Problem> {
    let mechanism = &mut built.mechanism;
    let said: Vec<Option<NumberSource>> = mechanism
        .actuators
        .iter()
        .map(|actuator| source(scenario, mechanism, described, &actuator.name))
        .collect::<Result<_, _>>()?;
    // Drives that hold take the coordinate that the joints and the other drives leave them.
    let followers: Vec<usize> = (0..said.len()).filter(|&i| said[i].is_some()).collect();
    if followers.len() < said.len() {
        let mut moved = mechanism.clone();
        moved.actuators = followers.iter().map(|&i| mechanism.actuators[i].clone()).collect();
        let sources = followers.iter().filter_map(|&i| said[i].clone()).collect();
        moved.commands = Arc::new(Each(sources));
        moved.assemble(0.0).map_err(|open| path::open(scenario, &moved, open))?;
        for (body, closed) in mechanism.bodies.iter_mut().zip(&moved.bodies) {
            (body.start, body.angle) = (closed.start, closed.angle);
        }
    }
    let start = |i: usize| mechanism.start_coordinate(mechanism.actuators[i].joint);
    let sources: Vec<NumberSource> = said
        .into_iter()
        .enumerate()
        .map(|(i, source)| source.unwrap_or_else(|| NumberSource::Hold(start(i))))
        .collect();
    let known = sources.iter().map(NumberSource::known_until).fold(f64::INFINITY, f64::min);
    mechanism.commands = Arc::new(Each(sources));
    Ok(known)
}

/// What the drive of the joint `name` is told; none where nothing is said.
fn source(
    scenario: &Scenario,
    mechanism: &Mechanism,
    described: &scenario::Described,
    name: &str,
) -> Result<Option<NumberSource>, Problem> {
    let drives = described.drives.iter().enumerate();
    for (i, drive) in drives {
        if let JointDrive::Force(force) = drive
            && force.joint == name
        {
            return motion::force(scenario, &format!("drive.{i}"), force).map(Some);
        }
    }
    match &scenario.motion {
        scenario::Motion::Joints(motions) => {
            let Some(i) = motions.iter().position(|motion| motion.joint == name) else {
                return Ok(None);
            };
            let key = if scenario.is_list("motion") {
                format!("motion.{i}")
            } else {
                "motion".to_owned()
            };
            let start =
                joint_named(mechanism, name).map_or(0.0, |joint| mechanism.start_coordinate(joint));
            motion::joint(scenario, &key, name, &motions[i].path, start).map(Some)
        }
        scenario::Motion::Table(table) => {
            let column = format!("q_{name}");
            let spline = motion::column_of(scenario, "motion.file", &table.file, &column)?;
            Ok(Some(NumberSource::Spline(spline)))
        }
        _ => Ok(None),
    }
}
