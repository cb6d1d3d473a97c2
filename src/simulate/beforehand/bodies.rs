//! Masses, inertias and centres of mass that no body has.

use super::finding::Finding;
use crate::mechanism::{Attachment, Body, Mechanism};
use crate::scenario::{self, Problem, Scenario};

/// Density in kg/m³ that no body has: ten times that of lead, for bodies reach farther than their joints.
const LARGEST_DENSITY: f64 = 1.1e5;

/// Radius of gyration, in sizes of the mechanism, beyond which no body can have it, and distance of a centre of mass
/// from every joint of its body: a ring of its mass would reach five times as far as the machine.
const LARGEST_GYRATION: f64 = 5.0;

/// The same in bodies of templates, whose mass is between their joints and little beyond.
const LARGEST_TEMPLATE_GYRATION: f64 = 2.0;

/// What no described body of this machine can have.
pub(super) fn findings(scenario: &Scenario, mechanism: &Mechanism) -> Vec<Finding> {
    let mut found = far_centres(scenario, mechanism);
    if found.is_empty() {
        found = inertias(scenario, mechanism);
    }
    found
}

/// What the bodies hardly have.
pub(super) fn doubts(scenario: &Scenario, mechanism: &Mechanism) -> Vec<Finding> {
    let mut found = masses(scenario, mechanism);
    found.extend(inertia(scenario, mechanism));
    found
}

/// Centres of mass far away from the joints of their bodies, in a machine of the size between its joints.
fn far_centres(scenario: &Scenario, mechanism: &Mechanism) -> Vec<Finding> {
    let Some(described) = scenario.mechanism.described() else { return Vec::new() };
    let indices = (0..mechanism.bodies.len()).map(Some).chain([None]);
    let size = indices.map(|body| extent(mechanism, body)).fold(0.0, f64::max);
    let bodies = described.bodies.iter().enumerate().filter_map(|(place, body)| {
        body.center_of_mass?;
        let index = mechanism.bodies.iter().position(|moving| moving.name == body.name)?;
        let far = points(mechanism, Some(index)).map(|point| point.point.norm());
        let nearest = far.reduce(f64::min)?;
        (size > 0.0 && nearest > LARGEST_GYRATION * size).then(|| {
            let message = format!(
                "lies {nearest:.3} m from the nearest joint of \"{}\", in a machine of {size:.3} m",
                body.name
            );
            let help = "expected m, in the body's own axes: 30 mm are 0.03";
            let key = format!("body.{place}.center_of_mass");
            Finding::error(scenario.problem(&key, message, help))
        })
    });
    bodies.collect()
}

/// Inertias that no body of this machine can have.
fn inertias(scenario: &Scenario, mechanism: &Mechanism) -> Vec<Finding> {
    let Some(described) = scenario.mechanism.described() else { return Vec::new() };
    let size = mechanism.size();
    let bodies = mechanism.bodies.iter().filter_map(|body| {
        let gyration = (body.inertia / body.mass).sqrt();
        described.bodies.iter().position(|described| described.name == body.name)?;
        let key = key_of(scenario, &body.name, "inertia");
        (gyration > LARGEST_GYRATION * size)
            .then(|| Finding::error(gyrating(scenario, &key, body, size)))
    });
    bodies.collect()
}

/// Inertias of templates that are given as a key.
fn inertia(scenario: &Scenario, mechanism: &Mechanism) -> Option<Finding> {
    let (key, name) = match &scenario.mechanism {
        scenario::Mechanism::Pendulum(_) => ("mechanism.inertia", "arm"),
        scenario::Mechanism::ThreeRpr(_) => ("mechanism.platform_inertia", "platform"),
        _ => return None,
    };
    let body = mechanism.bodies.iter().find(|body| body.name == name)?;
    let (gyration, size) = ((body.inertia / body.mass).sqrt(), mechanism.size());
    (gyration > LARGEST_TEMPLATE_GYRATION * size)
        .then(|| Finding::warning(gyrating(scenario, key, body, size)))
}

fn gyrating(scenario: &Scenario, key: &str, body: &Body, size: f64) -> Problem {
    let message = format!(
        "of {} kg m² makes the radius of gyration of \"{}\" {:.3} m, in a machine of {size:.3} m",
        body.inertia,
        body.name,
        (body.inertia / body.mass).sqrt()
    );
    let help = if key.ends_with("shape") {
        "expected m and kg/m³: 12 mm are 0.012"
    } else {
        "expected kg m² about the body's own centre of mass: 1 kg mm² is 1e-6 kg m²"
    };
    scenario.problem(key, message, help)
}

/// The key of a mass or inertia of a body in the file: of its shape where that says it, of the mechanism where a
/// template made the body.
fn key_of(scenario: &Scenario, body: &str, key: &str) -> String {
    let bodies = scenario.mechanism.described().map_or(&[][..], |described| &described.bodies);
    let Some(place) = bodies.iter().position(|described| described.name == body) else {
        return "mechanism".to_owned();
    };
    let own = if key == "mass" { bodies[place].mass } else { bodies[place].inertia };
    let key = if own.is_none() && bodies[place].shape.is_some() { "shape" } else { key };
    format!("body.{place}.{key}")
}

/// Grams for kilograms: bodies heavier than any solid as large as they are between their joints.
fn masses(scenario: &Scenario, mechanism: &Mechanism) -> Vec<Finding> {
    let bodies = mechanism.bodies.iter().enumerate().filter_map(|(i, body)| {
        let extent = extent(mechanism, Some(i));
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
        let help = if key.ends_with("shape") {
            "expected m and kg/m³: 12 mm are 0.012"
        } else {
            "expected kg: 200 g are 0.2"
        };
        Some(Finding::warning(scenario.problem(&key, message, help)))
    });
    bodies.collect()
}

/// The revolute joints' points on a body or, without one, on the ground.
fn points(mechanism: &Mechanism, body: Option<usize>) -> impl Iterator<Item = Attachment> + '_ {
    let revolutes = mechanism.revolutes.iter().flat_map(|joint| [joint.ring, joint.journal]);
    revolutes.filter(move |point| point.body == body)
}

/// The largest distance in m between two revolute joints of a body or of the ground.
fn extent(mechanism: &Mechanism, body: Option<usize>) -> f64 {
    let points: Vec<Attachment> = points(mechanism, body).collect();
    let pairs =
        points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| (a.point - b.point).norm()).fold(0.0, f64::max)
}
