//! Mechanisms as plain data: bodies, joints, drives, commands, and what moves them. Builders
//! ([`three_rpr`]) make a [`Mechanism`]; nothing in it or below it knows how many legs there are.
//!
//! Planar vectors with three components hold a linear part (x, y) and an angular part: velocities
//! (m/s, m/s, rad/s), accelerations (m/s², m/s², rad/s²), wrenches (N, N, N·m about the centre of
//! mass).

pub mod drive_stage;
pub mod motion;
pub mod pendulum;
pub mod three_rpr;

mod assembly;
mod cascade;
mod constraints;
mod dynamics;
mod evaluation;
mod load;
mod reading;
mod rows;
mod telescope;
mod transmission;

pub use cascade::{Cascade, Held};
pub use dynamics::Dynamics;
pub use evaluation::Evaluation;
pub use load::{Load, Memory, Situation};
pub use reading::ReadingError;
pub use transmission::Transmission;

use crate::contact::{Clearance, Frame, OutOfRound};
use nalgebra::{UnitComplex, Vector2, Vector3};
use std::fmt::Debug;
use std::sync::Arc;

/// Where a body is and how it moves: position and velocity of its centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Centre of mass in m.
    pub position: Vector2<f64>,
    /// Rotation of the body's own axes against the world's.
    pub rotation: UnitComplex<f64>,
    /// Velocity (m/s, m/s) and angular velocity (rad/s).
    pub twist: Vector3<f64>,
}

impl BodyState {
    /// The ground: at the origin, at rest.
    pub fn ground() -> Self {
        Self {
            position: Vector2::zeros(),
            rotation: UnitComplex::identity(),
            twist: Vector3::zeros(),
        }
    }

    /// The state `tau` s away on the path `x + vτ + aτ²/2 + jτ³/6`, with acceleration `a` and jerk
    /// `j` (linear m/s², m/s³; angular rad/s², rad/s³).
    pub fn moved(&self, a: Vector3<f64>, j: Vector3<f64>, tau: f64) -> Self {
        let shift = (self.twist + (a / 2.0 + j * (tau / 6.0)) * tau) * tau;
        Self {
            position: self.position + shift.xy(),
            rotation: self.rotation * turn(shift.z),
            twist: self.twist + (a + j * (tau / 2.0)) * tau,
        }
    }

    /// Position, arm and velocity of a point given in the body's own axes (m, from its centre of
    /// mass).
    pub fn frame(&self, local: Vector2<f64>) -> Frame {
        let arm = self.rotation * local;
        let spin = self.twist.z;
        Frame {
            centre: self.position + arm,
            arm,
            velocity: self.twist.xy() + Vector2::new(-arm.y, arm.x) * spin,
            spin,
        }
    }
}

/// The rotation by `angle` rad. Steps turn bodies by far less than 0.01 rad, where seven terms of
/// the series are exact to the last digit and cost a fifth of a sine and a cosine.
fn turn(angle: f64) -> UnitComplex<f64> {
    if angle.abs() > 0.01 {
        return UnitComplex::new(angle);
    }
    let s = angle * angle;
    let cos = 1.0 - s / 2.0 * (1.0 - s / 12.0 * (1.0 - s / 30.0));
    let sin = angle * (1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0)));
    UnitComplex::from_cos_sin_unchecked(cos, sin)
}

/// A rigid body and its state at the start.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name for messages and tables.
    pub name: String,
    /// Mass in kg.
    pub mass: f64,
    /// Moment of inertia about the centre of mass in kg·m².
    pub inertia: f64,
    /// State at t = 0.
    pub start: BodyState,
    /// The point in the body's own axes, from its centre of mass (m), whose motion is the body's where
    /// it is an output: where the centre of mass was before anything was put on it.
    pub reference: Vector2<f64>,
}

/// A point of a body, or of the ground.
#[derive(Clone, Copy, Debug)]
pub struct Attachment {
    /// Index of the body, or `None` for the ground.
    pub body: Option<usize>,
    /// The point in the body's own axes, from its centre of mass (ground: world coordinates), m.
    pub point: Vector2<f64>,
}

/// How a revolute joint holds its two bodies together.
#[derive(Clone, Debug)]
pub enum Bearing {
    /// The two centres coincide exactly.
    Ideal,
    /// The journal moves freely inside the ring and hits it under a force law.
    Clearance(Clearance),
    /// The same geometry, left to the contacts of the physics engine.
    Native {
        /// Inner radius of the bearing ring in m.
        bearing_radius: f64,
        /// Radius of the journal in m.
        journal_radius: f64,
        /// Coefficient of friction μ.
        friction: f64,
    },
}

/// How the physics engine's own contacts behave, in all joints that are left to them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NativeContacts {
    /// Share of its normal speed that a journal keeps when it hits after a flight.
    pub restitution: f64,
    /// Natural frequency f of a lasting contact in Hz: it gives way like a spring of `m (2πf)²`,
    /// m the mass that the two bodies oppose to it.
    pub frequency: f64,
    /// Damping ratio of that spring.
    pub damping_ratio: f64,
    /// Sweeps of the solver over all joints and contacts in each step.
    pub iterations: usize,
    /// Whether a journal that would arrive within the step is stopped at the ring at once, whatever
    /// the spring. The physics engine's way; the force of such a stop is `m v/dt`.
    pub predictive: bool,
}

impl Default for NativeContacts {
    /// As the physics engine has them for its moving bodies.
    fn default() -> Self {
        Self {
            restitution: 0.0,
            frequency: 30.0,
            damping_ratio: 10.0,
            iterations: 1,
            predictive: true,
        }
    }
}

/// A revolute joint: a bearing ring on one body, a journal on another.
#[derive(Clone, Debug)]
pub struct Revolute {
    /// Name, such as `A1`.
    pub name: String,
    /// Centre of the bearing ring.
    pub ring: Attachment,
    /// Centre of the journal.
    pub journal: Attachment,
    /// What the joint does.
    pub bearing: Bearing,
    /// How its ring departs from a circle, if it does; [`Bearing::Clearance`] alone looks at it.
    pub out_of_round: Option<OutOfRound>,
}

/// How a prismatic joint is driven along its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// The length follows the command exactly; the drive force is the reaction.
    Prescribed,
    /// `F = k_p (q_cmd − q) + k_d (q̇_cmd − q̇)`.
    Servo {
        /// Stiffness k_p in N/m.
        stiffness: f64,
        /// Damping k_d in N·s/m.
        damping: f64,
    },
    /// A controller that is computed at instants and held in between.
    Sampled(Cascade),
}

/// A prismatic joint: a rod that slides along the x axis of its cylinder, both keeping the same
/// orientation. Its length is the distance from the cylinder's to the rod's attachment point.
#[derive(Clone, Debug)]
pub struct Prismatic {
    /// Name, such as `P1`.
    pub name: String,
    /// The body that carries the axis, and the point from which the length counts.
    pub cylinder: Attachment,
    /// The body that slides, and the point to which the length counts.
    pub rod: Attachment,
    /// Its drive; the command with the same index is what it follows.
    pub drive: Drive,
    /// How its true length differs from what its encoder and its drive read, in sum.
    pub reading_errors: Vec<Arc<dyn ReadingError>>,
    /// What gives between drive and rod, if anything does; a [`Drive::Servo`] alone feels it.
    pub transmission: Option<Transmission>,
}

/// Commanded length of one prismatic joint at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// Length q in m.
    pub length: f64,
    /// q̇ in m/s.
    pub rate: f64,
    /// q̈ in m/s².
    pub acceleration: f64,
}

/// Commands of all prismatic joints of a mechanism as functions of time.
pub trait Commands: Debug + Send + Sync {
    /// Writes the command of each prismatic joint at time `t` (s).
    fn at(&self, t: f64, commands: &mut [Command]);

    /// What is added at time `t` (s) to the output of the sampled controller of prismatic joint
    /// `index`, in V.
    fn added(&self, _index: usize, _t: f64) -> f64 {
        0.0
    }
}

/// A planar mechanism, ready to be simulated.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// The moving bodies.
    pub bodies: Vec<Body>,
    /// The revolute joints, in the order of the result columns.
    pub revolutes: Vec<Revolute>,
    /// The prismatic joints, in the order of the result columns.
    pub prismatics: Vec<Prismatic>,
    /// What the prismatic joints are told.
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
    /// Index of the body whose reference point and angle are the mechanism's output.
    pub output: usize,
}

impl Mechanism {
    /// Motion of the output: position and velocity of its reference point.
    pub fn output_state(&self, states: &[BodyState]) -> BodyState {
        let state = states[self.output];
        let frame = state.frame(self.bodies[self.output].reference);
        let twist = Vector3::new(frame.velocity.x, frame.velocity.y, frame.spin);
        BodyState { position: frame.centre, twist, ..state }
    }

    /// Acceleration of the output's reference point r from the centre of mass,
    /// `a + α × r − ω² r`, and α (m/s², m/s², rad/s²).
    pub fn output_acceleration(
        &self,
        states: &[BodyState],
        accelerations: &[Vector3<f64>],
    ) -> Vector3<f64> {
        let (a, state) = (accelerations[self.output], states[self.output]);
        let r = state.rotation * self.bodies[self.output].reference;
        let omega2 = state.twist.z * state.twist.z;
        Vector3::new(a.x - a.z * r.y - omega2 * r.x, a.y + a.z * r.x - omega2 * r.y, a.z)
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
        body.inertia += reduced * from_centre.norm_squared();
        body.mass = total;
        body.reference -= shift;
        let frame = body.start.frame(shift);
        body.start.position = frame.centre;
        body.start.twist = Vector3::new(frame.velocity.x, frame.velocity.y, frame.spin);
        let revolutes = self.revolutes.iter_mut().flat_map(|j| [&mut j.ring, &mut j.journal]);
        let prismatics = self.prismatics.iter_mut().flat_map(|j| [&mut j.cylinder, &mut j.rod]);
        for attachment in revolutes.chain(prismatics) {
            if attachment.body == Some(index) {
                attachment.point -= shift;
            }
        }
    }

    /// Writes what the true length of each prismatic joint is commanded to do `t` s after the start.
    /// Servos follow what is read: theirs are commands to be compared with readings.
    pub fn true_commands(&self, t: f64, commands: &mut [Command]) {
        self.commands.at(self.epoch + t, commands);
        for (command, joint) in commands.iter_mut().zip(&self.prismatics) {
            if !joint.reading_errors.is_empty() {
                *command = joint.true_command(*command);
            }
        }
    }

    /// Time in s between two samples of the controllers; the shortest where they differ, and none
    /// where nothing is sampled.
    pub fn sampling(&self) -> Option<f64> {
        let sampled = self.prismatics.iter().filter_map(|joint| match joint.drive {
            Drive::Sampled(cascade) => Some(cascade.interval),
            Drive::Prescribed | Drive::Servo { .. } => None,
        });
        sampled.reduce(f64::min)
    }

    /// Mass in kg that the two bodies of a revolute joint oppose to a hit, in the direction in which
    /// they give way most easily: `1/m = Σ (1/m_i + r_i²/I_i)`, r the distance of the joint from the
    /// centre of mass.
    pub fn joint_mass(&self, joint: &Revolute) -> f64 {
        let lightness = |attachment: &Attachment| {
            attachment.body.map_or(0.0, |i| {
                let body = &self.bodies[i];
                1.0 / body.mass + attachment.point.norm_squared() / body.inertia
            })
        };
        1.0 / (lightness(&joint.ring) + lightness(&joint.journal))
    }

    /// The longest fixed step in s that resolves every clearance joint's hits at `speed` m/s and
    /// every servo, or `None` where nothing limits the step.
    pub fn longest_step(&self, speed: f64) -> Option<f64> {
        let joints = self.revolutes.iter().filter_map(|joint| {
            let Bearing::Clearance(clearance) = &joint.bearing else { return None };
            Some(clearance.law.longest_step(self.joint_mass(joint), speed))
        });
        joints.chain(self.longest_smooth_step()).reduce(f64::min)
    }

    /// The longest step in s that every servo and every load stands, or `None` where nothing limits it.
    pub fn longest_smooth_step(&self) -> Option<f64> {
        let loads = self.loads.iter().filter_map(|load| load.longest_step(self));
        loads.chain(self.longest_servo_step()).reduce(f64::min)
    }

    /// The longest step in s that every servo stands: on two bodies of reduced mass μ,
    /// `h ≤ √(μ/k_p)` and `h ≤ μ/k_d` (explicit), or `None` without servos.
    pub fn longest_servo_step(&self) -> Option<f64> {
        let servos = self.prismatics.iter().filter_map(|joint| {
            let Drive::Servo { stiffness, damping } = joint.drive else { return None };
            let gains = [stiffness, damping];
            let [stiffness, damping] = joint.transmission.map_or(gains, |t| t.gains(gains));
            let mass = self.stroke_mass(joint);
            Some((mass / stiffness).sqrt().min(mass / damping))
        });
        servos.reduce(f64::min)
    }

    /// Mass in kg that the two bodies of a prismatic joint oppose to its drive,
    /// `1/m = 1/m_1 + 1/m_2`.
    pub fn stroke_mass(&self, joint: &Prismatic) -> f64 {
        let lightness =
            |attachment: &Attachment| attachment.body.map_or(0.0, |i| 1.0 / self.bodies[i].mass);
        1.0 / (lightness(&joint.cylinder) + lightness(&joint.rod))
    }
}

impl Attachment {
    /// Rotation of the body that carries the point.
    pub fn rotation(&self, states: &[BodyState]) -> UnitComplex<f64> {
        self.body.map_or(UnitComplex::identity(), |i| states[i].rotation)
    }

    /// Where the point is and how it moves, given the states of all bodies.
    pub fn frame(&self, states: &[BodyState]) -> Frame {
        match self.body {
            Some(i) => states[i].frame(self.point),
            None => {
                Frame { centre: self.point, arm: self.point, velocity: Vector2::zeros(), spin: 0.0 }
            }
        }
    }
}
