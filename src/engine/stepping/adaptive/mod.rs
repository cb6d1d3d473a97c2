//! Stepping under error control: path-averaged leapfrog, fourth order on the smooth parts.
//!
//! rapier's velocity after a step is the step's mean velocity `v_{n+½} = (x_{n+1} − x_n)/h`, and for
//! any sequence of steps, exactly,
//!
//! `v_{n+½} − v_{n−½} = ∫ hat(t) a(t) dt`, hat rising 0→1 over the past step, falling 1→0 over the
//! next.
//!
//! Forces cost little and a rapier step costs much, so rapier is handed the hat-averaged force of a
//! path that is predicted locally, `x + vτ + aτ²/2 + jτ³/6`, by four-point Lobatto quadrature. What
//! the forward half of the last average got wrong is made good in the next, where the path is known
//! better: `kick = ∫F over the past step − forward part given before + forward part`.

mod ahead;

use super::between;
use super::energy::{Books, Exchange, Power};
use super::looks::Looks;
use super::stepper::Stepper;
use crate::engine::physics::world::{MotorTarget, World, joint_advance};
use crate::mechanism::{Bearing, BodyState, Command, Dynamics, Evaluation, Mechanism};
use nalgebra::Vector3;

/// Inner nodes of the four-point Lobatto rule on [0, 1]: ½(1 ∓ 1/√5); weights 1, 5, 5, 1 over 12.
const NODES: [f64; 2] = [0.276_393_202_250_021, 0.723_606_797_749_979];

/// Longest step in s under error control: a journal at 0.3 m/s crosses 50 µm in it, so that no hit is
/// stepped over. With steps of 2e-4 s the energy of the paper's machine is off by three times as much at a tolerance of
/// 1e-3 m/s.
pub const LONGEST_STEP: f64 = 1.6e-4;

/// Part of the tolerance that the error of a step may reach. With it, paths and drive forces of the paper's machine (both
/// drives, with gravity and without, ten start phases, 1e-5 and 1e-7 m/s) err no more than with all of the tolerance and
/// steps that end at rows of 0.1 ms, which take more steps; with all of it, drive forces err up to three times as much.
const SAFETY: f64 = 0.7;

/// First step in s, before anything is known of the error.
const FIRST_STEP: f64 = 1e-6;

/// Steps whose length keeps the velocity error of each at a tolerance.
pub(in crate::engine) struct Adaptive {
    tolerance: f64,
    longest: f64,
    pub(in crate::engine) world: World,
    dynamics: Dynamics,
    /// Joints share bodies: rapier is handed the joint forces with the others.
    coupled: bool,
    /// The present instant: synchronised states and their evaluation.
    states: Vec<BodyState>,
    now: Evaluation,
    /// Twists v_{n−½} as rapier holds them.
    half: Vec<Vector3<f64>>,
    jerks: Vec<Vector3<f64>>,
    /// The instant before: length of the step since, states, wrenches and accelerations.
    previous_step: f64,
    previous_states: Vec<BodyState>,
    previous_wrenches: Vec<Vector3<f64>>,
    previous_commands: Vec<Command>,
    previous_accelerations: Vec<Vector3<f64>>,
    /// Forward part of the last average, N·s.
    forward: Vec<Vector3<f64>>,
    next_length: f64,
    /// Estimated error of the last step in m/s.
    step_error: f64,
    /// Whether the last step was taken although its error exceeds the tolerance.
    forced: bool,
    /// Kept only where somebody asked for the balance.
    books: Option<Books>,
    /// Work space: a point of the predicted path.
    path_states: Vec<BodyState>,
    path: Evaluation,
    ends: Vec<Vector3<f64>>,
    sums: Vec<Vector3<f64>>,
    turns: Vec<f64>,
    looks: Looks,
    errors: Vec<Vector3<f64>>,
    /// When the last step ended, in s, and an instant inside it.
    end: f64,
    inside: Inside,
}

/// A row between a step's ends.
struct Inside {
    /// Whether it is the present instant.
    present: bool,
    states: Vec<BodyState>,
    evaluation: Evaluation,
}

/// Share of the tolerance that a machine gets: in proportion to its smallest clearance, from
/// 0.5 mm down to 10 µm.
///
/// The less play, the slower the journals hit, and an error that is small against hits of 0.1 m/s
/// damps the rattle away where hits come at 1 mm/s. Below 10 µm the penetration (some µm) takes the
/// place of the clearance, and the share stays. Found on the statistics of an independent solver:
/// with it, one tolerance reproduces them from 1 mm to 10 nm.
pub(in crate::engine) fn share(mechanism: &Mechanism) -> f64 {
    let clearances = mechanism.revolutes.iter().filter_map(|joint| match &joint.bearing {
        Bearing::Clearance(clearance) => Some(clearance.radial()),
        Bearing::Ideal | Bearing::Native { .. } => None,
    });
    clearances.fold(5e-4, f64::min).max(1e-5) / 5e-4
}

impl Adaptive {
    /// Steps with a velocity error of about `tolerance` m/s each, less where joints are tight (see
    /// [`share`]); with `books` it keeps what a balance of energy needs.
    pub fn new(mechanism: &Mechanism, tolerance: f64, books: Option<Books>) -> Self {
        let bodies = mechanism.bodies.len();
        let zeros = vec![Vector3::zeros(); bodies];
        let states: Vec<BodyState> = mechanism.bodies.iter().map(|b| b.start).collect();
        let dynamics = Dynamics::new(mechanism);
        Self {
            tolerance: SAFETY * tolerance * share(mechanism),
            longest: mechanism.longest_servo_step().map_or(LONGEST_STEP, |s| s.min(LONGEST_STEP)),
            world: World::new(mechanism, false),
            coupled: dynamics.coupled(),
            dynamics,
            half: states.iter().map(|s| s.twist).collect(),
            path_states: states.clone(),
            previous_states: states.clone(),
            end: 0.0,
            inside: Inside {
                present: false,
                states: states.clone(),
                evaluation: Evaluation::new(mechanism),
            },
            states,
            now: Evaluation::new(mechanism),
            path: Evaluation::new(mechanism),
            jerks: zeros.clone(),
            previous_step: 0.0,
            previous_wrenches: zeros.clone(),
            previous_commands: vec![Command::default(); mechanism.actuators.len()],
            previous_accelerations: zeros.clone(),
            forward: zeros.clone(),
            next_length: FIRST_STEP,
            step_error: 0.0,
            forced: false,
            books,
            ends: zeros.clone(),
            sums: zeros.clone(),
            turns: vec![0.0; bodies],
            looks: Looks::new(NODES.len(), mechanism.revolutes.len()),
            errors: zeros,
        }
    }

    /// Enters the present power in the books.
    fn book(&mut self, mechanism: &Mechanism) {
        if let Some(books) = &mut self.books {
            books.now = Power::of(&self.dynamics, mechanism, &self.states, &self.now);
        }
    }

    /// Power at the point of the path that was looked at last, a share `s` into the past step.
    fn power_inside(&mut self, mechanism: &Mechanism, s: f64) -> Power {
        if !self.coupled {
            self.path.command_between(&self.previous_commands, &self.now.commands, s);
            self.dynamics.accelerations(mechanism, &self.path_states, &mut self.path);
        }
        Power::of(&self.dynamics, mechanism, &self.path_states, &self.path)
    }

    /// The past step once more, on the corrected path: the sum of its forces and, where books are kept, their
    /// work.
    fn look_back(&mut self, mechanism: &Mechanism, t: f64) {
        let hp = self.previous_step;
        for (sum, (before, now)) in
            self.sums.iter_mut().zip(self.previous_wrenches.iter().zip(&self.now.wrenches))
        {
            *sum = before + now;
        }
        if hp > 0.0 {
            let mut inside = [Power::default(); 2];
            for (k, (power, s)) in inside.iter_mut().zip(NODES).enumerate() {
                let back = -hp * (1.0 - s);
                self.look(mechanism, t, back);
                self.looks.set(k, t + back, &self.path.contacts);
                if self.books.is_some() {
                    *power = self.power_inside(mechanism, s);
                }
                for (sum, w) in self.sums.iter_mut().zip(&self.path.wrenches) {
                    *sum += w * 5.0;
                }
            }
            if let Some(books) = &mut self.books {
                let [outer, inner] = [1.0 / 12.0, 5.0 / 12.0];
                let [first, second] = inside;
                let rule =
                    [(outer, books.before), (inner, first), (inner, second), (outer, books.now)];
                books.exchange = Exchange::over(hp, rule);
            }
        }
    }

    /// Lets rapier take a step of `h` s under the forces of `sums` (N), and joints with it.
    #[inline]
    fn step_world(&mut self, mechanism: &Mechanism, h: f64) {
        for (i, turn) in self.turns.iter_mut().enumerate() {
            let (a, j) = (self.now.accelerations[i].z, self.jerks[i].z);
            *turn = (self.states[i].twist.z + (a / 2.0 + j * (h / 6.0)) * h) * h;
        }
        // The path was last looked at where the step ends, so its commands and lengths are the
        // targets.
        let (turns, now, path) = (&self.turns, &self.now, &self.path);
        let dynamics = &self.dynamics;
        let targets = |i: usize| {
            let joint = &mechanism.prismatics[i];
            let commanded = dynamics.prescribed(i).map(|drive| path.commands[drive].position);
            let turn = joint.base.body.map_or(0.0, |body| turns[body]);
            Some(MotorTarget::new(
                joint,
                commanded.unwrap_or(path.lengths[i]),
                now.lengths[i],
                turn,
            ))
        };
        let advances = |i: usize| {
            let advance = path.commands[i].position - now.coordinates[i];
            joint_advance(advance, mechanism.ring_turn(i, turns))
        };
        self.world.step(h, &self.sums, Some(turns), targets, advances);
    }
}

impl Stepper for Adaptive {
    fn synchronise(&mut self, mechanism: &Mechanism, t: f64) {
        let hp = self.previous_step;
        self.end = t;
        self.inside.present = false;
        if self.coupled {
            self.dynamics.forget_singular();
        }
        if hp > 0.0 {
            self.world.read(&mut self.states);
            for (half, state) in self.half.iter_mut().zip(&self.states) {
                *half = state.twist;
            }
            self.now.accelerations.copy_from_slice(&self.ends);
        }
        for _ in 0..2 {
            if hp > 0.0 {
                for i in 0..self.states.len() {
                    let a = self.now.accelerations[i];
                    self.jerks[i] = (a - self.previous_accelerations[i]) / hp;
                    self.states[i].twist =
                        self.half[i] + (a / 2.0 - self.jerks[i] * (hp / 6.0)) * hp;
                }
            }
            self.dynamics.forces(mechanism, t, &self.states, &mut self.now);
            self.dynamics.accelerations(mechanism, &self.states, &mut self.now);
        }
        self.book(mechanism);
        if self.coupled {
            self.dynamics.replace_wrenches(&mut self.now);
        }
        if hp > 0.0 {
            for i in 0..self.states.len() {
                self.jerks[i] = (self.now.accelerations[i] - self.previous_accelerations[i]) / hp;
            }
        }
        self.look_back(mechanism, t);
    }

    fn ends_at_rows(&self) -> bool {
        false
    }

    fn read(&mut self, mechanism: &Mechanism, t: f64) {
        self.inside.present = t < self.end;
        if !self.inside.present {
            return;
        }
        let h = self.previous_step;
        let s = 1.0 - (self.end - t) / h;
        let Inside { states, evaluation, .. } = &mut self.inside;
        for (i, state) in states.iter_mut().enumerate() {
            let (from, to) = (&self.previous_states[i], &self.states[i]);
            let turn = (to.rotation / from.rotation).angle();
            let ends = [(from, self.previous_accelerations[i]), (to, self.now.accelerations[i])];
            // Rates go by those at both ends, which forces do; rapier's way has the error of the step, spread over it.
            let [a, b] = ends.map(|(_, acceleration)| acceleration);
            let shift = (from.twist + to.twist) * (h / 2.0) + (a - b) * (h * h / 12.0);
            let left = (to.position - from.position).push(turn) - shift;
            *state = between::state(h, s, ends, shift).displaced(left * (s * s * (3.0 - 2.0 * s)));
        }
        // What steps are controlled by must not hear of rows.
        let singular = self.dynamics.was_singular();
        self.dynamics.forces(mechanism, t, states, evaluation);
        self.dynamics.accelerations(mechanism, states, evaluation);
        if !singular {
            self.dynamics.forget_singular();
        }
    }

    fn states(&self) -> &[BodyState] {
        if self.inside.present { &self.inside.states } else { &self.states }
    }

    fn evaluation(&self) -> &Evaluation {
        if self.inside.present { &self.inside.evaluation } else { &self.now }
    }

    fn step_error(&self) -> Option<f64> {
        Some(self.step_error)
    }

    fn looks(&self) -> Option<&Looks> {
        Some(&self.looks)
    }

    fn exchange(&self) -> Option<Exchange> {
        self.books.map(|books| books.exchange)
    }

    fn forced(&self) -> bool {
        self.forced
    }

    // The jerk stays that of before: a force that jumps says nothing of how it goes on.
    fn sample(&mut self, mechanism: &Mechanism, t: f64, due: &[bool]) {
        self.dynamics.sample(mechanism, t, &self.states, due);
        self.dynamics.forces(mechanism, t, &self.states, &mut self.now);
        self.dynamics.accelerations(mechanism, &self.states, &mut self.now);
        self.book(mechanism);
        if self.coupled {
            self.dynamics.replace_wrenches(&mut self.now);
        }
    }

    fn advance(&mut self, mechanism: &Mechanism, t: f64, until: f64) -> f64 {
        self.dynamics.remember(mechanism, t, &self.states);
        if let Some(books) = &mut self.books {
            books.before = books.now;
        }
        self.forced = false;
        let hp = self.previous_step;
        for (sum, forward) in self.sums.iter_mut().zip(&self.forward) {
            *sum = *sum * (hp / 12.0) - forward;
        }
        let (h, reached) = self.next_step(mechanism, t, until);
        for (sum, forward) in self.sums.iter_mut().zip(&self.forward) {
            *sum = (*sum + forward) / h;
        }
        self.step_world(mechanism, h);
        self.previous_states.copy_from_slice(&self.states);
        self.previous_wrenches.copy_from_slice(&self.now.wrenches);
        self.previous_commands.copy_from_slice(&self.now.commands);
        self.previous_accelerations.copy_from_slice(&self.now.accelerations);
        self.previous_step = h;
        reached
    }
}
