//! Keys that an override gives and that cannot act on this machine.

use super::finding::Finding;
use crate::mechanism::{Bearing, Drive};
use crate::model::Machine;
use crate::scenario::{Law, Scenario};

/// Keys that somebody set (`--set`) and that this machine does not look at, for commands that simulate it as it is;
/// what stands in a file may be there for another day.
pub fn unacting(scenario: &Scenario, machine: &Machine) -> Vec<Finding> {
    let mechanism = &machine.mechanism;
    let bearings = || mechanism.revolutes.iter().map(|joint| &joint.bearing);
    let native = bearings().any(|bearing| matches!(bearing, Bearing::Native { .. }));
    let servo = mechanism.actuators.iter().any(|a| matches!(a.drive, Drive::Servo { .. }));
    let rubs = bearings().any(|bearing| match bearing {
        Bearing::Clearance(clearance) => clearance.friction.is_some(),
        _ => false,
    });
    let ideal =
        scenario.contact.law == Law::Ideal && bearings().all(|b| matches!(b, Bearing::Ideal));
    let stiff = scenario.contact.stiffness.is_some();
    let cases = [
        ("drive.stiffness", !servo, "no drive is a servo", "set drive.mode=servo"),
        ("drive.damping", !servo, "no drive is a servo", "set drive.mode=servo"),
        ("native", !native, "no contact is the physics engine's own", "set contact.law=native"),
        (
            "contact.friction_velocity",
            !rubs && !native,
            "no joint with a contact law has friction",
            "set joints.friction",
        ),
        ("joints.clearance", ideal, "all joints are ideal", "take contact.law = \"ideal\" out"),
        ("contact.youngs_modulus", stiff, "contact.stiffness is given", "take that out"),
        ("contact.poisson_ratio", stiff, "contact.stiffness is given", "take that out"),
    ];
    let idle = cases.into_iter().filter(|(_, idle, ..)| *idle);
    let set = idle.filter_map(|(key, _, because, help)| {
        let path = scenario.set_by_override(key)?;
        let message = format!("changes nothing: {because}");
        let help = format!("{help}, or leave it out");
        Some(Finding::warning(scenario.problem(path, message, help)))
    });
    set.collect()
}
