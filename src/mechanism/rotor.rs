//! Rotors of motors that a joint spins through a gear.

use super::Revolute;
use super::equations::rows::Row;
use nalgebra::Vector3;

/// A rotor on the ring's body that the joint spins through a gear. With ω_r and ω_j, the rates of the bodies of
/// ring and journal, n, the gear's ratio, and I, its own inertia, its energy beside that of a part of the ring's
/// body is `½ I (ω_r + n (ω_j − ω_r))² = ½ J (ω_j − ω_r + ω_r/n)²`, `J = n² I` (Spong, *J. Dyn. Sys. Meas.
/// Control* 109, 1987, 310–319, who leaves `ω_r/n` out).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    /// Index of the revolute joint.
    pub joint: usize,
    /// J in kg m²: its inertia as the joint feels it.
    pub inertia: f64,
    /// 1/n, negative where the gear turns the direction round; 0 of a fast and light rotor.
    pub coupling: f64,
}

impl Rotor {
    /// What its rate, `g₀ ω_r + g₁ ω_j`, takes of each of the two.
    fn shares(&self) -> [f64; 2] {
        [self.coupling - 1.0, 1.0]
    }

    /// The rotor as a soft condition: the row `g·α = 0` that gives way by 1/J holds back with
    /// `λ = −J g·α`, the torque of its inertia.
    pub(super) fn row(&self, joint: &Revolute) -> Row {
        Row {
            bodies: [joint.ring.body, joint.journal.body],
            jacobians: self.shares().map(|share| Vector3::z() * share),
            bias: 0.0,
            softness: 1.0 / self.inertia,
        }
    }

    /// Torques (N·m) on the bodies of ring and journal that angular accelerations (rad/s²) of them take.
    pub(super) fn torques(&self, turns: [f64; 2]) -> [f64; 2] {
        let [ring, journal] = self.shares();
        let torque = self.inertia * (ring * turns[0] + journal * turns[1]);
        [ring * torque, journal * torque]
    }
}
