//! Where laws and stiffnesses of conforming surfaces end.

use super::finding::Finding;
use super::plausible::own_key;
use crate::contact::StiffnessForm;
use crate::engine::TYPICAL_IMPACT_SPEED;
use crate::mechanism::Bearing;
use crate::model::{Machine, radial_clearance};
use crate::scenario::Scenario;

/// Clearance in m below which the conformal stiffness, which grows like 1/√c, is far beyond that of
/// any real contact: at 1e-6 m it is a hundred times that of two convex bodies.
const SMALLEST_CONFORMAL_CLEARANCE: f64 = 1e-6;

/// What is beyond their ends.
pub(super) fn findings(scenario: &Scenario, machine: &Machine) -> Vec<Finding> {
    let checks = [stiffness_form, too_loose, too_deep];
    checks.iter().filter_map(|check| check(scenario, machine)).collect()
}

/// A conformal stiffness out of its range.
fn stiffness_form(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    let contact = &scenario.contact;
    let joints = machine.mechanism.revolutes.iter();
    let under_law = joints.filter(|joint| matches!(joint.bearing, Bearing::Clearance(_)));
    let clearances = under_law.filter_map(|joint| radial_clearance(&joint.bearing));
    let smallest = clearances.fold(f64::INFINITY, f64::min);
    let computed =
        contact.stiffness.is_none() && contact.stiffness_form == StiffnessForm::Conformal;
    (computed && smallest < SMALLEST_CONFORMAL_CLEARANCE).then(|| {
        let message = format!(
            "is conformal at a clearance of {smallest:e} m: this stiffness grows without bound as \
             the clearance vanishes"
        );
        let help = "give contact.stiffness, or use \"printed\"";
        Finding::warning(scenario.problem("contact.stiffness_form", message, help))
    })
}

/// A clearance larger than a law of conforming surfaces is meant for.
fn too_loose(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    machine.mechanism.revolutes.iter().find_map(|joint| {
        let Bearing::Clearance(clearance) = &joint.bearing else { return None };
        let ratio = clearance.radial() / clearance.bearing_radius;
        let valid = clearance.law.valid_clearance()?;
        (ratio > valid).then(|| {
            let message = format!(
                "is of surfaces that conform, up to a clearance of {valid} of the ring's radius, and that of {} is \
                 {ratio:.2}",
                joint.name
            );
            let help = "take the law \"liu\", which holds for any clearance, or a smaller clearance";
            Finding::warning(scenario.problem(&law_key(scenario, &joint.name), message, help))
        })
    })
}

/// A hit that goes deeper than the formula of its law holds.
fn too_deep(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    let mechanism = &machine.mechanism;
    mechanism.revolutes.iter().find_map(|joint| {
        let Bearing::Clearance(clearance) = &joint.bearing else { return None };
        let valid = clearance.law.valid_depth()?;
        let mass = mechanism.joint_mass(joint);
        let depth = clearance.law.deepest_penetration(mass, TYPICAL_IMPACT_SPEED);
        (depth > valid).then(|| {
            let message = format!(
                "holds down to {valid:.1e} m in the joint {}, and a hit at {TYPICAL_IMPACT_SPEED} m/s goes \
                 {depth:.1e} m deep: beyond, its tangent is taken",
                joint.name
            );
            let help = "take the law \"liu\", which holds for small clearances, or a larger clearance";
            Finding::warning(scenario.problem(&law_key(scenario, &joint.name), message, help))
        })
    })
}

/// Where the law of a joint is written.
fn law_key(scenario: &Scenario, joint: &str) -> String {
    own_key(scenario, joint, "law", |joint| joint.law.is_some())
        .unwrap_or_else(|| "contact.law".to_owned())
}
