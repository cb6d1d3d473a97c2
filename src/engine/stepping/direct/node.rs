//! An instant of the path, and what has been exchanged until then.

use super::super::between;
use super::super::energy::Exchange;
use crate::mechanism::{BodyState, Dynamics, Evaluation, Mechanism};
use nalgebra::Vector3;

/// Where among the amounts those of the whole machine are: work of everything, of the drives, and how much
/// changed hands. Behind them comes what the normal force took in each joint, and, where that is counted, normal force
/// times sliding distance in each joint.
const TOTAL: usize = 0;
const DRIVES: usize = 1;
const TURNED_OVER: usize = 2;
const JOINTS: usize = 3;

/// An instant of the path: states, what acts there, and what has been exchanged until then.
#[derive(Clone, Debug)]
pub struct Node {
    /// Time in s.
    pub t: f64,
    /// State of each body.
    pub states: Vec<BodyState>,
    /// Forces and accelerations there.
    pub evaluation: Evaluation,
    /// Energies exchanged since the start in J, and their rates in W.
    pub amounts: Vec<f64>,
    pub flows: Vec<f64>,
    /// Whether those of the whole machine are kept, and how much journals rub.
    balanced: bool,
    rubs: bool,
}

impl Node {
    /// The start of a run; nothing is evaluated yet.
    pub fn new(mechanism: &Mechanism, balanced: bool, rubs: bool) -> Self {
        let joints = mechanism.revolutes.len();
        let amounts = vec![0.0; JOINTS + if rubs { 2 * joints } else { joints }];
        Self {
            t: 0.0,
            states: mechanism.bodies.iter().map(|body| body.start).collect(),
            evaluation: Evaluation::new(mechanism),
            flows: amounts.clone(),
            amounts,
            balanced,
            rubs,
        }
    }

    /// Finds what acts at the states that it has.
    pub fn evaluate(&mut self, dynamics: &mut Dynamics, mechanism: &Mechanism) {
        dynamics.forces(mechanism, self.t, &self.states, &mut self.evaluation);
        dynamics.accelerations(mechanism, &self.states, &mut self.evaluation);
        self.count(dynamics, mechanism);
    }

    /// The same where contacts in flight need not be described, at states that the coordinates have made; fills `row` with
    /// their accelerations.
    pub fn evaluate_on_path(
        &mut self,
        dynamics: &mut Dynamics,
        mechanism: &Mechanism,
        row: &mut [f64],
    ) {
        dynamics.act(mechanism, &self.states, &mut self.evaluation, (row, self.balanced));
        self.count(dynamics, mechanism);
    }

    /// Finds what is exchanged there.
    fn count(&mut self, dynamics: &Dynamics, mechanism: &Mechanism) {
        if self.balanced {
            let [total, drives] = dynamics.power(mechanism, &self.states, &self.evaluation);
            (self.flows[TOTAL], self.flows[DRIVES]) = (total, drives);
            self.flows[TURNED_OVER] = total.abs();
        }
        for (flow, contact) in self.flows[JOINTS..].iter_mut().zip(&self.evaluation.contacts) {
            *flow = contact.normal_force * contact.rate;
        }
        if self.rubs {
            let slides = self.flows[JOINTS + mechanism.revolutes.len()..].iter_mut();
            for (flow, contact) in slides.zip(&self.evaluation.contacts) {
                *flow = contact.rubbing_power();
            }
        }
    }

    /// Makes it the instant `t` (s) between two others; `shifts` is the way from one to the other.
    pub fn interpolate(&mut self, [from, to]: [&Node; 2], shifts: &[Vector3<f64>], t: f64) {
        let h = to.t - from.t;
        let s = (t - from.t) / h;
        self.t = t;
        for (i, state) in self.states.iter_mut().enumerate() {
            let ends = [from, to].map(|node| (&node.states[i], node.evaluation.accelerations[i]));
            *state = between::state(h, s, ends, shifts[i]);
        }
        let ends = from.amounts.iter().zip(&to.amounts).zip(from.flows.iter().zip(&to.flows));
        for (amount, ((a, b), (from, to))) in self.amounts.iter_mut().zip(ends) {
            *amount = a + between::growth(h, s, [*from, *to], b - a);
        }
    }

    /// What has been exchanged since the amounts were those, where that is kept.
    pub fn exchange(&self, since: &[f64]) -> Option<Exchange> {
        let of = |k: usize| self.amounts[k] - since[k];
        self.balanced.then(|| Exchange {
            total: of(TOTAL),
            drives: of(DRIVES),
            turned_over: of(TURNED_OVER),
        })
    }

    /// What the normal force of each joint has taken since then, and, where that is kept, behind it normal force times
    /// sliding distance.
    pub fn joint_work(&self, since: &[f64], work: &mut [f64]) {
        let pairs = self.amounts[JOINTS..].iter().zip(&since[JOINTS..]);
        for (work, (now, then)) in work.iter_mut().zip(pairs) {
            *work = now - then;
        }
    }
}
