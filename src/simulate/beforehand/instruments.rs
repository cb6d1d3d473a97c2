//! Instruments that are hardly meant: noise and steps in another unit.

use super::finding::Finding;
use crate::mechanism::{Mechanism, Reads, Sensor};
use crate::scenario::Scenario;

/// Noise of a place, or its step, as a share of the machine's size beyond which an instrument tells nothing of it.
const LARGEST_SHARE: f64 = 0.1;

/// The same of a joint's angle in rad: of an encoder of twenty steps a turn, which tells nothing of a motion.
const LARGEST_ANGLE: f64 = 0.3;

/// The same of a body's angle in rad: a degree, what the cheapest inclinometers stay within.
const LARGEST_TRACKED_ANGLE: f64 = 0.02;

/// Noise of a force, or its step, in weights of the whole machine beyond which an instrument tells nothing of it.
/// Machines whose drives accelerate them by more than ten times the earth's pull are rare.
const LARGEST_WEIGHTS: f64 = 10.0;

/// The earth's pull in m/s².
const EARTH: f64 = 9.81;

pub(super) fn findings(scenario: &Scenario, mechanism: &Mechanism) -> Vec<Finding> {
    let mut told: Vec<(String, Finding)> = Vec::new();
    for (i, sensor) in mechanism.sensors.iter().enumerate() {
        let Some(limit) = limit(mechanism, sensor) else { continue };
        for (name, value) in [("std", sensor.std), ("resolution", sensor.resolution)] {
            let Some(key) = key(scenario, i, sensor, name) else { continue };
            if value <= limit || told.iter().any(|(before, _)| *before == key) {
                continue;
            }
            let unit = sensor.unit(mechanism);
            let message = format!(
                "is {value} {unit}, and more than {limit:.3} {unit} tells nothing of this machine"
            );
            let help = expected(unit, value);
            told.push((key.clone(), Finding::warning(scenario.problem(&key, message, help))));
        }
    }
    told.into_iter().map(|(_, finding)| finding).collect()
}

/// The largest error that makes sense of what a sensor reads, in its unit; none where nothing is known of it.
fn limit(mechanism: &Mechanism, sensor: &Sensor) -> Option<f64> {
    let size = mechanism.size();
    let weight = EARTH * mechanism.bodies.iter().map(|body| body.mass).sum::<f64>();
    let largest = match (&sensor.reads, sensor.unit(mechanism)) {
        (Reads::Effort(_) | Reads::Output(_), "N") => LARGEST_WEIGHTS * weight,
        (Reads::Effort(_) | Reads::Output(_), _) => LARGEST_WEIGHTS * weight * size,
        (_, "m") => LARGEST_SHARE * size,
        (Reads::Angle(..), _) => LARGEST_TRACKED_ANGLE,
        (_, "rad") => LARGEST_ANGLE,
        _ => return None,
    };
    Some(largest)
}

/// The key that says so: of a described machine that of its sensor, else that of the section.
fn key(scenario: &Scenario, index: usize, sensor: &Sensor, name: &str) -> Option<String> {
    if scenario.mechanism.described().is_some() {
        return Some(format!("sensor.{index}.{name}"));
    }
    let key = match (&sensor.reads, name) {
        (Reads::X(_) | Reads::Y(_), "std") => "pose_std",
        (Reads::Angle(..), "std") => "angle_std",
        (Reads::Effort(_), "std") => "force_std",
        (Reads::Position(_), "resolution") => "length_resolution",
        _ => return None,
    };
    Some(format!("sensors.{key}"))
}

/// What it would be, had it been written in a smaller unit.
fn expected(unit: &str, value: f64) -> String {
    match unit {
        "m" => format!("expected m: {value} µm are {:e}", value * 1e-6),
        "rad" => format!(
            "expected rad: {value} degrees are {:.4}, {value} mrad {:e}",
            value.to_radians(),
            value * 1e-3
        ),
        "N" => format!("expected N: {value} mN are {}", value * 1e-3),
        _ => format!("expected N m: {value} N mm are {}", value * 1e-3),
    }
}
