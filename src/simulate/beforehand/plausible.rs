//! Numbers that are legal, and hardly meant: another unit is likely, or a value was forgotten.

use super::finding::Finding;
use super::three_rpr::angle_key;
use super::{bodies, idle, instruments, restraints};
use crate::contact::Clearance;
use crate::mechanism::{Bearing, Mechanism};
use crate::model::Machine;
use crate::scenario::{self, Joint, JointPath, Motion, Revolute, Scenario, Shape, Template};
use std::f64::consts::TAU;

/// Gravity in m/s² beyond which no machine stands on: ten times the earth's, four times Jupiter's.
const LARGEST_GRAVITY: f64 = 100.0;

/// Young's moduli in Pa: of a soft rubber, and more than that of diamond, 1.2e12.
const MODULI: [f64; 2] = [1e5, 2e12];

/// Stiffness in N/m^n that no contact has: that of a tenth of a millimetre of the softest rubber, 1e5 Pa.
const SMALLEST_STIFFNESS: f64 = 10.0;

/// Friction coefficient beyond those of rubber, and of clean metals in vacuum.
const LARGEST_FRICTION: f64 = 2.0;

/// Density in kg/m³ of the lightest foams that machines are made of.
const SMALLEST_DENSITY: f64 = 10.0;

/// Length in m of the longest booms of cranes.
const LARGEST_MACHINE: f64 = 100.0;

/// What is hardly meant.
pub(super) fn findings(scenario: &Scenario, machine: &Machine) -> Vec<Finding> {
    let mut found = Vec::new();
    found.extend(gravity(scenario));
    found.extend(angle(scenario, machine));
    found.extend(starts(scenario));
    found.extend(bodies::doubts(scenario, &machine.mechanism));
    found.extend(phases(scenario));
    found.extend(idle::findings(scenario, machine.ideal.mechanism()));
    found.extend(instruments::findings(scenario, &machine.mechanism));
    found.extend(restraints::findings(scenario, &machine.mechanism));
    found.extend(written(scenario));
    found.extend(rings(scenario, &machine.mechanism));
    found
}

/// What is written in another unit than SI.
fn written(scenario: &Scenario) -> Vec<Finding> {
    let mut found = Vec::new();
    let mut doubt = |key: String, message: String, help: &str| {
        found.push(Finding::warning(scenario.problem(&key, message, help)));
    };
    let modulus = scenario.contact.youngs_modulus;
    if !(MODULI[0]..=MODULI[1]).contains(&modulus) {
        let message = format!("is {modulus:e} Pa, and no solid has that");
        doubt("contact.youngs_modulus".to_owned(), message, "expected Pa: 206 GPa are 206e9");
    }
    for (key, stiffness) in stiffnesses(scenario).filter(|(_, k)| *k < SMALLEST_STIFFNESS) {
        let message = format!("is {stiffness} N/m^n, softer than any rubber");
        doubt(
            key,
            message,
            "expected N/m^1.5 (N/m^n for another exponent): steel on steel is 1e9 and more",
        );
    }
    for (key, friction) in frictions(scenario).filter(|(_, value)| *value > LARGEST_FRICTION) {
        let message = format!("is {friction}, more than rubber has");
        doubt(key, message, "expected a coefficient, such as 0.1; 10 % are 0.1");
    }
    for (key, length) in lengths(scenario).filter(|(_, length)| *length > LARGEST_MACHINE) {
        let help = format!("expected m: {length} mm are {}", length / 1e3);
        doubt(key, format!("makes a machine of {length} m"), &help);
    }
    for (key, density) in densities(scenario).filter(|(_, density)| *density < SMALLEST_DENSITY) {
        let message = format!("is {density} kg/m³, lighter than foam");
        doubt(key, message, &format!("expected kg/m³: {density} g/cm³ are {}", density * 1e3));
    }
    found
}

fn stiffnesses(scenario: &Scenario) -> impl Iterator<Item = (String, f64)> {
    let all = scenario.contact.stiffness.map(|k| ("contact.stiffness".to_owned(), k));
    let joints = scenario.mechanism.described().map_or(&[][..], |described| &described.joints);
    let own = joints.iter().enumerate().filter_map(|(i, joint)| {
        let stiffness = match joint {
            Joint::Revolute(joint) => joint.stiffness,
            Joint::Prismatic(joint) => joint.stiffness,
            Joint::Fixed(_) => None,
        };
        Some((format!("joint.{i}.stiffness"), stiffness?))
    });
    all.into_iter().chain(own)
}

fn frictions(scenario: &Scenario) -> impl Iterator<Item = (String, f64)> {
    let all = scenario.joints.friction.values().iter().copied().fold(0.0, f64::max);
    let joints = scenario.mechanism.described().map_or(&[][..], |described| &described.joints);
    let own = joints.iter().enumerate().filter_map(|(i, joint)| {
        let friction = match joint {
            Joint::Revolute(joint) => joint.friction,
            Joint::Prismatic(joint) => joint.friction,
            Joint::Fixed(_) => None,
        };
        Some((format!("joint.{i}.friction"), friction?))
    });
    [("joints.friction".to_owned(), all)].into_iter().chain(own)
}

/// Rings larger than the whole machine; those of ideal joints are none.
fn rings(scenario: &Scenario, mechanism: &Mechanism) -> Vec<Finding> {
    let size = mechanism.size();
    let large = mechanism.revolutes.iter().filter_map(|joint| match &joint.bearing {
        Bearing::Clearance(Clearance { bearing_radius, .. })
        | Bearing::Native { bearing_radius, .. } => Some((&joint.name, *bearing_radius)),
        Bearing::Ideal => None,
    });
    let mut told = Vec::new();
    for (name, radius) in large.filter(|(_, radius)| *radius > size) {
        let key = own_key(scenario, name, "bearing_radius", |joint| joint.bearing_radius.is_some())
            .unwrap_or_else(|| "joints.bearing_radius".to_owned());
        let message = format!("is {radius} m, in a machine of {size:.3} m");
        let help = format!("expected m: {radius} mm are {}", radius / 1e3);
        told.push((key.clone(), Finding::warning(scenario.problem(&key, message, &help))));
    }
    told.dedup_by(|a, b| a.0 == b.0);
    told.into_iter().map(|(_, finding)| finding).collect()
}

/// The key of what a described revolute joint says for itself, where it does.
pub(super) fn own_key(
    scenario: &Scenario,
    name: &str,
    key: &str,
    says: fn(&Revolute) -> bool,
) -> Option<String> {
    let joints = &scenario.mechanism.described()?.joints;
    let place = joints.iter().position(|joint| joint.name() == name)?;
    match &joints[place] {
        Joint::Revolute(joint) if says(joint) => Some(format!("joint.{place}.{key}")),
        _ => None,
    }
}

fn lengths(scenario: &Scenario) -> impl Iterator<Item = (String, f64)> {
    let template = scenario.mechanism.template().map(Template::distances).unwrap_or_default();
    let template = template.into_iter().map(|(key, l)| (format!("mechanism.{key}"), l));
    let bodies = scenario.mechanism.described().map_or(&[][..], |described| &described.bodies);
    let bodies = bodies.iter().enumerate().map(|(i, body)| {
        let far = body.points.values().flatten().fold(0.0f64, |far, x| far.max(x.abs()));
        (format!("body.{i}.points"), far)
    });
    template.chain(bodies)
}

fn densities(scenario: &Scenario) -> impl Iterator<Item = (String, f64)> {
    let legs = matches!(scenario.mechanism, scenario::Mechanism::ThreeRpr(_))
        .then(|| ("legs.density".to_owned(), scenario.legs.density));
    let bodies = scenario.mechanism.described().map_or(&[][..], |described| &described.bodies);
    let bodies = bodies.iter().enumerate().filter_map(|(i, body)| {
        let (Shape::Bar { density, .. }
        | Shape::Disc { density, .. }
        | Shape::Polygon { density, .. }) = body.shape.as_ref()?;
        Some((format!("body.{i}.shape.density"), *density))
    });
    legs.into_iter().chain(bodies)
}

/// Millimetres for metres.
fn gravity(scenario: &Scenario) -> Option<Finding> {
    let [x, y] = scenario.environment.gravity;
    let size = x.hypot(y);
    (size > LARGEST_GRAVITY).then(|| {
        let message = format!("is {size} m/s², {:.0} times the earth's", size / 9.81);
        let help = "expected m/s²: 9810 mm/s² are 9.81";
        Finding::warning(scenario.problem("environment.gravity", message, help))
    })
}

/// Degrees for radians in the platform's angle.
fn angle(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    let scenario::Mechanism::ThreeRpr(_) = scenario.mechanism else { return None };
    let phi = machine.motion.at(0.0).pose.z;
    (phi.abs() > TAU).then(|| turned(scenario, angle_key(scenario), phi))
}

/// Degrees for radians in where on its way a motion starts.
fn phases(scenario: &Scenario) -> Vec<Finding> {
    let phases: Vec<(String, f64)> = match &scenario.motion {
        Motion::Circle(circle) => vec![("motion.phase".to_owned(), circle.phase)],
        Motion::Multisine(sines) => {
            let terms = sines.terms.iter().enumerate();
            terms.map(|(i, term)| (format!("motion.terms.{i}.phase"), term.phase)).collect()
        }
        Motion::Joints(motions) if scenario.is_list("motion") => {
            let terms = motions.iter().enumerate().flat_map(|(m, motion)| {
                let JointPath::Multisine(sines) = &motion.path else { return Vec::new() };
                let terms = sines.terms.iter().enumerate();
                let key = |i| format!("motion.{m}.terms.{i}.phase");
                terms.map(|(i, term)| (key(i), term.phase)).collect()
            });
            terms.collect()
        }
        _ => Vec::new(),
    };
    // Phases wrap, and who takes several starts goes on beyond a turn; 13 degrees of phase are seldom given.
    let far = phases.into_iter().filter(|(_, phase)| phase.abs() > 2.0 * TAU);
    far.map(|(key, phase)| turned(scenario, &key, phase)).collect()
}

/// Degrees for radians in where bodies start, as it is written; a 3-RPR's start where their motion does, and
/// [`angle`] tells of that.
fn starts(scenario: &Scenario) -> Vec<Finding> {
    let template = scenario.mechanism.template().map(Template::angles).unwrap_or_default();
    let template = template.into_iter().map(|(key, angle)| (format!("mechanism.{key}"), angle));
    let bodies = scenario.mechanism.described().map_or(&[][..], |described| &described.bodies);
    let bodies = bodies.iter().enumerate();
    let bodies = bodies.map(|(i, body)| (format!("body.{i}.start"), body.start[2]));
    let angles = template.chain(bodies);
    let far = angles.filter(|(_, angle)| angle.abs() > TAU);
    far.map(|(key, angle)| turned(scenario, &key, angle)).collect()
}

fn turned(scenario: &Scenario, key: &str, angle: f64) -> Finding {
    let message = format!("has an angle of {angle} rad, more than a whole turn");
    let help = format!("angles are in rad: {angle} degrees are {:.4}", angle.to_radians());
    Finding::warning(scenario.problem(key, message, &help))
}
