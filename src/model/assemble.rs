//! The only way from a scenario to a machine.

use super::built::build::{Built, build};
use super::built::declared_drives::kind_of_drives;
use super::built::layout::Layout;
use super::built::parts::Parts;
use super::drives::{Followed, command, follow};
use super::ideal::{Ideal, States};
use super::path::DrivenPath;
use super::templates::expand;
use super::{motion, native};
use crate::contact::ForceLaw;
use crate::effects::Wrong;
use crate::engine::{Schedule, StepControl};
use crate::mechanism::motion::{Line, Motion};
use crate::mechanism::{
    Bearing, BodyState, Commands, Imposed, Mechanism, TelescopicLegs, Tracker, angle_near,
};
use crate::scenario::{self, Problem, Scenario};
use nalgebra::{UnitComplex, Vector2, Vector3};
use std::sync::Arc;

/// A machine, its motion, how it is to be stepped, and itself without clearance.
///
/// ```
/// use freeplay::prelude::*;
///
/// let mut machine = assemble(&Scenario::load(None, &[])?)?;
/// assert_eq!((machine.mechanism.revolutes.len(), machine.mechanism.actuators.len()), (6, 3));
/// // The machine without clearance is where the motion asks for.
/// let asked = machine.motion.at(0.1).pose;
/// assert!((machine.ideal.at(0.1).position - asked.xy()).norm() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Machine {
    /// What is simulated.
    pub mechanism: Mechanism,
    /// What the target of the motion is asked to do; rest where joints are moved, or nothing.
    pub motion: Arc<dyn Motion>,
    /// Time in s up to which the motion was said.
    pub known_until: f64,
    /// The machine as declared, without effects, with ideal joints and prescribed drives: what results
    /// are compared with.
    pub ideal: Ideal,
    /// Kind of its drives as declared; "none" without any, "mixed" where they differ.
    pub drives: &'static str,
    /// Largest error (m, rad) of the drives' commands where they come from a table of the inverse kinematics.
    pub table_error: Option<f64>,
    /// Which columns its results have.
    pub layout: Layout,
    /// Which instants are wanted.
    pub schedule: Schedule,
    /// How to step.
    pub control: StepControl,
    /// Shortest and longest length that each driven prismatic joint is declared to have, in m.
    pub(super) ranges: Vec<Option<[f64; 2]>>,
}

/// A machine put together at its start, before its effects.
struct Assembled {
    built: Built,
    motion: Arc<dyn Motion>,
    known_until: f64,
    followed: Followed,
    ranges: Vec<Option<[f64; 2]>>,
}

/// Makes the machine that a scenario describes.
///
/// # Errors
/// A table that cannot be read, a machine that cannot be put together, an effect that it cannot take.
pub fn assemble(scenario: &Scenario) -> Result<Machine, Problem> {
    let scenario = &expand(scenario)?;
    let motion = motion::path(scenario)?;
    let Assembled { built, motion, known_until, followed, ranges } =
        put_together(scenario, motion)?;
    let Followed { legs, table_error } = followed;
    let Built { mut mechanism, mut layout, laws, .. } = built;
    let simulation = &scenario.simulation;
    let schedule = Schedule { duration: simulation.duration, interval: simulation.output_interval };
    let control = scenario.step_control();
    let ideal = ideal(&mechanism, legs, schedule, control);
    let drives = kind_of_drives(&mechanism);
    if mechanism.revolutes.iter().any(|joint| matches!(joint.bearing, Bearing::Native { .. })) {
        mechanism.native = native::contacts(scenario, &mechanism, &laws);
    }
    add_effects(scenario, &mut mechanism)?;
    if !scenario.effects.is_empty() {
        close(scenario, &mut mechanism)?;
        layout.follow(&mechanism.names);
    }
    Ok(Machine {
        mechanism,
        motion,
        known_until,
        ideal,
        drives,
        table_error,
        layout,
        schedule,
        control,
        ranges,
    })
}

/// The machine of a scenario with its effects, at rest at the pose (m, m, rad) of its output, under
/// other commands than its motion's. Commands and loads take the start for the time `epoch` in s.
/// What it is simulated from has to be closed first ([`close`]).
///
/// # Errors
/// A pose that it cannot take, an effect that the machine cannot take.
pub fn driven(
    scenario: &Scenario,
    pose: Vector3<f64>,
    commands: Arc<dyn Commands>,
    epoch: f64,
) -> Result<Mechanism, Problem> {
    let scenario = &expand(scenario)?;
    let rest = Line { start: pose.xy(), velocity: Vector2::zeros(), phi: pose.z };
    let mut mechanism = put_together(scenario, Arc::new(rest))?.built.mechanism;
    mechanism.commands = commands;
    mechanism.epoch = epoch;
    add_effects(scenario, &mut mechanism)?;
    Ok(mechanism)
}

/// The bodies, joints, drives and sensors of a scenario, not yet put together.
///
/// # Errors
/// A template whose machine cannot be put together.
pub fn parts_of(scenario: &Scenario) -> Result<Mechanism, Problem> {
    let scenario = &expand(scenario)?;
    Ok(build(scenario, described(scenario)).mechanism)
}

/// The machine of a scenario with its effects, under the commands and with the joints held that `begin` gives
/// it, closed at its epoch.
///
/// # Errors
/// Joints that do not close there, an effect that the machine cannot take.
pub fn recorded(
    scenario: &Scenario,
    begin: &mut dyn FnMut(&mut Mechanism),
) -> Result<Mechanism, Problem> {
    let scenario = &expand(scenario)?;
    let described = described(scenario);
    let mut built = build(scenario, described);
    fixed_parts(scenario, described, &built.parts)?;
    let mechanism = &mut built.mechanism;
    begin(mechanism);
    mechanism.assemble(0.0).map_err(|open| super::path::open(scenario, mechanism, open))?;
    add_effects(scenario, mechanism)?;
    if !scenario.effects.is_empty() {
        close(scenario, mechanism)?;
    }
    Ok(built.mechanism)
}

/// The description of an expanded scenario.
fn described(scenario: &Scenario) -> &scenario::Described {
    static NONE: std::sync::LazyLock<scenario::Described> =
        std::sync::LazyLock::new(scenario::Described::default);
    scenario.mechanism.described().unwrap_or(&NONE)
}

/// Builds an expanded scenario, gives its drives their commands, and closes its joints.
fn put_together(scenario: &Scenario, path: Arc<dyn Motion>) -> Result<Assembled, Problem> {
    let described = described(scenario);
    let mut built = build(scenario, described);
    fixed_parts(scenario, described, &built.parts)?;
    let mut followed = Followed::default();
    let known_until = match &scenario.target {
        Some(target) => {
            followed = follow(scenario, &mut built, target, &path)?;
            path.known_until()
        }
        None => command(scenario, &mut built, described)?,
    };
    match &followed.legs {
        Some(legs) => {
            for (body, state) in built.mechanism.bodies.iter_mut().zip(legs.states(0.0)) {
                body.angle = angle_near(state.rotation, body.angle);
                body.start = state;
            }
            if let Some(target) = built.mechanism.bodies.get_mut(built.mechanism.output) {
                target.angle = path.at(0.0).pose.z;
            }
        }
        None => {
            built
                .mechanism
                .assemble(0.0)
                .map_err(|open| super::path::open(scenario, &built.mechanism, open))?;
        }
    }
    let ranges = ranges(&built.mechanism, described);
    Ok(Assembled { built, motion: path, known_until, followed, ranges })
}

/// Distance (m) and angle (rad) to which fixed joints of the same bodies agree.
const FITS: f64 = 1e-9;

/// Fixed joints that contradict each other, and other joints between bodies that fixed joints make one.
fn fixed_parts(
    scenario: &Scenario,
    described: &scenario::Described,
    parts: &Parts,
) -> Result<(), Problem> {
    for (i, joint) in described.joints.iter().enumerate() {
        let [(first, angle), (second, other)] = joint.points().map(|(_, point)| parts.point(point));
        if first.body != second.body {
            continue;
        }
        let key = format!("joint.{i}");
        let scenario::Joint::Fixed(fixed) = joint else {
            let message = format!(
                "\"{}\" joins two parts that fixed joints make one body, or ground",
                joint.name()
            );
            let help = "take it out, or the fixed joint";
            return Err(scenario.problem(&key, message, help));
        };
        let gap = (first.point - second.point).norm();
        let turned = UnitComplex::new(other - angle - fixed.angle).angle().abs();
        if gap > FITS || turned > FITS {
            let message = format!(
                "\"{}\" contradicts the other fixed joints of its bodies: {:.3} mm and {turned:.4} rad are \
                 left between its points",
                fixed.name,
                1e3 * gap
            );
            let help = "one fixed joint holds two bodies; a second one must fit";
            return Err(scenario.problem(&key, message, help));
        }
    }
    Ok(())
}

/// The declared range of each drive's joint.
fn ranges(mechanism: &Mechanism, described: &scenario::Described) -> Vec<Option<[f64; 2]>> {
    let range = |name: &str| {
        described.joints.iter().find_map(|joint| match joint {
            scenario::Joint::Prismatic(joint) if joint.name == name => joint.range,
            _ => None,
        })
    };
    mechanism.actuators.iter().map(|actuator| range(&actuator.name)).collect()
}

/// The machine without clearance, by whatever says where it is.
fn ideal(
    mechanism: &Mechanism,
    legs: Option<TelescopicLegs>,
    schedule: Schedule,
    control: StepControl,
) -> Ideal {
    let ideal = mechanism.without_clearance();
    if let Some(legs) = legs {
        return Ideal::new(ideal, States::Legs(legs));
    }
    let starts: Vec<BodyState> = ideal.bodies.iter().map(|body| body.start).collect();
    let freedoms = ideal.freedoms(&starts);
    let determined = freedoms.loose.is_empty() && !ideal.actuators.is_empty();
    let tracker = determined
        .then(|| Tracker::new(ideal.clone(), Imposed::Drives, starts, 0.0).ok())
        .flatten();
    let states = match tracker {
        Some(tracker) => States::Tracked(Box::new(tracker)),
        None => States::Simulated { schedule, control, rows: Vec::new() },
    };
    Ideal::new(ideal, states)
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

/// Centres the journals and gives the drives their commanded coordinates.
///
/// # Errors
/// Joints that cannot be closed.
pub fn close(scenario: &Scenario, mechanism: &mut Mechanism) -> Result<(), Problem> {
    mechanism.close(0.0).map_err(|gap| {
        let message = format!("leave the joints open by {gap:.1e} m at the start");
        let help = "smaller offsets and scale errors, or another motion";
        scenario.problem("effect", message, help)
    })
}

impl Machine {
    /// The force law of joint `index`, and how long (s) it touches in a lossless hit at `speed` m/s.
    pub fn contact(&self, index: usize, speed: f64) -> Option<(&dyn ForceLaw, f64)> {
        let joint = &self.mechanism.revolutes[index];
        let Bearing::Clearance(clearance) = &joint.bearing else { return None };
        let law = &*clearance.law;
        Some((law, law.contact_time(self.mechanism.joint_mass(joint), speed)))
    }

    /// The driven path of the machine without clearance, looked at from end to end; none where the motion
    /// leaves the machine a freedom.
    pub fn driven_path(&mut self) -> Option<DrivenPath> {
        let ranges = self.ranges.clone();
        self.ideal
            .is_kinematic()
            .then(|| DrivenPath::of(&mut self.ideal, self.schedule.duration, &ranges))
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
