//! Stepping without the physics engine: the mechanism's own equations of motion, integrated by a Runge–Kutta
//! pair of orders 5(4) under error control.
//!
//! * `tsitouras.rs`: the pair, and the path between a step's ends.
//! * `onset.rs`: steps end shortly after a contact begins, and before it where that is far: the force is not
//!   smooth there.
//! * `path.rs`: the way from a step's start to its end, coordinates in a row.
//! * `node.rs`: an instant, and what has been going on until then.
//!
//! Rigid joints are met in their accelerations (Gauss' principle) and, after each step, in places and velocities
//! ([`Dynamics::project`]). Rows between a step's ends are read from the path between them, so that steps do
//! not depend on what is asked for; sampled controllers alone end steps.

mod node;
mod onset;
mod path;
mod tsitouras;

use self::node::Node;
use self::onset::next_onset;
use self::path::Path;
use self::tsitouras::{C, WEIGHTS};
use super::adaptive::share;
use super::energy::Exchange;
use super::looks::Looks;
use super::stepper::Stepper;
use crate::mechanism::{BodyState, Dynamics, Evaluation, Mechanism, Situation};

/// First step in s, before anything is known of the error.
const FIRST_STEP: f64 = 1e-5;

/// Longest step in s: in free flight the error limits nothing, and the forecast of its end is only so good.
const LONGEST_STEP: f64 = 1e-3;

/// Shortest step in s that is tried: below it times of a run of some seconds no longer differ.
const SHORTEST_STEP: f64 = 1e-14;

/// Shortest step in s that error control asks for where rigid joints are nearly singular: a shorter one ends
/// closer to such a pose, and loses more than it wins.
const SINGULAR_STEP: f64 = 2e-5;

/// Angle in rad that a body may turn by in one step: whole turns are counted from one to the next.
const LARGEST_TURN: f64 = 0.5;

/// Longest step of a damper in units of what an explicit step of first order stands: the pair is stable up to
/// 3.3 of them.
const STIFF: f64 = 2.0;

/// Share of the step that would meet the tolerance, and bounds of what a step grows or shrinks by.
const SAFETY: f64 = 0.9;
const LARGEST_GROWTH: f64 = 5.0;
const LARGEST_SHRINKAGE: f64 = 0.2;

/// The estimate is of order h⁵: exponent of the error in the step's growth, and of the error before it (the PI
/// controller of Gustafsson, with β of Hairer & Wanner, *Solving ODEs II*, §IV.2).
const EXPONENT: f64 = 0.2;
const BETA: f64 = 0.04;

/// A step from further away than so many reaches would weigh the force at its end by its own length: it stops
/// short of the onset, at this part of the forecast, which leaves accelerations out.
const NEAR: f64 = 2.0;
const APPROACH: f64 = 0.95;

/// The step after an onset is at most so many times as long as the reach into it.
const AFTER_ONSET: f64 = 3.0;

/// Steps of the mechanism's own equations of motion.
pub(in crate::engine) struct Direct {
    tolerance: f64,
    dynamics: Dynamics,
    /// The step made last.
    start: Node,
    end: Node,
    path: Path,
    /// An instant between the two, and whether it is the present one.
    inside: Node,
    is_inside: bool,
    /// Length in s that the error lets the next step have, and the one that the contact just begun does.
    wanted: f64,
    after_onset: f64,
    log_before: f64,
    step_error: f64,
    /// Whether the last step was taken although its error exceeds the tolerance.
    forced: bool,
    /// What the normal force of each joint has taken since the last step began, in J, and, where that is counted, behind
    /// that normal force times sliding distance.
    work: Vec<f64>,
}

/// Velocity error in m/s that a step of the pair may make for a run to be as good as one of the physics engine
/// at this `tolerance` (m/s), on the whole.
///
/// The pair's steps are several times as long, and each of its errors counts for more; and where contacts begin
/// and end in numbers, the error of a run falls with the 0.8th power of a step's, not in proportion. Measured on the
/// paper's machine, 8 starts of each of six cases: at 1e-7 m/s it is as exact as the engine's at 1e-5 (by factors
/// of 0.4 to 10), and with this power so it is from 1e-4 to 1e-7. Joints tighter than 0.1 mm ask no more of it: with the engine's
/// own share ([`share`]) runs with 10 nm of play err by a sixth of what the engine's do, with this one by as much.
fn step_tolerance(mechanism: &Mechanism, tolerance: f64) -> f64 {
    1e-7 * (tolerance / 1e-5).powf(1.25) * share(mechanism).max(LEAST_SHARE)
}

/// Share of the tolerance at 0.1 mm of play, and below.
const LEAST_SHARE: f64 = 0.2;

impl Direct {
    /// Steps that make a run about as exact as the physics engine's with `tolerance` (m/s), less where joints
    /// are tight; `balanced` ones keep what a balance of energy needs, and where `rubs` is true how much journals rub.
    pub fn new(mechanism: &Mechanism, tolerance: f64, balanced: bool, rubs: bool) -> Self {
        let joints = mechanism.revolutes.len();
        let node = Node::new(mechanism, balanced, rubs);
        let dynamics = Dynamics::new(mechanism);
        Self {
            tolerance: step_tolerance(mechanism, tolerance),
            path: Path::new(mechanism, &dynamics, &node),
            dynamics,
            work: vec![0.0; if rubs { 2 * joints } else { joints }],
            start: node.clone(),
            inside: node.clone(),
            end: node,
            is_inside: false,
            wanted: FIRST_STEP,
            after_onset: f64::INFINITY,
            log_before: 0.0,
            step_error: 0.0,
            forced: false,
        }
    }

    fn present(&self) -> &Node {
        if self.is_inside { &self.inside } else { &self.end }
    }

    /// The longest step from here that loads, turning and flights allow, and the longest that the step
    /// after it may be.
    fn bounds(&self, mechanism: &Mechanism) -> [f64; 2] {
        let Node { t, states, evaluation, .. } = &self.start;
        let at = Situation { t: mechanism.epoch + t, mechanism, states, angles: None };
        let loads = mechanism.loads.iter().filter_map(|load| load.longest_step_at(at));
        let fastest = states.iter().map(|state| state.twist.z.abs()).fold(0.0, f64::max);
        let longest = loads.map(|step| STIFF * step).fold(LONGEST_STEP, f64::min);
        let contacts = self.dynamics.longest_contact_step(mechanism, &evaluation.contacts);
        let h = self
            .wanted
            .min(self.after_onset)
            .min(longest)
            .min(contacts)
            .min(LARGEST_TURN / fastest);
        match next_onset(mechanism, states, &evaluation.contacts) {
            Some(onset) if onset.time < h => {
                let reach = onset.reach(mechanism, self.tolerance);
                if onset.time > NEAR * reach {
                    [APPROACH * onset.time, f64::INFINITY]
                } else if onset.time + reach < h {
                    [onset.time + reach, AFTER_ONSET * reach]
                } else {
                    [h, f64::INFINITY]
                }
            }
            _ => [h, f64::INFINITY],
        }
    }

    /// Goes one step on from the last one's end, not beyond `until` s.
    fn step(&mut self, mechanism: &Mechanism, until: f64) {
        self.dynamics.remember(mechanism, self.end.t, &self.end.states);
        std::mem::swap(&mut self.start, &mut self.end);
        self.path.begin(&mut self.dynamics, &self.start);
        self.forced = false;
        let [mut h, after_onset] = self.bounds(mechanism);
        loop {
            let mut reached = self.start.t + h;
            let span = until - self.start.t;
            if h >= span * (1.0 - 1e-9) {
                (h, reached) = (span, until);
            } else if h > 0.5 * span {
                // No sliver is left before the end.
                h = 0.5 * span;
                reached = self.start.t + h;
            }
            self.dynamics.forget_singular();
            self.go(mechanism, h);
            self.end.t = reached;
            self.step_error = self.path.error(h);
            let ratio = self.step_error / self.tolerance;
            // Shorter steps do not help against the errors of a nearly singular pose.
            self.forced = self.dynamics.was_singular() && h <= SINGULAR_STEP && ratio > 1.0;
            if ratio <= 1.0 || self.forced || h <= SHORTEST_STEP {
                let log = ratio.max(1e-5).ln();
                let growth = BETA * self.log_before - (EXPONENT - 0.75 * BETA) * log;
                self.log_before = log;
                let factor = (SAFETY * growth.exp()).clamp(LARGEST_SHRINKAGE, LARGEST_GROWTH);
                self.wanted = if self.forced { h } else { h * factor };
                self.after_onset = after_onset;
                return;
            }
            // No number at all means far too long.
            h *= (SAFETY * ratio.powf(-EXPONENT)).max(LARGEST_SHRINKAGE);
        }
    }

    /// One step of `h` s from start to end.
    fn go(&mut self, mechanism: &Mechanism, h: f64) {
        let flows = self.end.amounts.iter_mut().zip(&self.start.amounts).zip(&self.start.flows);
        for ((amount, before), flow) in flows {
            *amount = before + h * WEIGHTS[0] * flow;
        }
        self.stage::<1>(mechanism, h);
        self.stage::<2>(mechanism, h);
        self.stage::<3>(mechanism, h);
        self.stage::<4>(mechanism, h);
        self.stage::<5>(mechanism, h);
        self.stage::<6>(mechanism, h);
    }

    fn stage<const I: usize>(&mut self, mechanism: &Mechanism, h: f64) {
        let Self { start, end, path, dynamics, .. } = self;
        end.t = start.t + C[I] * h;
        path.go::<I>(dynamics, mechanism, h, [start, end]);
        if WEIGHTS[I] != 0.0 {
            for (amount, flow) in end.amounts.iter_mut().zip(&end.flows) {
                *amount += h * WEIGHTS[I] * flow;
            }
        }
    }
}

impl Stepper for Direct {
    fn synchronise(&mut self, mechanism: &Mechanism, _: f64) {
        self.is_inside = false;
        if self.end.t == 0.0 {
            self.end.evaluate(&mut self.dynamics, mechanism);
        }
        self.end.joint_work(&self.start.amounts, &mut self.work);
    }

    fn ends_at_rows(&self) -> bool {
        false
    }

    fn read(&mut self, mechanism: &Mechanism, t: f64) {
        self.is_inside = t < self.end.t;
        if self.is_inside {
            self.inside.interpolate([&self.start, &self.end], self.path.shifts(), t);
            self.inside.evaluate(&mut self.dynamics, mechanism);
        }
        let Self { is_inside, inside, end, work, .. } = self;
        let now = if *is_inside { inside } else { end };
        now.joint_work(&self.start.amounts, work);
    }

    fn states(&self) -> &[BodyState] {
        &self.present().states
    }

    fn evaluation(&self) -> &Evaluation {
        &self.present().evaluation
    }

    fn step_error(&self) -> Option<f64> {
        Some(self.step_error)
    }

    fn forced(&self) -> bool {
        self.forced
    }

    fn looks(&self) -> Option<&Looks> {
        Some(self.path.looks())
    }

    fn joint_work(&self) -> Option<&[f64]> {
        Some(&self.work)
    }

    fn slid(&self) -> Option<&[f64]> {
        let joints = self.end.evaluation.contacts.len();
        Some(&self.work[joints..]).filter(|slid| !slid.is_empty())
    }

    fn exchange(&self) -> Option<Exchange> {
        self.end.exchange(&self.start.amounts)
    }

    fn sample(&mut self, mechanism: &Mechanism, t: f64, due: &[bool]) {
        self.dynamics.sample(mechanism, t, &self.end.states, due);
        self.end.evaluate(&mut self.dynamics, mechanism);
    }

    fn advance(&mut self, mechanism: &Mechanism, _: f64, until: f64) -> f64 {
        self.step(mechanism, until);
        self.end.t
    }
}
