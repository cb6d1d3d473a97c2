//! Dry friction between journal and bearing.

use crate::contact::CoulombFriction;
use crate::effects::kind::linear;
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Bearing, Mechanism};

/// Sliding speed in m/s at which friction is near its full value where the machine has none of its
/// own to say: that of a scenario's `contact.friction_velocity`.
const SLIDING_SPEED: f64 = 1e-3;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "journal-friction",
    summary: "Coulomb friction between journals and bearings",
    equation: "mu F_N tanh(v_t/v_s) at the contact point, against the sliding v_t, on both bodies",
    source: "Coulomb; tanh as a smooth sign",
    trace: "with load: torques that follow the directions in which the joints turn; without: quieter rattle",
    targets: Targets::JointOrAll(JointKinds::Bearing),
    parameters: &[Parameter::size(
        "mu",
        "",
        "coefficient of friction, in place of the declared one",
        2.0,
        0.02,
    )],
    variants: &[&["mu"]],
    // Joints that are not declared alike have no coefficient in common that leaves them as they are.
    neutral: |mechanism, setting| {
        let joints = setting.revolutes(mechanism).unwrap_or_default().into_iter();
        let mut declared = joints.filter_map(|joint| declared(&mechanism.revolutes[joint].bearing));
        let first = declared.next().unwrap_or(0.0);
        if declared.all(|other| other == first) { vec![first] } else { Vec::new() }
    },
    starts: linear,
    scan: None,
    apply,
};

/// The coefficient of friction that a joint with clearance has without the effect.
fn declared(bearing: &Bearing) -> Option<f64> {
    match bearing {
        Bearing::Clearance(clearance) => Some(clearance.friction.map_or(0.0, |f| f.coefficient())),
        Bearing::Native { friction, .. } => Some(*friction),
        Bearing::Ideal => None,
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let coefficient = setting.number("mu");
    for index in setting.revolutes(mechanism)? {
        match &mut mechanism.revolutes[index].bearing {
            Bearing::Clearance(clearance) => {
                let coulomb = CoulombFriction { coefficient, velocity: SLIDING_SPEED };
                clearance.friction = Some(match clearance.friction {
                    Some(friction) => friction.with_coefficient(coefficient),
                    None => coulomb.into(),
                });
            }
            Bearing::Native { friction, .. } => *friction = coefficient,
            Bearing::Ideal => {}
        }
    }
    Ok(())
}
