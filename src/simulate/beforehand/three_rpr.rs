//! What can be said against the motion of a 3-RPR, in the words of that machine.

use super::finding::Finding;
use crate::mechanism::motion::Motion;
use crate::model::leg_use;
use crate::scenario::{self, Scenario, ThreeRpr};

/// Distance from singularity, as a share of the platform's circumradius, below which a motion is
/// refused: the actuators then hold the platform's angle with arms of less than 3 mm on the paper's
/// machine, and clearance alone lets it turn through.
const REFUSED_SHARE: f64 = 0.05;

/// The share below which a motion is doubtful: forces grow with its inverse.
const DOUBTFUL_SHARE: f64 = 0.2;

/// π/6 rad, the angle of the default motions: far from both singularities.
const SAFE_PHI: &str = "0.5236";

/// Legs that leave their stroke, and a platform that comes near a singularity.
pub(super) fn findings(
    scenario: &Scenario,
    machine: &ThreeRpr,
    motion: &dyn Motion,
    found: &mut Vec<Finding>,
) {
    let reach = leg_use(scenario, machine, motion);
    let [shortest, longest] = scenario.legs.stroke;
    for breach in &reach.breaches {
        let message = format!(
            "leg {} would have to be {:.4} m long at t = {:.4} s; its stroke goes from {shortest} \
             to {longest} m",
            breach.leg, breach.length, breach.t
        );
        let help = "choose a smaller motion, one nearer to the middle, or another legs.stroke";
        found.push(Finding::error(scenario.problem(size_key(scenario), message, help)));
    }

    let circumradius = machine.platform_side / 3f64.sqrt();
    let share = reach.singularity_distance / circumradius;
    if share >= DOUBTFUL_SHARE {
        return;
    }
    let (t, phi) = (reach.singularity_time, motion.at(reach.singularity_time).pose.z);
    let distance = 1e3 * reach.singularity_distance;
    let key = angle_key(scenario);
    if share < REFUSED_SHARE {
        let what = if reach.singularity_distance < 1e-6 {
            "reaches a singularity".to_owned()
        } else {
            format!("comes within {distance:.2} mm of a singularity")
        };
        let message = format!(
            "the platform {what} at t = {t:.4} s, phi = {phi:.4} rad: there the three leg lines \
             meet in one point, about which the platform turns without any actuator moving (base \
             and platform are similar triangles, so this is so at phi = 0 and phi = pi wherever \
             the platform is)"
        );
        let help =
            format!("keep motion.phi well away from 0 and pi, for example at {SAFE_PHI} (pi/6)");
        found.push(Finding::error(scenario.problem(key, message, help)));
    } else {
        let message = format!(
            "the platform comes within {distance:.1} mm of a singularity at t = {t:.4} s, phi = \
             {phi:.4} rad ({:.0} % of its circumradius): its angle is held weakly there, and \
             forces grow",
            100.0 * share
        );
        let help = format!("phi = {SAFE_PHI} (pi/6) keeps the built-in machine clear of it");
        found.push(Finding::warning(scenario.problem(key, message, help)));
    }
}

/// The key that says how far the motion goes.
fn size_key(scenario: &Scenario) -> &'static str {
    match &scenario.motion {
        scenario::Motion::Circle(_) => "motion.radius",
        scenario::Motion::Line(_) => "motion.velocity",
        scenario::Motion::Quintic(_) => "motion.to",
        scenario::Motion::Multisine(_) => "motion.terms",
        scenario::Motion::Table(_) => "motion.file",
        scenario::Motion::Joints(_) | scenario::Motion::Rest => "motion",
    }
}

/// The key that says at what angle the platform stands.
pub(super) fn angle_key(scenario: &Scenario) -> &'static str {
    match &scenario.motion {
        scenario::Motion::Circle(_) | scenario::Motion::Line(_) => "motion.phi",
        scenario::Motion::Quintic(_) => "motion.to",
        scenario::Motion::Multisine(_) => "motion.center",
        scenario::Motion::Table(_) => "motion.file",
        scenario::Motion::Joints(_) | scenario::Motion::Rest => "motion",
    }
}
