//! Drives as a description has them.

use super::layout::Layout;
use super::names::joint_named;
use crate::mechanism::{Actuator, Cascade, Drive, Mechanism};
use crate::scenario::{Described, DriveMode, JointDrive, Motion, Sampled, Scenario};

pub(super) fn add_drives(
    scenario: &Scenario,
    described: &Described,
    mechanism: &mut Mechanism,
    layout: &mut Layout,
) {
    for drive in &described.drives {
        add_drive(mechanism, drive.joint(), joint_drive(drive));
        layout.drives.push(drive.label());
    }
    // Joints that are moved and have no drive of their own follow as `[drive]` says.
    if let Motion::Joints(motions) = &scenario.motion {
        for motion in motions {
            if !mechanism.actuators.iter().any(|actuator| actuator.name == motion.joint) {
                add_drive(mechanism, &motion.joint, drive(scenario));
                layout.drives.push(format!("_{}", motion.joint));
            }
        }
    }
}

fn add_drive(mechanism: &mut Mechanism, name: &str, drive: Drive) {
    if let Some(joint) = joint_named(mechanism, name) {
        mechanism.actuators.push(Actuator::new(name, joint, drive));
    }
}

/// The drive that `[drive]` asks for.
pub fn drive(scenario: &Scenario) -> Drive {
    let drive = &scenario.drive;
    match drive.mode {
        DriveMode::Prescribed => Drive::Prescribed,
        DriveMode::Servo => Drive::Servo { stiffness: drive.stiffness, damping: drive.damping },
        DriveMode::Sampled => Drive::Sampled(cascade(&drive.sampled())),
    }
}

/// The kind that all drives have; "none" without any, "mixed" where they differ.
pub(in crate::model) fn kind_of_drives(mechanism: &Mechanism) -> &'static str {
    let kind = |drive: &Drive| match drive {
        Drive::Prescribed => "prescribed",
        Drive::Servo { .. } => "servo",
        Drive::Sampled(_) => "sampled",
        Drive::Effort => "force",
    };
    let mut kinds = mechanism.actuators.iter().map(|actuator| kind(&actuator.drive));
    let Some(first) = kinds.next() else { return "none" };
    if kinds.all(|kind| kind == first) { first } else { "mixed" }
}

fn joint_drive(drive: &JointDrive) -> Drive {
    match drive {
        JointDrive::Prescribed(_) => Drive::Prescribed,
        JointDrive::Servo(servo) => {
            Drive::Servo { stiffness: servo.stiffness, damping: servo.damping }
        }
        JointDrive::Sampled(sampled) => Drive::Sampled(cascade(&sampled.controller)),
        JointDrive::Force(_) => Drive::Effort,
    }
}

fn cascade(sampled: &Sampled) -> Cascade {
    Cascade {
        position_gain: sampled.position_gain,
        velocity_gain: sampled.velocity_gain,
        interval: sampled.interval,
        limit: sampled.limit,
        force_gain: sampled.force_gain,
        lag: sampled.lag,
    }
}
