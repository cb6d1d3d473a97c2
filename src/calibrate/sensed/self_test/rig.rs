//! The rig of a trial: a machine of a family in another size, with other play, noise and sensors.

use super::Trial;
use super::families::Family;
use crate::model::expand;
use crate::scenario::{
    Body, Described, Joint, JointDrive, Mechanism, Problem, Problems, Quantity, Scenario, Shape,
};

/// What a machine of another size is multiplied by, unit by unit.
#[derive(Clone, Copy)]
struct Scale {
    length: f64,
    mass: f64,
    inertia: f64,
}

impl Scale {
    fn of(trial: &Trial) -> Self {
        let (length, mass) = (trial.size, trial.size.powf(trial.mass_exponent));
        Self { length, mass, inertia: mass * length * length }
    }
}

/// The rig of a family, as a described mechanism.
///
/// # Errors
/// A text that is no rig.
pub(super) fn of_family(family: &Family) -> Result<Scenario, Problem> {
    match Scenario::from_text(&family.text.concat(), "self-test rig", &[]) {
        Ok(rig) => expand(&rig),
        Err(Problems(mut problems)) => Err(problems.swap_remove(0)),
    }
}

/// The rig that a trial's maker declares.
///
/// # Errors
/// A family whose text is no rig.
pub(super) fn rig(trial: &Trial) -> Result<Scenario, Problem> {
    let mut rig = of_family(trial.family())?;
    let scale = Scale::of(trial);
    rig.name.clone_from(&trial.machine);
    rig.environment.gravity = [0.0, if trial.gravity { -9.81 } else { 0.0 }];
    // Light machines with the contact damping of heavy ones would be glued to their rings.
    rig.contact.c_max *= scale.mass;
    rig.joints.bearing_radius *= scale.length;
    if let Mechanism::Described(described) = &mut rig.mechanism {
        resized(described, scale, trial);
        instruments(described, scale, trial);
    }
    Ok(rig)
}

/// Lengths, masses and gains; drives keep their natural frequencies.
fn resized(described: &mut Described, scale: Scale, trial: &Trial) {
    let place = |point: &mut [f64; 2]| point.iter_mut().for_each(|x| *x *= scale.length);
    described.ground.points.values_mut().for_each(place);
    for body in &mut described.bodies {
        let Body { mass, inertia, center_of_mass, points, start, shape, .. } = body;
        mass.iter_mut().for_each(|mass| *mass *= scale.mass);
        inertia.iter_mut().for_each(|inertia| *inertia *= scale.inertia);
        points.values_mut().chain(center_of_mass).for_each(place);
        start[..2].iter_mut().for_each(|x| *x *= scale.length);
        if let Some(Shape::Bar { diameter, .. }) = shape {
            *diameter *= scale.length;
        }
    }
    let prismatic = prismatic(described);
    for joint in &mut described.joints {
        match joint {
            Joint::Revolute(joint) => {
                joint.bearing_radius.iter_mut().for_each(|radius| *radius *= scale.length);
                if let Some(clearance) = &mut joint.clearance {
                    *clearance = trial.clearance_m;
                    joint.friction = Some(trial.friction);
                }
            }
            Joint::Prismatic(joint) => {
                joint.range.iter_mut().flatten().for_each(|end| *end *= scale.length);
            }
            Joint::Fixed(_) => {}
        }
    }
    for drive in &mut described.drives {
        let JointDrive::Servo(servo) = drive else { continue };
        let inert = if prismatic.contains(&servo.joint) { scale.mass } else { scale.inertia };
        servo.stiffness *= inert;
        servo.damping *= inert;
    }
}

/// Names of the prismatic joints.
fn prismatic(described: &Described) -> Vec<String> {
    let joints = described.joints.iter();
    joints
        .filter(|joint| matches!(joint, Joint::Prismatic(_)))
        .map(|joint| joint.name().to_owned())
        .collect()
}

/// The sensors that the trial has, with its noise: what they read grows with the machine, and so does their noise.
fn instruments(described: &mut Described, scale: Scale, trial: &Trial) {
    let prismatic = prismatic(described);
    described.sensors.retain(|sensor| {
        sensor.quantity == Quantity::Command || trial.columns.contains(&sensor.column)
    });
    for sensor in &mut described.sensors {
        let straight = prismatic.contains(&sensor.of);
        let by = match sensor.quantity {
            Quantity::Force | Quantity::Output if straight => scale.mass,
            Quantity::Force | Quantity::Output => scale.mass * scale.length,
            Quantity::X | Quantity::Y => scale.length,
            Quantity::Position if straight => scale.length,
            Quantity::Position
            | Quantity::Angle
            | Quantity::Acceleration
            | Quantity::Command
            | Quantity::Added => 1.0,
        };
        sensor.std *= by * trial.noise;
        sensor.resolution *= by * trial.noise;
    }
}
