//! Sensors that a rig does not have, one instrument at a time: which would help most.

use super::separation::{PosedQuestion, apart};
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
pub struct RankedInstrument {
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
    let shop = Shop { rig, machine, declared: &described.sensors };
    let mut found = Vec::new();
    found.extend(shop.tracker());
    found.extend(shop.encoders());
    found.extend(shop.effort_sensors());
    found.extend(shop.accelerometers());
    found.truncate(MOST);
    found
}

/// Where instruments for a machine are looked for.
struct Shop<'a> {
    rig: &'a Scenario,
    machine: &'a Mechanism,
    /// Sensors that the rig has.
    declared: &'a [scenario::Sensor],
}

impl Shop<'_> {
    /// Whether the machine has a sensor that reads this.
    fn has(&self, reads: &dyn Fn(&Reads) -> bool) -> bool {
        self.machine.sensors.iter().any(|sensor| reads(&sensor.reads))
    }

    /// A sensor with the noise of those like it, or that of a good laboratory.
    fn sensor(&self, quantity: Quantity, turns: bool, column: &str, of: &str) -> scenario::Sensor {
        let bare = laboratory(quantity, turns, column, of);
        let joint = |name: &str| {
            let found = self.machine.joints().find(|(known, _)| *known == name);
            found.is_some_and(|(_, joint)| matches!(joint, JointIndex::Revolute(_)))
        };
        let alike =
            |known: &&scenario::Sensor| known.quantity == quantity && joint(&known.of) == turns;
        let like = self.declared.iter().find(alike);
        like.map_or(bare.clone(), |like| scenario::Sensor {
            std: like.std,
            resolution: like.resolution,
            lowpass: like.lowpass,
            ..bare
        })
    }

    fn tracker(&self) -> Option<Instrument> {
        let output = self.machine.output;
        let (body, point) = point_of(self.rig, self.machine, output)?;
        if self.has(&|reads| matches!(reads, Reads::X(mark) if mark.body == Some(output))) {
            return None;
        }
        let sensors = [("x", Quantity::X), ("y", Quantity::Y), ("phi", Quantity::Angle)];
        let sensor = |(name, quantity): (&str, Quantity)| {
            self.sensor(quantity, false, &format!("plan_{name}_{body}"), &point)
        };
        let name = format!("tracker of {body}");
        Some(Instrument { name, sensors: sensors.map(sensor).to_vec() })
    }

    fn encoders(&self) -> impl Iterator<Item = Instrument> {
        self.machine.joints().filter_map(|(name, joint)| {
            let known = |reads: &Reads| matches!(reads, Reads::Position(of) if *of == joint);
            if self.has(&known) {
                return None;
            }
            let turns = matches!(joint, JointIndex::Revolute(_));
            let one = self.sensor(Quantity::Position, turns, &format!("plan_q_{name}"), name);
            Some(Instrument { name: format!("encoder of {name}"), sensors: vec![one] })
        })
    }

    fn effort_sensors(&self) -> impl Iterator<Item = Instrument> {
        self.machine.actuators.iter().enumerate().filter_map(|(index, drive)| {
            if self.has(&|reads| matches!(reads, Reads::Effort(of) if *of == index)) {
                return None;
            }
            let turns = matches!(drive.joint, JointIndex::Revolute(_));
            let joint = self.machine.joint_name(drive.joint);
            let one = self.sensor(Quantity::Force, turns, &format!("plan_F_{joint}"), joint);
            let what = if turns { "torque" } else { "force" };
            Some(Instrument { name: format!("{what} sensor of {joint}"), sensors: vec![one] })
        })
    }

    fn accelerometers(&self) -> impl Iterator<Item = Instrument> {
        (0..self.machine.bodies.len()).filter_map(|index| {
            let (body, point) = point_of(self.rig, self.machine, index)?;
            let known = |reads: &Reads| matches!(reads, Reads::Acceleration(mark, _) if mark.body == Some(index));
            if self.has(&known) {
                return None;
            }
            let along = |axis: f64, name: &str| scenario::Sensor {
                axis: Some(axis),
                ..self.sensor(
                    Quantity::Acceleration,
                    false,
                    &format!("plan_a{name}_{body}"),
                    &point,
                )
            };
            let sensors = vec![along(0.0, "x"), along(std::f64::consts::FRAC_PI_2, "y")];
            Some(Instrument { name: format!("accelerometer on {body}"), sensors })
        })
    }
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
    posed: &[PosedQuestion],
    control: StepControl,
    seed: u64,
    like: &dyn Fn(&Mechanism) -> crate::calibrate::sensed::recording::Recording,
) -> Vec<RankedInstrument> {
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
        Some(RankedInstrument { instrument, sigma, worth })
    };
    let mut found: Vec<RankedInstrument> = instruments.into_iter().filter_map(one).collect();
    found.sort_by(|a, b| b.worth.total_cmp(&a.worth));
    found
}

/// The least of some separations over what answers their questions.
pub fn worth(posed: &[PosedQuestion], sigma: &[f64]) -> f64 {
    posed
        .iter()
        .zip(sigma)
        .map(|(posed, sigma)| sigma / posed.wanted())
        .fold(f64::INFINITY, f64::min)
}
