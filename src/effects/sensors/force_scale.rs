//! A force or torque sensor with a wrong scale.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Senses, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "force-scale",
    summary: "a sensor of a drive's force or torque with a wrong scale: a motor constant beside its datasheet",
    equation: "shows F (1 + relative)",
    source: "definition",
    trace: "that column: in proportion to itself, whatever the motion",
    targets: Targets::Sensor(Senses::Effort),
    parameters: &[Parameter {
        name: "relative",
        unit: "",
        about: "relative error of the scale",
        bounds: [-0.9, 9.0],
        step: 1e-3,
        default: Some(0.0),
    }],
    variants: &[&["relative"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for index in setting.sensors(mechanism)? {
        mechanism.sensors[index].scale *= 1.0 + setting.number("relative");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{SLIDER_CRANK, closed};

    #[test]
    fn the_column_is_scaled_and_shifted_and_the_drive_is_not() {
        let effects = "[[effect]]\nkind = \"force-scale\"\nsensor = \"T_O\"\nrelative = 0.1\n\
                       [[effect]]\nkind = \"force-offset\"\nsensor = \"T_O\"\noffset = 0.25\n";
        let [plain, off] = ["", effects].map(|effects| closed(&format!("{SLIDER_CRANK}{effects}")));
        let torque = plain.shows("T_O");
        assert!(torque.abs() > 1e-2 && (off.effort(0) - torque).abs() < 1e-9, "{torque}");
        assert!((off.shows("T_O") - (1.1 * torque + 0.25)).abs() < 1e-9);
    }
}
