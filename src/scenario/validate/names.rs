//! Names and numbers of a described machine: whether they are there, and what was meant.

use super::described::DescribedChecks;
use crate::measure::spelling::nearest;
use crate::scenario::{GROUND, Joint};
use std::collections::BTreeSet;

impl DescribedChecks<'_> {
    pub(super) fn name<'a>(
        &mut self,
        path: &str,
        name: &'a str,
        what: &str,
        seen: &mut BTreeSet<&'a str>,
    ) {
        if name.is_empty() {
            self.complain(path, "is missing".to_owned(), &format!("give the {what} a name"));
        } else if name.contains('.') || name.chars().any(char::is_control) {
            let help = "letters, digits, spaces and dashes: a point separates body and point";
            self.complain(path, format!("is {name:?}"), help);
        } else if !seen.insert(name) {
            let message = format!("\"{name}\" is taken already");
            self.complain(path, message, &format!("give the {what} a name of its own"));
        }
    }

    pub(super) fn body(&mut self, path: &str, name: &str) {
        let known: Vec<&str> =
            self.described.bodies.iter().map(|body| body.name.as_str()).collect();
        if !known.contains(&name) {
            let message = format!("there is no body \"{name}\"");
            self.complain(path, message, &suggest(name, &known));
        }
    }

    /// A `body.point` that must be there.
    pub(super) fn point(&mut self, path: &str, name: &str) {
        let Some((body, point)) = name.split_once('.') else {
            let message =
                if name.is_empty() { "is missing".to_owned() } else { format!("is \"{name}\"") };
            self.complain(path, message, "expected \"body.point\", such as \"ground.O\"");
            return;
        };
        let points = if body == GROUND {
            Some(&self.described.ground.points)
        } else {
            let found = self.described.bodies.iter().find(|b| b.name == body);
            found.map(|body| &body.points)
        };
        match points {
            None => {
                let names = self.described.bodies.iter().map(|b| b.name.as_str());
                let known: Vec<&str> = [GROUND].into_iter().chain(names).collect();
                self.complain(path, format!("there is no body \"{body}\""), &suggest(body, &known));
            }
            Some(points) if !points.contains_key(point) => {
                let known: Vec<&str> = points.keys().map(String::as_str).collect();
                let message = format!("\"{body}\" has no point \"{point}\"");
                self.complain(path, message, &suggest(point, &known));
            }
            Some(_) => {}
        }
    }

    /// Complains of a joint that does not move or is not there, and says whether it moves.
    pub(super) fn movable(&mut self, path: &str, name: &str) -> bool {
        let movable = |joint: &&Joint| !matches!(joint, Joint::Fixed(_));
        let known: Vec<&str> =
            self.described.joints.iter().filter(movable).map(Joint::name).collect();
        if known.contains(&name) {
            return true;
        }
        let message = if self.described.joints.iter().any(|joint| joint.name() == name) {
            format!("the joint \"{name}\" is fixed")
        } else {
            format!("there is no joint \"{name}\"")
        };
        self.complain(path, message, &suggest(name, &known));
        false
    }

    pub(super) fn above_zero(&mut self, path: &str, value: f64) {
        if value <= 0.0 {
            self.complain(path, format!("is {value}"), "expected above 0");
        }
    }

    pub(super) fn not_negative(&mut self, path: &str, value: f64) {
        if value < 0.0 {
            self.complain(path, format!("is {value}"), "expected 0 or more");
        }
    }

    pub(super) fn increasing(&mut self, path: &str, low: f64, high: f64) {
        if low >= high {
            let message = format!("is [{low}, {high}]");
            self.complain(path, message, "expected two increasing numbers");
        }
    }

    pub(in crate::scenario) fn complain(&mut self, path: &str, message: String, help: &str) {
        self.problems.push(self.scenario.problem(path, message, help));
    }
}

/// The nearest of the known names, or all of them.
pub(super) fn suggest(name: &str, known: &[&str]) -> String {
    match nearest(name, known) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None if known.is_empty() => "there are none".to_owned(),
        None => format!("known here: {}", known.join(", ")),
    }
}
