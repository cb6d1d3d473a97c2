//! A spring and what it loses: the one form of the laws of this room.

use super::loss::Loss;
use super::spring::ElasticForce;
use crate::contact::{ForceLaw, step};
use std::sync::Arc;

/// `F = S(δ) + loss`, never below zero: surfaces do not pull.
#[derive(Clone, Debug, PartialEq)]
pub struct Damped<S> {
    /// The elastic force.
    pub spring: S,
    /// What is lost.
    pub loss: Loss,
}

impl<S: ElasticForce> ForceLaw for Damped<S> {
    fn normal_force(&self, penetration: f64, rate: f64) -> f64 {
        self.normal_force_after(penetration, rate, rate.abs())
    }

    fn remembers(&self) -> bool {
        matches!(self.loss, Loss::Restitution(_))
    }

    fn normal_force_after(&self, penetration: f64, rate: f64, impact_speed: f64) -> f64 {
        if penetration <= 0.0 {
            return 0.0;
        }
        let elastic = self.spring.force(penetration);
        let force = match self.loss {
            Loss::None => elastic,
            Loss::Viscous(c) => elastic + c * rate,
            Loss::Step { c_max, d_max } => elastic + step(penetration, d_max, c_max) * rate,
            Loss::Hysteresis(alpha) => elastic * (1.0 + alpha * rate),
            // A rate of zero has no damping, whatever the impact speed.
            Loss::Restitution(_) if rate == 0.0 => elastic,
            Loss::Restitution(h) => elastic * (1.0 + h * rate / impact_speed),
        };
        force.max(0.0)
    }

    fn resting_penetration(&self, force: f64) -> f64 {
        self.spring.penetration(force)
    }

    fn damping(&self, penetration: f64, impact_speed: f64) -> f64 {
        match self.loss {
            Loss::None => 0.0,
            Loss::Viscous(c) => c,
            Loss::Step { c_max, d_max } => step(penetration, d_max, c_max),
            Loss::Hysteresis(alpha) => alpha * self.spring.force(penetration),
            Loss::Restitution(h) => h * self.spring.force(penetration) / impact_speed,
        }
    }

    fn deepest_penetration(&self, mass: f64, speed: f64) -> f64 {
        self.spring.deepest(mass, speed)
    }

    fn contact_time(&self, mass: f64, speed: f64) -> f64 {
        self.spring.contact_time(mass, speed)
    }

    fn stiffness(&self) -> Option<f64> {
        self.spring.stiffness()
    }

    fn valid_clearance(&self) -> Option<f64> {
        self.spring.valid_clearance()
    }

    fn valid_depth(&self) -> Option<f64> {
        self.spring.valid_depth()
    }

    /// Five steps per hit, and `h C/m ≤ 1` with the damping C at its deepest, as
    /// [`HertzStep`](crate::contact::HertzStep) has it.
    fn longest_step(&self, mass: f64, speed: f64) -> f64 {
        let elastic = self.contact_time(mass, speed) / 5.0;
        let damping = self.damping(self.spring.deepest(mass, speed), speed);
        if damping > 0.0 { elastic.min(mass / damping) } else { elastic }
    }

    fn damped(&self, factor: f64) -> Option<Arc<dyn ForceLaw>> {
        let loss = match self.loss {
            Loss::None => return None,
            Loss::Viscous(c) => Loss::Viscous(c * factor),
            Loss::Step { c_max, d_max } => Loss::Step { c_max: c_max * factor, d_max },
            Loss::Hysteresis(alpha) => Loss::Hysteresis(alpha * factor),
            Loss::Restitution(h) => Loss::Restitution(h * factor),
        };
        self.losing(loss)
    }

    fn losing(&self, loss: Loss) -> Option<Arc<dyn ForceLaw>> {
        Some(Arc::new(Damped { spring: self.spring.clone(), loss }))
    }
}
