//! What journals, rings and guides are of.

use crate::contact::Material;
use crate::scenario::{ContactKeys, Scenario};

/// What journals, rings and guides are of.
pub(super) fn material(scenario: &Scenario) -> Material {
    let ContactKeys { youngs_modulus, poisson_ratio, .. } = scenario.contact;
    Material { youngs_modulus, poisson_ratio }
}
