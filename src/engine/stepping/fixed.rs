//! Stepping at a fixed step: leapfrog, second order in time.
//!
//! rapier's velocity after a step is that of the half step (see [`leapfrog`](crate::engine::physics::leapfrog)). Here,
//! where the forces are known, the velocity at the step's end is not extrapolated from the past but
//! solved for, by one correction of the extrapolated one:
//!
//! `v_n = v_{n−½} + (h/2) a(x_n, v_n)`.
//!
//! That is the velocity-Verlet scheme, symmetric in time: on the reference curves its error is a
//! seventh of the extrapolation's, and a tenth in the rebound of one hit.

use super::energy::{Books, Exchange, Power};
use super::looks::Looks;
use super::stepper::{Stepper, even_step};
use crate::engine::physics::world::{MotorTarget, World, joint_advance};
use crate::mechanism::{BodyState, Command, Dynamics, Evaluation, Mechanism};
use nalgebra::Vector3;

/// Where inside a step the contact forces are looked at for peaks. A hard hit's force has a cusp
/// where the damping is complete; at four points the step sees it to a fifth of what it would miss.
const LOOKS: [f64; 4] = [0.2, 0.4, 0.6, 0.8];

/// Steps of equal length under the forces of the present state.
pub(in crate::engine) struct FixedSteps {
    step: f64,
    pub(in crate::engine) world: World,
    dynamics: Dynamics,
    states: Vec<BodyState>,
    now: Evaluation,
    /// Twists v_{n−½} as rapier holds them.
    half: Vec<Vector3<f64>>,
    /// a_{n−1}, a_{n−2}, and the length of the step since.
    past: [Vec<Vector3<f64>>; 2],
    previous_step: f64,
    targets: Vec<Command>,
    wrenches: Vec<Vector3<f64>>,
    /// Turn of each body in the next step in rad, as predicted.
    turns: Vec<f64>,
    /// Joints that share a body are more than one sweep of rapier's solver does: it is handed the
    /// joint forces with the others, and has only the drift to correct.
    coupled: bool,
    /// Work space for looking inside a step, and what was seen there.
    inside_states: Vec<BodyState>,
    inside: Evaluation,
    touched: bool,
    looks: Looks,
    /// Kept only where somebody asked for the balance.
    books: Option<Books>,
}

impl FixedSteps {
    /// Steps of at most `step` s; with `books` it keeps what a balance of energy needs.
    pub fn new(mechanism: &Mechanism, step: f64, books: Option<Books>) -> Self {
        let zeros = vec![Vector3::zeros(); mechanism.bodies.len()];
        let states: Vec<BodyState> = mechanism.bodies.iter().map(|b| b.start).collect();
        let dynamics = Dynamics::new(mechanism);
        Self {
            step,
            world: World::new(mechanism, false),
            coupled: dynamics.coupled(),
            dynamics,
            half: states.iter().map(|s| s.twist).collect(),
            inside_states: states.clone(),
            states,
            now: Evaluation::new(mechanism),
            past: [zeros.clone(), zeros.clone()],
            previous_step: 0.0,
            targets: vec![Command::default(); mechanism.actuators.len()],
            wrenches: zeros,
            turns: vec![0.0; mechanism.bodies.len()],
            inside: Evaluation::new(mechanism),
            touched: false,
            looks: Looks::new(LOOKS.len(), mechanism.revolutes.len()),
            books,
        }
    }

    fn evaluate(&mut self, mechanism: &Mechanism, t: f64) {
        self.dynamics.forces(mechanism, t, &self.states, &mut self.now);
        self.dynamics.accelerations(mechanism, &self.states, &mut self.now);
        if let Some(books) = &mut self.books {
            books.now = Power::of(&self.dynamics, mechanism, &self.states, &self.now);
        }
    }

    /// Looks at the contact forces inside the step that ends at `t`.
    fn look_inside(&mut self, mechanism: &Mechanism, t: f64) {
        self.looks.none();
        let touching = self.now.contacts.iter().any(|contact| contact.penetration > 0.0);
        if touching || self.touched {
            let h = self.previous_step;
            for (k, s) in LOOKS.into_iter().enumerate() {
                let back = (s - 1.0) * h;
                for (i, point) in self.inside_states.iter_mut().enumerate() {
                    let a = self.now.accelerations[i];
                    *point = self.states[i].moved(a, (a - self.past[0][i]) / h, back);
                }
                let inside = &mut self.inside;
                self.dynamics.forces(mechanism, t + back, &self.inside_states, inside);
                self.looks.set(k, t + back, &inside.contacts);
            }
        }
        self.touched = touching;
    }
}

impl Stepper for FixedSteps {
    fn synchronise(&mut self, mechanism: &Mechanism, t: f64) {
        let h = self.previous_step;
        if h > 0.0 {
            self.world.read(&mut self.states);
            for (i, state) in self.states.iter_mut().enumerate() {
                self.half[i] = state.twist;
                let [a1, a2] = [self.past[0][i], self.past[1][i]];
                state.twist += (a1 + (a1 - a2) * 0.75) * (0.5 * h);
            }
            self.evaluate(mechanism, t);
            for (i, state) in self.states.iter_mut().enumerate() {
                state.twist = self.half[i] + self.now.accelerations[i] * (0.5 * h);
            }
        }
        self.evaluate(mechanism, t);
        if self.coupled {
            self.dynamics.replace_wrenches(&mut self.now);
        }
        if h > 0.0 {
            if let Some(books) = &mut self.books {
                // The trapezoidal rule is of the stepping's own order.
                books.exchange = Exchange::over(h, [(0.5, books.before), (0.5, books.now)]);
            }
            self.look_inside(mechanism, t);
        }
    }

    fn states(&self) -> &[BodyState] {
        &self.states
    }

    fn evaluation(&self) -> &Evaluation {
        &self.now
    }

    fn looks(&self) -> Option<&Looks> {
        Some(&self.looks)
    }

    fn exchange(&self) -> Option<Exchange> {
        self.books.map(|books| books.exchange)
    }

    // The kick of a full step is centred here: half of it belongs to the forces of before.
    fn sample(&mut self, mechanism: &Mechanism, t: f64, due: &[bool]) {
        let before = self.now.wrenches.clone();
        self.dynamics.sample(mechanism, t, &self.states, due);
        self.evaluate(mechanism, t);
        if self.coupled {
            self.dynamics.replace_wrenches(&mut self.now);
        }
        if self.previous_step > 0.0 {
            for (now, before) in self.now.wrenches.iter_mut().zip(before) {
                *now = (*now + before) / 2.0;
            }
        }
    }

    fn advance(&mut self, mechanism: &Mechanism, t: f64, until: f64) -> f64 {
        self.dynamics.remember(mechanism, t, &self.states);
        if let Some(books) = &mut self.books {
            books.before = books.now;
        }
        let (dt, reached) = even_step(self.step, t, until);
        // The first step is a half kick: v_½ = v_0 + (h/2) a_0.
        let first = self.previous_step == 0.0;
        let kick = if first { 0.5 } else { 1.0 };
        for (wrench, now) in self.wrenches.iter_mut().zip(&self.now.wrenches) {
            *wrench = now * kick;
        }
        mechanism.true_commands(reached, &mut self.targets);
        let now = &self.now;
        for ((turn, state), a) in self.turns.iter_mut().zip(&self.states).zip(&now.accelerations) {
            *turn = (state.twist.z + a.z * (0.5 * dt)) * dt;
        }
        let turns = &self.turns;
        let (dynamics, commands) = (&self.dynamics, &self.targets);
        let targets = |i: usize| {
            let joint = &mechanism.prismatics[i];
            let turn = joint.base.body.map_or(0.0, |body| turns[body]);
            let length = commands[dynamics.prescribed(i)?].position;
            Some(MotorTarget::new(joint, length, now.lengths[i], turn))
        };
        let advances = |i: usize| {
            joint_advance(commands[i].position - now.coordinates[i], mechanism.ring_turn(i, turns))
        };
        self.world.step(dt, &self.wrenches, Some(turns), targets, advances);
        let [before, before_that] = &mut self.past;
        std::mem::swap(before, before_that);
        before.copy_from_slice(&self.now.accelerations);
        if first {
            before_that.copy_from_slice(before);
        }
        self.previous_step = dt;
        reached
    }
}
