//! Hits that lose more or less than declared.

use super::contact_law::change;
use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "contact-damping",
    summary: "hits of journals that lose more or less than declared",
    equation: "damping of the contact law = declared damping (1 + relative)",
    source: "definition",
    trace: "rattle: how fast it dies, how hard the hits are; nothing where a joint's load keeps it shut",
    targets: Targets::JointOrAll(JointKinds::Bearing),
    parameters: &[Parameter {
        name: "relative",
        unit: "",
        about: "relative error of the contact law's damping",
        bounds: [-1.0, 100.0],
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
    let relative = setting.number("relative");
    // Of a law without damping nothing is asked where nothing is changed.
    if relative == 0.0 {
        return setting.revolutes(mechanism).map(|_| ());
    }
    let help = "take a law whose damping is a number of its own";
    change(setting, mechanism, help, |law| law.damped(1.0 + relative))
}
