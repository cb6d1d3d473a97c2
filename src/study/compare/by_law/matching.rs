//! Every law with the parameter by which it returns as much of a hit as the scenario's own.

use crate::contact::impact;
use crate::contact::laws::{HERTZ_STEP, LawKind, Losses};
use crate::mechanism::{Bearing, Mechanism};
use crate::scenario::{self, Joint, Law, Problem, Scenario};
use crate::simulate::{FIT_SPEED, assemble};

/// Halvings in which a parameter is sought: six digits.
const HALVINGS: usize = 20;

/// Range of dampings that are tried, as powers of ten around 1 in the law's unit: from none that shows to a
/// journal that stays.
const DAMPINGS: [f64; 2] = [-4.0, 6.0];

/// Smallest restitution that a law is asked for.
const LEAST: f64 = 0.01;

/// What is returned of a hit is matched to this.
const MATCHED: f64 = 1e-3;

/// A scenario under one law.
#[derive(Clone, Debug)]
pub struct Matched {
    /// The law.
    pub kind: &'static LawKind,
    /// The scenario.
    pub scenario: Scenario,
    /// The parameter that was chosen, and its value.
    pub chosen: Option<(&'static str, f64)>,
    /// Share of the speed that its joints' hits at [`FIT_SPEED`] return, mean over the joints.
    pub returned: f64,
    /// Whether that is what was asked for.
    pub matched: bool,
}

/// The scenario under its own law, or the default one where it has none, as it is.
///
/// # Errors
/// A machine that cannot be put together.
pub fn own(scenario: &Scenario) -> Result<Matched, Problem> {
    let kind = scenario.contact.law.kind().unwrap_or(&HERTZ_STEP);
    let mut scenario = scenario.clone();
    scenario.contact.law = Law::of(kind);
    let returned = returned(&assemble(&scenario)?.mechanism);
    Ok(Matched { kind, scenario, chosen: None, returned, matched: true })
}

/// The scenario under a law that is to return the share `asked` of the speed of hits.
///
/// # Errors
/// A machine that cannot be put together.
pub fn under(scenario: &Scenario, kind: &'static LawKind, asked: f64) -> Result<Matched, Problem> {
    let (key, range): (_, [f64; 2]) = match kind.losses {
        // What is returned rises with the first of them and falls with the second.
        Losses::Restitution => ("restitution", [LEAST, 1.0]),
        Losses::Damping => ("damping", [DAMPINGS[1], DAMPINGS[0]]),
        Losses::Elastic | Losses::Step => {
            let scenario = with(scenario, kind, None);
            let returned = returned(&assemble(&scenario)?.mechanism);
            let matched = (returned - asked).abs() < MATCHED;
            return Ok(Matched { kind, scenario, chosen: None, returned, matched });
        }
    };
    let value = |x: f64| if kind.losses == Losses::Damping { 10f64.powf(x) } else { x };
    let [mut low, mut high] = range;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let found = returned(&assemble(&with(scenario, kind, Some(value(middle))))?.mechanism);
        if found < asked { low = middle } else { high = middle }
    }
    // Six digits, as they are told: the scenario that is written is the one that is run.
    let digits = format!("{:.5e}", value(high));
    let chosen = digits.parse().unwrap_or_else(|_| value(high));
    let scenario = with(scenario, kind, Some(chosen));
    let returned = returned(&assemble(&scenario)?.mechanism);
    let matched = (returned - asked).abs() < MATCHED;
    Ok(Matched { kind, scenario, chosen: Some((key, chosen)), returned, matched })
}

/// The scenario with a law in all joints that have one, and its parameter. Parameters of other laws, and a
/// stiffness in another law's unit, are left out.
fn with(scenario: &Scenario, kind: &'static LawKind, value: Option<f64>) -> Scenario {
    let mut scenario = scenario.clone();
    let linear = !kind.takes("exponent");
    let contact = &mut scenario.contact;
    contact.law = Law::of(kind);
    contact.restitution = value.filter(|_| kind.losses == Losses::Restitution);
    contact.damping = value.filter(|_| kind.losses == Losses::Damping);
    contact.stiffness = contact.stiffness.filter(|_| !linear);
    if let scenario::Mechanism::Described(described) = &mut scenario.mechanism {
        let revolutes = described.joints.iter_mut().filter_map(|joint| match joint {
            Joint::Revolute(joint) => Some(joint),
            Joint::Prismatic(_) | Joint::Fixed(_) => None,
        });
        for joint in revolutes {
            joint.law = joint.law.filter(|law| *law == Law::Ideal);
            (joint.restitution, joint.damping) = (None, None);
            joint.stiffness = joint.stiffness.filter(|_| !linear);
            if kind.losses != Losses::Step {
                (joint.c_max, joint.d_max) = (None, None);
            }
        }
    }
    scenario
}

/// Share of the speed that hits at [`FIT_SPEED`] return, mean over the joints under a law.
fn returned(mechanism: &Mechanism) -> f64 {
    let hits: Vec<f64> = mechanism
        .revolutes
        .iter()
        .filter_map(|joint| match &joint.bearing {
            Bearing::Clearance(clearance) => {
                let hit = impact(&*clearance.law, mechanism.joint_mass(joint), FIT_SPEED);
                Some(hit.rebound / FIT_SPEED)
            }
            Bearing::Ideal | Bearing::Native { .. } => None,
        })
        .collect();
    hits.iter().sum::<f64>() / hits.len() as f64
}
