//! What can be said against a machine before it is simulated.

use super::assemble::Machine;
use super::three_rpr;
use crate::engine::{StepControl, TYPICAL_IMPACT_SPEED};
use crate::scenario::{self, Law, Problem, Scenario, StiffnessForm};
use std::fmt;

/// How bad a [`Finding`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The results would be worthless: nothing is simulated.
    Error,
    /// The results need care.
    Warning,
}

/// Something wrong or doubtful about a scenario, with the key that it hangs on.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Whether it stops a run.
    pub severity: Severity,
    /// What, where, and what would be right.
    pub problem: Problem,
}

impl Finding {
    /// A finding that stops a run.
    pub fn error(problem: Problem) -> Self {
        Self { severity: Severity::Error, problem }
    }

    /// A finding that does not.
    pub fn warning(problem: Problem) -> Self {
        Self { severity: Severity::Warning, problem }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, "{severity}: {}", self.problem)
    }
}

/// Clearance in m below which the conformal stiffness, which grows like 1/√c, is far beyond that of
/// any real contact: at 1e-6 m it is a hundred times that of two convex bodies.
const SMALLEST_CONFORMAL_CLEARANCE: f64 = 1e-6;

/// Everything wrong or doubtful about a machine and its motion.
pub fn findings(scenario: &Scenario, machine: &Machine) -> Vec<Finding> {
    let mut found = Vec::new();
    match &scenario.mechanism {
        scenario::Mechanism::ThreeRpr(kind) => {
            three_rpr::findings(scenario, kind, &*machine.motion, &mut found);
        }
        scenario::Mechanism::DriveStage(_) | scenario::Mechanism::Pendulum(_) => {}
    }
    found.extend(step(scenario, machine));
    found.extend(rows(scenario));
    found.extend(conformal(scenario));
    found.extend(table_end(scenario, machine));
    found
}

/// A step that the machine does not stand, or that its law cannot take.
fn step(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    match (scenario.contact.law, machine.control) {
        (Law::Native, StepControl::Tolerance(_)) => Some(Finding::error(scenario.problem(
            "simulation.tolerance",
            "does not go with contact.law = \"native\": the physics engine's own contacts have no \
             error estimate",
            "set simulation.step instead, such as 1e-5",
        ))),
        (Law::HertzStep, StepControl::Fixed(step)) => {
            let longest = machine.mechanism.longest_step(TYPICAL_IMPACT_SPEED)?;
            let what = if machine.mechanism.longest_servo_step() == Some(longest) {
                "servos"
            } else if machine.mechanism.longest_smooth_step() == Some(longest) {
                "effects"
            } else {
                "hits of the journals"
            };
            let message = format!("is {step:e} s, too long for the {what}");
            let help =
                format!("use at most {:.1e} s, or simulation.tolerance", two_digits_below(longest));
            (step > longest)
                .then(|| Finding::error(scenario.problem("simulation.step", message, help)))
        }
        _ => None,
    }
}

/// The largest number with two digits that is not above a positive `limit`: good advice stays within
/// the limit that it is about.
fn two_digits_below(limit: f64) -> f64 {
    let unit = 10f64.powf(limit.log10().floor() - 1.0);
    // 1e-9 forgives rounding where the limit has two digits itself.
    (limit / unit + 1e-9).floor() * unit
}

/// A motion table that ends before the run does: the machine is commanded to stop there, at once.
fn table_end(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    let (end, duration) = (machine.motion.known_until(), scenario.simulation.duration);
    // 1e-9 forgives rounding.
    (end < duration * (1.0 - 1e-9)).then(|| {
        let message = format!(
            "ends at t = {end} s, and the run at {duration} s: from there on the motion rests at the \
             last row's pose"
        );
        let help = format!("simulate {end} s (--duration), or give a table with more rows");
        Finding::warning(scenario.problem("motion.file", message, help))
    })
}

/// Too few rows for peaks and means.
fn rows(scenario: &Scenario) -> Option<Finding> {
    let simulation = &scenario.simulation;
    let (settle, interval) = (simulation.settle(), simulation.output_interval);
    let left = simulation.duration - settle;
    // 1e-9 forgives rounding.
    (left < 2.0 * interval * (1.0 - 1e-9)).then(|| {
        let message = format!(
            "is {interval} s: that leaves fewer than two rows after the first {settle} s, which \
             peaks and means leave out (simulation.settle)"
        );
        let help = format!(
            "simulate longer than {} s, or use an interval of at most {:.1e} s",
            simulation.duration,
            two_digits_below(left / 2.0)
        );
        Finding::error(scenario.problem("simulation.output_interval", message, help))
    })
}

/// A conformal stiffness out of its range.
fn conformal(scenario: &Scenario) -> Option<Finding> {
    let contact = &scenario.contact;
    let computed = contact.law == Law::HertzStep
        && contact.stiffness.is_none()
        && contact.stiffness_form == StiffnessForm::Conformal;
    let smallest = scenario.joints.clearance.iter().copied().fold(f64::INFINITY, f64::min);
    (computed && smallest < SMALLEST_CONFORMAL_CLEARANCE).then(|| {
        let message = format!(
            "is conformal at a clearance of {smallest:e} m: this stiffness grows without bound as \
             the clearance vanishes"
        );
        let help = "give contact.stiffness, or use \"printed\"";
        Finding::warning(scenario.problem("contact.stiffness_form", message, help))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_stays_within_its_limit() {
        for (limit, advice) in [(2.06e-5, "2.0e-5"), (1.25e-4, "1.2e-4"), (1e-5, "1.0e-5")] {
            assert_eq!(format!("{:.1e}", two_digits_below(limit)), advice);
        }
    }
}
