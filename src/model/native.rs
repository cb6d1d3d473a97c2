//! Settings with which the physics engine's own contacts come nearest to the contact law.

use crate::contact::{HertzStep, impact};
use crate::mechanism::{Mechanism, NativeContacts};
use crate::scenario::Scenario;
use std::f64::consts::PI;

/// Speed in m/s of the hit that the settings are fitted to: between the many slow hits of the paper's
/// machine and the few hard ones, at 0.02–0.3 m/s.
pub const FIT_SPEED: f64 = 0.1;

/// What a scenario says about native contacts, the rest fitted to its contact law: one hit of each
/// joint's mass at [`FIT_SPEED`] is simulated under the law, and spring and damper are chosen so that
/// a hit lasts as long and returns as much speed. For a linear spring and damper with the circular
/// frequency ω and the damping ratio ζ that is
///
/// `T = π/(ω √(1−ζ²))`, `v₁/v₀ = exp(−πζ/√(1−ζ²))`.
///
/// Joints have one setting together: means over them.
pub(super) fn contacts(
    scenario: &Scenario,
    mechanism: &Mechanism,
    laws: &[Option<HertzStep>],
) -> NativeContacts {
    let joints = mechanism.revolutes.iter().zip(laws);
    let hits: Vec<_> = joints
        .filter_map(|(joint, law)| {
            Some(impact(law.as_ref()?, mechanism.joint_mass(joint), FIT_SPEED))
        })
        .collect();
    if hits.is_empty() {
        return NativeContacts::default();
    }
    let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
    // Nothing is returned where the damper stops the journal for good: 1e-3 keeps the logarithm.
    let rebound = mean(hits.iter().map(|hit| hit.rebound / FIT_SPEED).collect()).max(1e-3);
    let duration = mean(hits.iter().map(|hit| hit.duration).collect());
    let loss = -rebound.ln();
    let damping_ratio = loss / loss.hypot(PI);
    let frequency = 1.0 / (2.0 * duration * (1.0 - damping_ratio * damping_ratio).sqrt());
    let native = &scenario.native;
    NativeContacts {
        restitution: native.restitution,
        frequency: native.frequency.unwrap_or(frequency),
        damping_ratio: native.damping_ratio.unwrap_or(damping_ratio),
        iterations: native.iterations,
        predictive: native.predictive,
    }
}
