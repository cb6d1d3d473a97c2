//! A mass on a body that nobody declared.

use super::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;
use nalgebra::Vector2;

pub(super) const KIND: Kind = Kind {
    name: "payload",
    summary: "a point mass on a body: the platform, where none is named",
    equation: "mass and centre of mass of the body become those of both; \
               I += m M/(M + m) |r|^2 about the common centre",
    source: "parallel axis theorem",
    trace: "actuator forces: with acceleration, and with gravity where there is any",
    targets: Targets::Body,
    parameters: &[
        Parameter::size("mass_kg", "kg", "mass m", 20.0, 2e-3),
        Parameter {
            name: "com_x_m",
            unit: "m",
            about: "where it sits, along the x axis of the body's own axes, from their origin",
            bounds: [-0.3, 0.3],
            step: 2e-3,
            default: Some(0.0),
        },
        Parameter {
            name: "com_y_m",
            unit: "m",
            about: "where it sits, along the y axis of the body's own axes, from their origin",
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
    let (body, axes) = setting.body(mechanism)?;
    let point = axes.origin.point + axes.turned(point);
    mechanism.add_point_mass(body, setting.number("mass_kg"), point);
    Ok(())
}
