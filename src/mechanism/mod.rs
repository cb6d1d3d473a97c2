//! Mechanisms as plain data: bodies, joints, drives, commands, and what moves them. Builders
//! ([`three_rpr`]) make a [`Mechanism`]; nothing in it or below it knows how many legs there are.
//!
//! Planar vectors with three components hold a linear part (x, y) and an angular part: velocities
//! (m/s, m/s, rad/s), accelerations (m/s², m/s², rad/s²), wrenches (N, N, N·m about the centre of
//! mass).
//!
//! `parts` and `drives` are what a mechanism has; `equations`: what rigid joints ask of it, from its assembly to the forces that a
//! motion takes; `dynamics`: the accelerations of a state; [`motion`]: commanded paths, `legs` what drives do along them.

mod drives;
mod dynamics;
mod equations;
mod evaluation;
mod legs;
pub mod motion;
mod parts;
pub mod pendulum;
mod reading;
mod rotor;
mod sensor;
pub mod three_rpr;

pub use drives::actuator::{Actuator, Drive};
pub use drives::cascade::{Cascade, Held};
pub use drives::command::{Command, Commands, Idle};
pub use drives::reading_error::ReadingError;
pub use drives::transmission::Transmission;
pub use dynamics::Dynamics;
pub use equations::assembly::OpenJoint;
pub use equations::closing::ClosingLength;
pub use equations::freedoms::{Freedoms, Hold};
pub use equations::inverse::{Posed, Taken};
pub use equations::loops::Loop;
pub use equations::tracker::{Closing, Imposed, Place, Stuck, Tracker};
pub use evaluation::Evaluation;
pub use legs::TelescopicLegs;
pub use parts::body::{Attachment, Body, BodyState, turn};
pub use parts::joint::{Bearing, JointIndex, NativeContacts, Prismatic, Revolute, angle_near};
pub use parts::load::{Load, Memory, Situation};
pub use parts::mark::Mark;
pub use parts::names::{Axes, NamedPoint, Names, Use};
pub use parts::oil::OilFilm;
pub use parts::spring::{JointSpring, PointSpring, Stop};
pub(crate) use reading::LAST_STEP;
pub use rotor::Rotor;
pub use sensor::{Reads, Sensor, TrackerFrame};

use nalgebra::{Vector2, Vector3};
use std::sync::Arc;

/// A planar mechanism, ready to be simulated.
///
/// ```
/// use freeplay::mechanism::{Body, BodyState, Mechanism};
/// use nalgebra::Vector2;
///
/// let mut mechanism = Mechanism::free(vec![Body::new("beam", 2.0, 0.1, BodyState::ground())]);
/// // 2 kg more at its end: the centre of mass moves half of the way, and what was the beam's centre stays its output.
/// mechanism.add_point_mass(0, 2.0, Vector2::new(1.0, 0.0));
/// assert_eq!(mechanism.bodies[0].mass, 4.0);
/// assert!((mechanism.bodies[0].start.position.x - 0.5).abs() < 1e-12);
/// let start = mechanism.bodies[0].start;
/// assert!(mechanism.output_state(&[start]).position.norm() < 1e-12);
/// ```
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// The moving bodies.
    pub bodies: Vec<Body>,
    /// The revolute joints, in the order of the result columns; behind them the corners of sliders with clearance.
    pub revolutes: Vec<Revolute>,
    /// The prismatic joints.
    pub prismatics: Vec<Prismatic>,
    /// The drives, in the order of the result columns.
    pub actuators: Vec<Actuator>,
    /// Rotors that joints spin through gears.
    pub rotors: Vec<Rotor>,
    /// What the drives are told.
    pub commands: Arc<dyn Commands>,
    /// What commands and loads take for the time at the start of a run, in s: a recording may begin
    /// some time after its machine was released.
    pub epoch: f64,
    /// Uniform gravity in m/s².
    pub gravity: Vector2<f64>,
    /// What else acts on the bodies.
    pub loads: Vec<Arc<dyn Load>>,
    /// The contacts of [`Bearing::Native`] joints.
    pub native: NativeContacts,
    /// What measures it.
    pub sensors: Vec<Sensor>,
    /// How its bodies and points are called.
    pub names: Names,
    /// Index of the body whose reference point and angle are the mechanism's output.
    pub output: usize,
}

impl Mechanism {
    /// Bodies that nothing holds, drives or pulls; the last one is the output.
    pub fn free(bodies: Vec<Body>) -> Self {
        Self {
            output: bodies.len().saturating_sub(1),
            bodies,
            revolutes: Vec::new(),
            prismatics: Vec::new(),
            actuators: Vec::new(),
            rotors: Vec::new(),
            commands: Arc::new(Idle),
            epoch: 0.0,
            gravity: Vector2::zeros(),
            loads: Vec::new(),
            native: NativeContacts::default(),
            sensors: Vec::new(),
            names: Names::default(),
        }
    }

    /// Motion of the output: position and velocity of its reference point.
    pub fn output_state(&self, states: &[BodyState]) -> BodyState {
        states[self.output].at(self.bodies[self.output].reference)
    }

    /// Acceleration of the output's reference point, and α (m/s², m/s², rad/s²).
    pub fn output_acceleration(
        &self,
        states: &[BodyState],
        accelerations: &[Vector3<f64>],
    ) -> Vector3<f64> {
        let reference = self.bodies[self.output].reference;
        states[self.output].acceleration_at(accelerations[self.output], reference)
    }

    /// Puts a point mass (kg) on body `index`, at a point given from the body's reference point in
    /// its own axes (m). The centre of mass moves, `d = m r/(M + m)`, and the inertia about it
    /// becomes `I + m M/(M + m) |r|²`, r from the old centre of mass (parallel axis theorem).
    pub fn add_point_mass(&mut self, index: usize, mass: f64, point: Vector2<f64>) {
        let body = &mut self.bodies[index];
        let from_centre = body.reference + point;
        let total = body.mass + mass;
        let shift = from_centre * (mass / total);
        let reduced = body.mass * mass / total;
        let inertia = body.inertia + reduced * from_centre.norm_squared();
        self.set_mass(index, total, shift, inertia);
    }

    /// Gives body `index` another mass (kg), another centre of mass, `shift` (m, in its own axes) from the one
    /// that it has, and another inertia about that (kg m²). Its points stay where they are.
    pub fn set_mass(&mut self, index: usize, mass: f64, shift: Vector2<f64>, inertia: f64) {
        let body = &mut self.bodies[index];
        body.mass = mass;
        body.inertia = inertia;
        body.reference -= shift;
        body.start = body.start.at(shift);
        let revolutes = self.revolutes.iter_mut().flat_map(|j| [&mut j.ring, &mut j.journal]);
        let prismatics = self.prismatics.iter_mut().flat_map(|j| [&mut j.base, &mut j.slider]);
        for attachment in revolutes.chain(prismatics) {
            if attachment.body == Some(index) {
                attachment.point -= shift;
            }
        }
    }

    /// Writes what the true coordinate of each driven joint is commanded to do `t` s after the start.
    /// Servos follow what is read: theirs are commands to be compared with readings.
    pub fn true_commands(&self, t: f64, commands: &mut [Command]) {
        self.commands.at(self.epoch + t, commands);
        for (command, actuator) in commands.iter_mut().zip(&self.actuators) {
            if !actuator.reading_errors.is_empty() {
                *command = actuator.true_command(*command);
            }
        }
    }

    /// The joints by name, revolute ones first; corners of sliders are none.
    pub fn joints(&self) -> impl Iterator<Item = (&str, JointIndex)> {
        let revolutes = self.revolutes.iter().enumerate().filter(|(_, joint)| !joint.is_corner());
        let prismatics = self.prismatics.iter().enumerate();
        revolutes
            .map(|(i, joint)| (joint.name.as_str(), JointIndex::Revolute(i)))
            .chain(prismatics.map(|(i, joint)| (joint.name.as_str(), JointIndex::Prismatic(i))))
    }

    /// By how many rad the body that drive `index` works from turns, out of those of all bodies: that of
    /// the ring.
    pub fn ring_turn(&self, index: usize, turns: &[f64]) -> f64 {
        let JointIndex::Revolute(joint) = self.actuators[index].joint else { return 0.0 };
        self.revolutes[joint].ring.body.map_or(0.0, |body| turns[body])
    }

    /// Coordinate of a joint (m, rad) at the bodies' starts.
    pub fn start_coordinate(&self, joint: JointIndex) -> f64 {
        match joint {
            JointIndex::Revolute(i) => self.start_angle(i),
            JointIndex::Prismatic(i) => {
                let states: Vec<BodyState> = self.bodies.iter().map(|body| body.start).collect();
                self.prismatics[i].length(&states)
            }
        }
    }

    /// Angle (rad) at the start of revolute joint `index`: that of the journal's body less that of the
    /// ring's.
    pub fn start_angle(&self, index: usize) -> f64 {
        let angle = |a: &Attachment| a.body.map_or(0.0, |body| self.bodies[body].angle);
        let joint = &self.revolutes[index];
        angle(&joint.journal) - angle(&joint.ring)
    }
}
