//! Links heavier or lighter than declared.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "leg-density",
    summary: "links heavier or lighter than declared; the platform is not one of them",
    equation: "m = declared m (1 + relative), I = declared I (1 + relative) of every body but the platform",
    source: "definition",
    trace: "actuator forces: as a payload, but with the motion of the legs; not at all in the pose",
    targets: Targets::Machine,
    parameters: &[Parameter {
        name: "relative",
        unit: "",
        about: "relative error of the density",
        bounds: [-0.9, 10.0],
        step: 1e-2,
        default: Some(0.0),
    }],
    variants: &[&["relative"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let factor = 1.0 + setting.number("relative");
    let output = mechanism.output;
    for (index, body) in mechanism.bodies.iter_mut().enumerate() {
        if index != output {
            body.mass *= factor;
            body.inertia *= factor;
        }
    }
    Ok(())
}
