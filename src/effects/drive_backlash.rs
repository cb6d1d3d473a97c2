//! A nut with play on its screw.

use super::drive_compliance::release;
use super::kind::{defaults, linear};
use super::{Joints, Kind, Parameter, Setting, Wrong};
use crate::mechanism::{Drive, Mechanism, Transmission};

pub(super) const KIND: Kind = Kind {
    name: "drive-backlash",
    summary: "play between drive and rod: the rod is free until a flank of the nut meets it",
    equation: "F = k_p p + k_d de/dt with e = q_cmd - q and p = e less what of it lies within +-play/2; F = 0 \
               within, and the second term at most as large as the first: flanks push only. The encoder \
               at the drive reads q + e within the play and q +- play/2 beyond. Under a prescribed drive \
               the flanks have a stiffness and a damping of their own",
    source: "dead-zone model of backlash, drive without mass: Nordin and Gutman, Automatica 38 (2002) 1633-1649",
    trace: "measured pose against measured lengths: two levels, a play apart, by the sign of the actuator's force",
    joints: Joints::PrismaticOrAll,
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
    ],
    variants: &[&["play_m"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let play = setting.number("play_m");
    for index in setting.slide_drives(mechanism)? {
        if play == 0.0 {
            continue;
        }
        let joint = &mut mechanism.actuators[index];
        let prescribed = joint.drive == Drive::Prescribed;
        release(joint);
        let link = joint.transmission.get_or_insert(Transmission::default());
        link.play += play;
        if prescribed {
            link.compliance += 1.0 / setting.number("stiffness_N_m");
            link.damping = setting.number("damping_Ns_m");
        }
    }
    Ok(())
}
