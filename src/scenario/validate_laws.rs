//! Keys of contact laws: those that mean nothing to the law that is chosen, and values that no law takes.

use super::{Joint, Law, Problem, Revolute, Scenario};
use crate::contact::laws::{self, Kind, Range};
use std::collections::BTreeSet;

/// All that is wrong with the parameters of contact laws, in `[contact]` and in joints.
pub(super) fn problems(scenario: &Scenario) -> Vec<Problem> {
    let contact = &scenario.contact;
    let used = used(scenario);
    let mut found = Vec::new();
    for key in keys() {
        let path = format!("contact.{key}");
        if scenario.origins.has(&path) && !used.iter().any(|law| law.takes(key)) {
            found.push(stranger(scenario, &path, key, contact.law));
        }
    }
    let numbers = [
        ("restitution", contact.restitution),
        ("damping", contact.damping),
        ("length", contact.length),
    ];
    found.extend(
        numbers.into_iter().filter_map(|(key, value)| {
            out_of_range(scenario, &format!("contact.{key}"), key, value?)
        }),
    );
    found.extend(friction(scenario));
    for (i, joint) in revolutes(scenario) {
        let law = joint.law.unwrap_or(contact.law);
        for (key, value) in written(joint) {
            let Some(value) = value else { continue };
            let path = format!("joint.{i}.{key}");
            if law.takes(key) {
                found.extend(out_of_range(scenario, &path, key, value));
            } else {
                found.push(stranger(scenario, &path, key, law));
            }
        }
    }
    found
}

/// Keys of other friction laws, and values that none takes.
fn friction(scenario: &Scenario) -> Vec<Problem> {
    let contact = &scenario.contact;
    let fast = contact.friction_velocity;
    let numbers = [
        ("static_ratio", contact.static_ratio, Range::FromOne, f64::INFINITY),
        ("stribeck_velocity", contact.stribeck_velocity, Range::Positive, f64::INFINITY),
        ("rest_velocity", contact.rest_velocity, Range::NotNegative, fast),
    ];
    let wrong = |(key, value, range, below): (&str, Option<f64>, Range, f64)| {
        let (path, value) = (format!("contact.{key}"), value?);
        if !contact.friction_law.takes(key) {
            let help = "take it out, or set contact.friction_law: static_ratio and stribeck_velocity go with \
                        bengisu-akay and stribeck, rest_velocity with ambrosio";
            Some(scenario.problem(&path, "means nothing to the friction law", help))
        } else if !range.holds(value) {
            let help = format!("expected {}", range.in_words());
            Some(scenario.problem(&path, format!("is {value}"), help))
        } else if value >= below {
            let help = format!("expected below contact.friction_velocity, {below} m/s");
            Some(scenario.problem(&path, format!("is {value}"), help))
        } else {
            None
        }
    };
    numbers.into_iter().filter_map(wrong).collect()
}

/// The laws that a scenario names: that of `[contact]` and those of joints.
pub(super) fn used(scenario: &Scenario) -> Vec<Law> {
    revolutes(scenario).filter_map(|(_, joint)| joint.law).chain([scenario.contact.law]).collect()
}

/// The revolute joints of a described machine, with their places in the list.
fn revolutes(scenario: &Scenario) -> impl Iterator<Item = (usize, &Revolute)> {
    let joints = scenario.mechanism.described().map_or(&[][..], |described| &described.joints);
    joints.iter().enumerate().filter_map(|(i, joint)| match joint {
        Joint::Revolute(joint) => Some((i, joint)),
        Joint::Prismatic(_) | Joint::Fixed(_) => None,
    })
}

/// The keys of a joint that belong to its law and are checked here: what is said of the others stands with
/// the joint's other numbers.
fn written(joint: &Revolute) -> [(&'static str, Option<f64>); 5] {
    [
        ("restitution", joint.restitution),
        ("damping", joint.damping),
        ("stiffness", joint.stiffness),
        ("c_max", joint.c_max),
        ("d_max", joint.d_max),
    ]
}

/// The keys of all laws.
fn keys() -> BTreeSet<&'static str> {
    let parameters = laws::ALL.into_iter().flat_map(|kind| kind.parameters);
    parameters.map(|parameter| parameter.name).collect()
}

fn out_of_range(scenario: &Scenario, path: &str, key: &str, value: f64) -> Option<Problem> {
    let range = match key {
        "restitution" => Range::Share,
        "damping" => Range::NotNegative,
        "length" => Range::Positive,
        _ => return None,
    };
    (!range.holds(value)).then(|| {
        let help = format!("expected {}", range.in_words());
        scenario.problem(path, format!("is {value}"), help)
    })
}

/// A key of another law.
fn stranger(scenario: &Scenario, path: &str, key: &str, law: Law) -> Problem {
    let message = format!("means nothing to the law \"{}\"", law.name());
    let parameter =
        |kind: &Kind, name: &str| kind.parameters.iter().find(|p| p.name == name).copied();
    let other = match key {
        "restitution" => "damping",
        "damping" => "restitution",
        _ => "",
    };
    let help = match law.kind() {
        None => "take it out, or choose a law that takes it: see `freeplay laws`".to_owned(),
        Some(kind) => match parameter(kind, other) {
            Some(parameter) => {
                let unit = if parameter.unit.is_empty() { "no unit" } else { parameter.unit };
                format!("that law takes {} ({unit}): {}", parameter.name, parameter.about)
            }
            None => {
                let names: Vec<&str> = kind.parameters.iter().map(|p| p.name).collect();
                format!("that law takes {}", names.join(", "))
            }
        },
    };
    scenario.problem(path, message, help)
}
