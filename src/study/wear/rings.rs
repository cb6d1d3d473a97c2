//! The rings of a machine that wear, before and after.

use super::around::wearing;
use super::stage::Stage;
use crate::contact::Play;
use crate::engine::WEAR_DIRECTIONS;
use crate::mechanism::{Bearing, Mechanism};
use crate::model::{Machine, radial_clearance};
use crate::scenario::{self, Joint, JointPath, Motion, Problem, Scenario};
use std::f64::consts::TAU;

/// A ring that wears.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    /// Its joint, among the revolute ones.
    pub joint: usize,
    pub name: String,
    /// Declared radial clearance in m.
    pub clearance: f64,
    /// Inner radius in m.
    pub radius: f64,
    /// Axial length in m.
    pub length: f64,
    /// Wear coefficient in 1/Pa.
    pub coefficient: f64,
}

impl Ring {
    /// What its journal can reach on a machine that is not worn yet.
    pub fn play(&self, mechanism: &Mechanism) -> Play {
        let shape = mechanism.revolutes[self.joint].out_of_round.as_ref();
        Play::of(self.clearance, shape, WEAR_DIRECTIONS)
    }

    /// A room after so many cycles with `rubbed` J each, direction by direction.
    pub fn worn(&self, play: &Play, rubbed: &[f64], cycles: f64) -> Play {
        let area = self.coefficient / self.length * cycles;
        let areas: Vec<f64> = rubbed.iter().map(|work| work * area).collect();
        let mut worn = play.clone();
        worn.wear(&areas, self.radius);
        worn
    }

    /// Volume in m³ between two rooms.
    pub fn volume(&self, new: &Play, worn: &Play) -> f64 {
        TAU * self.radius * self.length * (worn.mean() - new.mean())
    }
}

/// The rings of a scenario that wear; `expanded` is its machine body by body.
///
/// # Errors
/// No contact law anywhere, or no wear coefficient where there is one.
pub(super) fn of(
    scenario: &Scenario,
    expanded: &Scenario,
    machine: &Machine,
) -> Result<Vec<Ring>, Problem> {
    let contact = &scenario.contact;
    let mechanism = &machine.mechanism;
    let joints = wearing(mechanism);
    if joints.is_empty() {
        let message = "leaves nothing that wears: no joint has clearance under a contact law";
        let help = "give joints.clearance, and a contact.law other than native and ideal";
        return Err(scenario.problem("contact.law", message, help));
    }
    let described = expanded.mechanism.described();
    let own = |name: &str| {
        let mut joints = described.into_iter().flat_map(|described| &described.joints);
        joints.find_map(|joint| match joint {
            Joint::Revolute(joint) if joint.name == name => joint.wear_coefficient,
            _ => None,
        })
    };
    let ring = |joint: usize| {
        let revolute = &mechanism.revolutes[joint];
        let Bearing::Clearance(clearance) = &revolute.bearing else { return None };
        let coefficient = own(&revolute.name).or(contact.wear_coefficient)?;
        let radius = clearance.bearing_radius;
        Some(Ring {
            joint,
            name: revolute.name.clone(),
            clearance: radial_clearance(&revolute.bearing)?,
            radius,
            length: contact.length.unwrap_or(2.0 * radius),
            coefficient,
        })
    };
    let rings: Vec<Ring> = joints.iter().filter_map(|joint| ring(*joint)).collect();
    if rings.iter().all(|ring| ring.coefficient == 0.0) {
        let message = "is missing: nothing says how much rings wear";
        let help = "write contact.wear_coefficient = … (1/Pa), the dimensionless wear coefficient over the hardness: \
                    about 1e-12 for dry mild steel on itself, 1e-14 for hard dry pairs, 1e-16 with boundary lubrication";
        return Err(scenario.problem("contact.wear_coefficient", message, help));
    }
    Ok(rings)
}

/// The worn machine: each ring with the profile of the last stage.
pub(super) fn worn(expanded: &Scenario, rings: &[Ring], stages: &[Stage]) -> Scenario {
    let mut worn = expanded.clone();
    let (scenario::Mechanism::Described(described), Some(last)) =
        (&mut worn.mechanism, stages.last())
    else {
        return worn;
    };
    for joint in &mut described.joints {
        let Joint::Revolute(joint) = joint else { continue };
        let found = rings.iter().zip(&last.plays).find(|(ring, _)| ring.name == joint.name);
        if let Some((ring, play)) = found {
            joint.profile = Some(play.widening(ring.clearance));
        }
    }
    worn
}

/// See [`period_of`](super::period_of).
pub(super) fn period(scenario: &Scenario) -> Option<f64> {
    // What nothing drives falls and swings: a motion stands in the scenario by default only.
    if !scenario.mechanism.uses("motion") {
        return None;
    }
    match &scenario.motion {
        Motion::Circle(circle) => Some(circle.period),
        Motion::Joints(motions) => match motions.as_slice() {
            [motion] => match &motion.path {
                JointPath::Line(line) if line.velocity != 0.0 => Some(TAU / line.velocity.abs()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    }
}
