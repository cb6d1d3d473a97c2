//! Numbers that are legal, and hardly meant: another unit is likely, or a value was forgotten.

use super::checks::Finding;
use super::three_rpr::angle_key;
use crate::contact::Clearance;
use crate::effects::Setting;
use crate::mechanism::{Attachment, Bearing, Mechanism};
use crate::model::Machine;
use crate::scenario::{self, Joint, Revolute, Scenario, Shape};
use std::f64::consts::TAU;

/// Gravity in m/s² beyond which no machine stands on: ten times the earth's, four times Jupiter's.
const LARGEST_GRAVITY: f64 = 100.0;

/// Density in kg/m³ that no body has: ten times that of lead, for bodies reach farther than their joints.
const LARGEST_DENSITY: f64 = 1.1e5;

/// Young's moduli in Pa: of a soft rubber, and more than that of diamond, 1.2e12.
const MODULI: [f64; 2] = [1e5, 2e12];

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
    found.extend(starts(scenario, &machine.mechanism));
    found.extend(masses(scenario, &machine.mechanism));
    found.extend(idle(scenario, machine.ideal.mechanism()));
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
    let template: Vec<(String, f64)> = match &scenario.mechanism {
        scenario::Mechanism::ThreeRpr(kind) => {
            let keys = [("base_side", kind.base_side), ("platform_side", kind.platform_side)];
            keys.map(|(key, side)| (format!("mechanism.{key}"), side)).into()
        }
        _ => Vec::new(),
    };
    let bodies = scenario.mechanism.described().map_or(&[][..], |described| &described.bodies);
    let bodies = bodies.iter().enumerate().map(|(i, body)| {
        let far = body.points.values().flatten().fold(0.0f64, |far, x| far.max(x.abs()));
        (format!("body.{i}.points"), far)
    });
    template.into_iter().chain(bodies)
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

/// Effects without values, whose defaults change nothing on the machine as declared: a payload of no mass. (Who
/// writes a zero, or varies from one, means it.)
fn idle(scenario: &Scenario, declared: &Mechanism) -> Vec<Finding> {
    let effects = scenario.effects.iter().enumerate();
    let silent = effects.filter(|(_, setting)| setting.values().next().is_none());
    let idle = silent.filter(|(_, setting)| {
        let variants = setting.kind.variants_of(declared, &setting.target);
        let neutral = |variant: &&[&'static str]| {
            let neutral = Setting::neutral(setting.kind, setting.target.clone(), variant, declared);
            neutral.is_some_and(|neutral| {
                neutral.values().all(|(name, value)| setting.value(name) == Some(value))
            })
        };
        !variants.is_empty() && variants.iter().all(neutral)
    });
    let found = idle.map(|(i, setting)| {
        let message = format!("{setting} has no values, and does nothing without");
        let names: Vec<&str> = setting.kind.parameters.iter().map(|p| p.name).collect();
        let help = format!("give it {}, or leave it out", names.join(", "));
        Finding::warning(scenario.problem(&format!("effect.{i}"), message, &help))
    });
    found.collect()
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

/// Degrees for radians in where bodies start; a 3-RPR's start where their motion does, and [`angle`] tells of that.
fn starts(scenario: &Scenario, mechanism: &Mechanism) -> Vec<Finding> {
    if let scenario::Mechanism::ThreeRpr(_) = scenario.mechanism {
        return Vec::new();
    }
    let far = mechanism.bodies.iter().filter(|body| body.angle.abs() > TAU);
    far.map(|body| turned(scenario, &key_of(scenario, &body.name, "start"), body.angle)).collect()
}

/// The key of a body in the file; of the mechanism where a template made the body.
fn key_of(scenario: &Scenario, body: &str, key: &str) -> String {
    let bodies = scenario.mechanism.described().map_or(&[][..], |described| &described.bodies);
    let place = bodies.iter().position(|described| described.name == body);
    place.map_or_else(|| "mechanism".to_owned(), |place| format!("body.{place}.{key}"))
}

fn turned(scenario: &Scenario, key: &str, angle: f64) -> Finding {
    let message = format!("has an angle of {angle} rad, more than a whole turn");
    let help = format!("angles are in rad: {angle} degrees are {:.4}", angle.to_radians());
    Finding::warning(scenario.problem(key, message, &help))
}

/// Grams for kilograms: bodies heavier than any solid as large as they are between their joints.
fn masses(scenario: &Scenario, mechanism: &Mechanism) -> Vec<Finding> {
    let bodies = mechanism.bodies.iter().enumerate().filter_map(|(i, body)| {
        let extent = extent(mechanism, i);
        if extent <= 0.0 || body.mass <= LARGEST_DENSITY * extent.powi(3) {
            return None;
        }
        let key = match &scenario.mechanism {
            scenario::Mechanism::ThreeRpr(_) if body.name == "platform" => {
                "mechanism.platform_mass".to_owned()
            }
            scenario::Mechanism::ThreeRpr(_) => "legs.density".to_owned(),
            _ => key_of(scenario, &body.name, "mass"),
        };
        let message = format!(
            "makes \"{}\", {extent} m from joint to joint, {} kg heavy: more than ten times a cube of lead of \
             that size",
            body.name, body.mass
        );
        Some(Finding::warning(scenario.problem(&key, message, "expected kg: 200 g are 0.2")))
    });
    bodies.collect()
}

/// The largest distance in m between two joints of a body.
fn extent(mechanism: &Mechanism, body: usize) -> f64 {
    let revolutes = mechanism.revolutes.iter().flat_map(|joint| [joint.ring, joint.journal]);
    let points: Vec<Attachment> = revolutes.filter(|point| point.body == Some(body)).collect();
    let pairs =
        points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| (a.point - b.point).norm()).fold(0.0, f64::max)
}
