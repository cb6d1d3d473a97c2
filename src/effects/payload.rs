//! A mass on the platform that nobody declared.

use super::{Joints, Kind, Parameter, Setting, Wrong};
use crate::mechanism::Mechanism;
use nalgebra::Vector2;

pub(super) const KIND: Kind = Kind {
    name: "payload",
    summary: "a point mass on the platform",
    equation: "mass and centre of mass of the platform become those of both; \
               I += m M/(M + m) |r|^2 about the common centre",
    source: "parallel axis theorem",
    trace: "actuator forces: with acceleration, and with gravity where there is any",
    joints: Joints::None,
    parameters: &[
        Parameter::size("mass_kg", "kg", "mass m", 20.0, 2e-3),
        Parameter {
            name: "com_x_m",
            unit: "m",
            about: "where it sits, along the platform's x axis from its centre",
            bounds: [-0.3, 0.3],
            step: 2e-3,
            default: Some(0.0),
        },
        Parameter {
            name: "com_y_m",
            unit: "m",
            about: "where it sits, along the platform's y axis from its centre",
            bounds: [-0.3, 0.3],
            step: 2e-3,
            default: Some(0.0),
        },
    ],
    variants: &[&["mass_kg", "com_x_m", "com_y_m"]],
    neutral: super::kind::defaults,
    starts: |_| vec![vec![0.05, 0.0, 0.0]],
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let point = Vector2::new(setting.number("com_x_m"), setting.number("com_y_m"));
    mechanism.add_point_mass(mechanism.output, setting.number("mass_kg"), point);
    Ok(())
}
