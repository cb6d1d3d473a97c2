//! A nut with play on its screw.

use super::drive_compliance::release;
use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Drive, JointIndex, Mechanism, Transmission};

pub(in crate::effects) const KIND: Kind = Kind {
    name: "drive-backlash",
    summary: "play between drive and joint: the rod is free until a flank of the nut meets it, the link until a tooth \
              does",
    equation: "F = k_p p + k_d de/dt with e = q_cmd - q and p = e less what of it lies within +-play/2; F = 0 \
               within, and the second term at most as large as the first: flanks push only. The encoder \
               at the drive reads q + e within the play and q +- play/2 beyond. Under a prescribed drive \
               the flanks have a stiffness and a damping of their own",
    source: "dead-zone model of backlash, drive without mass: Nordin and Gutman, Automatica 38 (2002) 1633-1649",
    trace: "measured pose against measured lengths: two levels, a play apart, by the sign of the actuator's force",
    targets: Targets::JointOrAll(JointKinds::Driven),
    parameters: &[
        Parameter::size("play_m", "m", "how far the rod can move from flank to flank", 0.01, 1e-6),
        Parameter {
            name: "stiffness_N_m",
            unit: "N/m",
            about: "stiffness of the flanks under a prescribed drive; a servo is far softer than they are",
            bounds: [1e4, 1e9],
            step: 1e4,
            default: Some(1e7),
        },
        Parameter {
            name: "damping_Ns_m",
            unit: "N s/m",
            about: "their damping: a few percent of critical for a rod of 0.1 kg on 1e7 N/m",
            bounds: [0.0, 1e5],
            step: 1.0,
            default: Some(100.0),
        },
        Parameter {
            name: "play_rad",
            unit: "rad",
            about: "of a revolute joint's drive in place of play_m",
            bounds: [0.0, 0.5],
            step: 1e-5,
            default: None,
        },
        Parameter {
            name: "stiffness_Nm_rad",
            unit: "N m/rad",
            about: "of a revolute joint's drive in place of stiffness_N_m; where not given, 1e5",
            bounds: [1e2, 1e7],
            step: 1e2,
            default: None,
        },
        Parameter {
            name: "damping_Nms_rad",
            unit: "N m s/rad",
            about: "of a revolute joint's drive in place of damping_Ns_m; where not given, 1",
            bounds: [0.0, 1e3],
            step: 1e-2,
            default: None,
        },
    ],
    variants: &[&["play_m"], &["play_rad"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for index in setting.drives(mechanism)? {
        let joint = &mut mechanism.actuators[index];
        let [play, stiffness, damping] = match joint.joint {
            JointIndex::Prismatic(_) => {
                ["play_m", "stiffness_N_m", "damping_Ns_m"].map(|name| setting.number(name))
            }
            JointIndex::Revolute(_) => [
                setting.number("play_rad"),
                setting.value("stiffness_Nm_rad").unwrap_or(1e5),
                setting.value("damping_Nms_rad").unwrap_or(1.0),
            ],
        };
        if play == 0.0 {
            continue;
        }
        let prescribed = joint.drive == Drive::Prescribed;
        release(joint);
        let link = joint.transmission.get_or_insert(Transmission::default());
        link.play += play;
        if prescribed {
            link.compliance += 1.0 / stiffness;
            link.damping = damping;
        }
    }
    Ok(())
}
