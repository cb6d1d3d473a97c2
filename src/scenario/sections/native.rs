//! `[native]`: the physics engine's own contacts, for `contact.law = "native"`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Settings of the physics engine's contacts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Native {
    /// Share of the normal speed that a journal keeps when it hits after a flight, beside what the
    /// contact's spring returns; 0 to 1. Default 0: the spring returns as much as the law does. The
    /// engine gives a restitution to a bar alone, before the bar's joints have their say: on the
    /// default machine 0.73 loses a third of the energy that the law loses, 0 all of it.
    pub restitution: f64,
    /// Natural frequency f of a contact's spring, Hz: k = m (2πf)², m the mass that the two bodies
    /// oppose to it. Default none: a contact lasts as long as one hit under the `[contact]` law.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency: Option<f64>,
    /// Damping ratio of that spring, dimensionless. Default none: a hit returns the speed that it
    /// returns under the `[contact]` law.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_ratio: Option<f64>,
    /// Sweeps of the engine's solver over joints and contacts in each step, 1 to 100. Default 4: more
    /// than halves the false peaks that a single sweep puts into the drives, for a fifth of its cost;
    /// 20 sweeps are no better.
    pub iterations: usize,
    /// Whether a journal that would arrive within the step is stopped at the ring at once, without
    /// give. Default true: what the engine does. The force of such a stop grows as 1/step; `false`
    /// leaves all to the spring, for those who may add a hook to their engine.
    pub predictive: bool,
}

impl Default for Native {
    fn default() -> Self {
        Native {
            restitution: 0.0,
            frequency: None,
            damping_ratio: None,
            iterations: 4,
            predictive: true,
        }
    }
}
