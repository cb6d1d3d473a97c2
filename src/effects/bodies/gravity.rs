//! Gravity other than declared: a table out of level.

use crate::effects::kind::linear;
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;
use nalgebra::Vector2;

const fn component(name: &'static str, about: &'static str) -> Parameter {
    Parameter { name, unit: "m/s^2", about, bounds: [-30.0, 30.0], step: 0.02, default: None }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "gravity",
    summary: "gravity in the plane of motion, where the machine declares another: a table out of level",
    equation: "force m g on every body",
    source: "Newton",
    trace: "actuator forces: constant directions, changing with the pose only",
    targets: Targets::Machine,
    parameters: &[
        component("gx_m_s2", "along x; where not given, as declared"),
        component("gy_m_s2", "along y; where not given, as declared"),
    ],
    variants: &[&["gx_m_s2", "gy_m_s2"]],
    neutral: |mechanism, _| vec![mechanism.gravity.x, mechanism.gravity.y],
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    mechanism.gravity = Vector2::new(
        setting.value("gx_m_s2").unwrap_or(mechanism.gravity.x),
        setting.value("gy_m_s2").unwrap_or(mechanism.gravity.y),
    );
    Ok(())
}
