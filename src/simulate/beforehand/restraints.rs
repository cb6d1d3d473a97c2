//! Springs and stops that are hardly meant.

use super::finding::Finding;
use crate::mechanism::{JointIndex, Mechanism};
use crate::scenario::{Scenario, Spring};
use std::f64::consts::TAU;

/// Free length, in sizes of the machine, beyond which no spring fits in it: one of ten times the size would push
/// with ten times what it does at its full length.
const LONGEST_SPRING: f64 = 10.0;

/// Two turns in degrees: larger ends of a stop are those of a joint that nothing stops on that side.
const TWO_TURNS: f64 = 720.0;

/// How far a start may lie beyond a stop, as a share of its range: a stop that bears the machine gives less.
const GIVEN_WAY: f64 = 0.01;

pub(super) fn findings(scenario: &Scenario, mechanism: &Mechanism) -> Vec<Finding> {
    let Some(described) = scenario.mechanism.described() else { return Vec::new() };
    let mut found = Vec::new();
    let mut doubt = |key: String, message: String, help: String| {
        found.push(Finding::warning(scenario.problem(&key, message, help)));
    };
    for (i, spring) in described.springs.iter().enumerate() {
        let reach = mechanism.size().max(distance(mechanism, spring));
        if let Some(length) = spring.free_length.filter(|l| l.abs() > LONGEST_SPRING * reach) {
            let message = format!("is {length} m, in a machine of {reach:.3} m");
            let help = format!("expected m: {length} mm are {}", length / 1e3);
            doubt(format!("spring.{i}.free_length"), message, help);
        }
    }
    for (i, stop) in described.stops.iter().enumerate() {
        let joint = mechanism.joints().find(|(name, _)| *name == stop.joint).map(|(_, j)| j);
        let Some(joint) = joint else { continue };
        let key = format!("stop.{i}.range");
        let angular = matches!(joint, JointIndex::Revolute(_));
        let large = |end: &&f64| angular && end.abs() > TAU && end.abs() <= TWO_TURNS;
        if let Some(end) = stop.range.iter().find(large) {
            let message = format!("has an end at {end} rad, more than a whole turn");
            let help = format!("angles are in rad: {end} degrees are {:.4}", end.to_radians());
            doubt(key.clone(), message, help);
        }
        let (at, [low, high]) = (mechanism.start_coordinate(joint), stop.range);
        if (low - at).max(at - high) > GIVEN_WAY * (high - low) {
            let unit = if angular { "rad" } else { "m" };
            let message = format!(
                "goes from {low} to {high} {unit}, and {} starts at {at:.4} {unit}, beyond its stop: it is \
                 thrown back",
                stop.joint
            );
            let help = "choose a range that holds the start, or another start".to_owned();
            doubt(key, message, help);
        }
    }
    found
}

/// Springs that do nothing, as they are written.
pub(super) fn idle(scenario: &Scenario) -> Vec<Finding> {
    let springs = scenario.mechanism.described().map_or(&[][..], |described| &described.springs);
    let idle = springs.iter().enumerate();
    let idle = idle.filter(|(_, spring)| spring.stiffness == 0.0 && spring.damping == 0.0);
    let found = idle.map(|(i, _)| {
        let message = "is 0, and damping is too: this spring does nothing";
        let help = "give it a stiffness in N/m, of a revolute joint in N m/rad";
        Finding::warning(scenario.problem(&format!("spring.{i}.stiffness"), message, help))
    });
    found.collect()
}

/// Distance in m at the start of the two points of a spring, 0 of one in a joint.
fn distance(mechanism: &Mechanism, spring: &Spring) -> f64 {
    let states: Vec<_> = mechanism.bodies.iter().map(|body| body.start).collect();
    let place = |name: &String| {
        let point = mechanism.names.points.get(name)?;
        Some(point.mark.attachment(mechanism).frame(&states).centre)
    };
    let ends = spring.between.as_ref().and_then(|[a, b]| Some((place(a)?, place(b)?)));
    ends.map_or(0.0, |(a, b)| (a - b).norm())
}
