//! Hits that lose more or less than declared.

use super::kind::{defaults, linear};
use super::{Joints, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Bearing, Mechanism};

pub(super) const KIND: Kind = Kind {
    name: "contact-damping",
    summary: "hits of journals that lose more or less than declared",
    equation: "damping of the contact law = declared damping (1 + relative)",
    source: "definition",
    trace: "rattle: how fast it dies, how hard the hits are; nothing where a joint's load keeps it shut",
    targets: Targets::JointOrAll(Joints::Bearing),
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
    let wrong = |message: &str, help: &str| {
        Err(Wrong { key: "kind".to_owned(), message: message.to_owned(), help: help.to_owned() })
    };
    for index in setting.revolutes(mechanism)? {
        if relative == 0.0 {
            continue;
        }
        match &mut mechanism.revolutes[index].bearing {
            Bearing::Ideal => {}
            Bearing::Native { .. } => {
                return wrong(
                    "is not possible under contact.law = \"native\"",
                    "the physics engine's own contacts have native.damping_ratio",
                );
            }
            Bearing::Clearance(clearance) => match clearance.law.damped(1.0 + relative) {
                Some(law) => clearance.law = law,
                None => {
                    return wrong(
                        "is not possible under this contact.law",
                        "take a law whose damping is a number of its own",
                    );
                }
            },
        }
    }
    Ok(())
}
