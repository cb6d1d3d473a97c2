//! A base joint that is not where it was declared.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;
use nalgebra::Vector2;

const fn component(name: &'static str, about: &'static str) -> Parameter {
    Parameter { name, unit: "m", about, bounds: [-0.05, 0.05], step: 1e-5, default: Some(0.0) }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "anchor-offset",
    summary: "a base joint beside its declared place",
    equation: "A = A declared + (dx, dy)",
    source: "geometry",
    trace: "measured pose against measured lengths: -u.(dx, dy), u the leg's direction",
    targets: Targets::Joint(JointKinds::Anchor),
    parameters: &[
        component("dx_m", "where it really is along x, less declared"),
        component("dy_m", "where it really is along y, less declared"),
    ],
    variants: &[&["dx_m", "dy_m"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for index in setting.revolutes(mechanism)? {
        let joint = &mut mechanism.revolutes[index];
        if joint.ring.body.is_some() {
            return Err(Wrong {
                key: "joint".to_owned(),
                message: format!("the bearing of {} is not on the base", joint.name),
                help: "name a joint whose bearing is: it is the base that may be off".to_owned(),
            });
        }
        joint.ring.point += Vector2::new(setting.number("dx_m"), setting.number("dy_m"));
    }
    Ok(())
}
