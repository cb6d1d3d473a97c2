//! Reading rapier's semi-implicit Euler steps as a leapfrog.
//!
//! rapier's step is `v ← v + h f(x)/m`, `x ← x + h v`. Read as it stands it is of first order; but
//! the same numbers with v taken *at the half step*, `v_{n+½} = (x_{n+1} − x_n)/h`, are the
//! leapfrog, of second order. The velocity that belongs to `x_n` is then
//!
//! `v_n = v_{n−½} + ∫ a dt ≈ v_{n−½} + (h/2) a(t_n − h/4)`,
//! `a(t_n − h/4) ≈ a_{n−1} + ¾ (a_{n−1} − a_{n−2})`,
//!
//! with the accelerations read from velocity changes, so that they contain what joints did. The
//! first step must be a half kick: `v_½ = v_0 + (h/2) a_0`.

use crate::mechanism::BodyState;
use nalgebra::{UnitComplex, Vector3};
use rapier2d_f64::dynamics::{RigidBodyHandle, RigidBodySet};

use crate::engine::from_rapier;

/// Synchronised states of a list of bodies, kept up with a fixed step.
#[derive(Clone, Debug)]
pub(super) struct Leapfrog {
    handles: Vec<RigidBodyHandle>,
    history: Vec<StepHistory>,
    states: Vec<BodyState>,
    steps: usize,
}

#[derive(Clone, Copy, Debug)]
struct StepHistory {
    /// v_{n−½}
    twist: Vector3<f64>,
    /// a_{n−1}, a_{n−2}
    accelerations: [Vector3<f64>; 2],
}

impl Leapfrog {
    pub fn new(handles: Vec<RigidBodyHandle>, bodies: &RigidBodySet) -> Self {
        let states: Vec<_> = handles.iter().map(|&h| read(bodies, h)).collect();
        let start =
            |s: &BodyState| StepHistory { twist: s.twist, accelerations: [Vector3::zeros(); 2] };
        Self { history: states.iter().map(start).collect(), handles, states, steps: 0 }
    }

    /// States at the present instant, velocities synchronised with positions.
    pub fn states(&self) -> &[BodyState] {
        &self.states
    }

    /// Share of a force that the next step must get: a half in the first one.
    pub fn kick(&self) -> f64 {
        if self.steps == 0 { 0.5 } else { 1.0 }
    }

    /// Takes in the step of `dt` s that rapier just made.
    pub fn record(&mut self, bodies: &RigidBodySet, dt: f64) {
        let since = dt * self.kick();
        self.steps += 1;
        for ((state, history), &handle) in
            self.states.iter_mut().zip(&mut self.history).zip(&self.handles)
        {
            *state = read(bodies, handle);
            let a1 = (state.twist - history.twist) / since;
            let a2 = if self.steps == 1 { a1 } else { history.accelerations[0] };
            *history = StepHistory { twist: state.twist, accelerations: [a1, a2] };
            state.twist += (a1 + (a1 - a2) * 0.75) * (0.5 * dt);
        }
    }
}

/// A body's state as rapier holds it: the twist is that of the last half step.
pub(in crate::engine) fn read(bodies: &RigidBodySet, handle: RigidBodyHandle) -> BodyState {
    let Some(body) = bodies.get(handle) else { return BodyState::ground() };
    let (v, rotation) = (body.linvel(), body.rotation());
    BodyState {
        position: from_rapier(body.translation()),
        rotation: UnitComplex::from_cos_sin_unchecked(rotation.cos(), rotation.sin()),
        twist: Vector3::new(v.x, v.y, body.angvel()),
    }
}
