//! A scenario as a machine that can be simulated. What concerns one kind of mechanism only stands in
//! that kind's own file.

use super::ideal::Ideal;
use super::{drive_stage, motion, native, pendulum, three_rpr};
use crate::contact::{Clearance, CoulombFriction, HertzStep, Material, hertz_stiffness};
use crate::effects::Wrong;
use crate::engine::{Schedule, StepControl};
use crate::mechanism::drive_stage::build as build_stage;
use crate::mechanism::motion::{Line, Motion};
use crate::mechanism::pendulum::build as build_pendulum;
use crate::mechanism::{Bearing, Cascade, Commands, Drive, Mechanism};
use crate::scenario::{self, DriveMode, Law, Problem, Scenario};
use nalgebra::{Vector2, Vector3};
use std::sync::Arc;

/// A machine, its motion, how it is to be stepped, and itself without clearance.
#[derive(Debug)]
pub struct Machine {
    /// What is simulated.
    pub mechanism: Mechanism,
    /// What the output body is asked to do.
    pub motion: Arc<dyn Motion>,
    /// The machine as declared, without effects, with ideal joints and prescribed drives: what results
    /// are compared with.
    pub ideal: Ideal,
    /// Which instants are wanted.
    pub schedule: Schedule,
    /// How to step.
    pub control: StepControl,
}

/// Makes the machine that a scenario describes.
///
/// # Errors
/// A motion table that cannot be read, an effect that the machine cannot take.
pub fn assemble(scenario: &Scenario) -> Result<Machine, Problem> {
    let mut motion = motion::of(scenario)?;
    let (mut mechanism, ideal) = match &scenario.mechanism {
        scenario::Mechanism::ThreeRpr(machine) => {
            three_rpr::assemble(scenario, machine, Arc::clone(&motion))
        }
        scenario::Mechanism::DriveStage(stage) => {
            drive_stage::assemble(scenario, stage, Arc::clone(&motion))
        }
        scenario::Mechanism::Pendulum(arm) => {
            motion = pendulum::rest(arm);
            pendulum::assemble(scenario, arm)
        }
    };
    if scenario.contact.law == Law::Native {
        mechanism.native = native::contacts(scenario, &mechanism);
    }
    add_effects(scenario, &mut mechanism)?;
    if !scenario.effects.is_empty() {
        close(scenario, &mut mechanism)?;
    }
    let simulation = &scenario.simulation;
    let schedule = Schedule { duration: simulation.duration, interval: simulation.output_interval };
    Ok(Machine { mechanism, motion, ideal, schedule, control: scenario.step_control() })
}

/// The machine of a scenario with its effects, at rest at the pose (m, m, rad) of its output, under
/// other commands than its motion's. Commands and loads take the start for the time `epoch` in s.
/// What it is simulated from has to be closed first ([`close`]).
///
/// # Errors
/// An effect that the machine cannot take.
pub fn driven(
    scenario: &Scenario,
    pose: Vector3<f64>,
    commands: Arc<dyn Commands>,
    epoch: f64,
) -> Result<Mechanism, Problem> {
    let rest = Line { start: pose.xy(), velocity: Vector2::zeros(), phi: pose.z };
    let mut mechanism = match &scenario.mechanism {
        scenario::Mechanism::ThreeRpr(machine) => {
            three_rpr::assemble(scenario, machine, Arc::new(rest)).0
        }
        scenario::Mechanism::DriveStage(stage) => {
            drive_stage::assemble(scenario, stage, Arc::new(rest)).0
        }
        scenario::Mechanism::Pendulum(arm) => pendulum::assemble(scenario, arm).0,
    };
    mechanism.commands = commands;
    mechanism.epoch = epoch;
    add_effects(scenario, &mut mechanism)?;
    Ok(mechanism)
}

/// A machine of one joint with its effects, somewhere on its way: a drive stage at a length (m) with a
/// rate (m/s) under `commands`, a pendulum at an angle (rad) with a rate (rad/s).
///
/// # Errors
/// A scenario that is none of these, an effect that the machine cannot take.
pub fn started(
    scenario: &Scenario,
    start: [f64; 2],
    commands: Arc<dyn Commands>,
) -> Result<Mechanism, Problem> {
    let gravity: Vector2<f64> = scenario.environment.gravity.into();
    let mut mechanism = match &scenario.mechanism {
        scenario::Mechanism::ThreeRpr(_) => {
            let help = "this takes a drive-stage or a pendulum";
            return Err(scenario.problem("mechanism.kind", "is \"3rpr\"", help));
        }
        scenario::Mechanism::DriveStage(stage) => {
            build_stage(stage.mass, drive(scenario), start, commands, gravity)
        }
        scenario::Mechanism::Pendulum(arm) => {
            build_pendulum(pendulum::arm(arm), bearing(scenario, 0), start, gravity)
        }
    };
    add_effects(scenario, &mut mechanism)?;
    Ok(mechanism)
}

/// Gives the mechanism the scenario's effects.
fn add_effects(scenario: &Scenario, mechanism: &mut Mechanism) -> Result<(), Problem> {
    for (i, effect) in scenario.effects.iter().enumerate() {
        effect.apply(mechanism).map_err(|Wrong { key, message, help }| {
            scenario.problem(&format!("effect.{i}.{key}"), message, help)
        })?;
    }
    Ok(())
}

/// Centres the journals and gives the drives their commanded lengths.
///
/// # Errors
/// Joints that cannot be closed.
pub fn close(scenario: &Scenario, mechanism: &mut Mechanism) -> Result<(), Problem> {
    mechanism.close(0.0).map_err(|gap| open(scenario, gap))
}

fn open(scenario: &Scenario, gap: f64) -> Problem {
    let message = format!("leave the joints open by {gap:.1e} m at the start");
    let help = "smaller offsets and scale errors, or another motion";
    scenario.problem("effect", message, help)
}

/// The drive that a scenario asks for.
pub fn drive(scenario: &Scenario) -> Drive {
    let drive = &scenario.drive;
    match drive.mode {
        DriveMode::Prescribed => Drive::Prescribed,
        DriveMode::Servo => Drive::Servo { stiffness: drive.stiffness, damping: drive.damping },
        DriveMode::Sampled => {
            let sampled = drive.sampled();
            Drive::Sampled(Cascade {
                position_gain: sampled.position_gain,
                velocity_gain: sampled.velocity_gain,
                interval: sampled.interval,
                limit: sampled.limit,
                force_gain: sampled.force_gain,
                lag: sampled.lag,
            })
        }
    }
}

/// Bearing of joint `index`, in the order of the joint columns.
pub(super) fn bearing(scenario: &Scenario, index: usize) -> Bearing {
    let (joints, contact) = (&scenario.joints, &scenario.contact);
    let bearing_radius = joints.bearing_radius;
    let journal_radius = bearing_radius - joints.clearance[index];
    let coefficient = joints.friction[index];
    match contact.law {
        Law::Ideal => Bearing::Ideal,
        Law::Native => Bearing::Native { bearing_radius, journal_radius, friction: coefficient },
        Law::HertzStep => Bearing::Clearance(Clearance {
            bearing_radius,
            journal_radius,
            law: Arc::new(hertz_step(scenario, index)),
            friction: (coefficient > 0.0)
                .then_some(CoulombFriction { coefficient, velocity: contact.friction_velocity }),
        }),
    }
}

/// The Hertz–STEP law of joint `index`.
pub(super) fn hertz_step(scenario: &Scenario, index: usize) -> HertzStep {
    let (joints, contact) = (&scenario.joints, &scenario.contact);
    let material =
        Material { youngs_modulus: contact.youngs_modulus, poisson_ratio: contact.poisson_ratio };
    let journal_radius = joints.bearing_radius - joints.clearance[index];
    let stiffness = contact.stiffness.unwrap_or_else(|| {
        hertz_stiffness(contact.stiffness_form, material, joints.bearing_radius, journal_radius)
    });
    HertzStep {
        stiffness,
        exponent: contact.exponent,
        c_max: contact.c_max,
        d_max: contact.d_max,
        clip: contact.clip,
    }
}

impl Machine {
    /// Stiffness K in N/mⁿ of joint `index` and how long it touches (s) in a lossless hit at `speed`
    /// m/s, under the laws that have a stiffness.
    pub fn contact(&self, scenario: &Scenario, index: usize, speed: f64) -> Option<(f64, f64)> {
        let law = match scenario.contact.law {
            Law::HertzStep => hertz_step(scenario, index),
            Law::Native | Law::Ideal => return None,
        };
        let joint = &self.mechanism.revolutes[index];
        Some((law.stiffness, law.contact_time(self.mechanism.joint_mass(joint), speed)))
    }
}

/// Radial clearance in m of a joint; an ideal one has none. To 1e-15 m, so that the difference of two
/// radii reads as the clearance that was asked for.
pub fn radial_clearance(bearing: &Bearing) -> Option<f64> {
    let radial = match bearing {
        Bearing::Ideal => return None,
        Bearing::Clearance(clearance) => clearance.radial(),
        Bearing::Native { bearing_radius, journal_radius, .. } => bearing_radius - journal_radius,
    };
    Some((radial * 1e15).round() / 1e15)
}
