//! A bearing ring that is not a circle.

use crate::contact::{OutOfRound, RingShape};
use crate::effects::kind::defaults;
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Bearing, Mechanism};
use std::f64::consts::TAU;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "out-of-round",
    summary: "a bearing ring that is not a circle: oval, or as a three-jaw chuck left it",
    equation: "clearance in direction theta of the ring's body: c + amplitude cos(lobes (theta - direction)); \
               the normal force acts along the gradient of the penetration",
    source: "roundness as a Fourier series, ISO 12181-1",
    trace: "measured pose against measured lengths: with the direction of the joint's force, lobes times a turn",
    targets: Targets::Joint(JointKinds::Bearing),
    parameters: &[
        Parameter::size(
            "amplitude_m",
            "m",
            "amplitude, smaller than the joint's clearance",
            0.01,
            5e-6,
        ),
        Parameter {
            name: "lobes",
            unit: "",
            about: "wide places round the ring, a whole number: 2 for an oval",
            bounds: [1.0, 50.0],
            step: 1.0,
            default: Some(2.0),
        },
        Parameter {
            name: "direction_rad",
            unit: "rad",
            about: "direction of one of the wide places in the ring's body, from its x axis",
            bounds: [-1e3, 1e3],
            step: 1e-2,
            default: Some(0.0),
        },
    ],
    variants: &[&["amplitude_m", "direction_rad"]],
    neutral: defaults,
    // A slight oval in eight directions of its half turn: it has to be less than the clearance.
    starts: |_, _| (0..8).map(|k| vec![5e-6, TAU * f64::from(k) / 16.0]).collect(),
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [amplitude, lobes, direction] =
        ["amplitude_m", "lobes", "direction_rad"].map(|name| setting.number(name));
    let wrong = |key: &str, message: String, help: String| {
        Err(Wrong { key: key.to_owned(), message, help })
    };
    if lobes != lobes.round() {
        let help = "expected a whole number: the ring closes after one turn".to_owned();
        return wrong("lobes", format!("is {lobes}"), help);
    }
    for index in setting.revolutes(mechanism)? {
        if amplitude == 0.0 {
            continue;
        }
        let joint = &mut mechanism.revolutes[index];
        match &joint.bearing {
            // The machine without clearance stays what it is.
            Bearing::Ideal => continue,
            Bearing::Native { .. } => {
                let message = "is not possible under contact.law = \"native\"".to_owned();
                let help =
                    "the physics engine's own contacts are made on round rings: take another law";
                return wrong("kind", message, help.to_owned());
            }
            Bearing::Clearance(clearance) if amplitude.abs() >= clearance.radial() => {
                let radial = clearance.radial();
                let help = format!("expected below the joint's clearance, {radial:.3e} m");
                return wrong("amplitude_m", format!("is {amplitude}"), help);
            }
            Bearing::Clearance(_) if matches!(joint.out_of_round, Some(RingShape::Table(_))) => {
                let help = "take one out: the profile can have the waves in it";
                return wrong(
                    "kind",
                    "is not possible on a ring that has a profile".to_owned(),
                    help.to_owned(),
                );
            }
            Bearing::Clearance(_) => {
                joint.out_of_round = Some(OutOfRound { amplitude, lobes, direction }.into());
            }
        }
    }
    Ok(())
}
