//! A joint with another clearance than declared.

use crate::effects::kind::linear;
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Bearing, Mechanism};

pub(in crate::effects) const KIND: Kind = Kind {
    name: "joint-wear",
    summary: "a joint whose clearance is not the declared one",
    equation: "journal radius = bearing radius - clearance_m; the bearing keeps its radius",
    source: "geometry",
    trace: "measured pose against measured lengths: the change of clearance, in the direction of the joint's force",
    targets: Targets::Joint(JointKinds::Bearing),
    parameters: &[Parameter {
        name: "clearance_m",
        unit: "m",
        about: "what the clearance really is",
        bounds: [1e-9, 0.01],
        step: 5e-6,
        default: None,
    }],
    variants: &[&["clearance_m"]],
    neutral: |mechanism, setting| {
        let joint = mechanism.revolutes.iter().find(|j| setting.joint() == Some(j.name.as_str()));
        vec![match joint.map(|joint| &joint.bearing) {
            Some(Bearing::Clearance(clearance)) => clearance.radial(),
            Some(Bearing::Native { bearing_radius, journal_radius, .. }) => {
                bearing_radius - journal_radius
            }
            Some(Bearing::Ideal) | None => 0.0,
        }]
    },
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let Some(worn) = setting.value("clearance_m") else {
        return Err(Wrong {
            key: "clearance_m".to_owned(),
            message: "is missing for the effect joint-wear".to_owned(),
            help: "write clearance_m = …: what the clearance really is".to_owned(),
        });
    };
    for index in setting.revolutes(mechanism)? {
        let joint = &mut mechanism.revolutes[index];
        let (bearing_radius, journal_radius) = match &mut joint.bearing {
            Bearing::Clearance(c) => (c.bearing_radius, &mut c.journal_radius),
            Bearing::Native { bearing_radius, journal_radius, .. } => {
                (*bearing_radius, journal_radius)
            }
            // The machine without clearance stays what it is.
            Bearing::Ideal => continue,
        };
        if worn >= bearing_radius {
            return Err(Wrong {
                key: "clearance_m".to_owned(),
                message: format!("is {worn}"),
                help: format!("expected below the bearing's radius, {bearing_radius} m"),
            });
        }
        if let Some(shape) = joint.out_of_round.as_ref().filter(|shape| worn <= shape.narrowing()) {
            return Err(Wrong {
                key: "clearance_m".to_owned(),
                message: format!("is {worn}"),
                help: format!("expected above the ring's out-of-round, {} m", shape.narrowing()),
            });
        }
        *journal_radius = bearing_radius - worn;
    }
    Ok(())
}
