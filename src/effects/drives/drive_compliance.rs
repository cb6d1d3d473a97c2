//! A drive that is not rigidly connected to its joint.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Actuator, Drive, JointIndex, Mechanism, Transmission};

/// Compliance in m/N or rad/(N·m) below which a prescribed drive stays rigid: its motion would ask for steps below
/// 5 µs and differ from the rigid one by a nanometre per newton.
const RIGID: f64 = 1e-9;

/// Stiffness in N/m or N·m/rad with which a prescribed drive holds its end of a link that gives: a million times
/// any link's, so that the link alone counts.
const HELD: f64 = 1e15;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "drive-compliance",
    summary: "an elastic link between drive and joint: a belt, a coupling, a long screw",
    equation: "read = true coordinate + compliance F, F the force on the rod or the torque in the joint: the encoder \
               sits at the drive. \
               Servo and link are springs and dampers in series, the drive's end without mass: \
               F = k k_p/(k + k_p) e + (k^2 k_d + k_p^2 d)/(k + k_p)^2 de/dt, k = 1/compliance, \
               e = q_cmd - q; a prescribed drive holds its end as commanded",
    source: "springs in series; massless drive to first order in frequency",
    trace: "measured pose against measured lengths: with the force of the same actuator",
    targets: Targets::JointOrAll(JointKinds::Driven),
    parameters: &[
        Parameter::size(
            "compliance_m_N",
            "m/N",
            "give of the link, 1/k; under 1e-9 m/N a prescribed drive stays rigid",
            1e-3,
            1e-7,
        ),
        Parameter {
            name: "damping_Ns_m",
            unit: "N s/m",
            about: "damping d of the link: a few percent of critical for a rod of 0.1 kg on 1e6 N/m",
            bounds: [0.0, 1e5],
            step: 1.0,
            default: Some(20.0),
        },
        Parameter {
            name: "compliance_rad_Nm",
            unit: "rad/(N m)",
            about: "of a revolute joint's drive in place of compliance_m_N",
            bounds: [0.0, 1.0],
            step: 1e-4,
            default: None,
        },
        Parameter {
            name: "damping_Nms_rad",
            unit: "N m s/rad",
            about: "of a revolute joint's drive in place of damping_Ns_m; where not given, none",
            bounds: [0.0, 1e3],
            step: 1e-3,
            default: None,
        },
    ],
    variants: &[&["compliance_m_N"], &["compliance_rad_Nm"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

/// Lets the motor of a prescribed drive hold the end of a link in place of the rod.
pub(super) fn release(joint: &mut Actuator) {
    if joint.drive == Drive::Prescribed {
        joint.drive = Drive::Servo { stiffness: HELD, damping: 0.0 };
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for index in setting.drives(mechanism)? {
        let joint = &mut mechanism.actuators[index];
        let [compliance, damping] = match joint.joint {
            JointIndex::Prismatic(_) => ["compliance_m_N", "damping_Ns_m"],
            JointIndex::Revolute(_) => ["compliance_rad_Nm", "damping_Nms_rad"],
        }
        .map(|name| setting.number(name));
        if compliance == 0.0 || joint.drive == Drive::Prescribed && compliance < RIGID {
            continue;
        }
        release(joint);
        let link = joint.transmission.get_or_insert(Transmission::default());
        link.compliance += compliance;
        link.damping = damping;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{TURNTABLE, closed};
    use crate::mechanism::Drive;

    /// A coupling of 1/k behind a servo k_p: together k k_p/(k + k_p).
    #[test]
    fn a_coupling_of_a_revolute_drive_gives_in_series_with_its_servo() {
        let keys = "joint = \"O\"\ncompliance_rad_Nm = 1e-3\n";
        let mut rig =
            closed(&format!("{TURNTABLE}[[effect]]\nkind = \"drive-compliance\"\n{keys}"));
        assert!(matches!(rig.mechanism.actuators[0].drive, Drive::Servo { .. }));
        rig.turn(0, 0.01);
        let expected = -0.01 * 400.0 * 1000.0 / 1400.0;
        assert!((rig.effort(0) - expected).abs() < 1e-9, "{} {expected}", rig.effort(0));
        // The encoder sits at the drive's end.
        assert!((rig.reads("q_O") - (0.51 + 1e-3 * expected)).abs() < 1e-9);
    }
}
