//! What is doubtful about the keys that a sweep varies, whatever its runs do.

use super::Vary;
use super::rows::statistics::is_start;
use crate::mechanism::JointIndex;
use crate::scenario::Scenario;
use crate::simulate::assemble;
use std::f64::consts::TAU;

/// Share of a turn within which two starts are the same: values are written to some twelve digits.
const SAME: f64 = 1e-9;

/// One line for each doubt about the keys `varied` over `base` with the overrides `sets`.
pub(super) fn doubts(varied: &[Vary], sets: &[String], base: &Scenario) -> Vec<String> {
    let mut doubts = Vec::new();
    if varied.iter().any(|vary| vary.path == "seed") {
        doubts.push(
            "--vary seed changes nothing: runs draw no random numbers, so that its rows are equal and no starts of \
             their own; a circle has other starts by --vary motion.phase=0..5.5:12"
                .to_owned(),
        );
    }
    for vary in varied {
        let set = |set: &&String| set.split_once('=').is_some_and(|(path, _)| path == vary.path);
        if let Some(set) = sets.iter().find(set) {
            doubts.push(format!("--set {set} does nothing: --vary says what {} is", vary.path));
        }
    }
    let turning = varied.iter().filter(|vary| is_start(&vary.path) && turns(&vary.path, base));
    doubts.extend(turning.filter_map(a_turn_apart));
    doubts
}

/// Whether a start is an angle: a phase is, and where a joint begins to turn.
fn turns(path: &str, base: &Scenario) -> bool {
    if path.ends_with(".phase") {
        return true;
    }
    let turning =
        |actuator: &crate::mechanism::Actuator| matches!(actuator.joint, JointIndex::Revolute(_));
    assemble(base).is_ok_and(|machine| machine.mechanism.actuators.iter().all(turning))
}

/// Two starts that are whole turns apart: one, but for rounding, which chaos takes a while to make another draw of.
fn a_turn_apart(vary: &Vary) -> Option<String> {
    let values = (0..vary.count()).filter_map(|k| vary.value(k).parse().ok());
    let values: Vec<f64> = values.collect();
    for (k, a) in values.iter().enumerate() {
        let same = |b: &&f64| {
            let turns = (*b - a) / TAU;
            (turns - turns.round()).abs() < SAME
        };
        if let Some(b) = values[k + 1..].iter().find(same) {
            return Some(format!(
                "--vary {vary}: {a} and {b} rad are whole turns apart, the same start but for rounding, and hardly a draw of \
                 its own in means over the starts; leave one of them out"
            ));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_of_a_turn_are_one_start() {
        let told = |text: &str| a_turn_apart(&Vary::parse(text).unwrap()).unwrap_or_default();
        assert!(told("motion.phase=0..6.283185307179586:5").contains("0 and 6.2831853"));
        assert!(told("motion.phase=0.5,1,6.783185307179586").contains("0.5 and 6.7831853"));
        assert_eq!(told("motion.phase=0..5.5:12"), "");
        assert_eq!(told("joints.clearance=1e-4,5e-4"), "");
    }
}
