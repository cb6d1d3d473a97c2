//! What assembling and checking a 3-RPR takes: the only file of this room that knows that machine.

use super::assemble::{bearing, drive};
use super::checks::Finding;
use super::ideal::Ideal;
use crate::mechanism::motion::Motion;
use crate::mechanism::three_rpr::{
    Geometry, InverseKinematics, LegBars, Reach, build, ideal_states, reach,
};
use crate::mechanism::{Bearing, Drive, Mechanism};
use crate::scenario::{self, Scenario, ThreeRpr};
use nalgebra::Vector2;
use std::array;
use std::sync::Arc;

/// Distance from singularity, as a share of the platform's circumradius, below which a motion is
/// refused: the actuators then hold the platform's angle with arms of less than 3 mm on the paper's
/// machine, and clearance alone lets it turn through.
const REFUSED_SHARE: f64 = 0.05;

/// The share below which a motion is doubtful: forces grow with its inverse.
const DOUBTFUL_SHARE: f64 = 0.2;

/// π/6 rad, the angle of the default motions: far from both singularities.
const SAFE_PHI: &str = "0.5236";

/// The machine, and itself without clearance.
pub(super) fn assemble(
    scenario: &Scenario,
    machine: &ThreeRpr,
    motion: Arc<dyn Motion>,
) -> (Mechanism, Ideal) {
    let kinematics = InverseKinematics { geometry: geometry(machine), motion };
    let platform = (machine.platform_mass, machine.platform_inertia());
    let legs = &scenario.legs;
    let bars = LegBars {
        density: legs.density,
        cylinder: [legs.cylinder_length, legs.cylinder_diameter],
        rod: [legs.rod_length, legs.rod_diameter],
    };
    let gravity: Vector2<f64> = scenario.environment.gravity.into();
    let joints = array::from_fn(|i| bearing(scenario, i));
    let mechanism = build(kinematics.clone(), platform, bars, joints, drive(scenario), gravity);
    let joints = [const { Bearing::Ideal }; 6];
    let ideal = build(kinematics.clone(), platform, bars, joints, Drive::Prescribed, gravity);
    let InverseKinematics { geometry, motion } = kinematics;
    let states = move |t| ideal_states(&geometry, &bars, &motion.at(t));
    (mechanism, Ideal::new(ideal, Box::new(states)))
}

fn geometry(machine: &ThreeRpr) -> Geometry {
    Geometry { base_side: machine.base_side, platform_side: machine.platform_side }
}

/// How far each leg travels, and how near the machine comes to a singularity.
pub fn leg_use(scenario: &Scenario, machine: &ThreeRpr, motion: &dyn Motion) -> Reach {
    reach(&geometry(machine), motion, scenario.simulation.duration, scenario.legs.stroke)
}

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
    }
}

/// The key that says at what angle the platform stands.
fn angle_key(scenario: &Scenario) -> &'static str {
    match &scenario.motion {
        scenario::Motion::Circle(_) | scenario::Motion::Line(_) => "motion.phi",
        scenario::Motion::Quintic(_) => "motion.to",
        scenario::Motion::Multisine(_) => "motion.center",
        scenario::Motion::Table(_) => "motion.file",
    }
}
