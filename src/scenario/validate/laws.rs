//! Keys of contact laws: those that mean nothing to the law that is chosen, and values that no law takes.

use crate::contact::laws::{self, LawKind, LawRange};
use crate::scenario::{Joint, Law, Problem, Revolute, Scenario};
use std::collections::BTreeSet;

/// All that is wrong with the parameters of contact laws, in `[contact]` and in joints.
pub(super) fn problems(scenario: &Scenario) -> Vec<Problem> {
    let contact = &scenario.contact;
    let used = used(scenario);
    let mut found = Vec::new();
    for key in keys() {
        let path = format!("contact.{key}");
        let asked = contact.asks_for(key) || used.iter().any(|law| law.takes(key));
        if scenario.origins.has(&path) && !asked {
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
    found.extend(film(scenario));
    for (i, law, written) in joints(scenario) {
        let law = law.unwrap_or(contact.law);
        for (key, value) in written {
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
        ("static_ratio", contact.static_ratio, LawRange::FromOne, f64::INFINITY),
        ("stribeck_velocity", contact.stribeck_velocity, LawRange::Positive, f64::INFINITY),
        ("rest_velocity", contact.rest_velocity, LawRange::NotNegative, fast),
        ("presliding", contact.presliding, LawRange::Positive, f64::INFINITY),
    ];
    let wrong = |(key, value, range, below): (&str, Option<f64>, LawRange, f64)| {
        let (path, value) = (format!("contact.{key}"), value?);
        if !contact.friction_law.takes(key) {
            let help = "take it out, or set contact.friction_law: static_ratio and stribeck_velocity go with \
                        bengisu-akay, stribeck and lugre, rest_velocity with ambrosio, presliding with lugre";
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

/// Keys of oil films where there is none, and what a film lacks.
fn film(scenario: &Scenario) -> Vec<Problem> {
    let contact = &scenario.contact;
    let own = |(i, joint): (usize, &Revolute)| {
        let path = format!("joint.{i}.film");
        joint.film.filter(|film| !film.is_none()).map(|_| (path, joint.law.unwrap_or(contact.law)))
    };
    let of_all = (!contact.film.is_none()).then(|| ("contact.film".to_owned(), contact.law));
    let films: Vec<(String, Law)> =
        of_all.into_iter().chain(revolutes(scenario).filter_map(own)).collect();
    let mut found = Vec::new();
    for (path, law) in &films {
        if *law == Law::Native {
            let message = "is not possible under the law \"native\"";
            let help = "the physics engine's own contacts know no oil: take another law";
            found.push(scenario.problem(path, message, help));
        } else if contact.viscosity.is_none() {
            let message = "needs the oil's viscosity";
            let help =
                "write contact.viscosity = … (Pa s): oil at working temperature has 0.01 to 0.1";
            found.push(scenario.problem(path, message, help));
        }
    }
    let most = contact.film_eccentricity_max;
    for (key, value, below) in
        [("viscosity", contact.viscosity, f64::INFINITY), ("film_eccentricity_max", most, 1.0)]
    {
        let (path, Some(value)) = (format!("contact.{key}"), value) else { continue };
        if films.is_empty() {
            let help = "take it out, or write contact.film = \"squeeze\" or \"short-bearing\"";
            found.push(scenario.problem(&path, "means nothing without an oil film", help));
        } else if value <= 0.0 || value >= below {
            let help =
                if below == 1.0 { "expected above 0 and below 1" } else { "expected above 0 Pa s" };
            found.push(scenario.problem(&path, format!("is {value}"), help));
        }
    }
    found
}

/// The laws that a scenario names: that of `[contact]` and those of joints.
pub(in crate::scenario) fn used(scenario: &Scenario) -> Vec<Law> {
    joints(scenario).filter_map(|(_, law, _)| law).chain([scenario.contact.law]).collect()
}

/// The revolute joints of a described machine, with their places in the list.
fn revolutes(scenario: &Scenario) -> impl Iterator<Item = (usize, &Revolute)> {
    described(scenario).iter().enumerate().filter_map(|(i, joint)| match joint {
        Joint::Revolute(joint) => Some((i, joint)),
        Joint::Prismatic(_) | Joint::Fixed(_) => None,
    })
}

fn described(scenario: &Scenario) -> &[Joint] {
    scenario.mechanism.described().map_or(&[][..], |described| &described.joints)
}

/// Keys with their values.
type WrittenKeys = [(&'static str, Option<f64>); 5];

/// The joints of a described machine that may have a law, with their places in the list, the law of their own, and the
/// keys that belong to it and are checked here: what is said of the others stands with the joint's other numbers.
fn joints(scenario: &Scenario) -> impl Iterator<Item = (usize, Option<Law>, WrittenKeys)> {
    let keys = |restitution, damping, stiffness, c_max, d_max| {
        [
            ("restitution", restitution),
            ("damping", damping),
            ("stiffness", stiffness),
            ("c_max", c_max),
            ("d_max", d_max),
        ]
    };
    described(scenario).iter().enumerate().filter_map(move |(i, joint)| match joint {
        Joint::Revolute(j) => {
            Some((i, j.law, keys(j.restitution, j.damping, j.stiffness, j.c_max, j.d_max)))
        }
        Joint::Prismatic(j) => {
            Some((i, j.law, keys(j.restitution, j.damping, j.stiffness, None, None)))
        }
        Joint::Fixed(_) => None,
    })
}

/// The keys of all laws.
fn keys() -> BTreeSet<&'static str> {
    let parameters = laws::ALL.iter().flat_map(|kind| kind.parameters);
    parameters.map(|parameter| parameter.name).collect()
}

fn out_of_range(scenario: &Scenario, path: &str, key: &str, value: f64) -> Option<Problem> {
    let range = match key {
        "restitution" => LawRange::Share,
        "damping" => LawRange::NotNegative,
        "length" => LawRange::Positive,
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
        |kind: &LawKind, name: &str| kind.parameters.iter().find(|p| p.name == name).copied();
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
