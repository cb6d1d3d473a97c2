//! Oil films that cannot be as they are asked for.

use super::finding::Finding;
use crate::contact::Film;
use crate::engine::TYPICAL_IMPACT_SPEED;
use crate::mechanism::Bearing;
use crate::model::Machine;
use crate::scenario::{FilmKind, Joint, Scenario};

/// Suction in Pa that oil stands against the surroundings' pressure: it boils, or gives off its air.
const TEARING: f64 = 1e5;

/// Length over diameter up to which a bearing counts as short. At 0.5 the theory carries some per cent too much, at 1 about
/// a third (DuBois and Ocvirk, NACA Report 1157).
const SHORT: f64 = 1.0;

/// Films that cavitate although they are said to be full, and bearings that are not short.
pub(super) fn findings(scenario: &Scenario, machine: &Machine) -> Vec<Finding> {
    let contact = &scenario.contact;
    let Some(viscosity) = contact.viscosity else { return Vec::new() };
    let described = scenario.mechanism.described().map(|described| &described.joints[..]);
    let own = |name: &str| {
        let joint = described?.iter().find(|joint| joint.name() == name)?;
        let Joint::Revolute(joint) = joint else { return None };
        joint.film
    };
    let mut found = Vec::new();
    for joint in &machine.mechanism.revolutes {
        let Bearing::Clearance(clearance) = &joint.bearing else { continue };
        let kind = own(&joint.name).unwrap_or(contact.film);
        let (radius, gap) = (clearance.bearing_radius, clearance.radial());
        let length = contact.length.unwrap_or(2.0 * radius);
        let slender = length / (2.0 * radius);
        if kind != FilmKind::None && slender > SHORT {
            let message = format!(
                "makes the bearing {} {slender:.2} times as long as wide: the film of a short bearing carries too much",
                joint.name
            );
            let help =
                "expected at most the diameter; about half of it is where the theory is good";
            found.push(Finding::warning(scenario.problem("contact.length", message, help)));
        }
        let suction = Film::suction(viscosity, length, gap, TYPICAL_IMPACT_SPEED);
        if kind == FilmKind::Squeeze && suction > TEARING {
            let message = format!(
                "cavitates in the joint {}: at {TYPICAL_IMPACT_SPEED} m/s a full film would pull with {:.2} MPa, and oil tears at \
                 {:.1} MPa",
                joint.name,
                1e-6 * suction,
                1e-6 * TEARING
            );
            let help = "write film = \"short-bearing\", which does not pull; or a thinner oil";
            found.push(Finding::warning(scenario.problem("contact.film", message, help)));
        }
    }
    found
}
