//! Where a machine stands and how it moves, by the coordinates of as many joints as it has freedoms.

use crate::mechanism::{
    Actuator, BodyState, Command, Commands, Drive, Imposed, JointIndex, Mechanism, Reads, Tracker,
    angle_near,
};
use std::sync::Arc;

/// States of all bodies, and their angles with whole turns counted.
#[derive(Clone, Debug)]
pub struct Pose {
    /// States.
    pub states: Vec<BodyState>,
    /// Angles in rad.
    pub angles: Vec<f64>,
}

impl Pose {
    /// Where a machine was put together.
    pub fn of(mechanism: &Mechanism) -> Self {
        Self {
            states: mechanism.bodies.iter().map(|body| body.start).collect(),
            angles: mechanism.bodies.iter().map(|body| body.angle).collect(),
        }
    }
}

/// Joints whose coordinates determine where a machine without clearance stands.
#[derive(Clone, Debug)]
pub struct Coordinates(pub Vec<JointIndex>);

impl Coordinates {
    /// Measured joints first, others as far as they add something; none where joints leave bodies loose.
    pub fn of(mechanism: &Mechanism) -> Option<Self> {
        let states = Pose::of(mechanism).states;
        let measured = |joint: JointIndex| {
            let reads = |reads: &Reads| matches!(reads, Reads::Position(of) if *of == joint);
            mechanism.sensors.iter().any(|sensor| reads(&sensor.reads))
        };
        let mut joints: Vec<JointIndex> = mechanism.joints().map(|(_, joint)| joint).collect();
        joints.sort_by_key(|joint| !measured(*joint));
        let mut ideal = mechanism.clone();
        ideal.actuators.clear();
        let mut found = Vec::new();
        for joint in joints {
            ideal.actuators.push(Actuator::new("", joint, Drive::Prescribed));
            if ideal.freedoms(&states).overdriven.is_empty() {
                found.push(joint);
            } else {
                ideal.actuators.pop();
            }
        }
        let freedoms = ideal.freedoms(&states);
        (!found.is_empty() && freedoms.driven == freedoms.free).then_some(Self(found))
    }

    /// Coordinates (m, rad) of a pose.
    pub fn read(&self, mechanism: &Mechanism, pose: &Pose) -> Vec<f64> {
        let read = |joint: &JointIndex| match *joint {
            JointIndex::Prismatic(i) => mechanism.prismatics[i].length(&pose.states),
            JointIndex::Revolute(i) => {
                let [ring, journal] = mechanism.revolutes[i]
                    .bodies()
                    .map(|body| body.map_or(0.0, |body| pose.angles[body]));
                journal - ring
            }
        };
        self.0.iter().map(read).collect()
    }

    /// The pose with these coordinates and rates, on the branch of a pose near it.
    pub fn pose(&self, mechanism: &Mechanism, near: &Pose, start: &[f64]) -> Option<Pose> {
        let (values, rates) = start.split_at(self.0.len());
        let mut ideal = mechanism.clone();
        ideal.loads.clear();
        ideal.epoch = 0.0;
        ideal.actuators =
            self.0.iter().map(|joint| Actuator::new("", *joint, Drive::Prescribed)).collect();
        ideal.commands = Arc::new(Still { values: values.to_vec(), rates: rates.to_vec() });
        let tracker = Tracker::new(ideal, Imposed::Drives, near.states.clone(), 0.0).ok()?;
        let states = tracker.states().to_vec();
        let mut angles: Vec<f64> = states
            .iter()
            .zip(&near.angles)
            .map(|(state, near)| angle_near(state.rotation, *near))
            .collect();
        // Whole turns are those of the coordinates: from the ground outwards.
        let mut known = vec![false; states.len()];
        for _ in 0..self.0.len() {
            for (joint, value) in self.0.iter().zip(values) {
                let JointIndex::Revolute(i) = *joint else { continue };
                let place =
                    |body: Option<usize>| body.map_or(Some(0.0), |b| known[b].then(|| angles[b]));
                let [ring, journal] = mechanism.revolutes[i].bodies();
                match (place(ring), place(journal), ring, journal) {
                    (Some(angle), None, _, Some(body)) => {
                        angles[body] = angle_near(states[body].rotation, angle + value);
                        known[body] = true;
                    }
                    (None, Some(angle), Some(body), _) => {
                        angles[body] = angle_near(states[body].rotation, angle - value);
                        known[body] = true;
                    }
                    _ => {}
                }
            }
        }
        Some(Pose { states, angles })
    }
}

/// Coordinates and rates of one instant.
#[derive(Debug)]
struct Still {
    values: Vec<f64>,
    rates: Vec<f64>,
}

impl Commands for Still {
    fn at(&self, t: f64, commands: &mut [Command]) {
        for ((command, value), rate) in commands.iter_mut().zip(&self.values).zip(&self.rates) {
            *command = Command { position: value + rate * t, rate: *rate, acceleration: 0.0 };
        }
    }
}
