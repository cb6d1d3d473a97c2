//! Everything that can be said of a scenario without simulating it.

use super::chaos::{WINDOW, engines_apart};
use crate::engine::TYPICAL_IMPACT_SPEED;
use crate::mechanism::motion::looks;
use crate::mechanism::{Actuator, Body, BodyState, Drive, JointIndex, Loop, Mechanism, Revolute};
use crate::model::DrivenPath;
use crate::scenario::{self, Law, Problem, Scenario};
use crate::simulate::unacting;
use crate::simulate::{
    Finding, Machine, OwnError, Severity, driven_path, findings_along, leg_use, neutral,
    radial_clearance,
};
use serde::Serialize;

/// Fewest instants at which the ideal machine's forces are looked at.
const INSTANTS: usize = 1000;

/// Distance from singularity in m that is none but for rounding: there the forces have no bound.
const NO_DISTANCE: f64 = 1e-9;

/// What a scenario describes, and what is wrong or doubtful about it.
///
/// [`check`](check()) has an example.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// Whether a run would start.
    pub ok: bool,
    /// Errors and warnings.
    pub findings: Vec<FindingText>,
    /// What the rest says; absent if the scenario could not be read.
    #[serde(flatten)]
    pub machine: Option<CheckedMachine>,
}

/// A finding as plain text.
#[derive(Clone, Debug, Serialize)]
pub struct FindingText {
    /// Error or warning.
    pub severity: Severity,
    /// Dotted path of the key; empty if the file as a whole is meant.
    pub key: String,
    /// Where it was written.
    pub location: String,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
    /// All of it as one line.
    #[serde(skip)]
    pub text: String,
}

/// What a scenario describes.
#[derive(Clone, Debug, Serialize)]
pub struct CheckedMachine {
    /// Name of the scenario.
    pub scenario_name: String,
    /// SHA-256 of the effective scenario.
    pub scenario_hash: String,
    /// Simulated time in s.
    pub duration_s: f64,
    /// Side of the base triangle in m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base_side_m: Option<f64>,
    /// Side of the platform triangle in m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub platform_side_m: Option<f64>,
    /// Name, mass (kg) and inertia (kg m²) of each body.
    pub bodies: Vec<CheckedBody>,
    /// How far each leg travels.
    pub legs: Vec<CheckedLeg>,
    /// Largest speed of a leg in m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fastest_leg_m_s: Option<f64>,
    /// Smallest distance from singularity in m; zero if the motion passes through one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub singularity_distance_m: Option<f64>,
    /// When it comes closest, in s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub singularity_time_s: Option<f64>,
    /// The platform's circumradius in m, which that distance is to be compared with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub platform_circumradius_m: Option<f64>,
    /// Contact law.
    pub law: Law,
    /// The revolute joints.
    pub joints: Vec<CheckedJoint>,
    /// Speed in m/s that a hit is taken to have in the figures on contacts and steps.
    pub impact_speed_m_s: f64,
    /// Longest fixed step in s that resolves the hits and the servos; none where nothing limits it.
    pub longest_step_s: Option<f64>,
    /// Fixed step asked for in s, if it is fixed.
    pub step_s: Option<f64>,
    /// Velocity error allowed for one step in m/s, if the step follows it.
    pub tolerance_m_s: Option<f64>,
    /// Kind of the drives; "none" without any, "mixed" where they differ.
    pub drive: &'static str,
    /// The driven joints.
    pub drives: Vec<CheckedDrive>,
    /// Largest error (m, rad) of the drives' commands where they come from a table of the inverse kinematics.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table_error: Option<f64>,
    /// How the machine without clearance can move.
    pub freedoms: CheckedFreedoms,
    /// Closed loops of revolute joints, and the area that each runs around: its sign is the branch on which the
    /// machine is put together.
    pub loops: Vec<CheckedLoop>,
    /// Gains of the first servo in N/m and N s/m (of a revolute joint N m/rad and N m s/rad), if there is one.
    #[serde(rename = "servo_stiffness_N_m")]
    pub servo_stiffness: Option<f64>,
    /// See there.
    #[serde(rename = "servo_damping_Ns_m")]
    pub servo_damping: Option<f64>,
    /// What the machine without clearance needs; none at a singularity.
    pub ideal: Option<IdealNeeds>,
    /// How far the physics engine and the equations of motion integrated directly are apart; absent where nobody
    /// asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub engines: Option<Engines>,
}

/// The same machine stepped by the physics engine, and by direct integration.
#[derive(Clone, Debug, Serialize)]
pub struct Engines {
    /// Velocity error allowed for one step in m/s, of both.
    pub tolerance_m_s: f64,
    /// Time that was looked at in s.
    pub looked_at_s: f64,
    /// How far they are apart; none where one of them breaks down.
    pub apart: Option<OwnError>,
}

impl Engines {
    /// Runs both over what can be predicted of a machine, at most as long as its scenario says. `None` where it
    /// steps without error control: contacts of the physics engine's own are nobody else's.
    pub fn of(machine: &Machine) -> Option<Self> {
        let tolerance_m_s = machine.control.tolerance()?;
        let looked_at_s = machine.schedule.duration.min(WINDOW);
        let apart = engines_apart(&machine.mechanism, tolerance_m_s, machine.schedule);
        Some(Self { tolerance_m_s, looked_at_s, apart })
    }
}

/// One body.
#[derive(Clone, Debug, Serialize)]
pub struct CheckedBody {
    /// Name.
    pub name: String,
    /// Mass in kg.
    pub mass_kg: f64,
    /// Inertia about the centre of mass in kg m².
    pub inertia_kg_m2: f64,
}

/// One leg's travel.
#[derive(Clone, Debug, Serialize)]
pub struct CheckedLeg {
    /// Shortest and longest length that the motion asks for, in m.
    pub used_m: [f64; 2],
    /// Shortest and longest length that the leg has, in m.
    pub stroke_m: [f64; 2],
}

/// One driven joint.
#[derive(Clone, Debug, Serialize)]
pub struct CheckedDrive {
    /// Name of the joint.
    pub joint: String,
    /// "m" or "rad".
    pub unit: &'static str,
    /// Smallest and largest coordinate that the motion asks for; none where nothing is asked.
    pub used: Option<[f64; 2]>,
    /// Largest rate, m/s or rad/s.
    pub fastest: Option<f64>,
    /// How fast the drive moves in shares of the machine's fastest point, at worst along the motion; zero in a
    /// singular pose.
    pub share_of_fastest_point: Option<f64>,
}

/// How the machine without clearance can move.
#[derive(Clone, Debug, Serialize)]
pub struct CheckedFreedoms {
    /// By Grübler's count: three for each body less those that joints take.
    pub counted: i64,
    /// By the rank of the joints' Jacobian.
    pub free: usize,
    /// Those that drives with a command determine.
    pub driven: usize,
    /// Joints whose conditions depend on each other.
    pub redundant: Vec<String>,
    /// Bodies that can move although every drive holds.
    pub loose: Vec<String>,
}

/// One closed loop.
#[derive(Clone, Debug, Serialize)]
pub struct CheckedLoop {
    /// Its joints in order.
    pub joints: Vec<String>,
    /// Signed area of their polygon at the start in m², positive where they run counterclockwise.
    pub area_m2: f64,
}

/// One revolute joint.
#[derive(Clone, Debug, Serialize)]
pub struct CheckedJoint {
    /// Name.
    pub joint: String,
    /// Radial clearance in m; none of an ideal joint.
    pub clearance_m: Option<f64>,
    /// Contact stiffness K in N/mⁿ (n is `contact.exponent`, 1 under kelvin-voigt); none where the law has none.
    #[serde(rename = "stiffness_N_m_n")]
    pub stiffness: Option<f64>,
    /// How long a hit lasts, in s.
    pub contact_time_s: Option<f64>,
}

/// What the machine without clearance needs for the motion.
#[derive(Clone, Debug, Serialize)]
pub struct IdealNeeds {
    /// Smallest and largest effort of each drive in N or N·m.
    #[serde(rename = "actuator_forces_N")]
    pub actuator_forces: Vec<[f64; 2]>,
    /// Largest |(a_x, a_y)| of the platform in m/s².
    pub peak_platform_acceleration_m_s2: f64,
}

impl Check {
    /// The check of a scenario that could not even be read or assembled.
    pub fn unreadable(problems: Vec<Problem>) -> Check {
        let findings = problems.into_iter().map(|problem| found(Finding::error(problem)));
        Check { ok: false, findings: findings.collect(), machine: None }
    }
}

fn found(finding: Finding) -> FindingText {
    let problem = finding.problem;
    FindingText {
        text: problem.to_string(),
        severity: finding.severity,
        key: problem.path,
        location: problem.location.to_string(),
        message: problem.message,
        help: problem.help,
    }
}

/// Looks at a machine from all sides.
///
/// ```
/// use freeplay::prelude::*;
/// use freeplay::study::check;
///
/// let scenario = Scenario::load(None, &[])?;
/// let check = check(&scenario, &mut assemble(&scenario)?);
/// let machine = check.machine.unwrap();
/// assert!(check.ok);
/// assert_eq!((machine.joints.len(), machine.freedoms.free, machine.freedoms.driven), (6, 3, 3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check(scenario: &Scenario, machine: &mut Machine) -> Check {
    let path = driven_path(scenario, machine);
    let mut findings = findings_along(scenario, machine, path.as_ref());
    findings.extend(neutral(scenario));
    findings.extend(unacting(scenario, machine));
    let ok = findings.iter().all(|finding| finding.severity != Severity::Error);
    let kind = match &scenario.mechanism {
        scenario::Mechanism::ThreeRpr(kind) => Some(kind),
        _ => None,
    };
    let reach = kind.map(|kind| leg_use(scenario, kind, &*machine.motion));
    let regular = reach.as_ref().is_none_or(|reach| reach.singularity_distance > NO_DISTANCE)
        && path.as_ref().is_none_or(|path| path.stuck.is_none())
        && machine.ideal.is_kinematic();
    let ideal = regular.then(|| ideal(machine, path.as_ref()));
    let mechanism = &machine.mechanism;
    let stroke_m = scenario.legs.stroke;
    let gains = mechanism.actuators.iter().find_map(|actuator| match actuator.drive {
        Drive::Servo { stiffness, damping } => Some([stiffness, damping]),
        _ => None,
    });
    let (step_s, tolerance_m_s) = (machine.control.step(), machine.control.tolerance());
    let machine = CheckedMachine {
        scenario_name: scenario.name.clone(),
        scenario_hash: scenario.hash(),
        duration_s: scenario.simulation.duration,
        base_side_m: kind.map(|kind| kind.base_side),
        platform_side_m: kind.map(|kind| kind.platform_side),
        bodies: bodies(mechanism),
        legs: reach
            .iter()
            .flat_map(|reach| reach.lengths)
            .map(|used_m| CheckedLeg { used_m, stroke_m })
            .collect(),
        fastest_leg_m_s: reach.as_ref().map(|reach| reach.fastest_leg),
        singularity_distance_m: reach.as_ref().map(|reach| reach.singularity_distance),
        singularity_time_s: reach.as_ref().map(|reach| reach.singularity_time),
        platform_circumradius_m: kind.map(|kind| kind.platform_side / 3f64.sqrt()),
        law: scenario.contact.law,
        joints: joints(machine),
        impact_speed_m_s: TYPICAL_IMPACT_SPEED,
        longest_step_s: mechanism.longest_step(TYPICAL_IMPACT_SPEED),
        step_s,
        tolerance_m_s,
        drive: machine.drives,
        drives: drives(mechanism, path.as_ref()),
        table_error: machine.table_error,
        freedoms: freedoms(mechanism),
        loops: loops(mechanism),
        servo_stiffness: gains.map(|[stiffness, _]| stiffness),
        servo_damping: gains.map(|[_, damping]| damping),
        ideal,
        engines: None,
    };
    Check { ok, findings: findings.into_iter().map(found).collect(), machine: Some(machine) }
}

fn starts(mechanism: &Mechanism) -> Vec<BodyState> {
    mechanism.bodies.iter().map(|body| body.start).collect()
}

fn bodies(mechanism: &Mechanism) -> Vec<CheckedBody> {
    let body = |body: &Body| CheckedBody {
        name: body.name.clone(),
        mass_kg: body.mass,
        inertia_kg_m2: body.inertia,
    };
    mechanism.bodies.iter().map(body).collect()
}

fn joints(machine: &Machine) -> Vec<CheckedJoint> {
    let joint = |(i, joint): (usize, &Revolute)| {
        let contact = machine.contact(i, TYPICAL_IMPACT_SPEED);
        CheckedJoint {
            joint: joint.name.clone(),
            clearance_m: radial_clearance(&joint.bearing),
            stiffness: contact.and_then(|(law, _)| law.stiffness()),
            contact_time_s: contact.map(|(_, time)| time),
        }
    };
    machine.mechanism.revolutes.iter().enumerate().map(joint).collect()
}

fn drives(mechanism: &Mechanism, path: Option<&DrivenPath>) -> Vec<CheckedDrive> {
    let drive = |(i, actuator): (usize, &Actuator)| {
        let finite = |range: &[f64; 2]| range[0].is_finite().then_some(*range);
        CheckedDrive {
            joint: actuator.name.clone(),
            unit: match actuator.joint {
                JointIndex::Revolute(_) => "rad",
                JointIndex::Prismatic(_) => "m",
            },
            used: path.and_then(|path| finite(&path.used[i])),
            fastest: path.map(|path| path.fastest[i]),
            share_of_fastest_point: path
                .and_then(|path| path.singular)
                .filter(|singular| singular.drive == i)
                .map(|singular| singular.share),
        }
    };
    mechanism.actuators.iter().enumerate().map(drive).collect()
}

fn freedoms(mechanism: &Mechanism) -> CheckedFreedoms {
    let freedoms = mechanism.without_clearance().freedoms(&starts(mechanism));
    let joint = |joint: &JointIndex| mechanism.joint_name(*joint).to_owned();
    CheckedFreedoms {
        counted: freedoms.counted,
        free: freedoms.free,
        driven: freedoms.driven,
        redundant: freedoms.redundant.iter().map(joint).collect(),
        loose: freedoms.loose.iter().map(|&body| mechanism.bodies[body].name.clone()).collect(),
    }
}

fn loops(mechanism: &Mechanism) -> Vec<CheckedLoop> {
    let states = starts(mechanism);
    let checked = |of: Loop| CheckedLoop {
        joints: of.joints.iter().map(|&joint| mechanism.joint_name(joint).to_owned()).collect(),
        area_m2: mechanism.signed_area(&of, &states),
    };
    mechanism.loops().into_iter().filter(|of| mechanism.has_branches(of)).map(checked).collect()
}

/// Extremes of the ideal machine over the motion, at the poses of its path where these are more.
fn ideal(machine: &mut Machine, path: Option<&DrivenPath>) -> IdealNeeds {
    let drives = machine.mechanism.actuators.len();
    let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; drives];
    let mut peak = 0.0f64;
    let instants: Vec<f64> = match path {
        Some(path) if path.instants.len() > INSTANTS => path.instants.clone(),
        _ => looks(&*machine.motion, machine.schedule.duration, INSTANTS).collect(),
    };
    for t in instants {
        let ideal = machine.ideal.at(t);
        for ([low, high], force) in ranges.iter_mut().zip(ideal.drive_forces) {
            *low = low.min(*force);
            *high = high.max(*force);
        }
        peak = peak.max(ideal.acceleration.xy().norm());
    }
    IdealNeeds { actuator_forces: ranges, peak_platform_acceleration_m_s2: peak }
}
