//! Sensors that a rig does not have, one instrument at a time: which would help most.

use super::separation::{Posed, apart};
use super::sight::{Seen, Sight};
use crate::engine::StepControl;
use crate::mechanism::{JointIndex, Mechanism, Reads};
use crate::model::laboratory;
use crate::scenario::{self, Quantity, Scenario};

/// Instruments that are looked at, at most: each costs the noise of one motion, a second or two.
const MOST: usize = 8;

/// An instrument: its name for people, and the columns that it adds.
#[derive(Clone, Debug)]
pub struct Instrument {
    /// What it is.
    pub name: String,
    /// Its sensors.
    pub sensors: Vec<scenario::Sensor>,
}

/// How far apart the models of each question are with one more instrument.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// The instrument.
    pub instrument: Instrument,
    /// Standard deviations, question by question.
    pub sigma: Vec<f64>,
    /// The least of them over what answers its question.
    pub worth: f64,
}

/// Instruments that a machine does not have yet: a tracker of its output body, an encoder of each joint, a force sensor of
/// each drive, an accelerometer on each body. Their noise is that of sensors of the same quantity that the rig has, else
/// that of a good laboratory.
pub fn missing(rig: &Scenario, machine: &Mechanism) -> Vec<Instrument> {
    let Some(described) = rig.mechanism.described() else { return Vec::new() };
    let has =
        |reads: &dyn Fn(&Reads) -> bool| machine.sensors.iter().any(|sensor| reads(&sensor.reads));
    let sensor = |quantity: Quantity, turns: bool, column: &str, of: &str| {
        let bare = laboratory(quantity, turns, column, of);
        let joint = |name: &str| {
            let found = machine.joints().find(|(known, _)| *known == name);
            found.is_some_and(|(_, joint)| matches!(joint, JointIndex::Revolute(_)))
        };
        let alike =
            |known: &&scenario::Sensor| known.quantity == quantity && joint(&known.of) == turns;
        let like = described.sensors.iter().find(alike);
        like.map_or(bare.clone(), |like| scenario::Sensor {
            std: like.std,
            resolution: like.resolution,
            lowpass: like.lowpass,
            ..bare
        })
    };
    let mut found = Vec::new();
    let output = machine.output;
    if let Some((body, point)) = point_of(rig, machine, output)
        && !has(&|reads| matches!(reads, Reads::X(mark) if mark.body == Some(output)))
    {
        let sensors = [("x", Quantity::X), ("y", Quantity::Y), ("phi", Quantity::Angle)];
        found.push(Instrument {
            name: format!("tracker of {body}"),
            sensors: sensors
                .map(|(name, quantity)| {
                    sensor(quantity, false, &format!("plan_{name}_{body}"), &point)
                })
                .to_vec(),
        });
    }
    for (name, joint) in machine.joints() {
        let known = |reads: &Reads| matches!(reads, Reads::Position(of) if *of == joint);
        if !has(&known) {
            let turns = matches!(joint, JointIndex::Revolute(_));
            let one = sensor(Quantity::Position, turns, &format!("plan_q_{name}"), name);
            found.push(Instrument { name: format!("encoder of {name}"), sensors: vec![one] });
        }
    }
    for (index, drive) in machine.actuators.iter().enumerate() {
        if !has(&|reads| matches!(reads, Reads::Effort(of) if *of == index)) {
            let turns = matches!(drive.joint, JointIndex::Revolute(_));
            let joint = machine.joint_name(drive.joint);
            let one = sensor(Quantity::Force, turns, &format!("plan_F_{joint}"), joint);
            let what = if turns { "torque" } else { "force" };
            found
                .push(Instrument { name: format!("{what} sensor of {joint}"), sensors: vec![one] });
        }
    }
    for index in 0..machine.bodies.len() {
        let Some((body, point)) = point_of(rig, machine, index) else { continue };
        if has(&|reads| matches!(reads, Reads::Acceleration(mark, _) if mark.body == Some(index))) {
            continue;
        }
        let along = |axis: f64, name: &str| scenario::Sensor {
            axis: Some(axis),
            ..sensor(Quantity::Acceleration, false, &format!("plan_a{name}_{body}"), &point)
        };
        let sensors = vec![along(0.0, "x"), along(std::f64::consts::FRAC_PI_2, "y")];
        found.push(Instrument { name: format!("accelerometer on {body}"), sensors });
    }
    found.truncate(MOST);
    found
}

/// Name of a body, and of the point of it where an instrument would sit: the last one, which is away from the joint that
/// carries it.
fn point_of(rig: &Scenario, machine: &Mechanism, index: usize) -> Option<(String, String)> {
    let name = &machine.bodies.get(index)?.name;
    let body = rig.mechanism.described()?.bodies.iter().find(|body| body.name == *name)?;
    let far = |point: &[f64; 2]| point[0].hypot(point[1]);
    let (point, _) = body.points.iter().max_by(|a, b| far(a.1).total_cmp(&far(b.1)))?;
    Some((name.clone(), format!("{name}.{point}")))
}

/// Those instruments by what they bring along a motion, the best first; such as cannot be looked at are left out.
/// `like` makes the motion for a machine with other sensors.
pub fn ranked(
    rig: &Scenario,
    instruments: Vec<Instrument>,
    posed: &[Posed],
    control: StepControl,
    seed: u64,
    like: &dyn Fn(&Mechanism) -> crate::calibrate::sensed::recording::Recording,
) -> Vec<Ranked> {
    let one = |instrument: Instrument| {
        let mut with = rig.clone();
        let scenario::Mechanism::Described(described) = &mut with.mechanism else { return None };
        described.sensors.extend(instrument.sensors.iter().cloned());
        let machine = crate::model::parts_of(&with).ok()?;
        let sight = Sight::new(&with, &like(&machine), control, seed).ok()?;
        let seen: Seen = sight.own();
        let sigma: Vec<f64> = posed
            .iter()
            .map(|posed| Some(apart(&sight, &seen, posed)?.sigma))
            .collect::<Option<_>>()?;
        let worth = worth(posed, &sigma);
        Some(Ranked { instrument, sigma, worth })
    };
    let mut found: Vec<Ranked> = instruments.into_iter().filter_map(one).collect();
    found.sort_by(|a, b| b.worth.total_cmp(&a.worth));
    found
}

/// The least of some separations over what answers their questions.
pub fn worth(posed: &[Posed], sigma: &[f64]) -> f64 {
    posed
        .iter()
        .zip(sigma)
        .map(|(posed, sigma)| sigma / posed.wanted())
        .fold(f64::INFINITY, f64::min)
}
