//! The balance of a run: what forces should have made of the kinetic energy, and what it is.
//!
//! Exactly, `T(t) = T(0) + ∫ Σ (M a)·v dt` over all bodies, with the accelerations a that all forces and joints
//! give them. The left side is read off the states that were stepped, the right side is integrated along
//! the way, to at least the order of the stepping; the difference is what stepping got wrong.

use crate::mechanism::{Bearing, Body, BodyState, Dynamics, Evaluation, Mechanism, Revolute};

/// Power of what acts on a machine at one instant, in W.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::engine) struct Power {
    /// Of everything: the rate of the kinetic energy.
    pub total: f64,
    /// Of the drives.
    pub drives: f64,
}

impl Power {
    /// At states whose accelerations `now` knows.
    pub fn of(
        dynamics: &Dynamics,
        mechanism: &Mechanism,
        states: &[BodyState],
        now: &Evaluation,
    ) -> Self {
        let [total, drives] = dynamics.power(mechanism, states, now);
        Self { total, drives }
    }
}

/// Work done over a step or a run, in J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::engine) struct Exchange {
    pub total: f64,
    pub drives: f64,
    /// `∫ |P| dt`: how much energy changed hands.
    pub turned_over: f64,
}

impl Exchange {
    /// Over a step of `h` s, by a quadrature rule: shares of the step, each with the power there.
    pub fn over<const N: usize>(h: f64, rule: [(f64, Power); N]) -> Self {
        rule.into_iter().fold(Self::default(), |sum, (share, power)| Self {
            total: sum.total + h * share * power.total,
            drives: sum.drives + h * share * power.drives,
            turned_over: sum.turned_over + h * share * power.total.abs(),
        })
    }
}

/// What a way of stepping keeps for the balance: powers now and where the last step began, in W, and what that
/// step exchanged.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::engine) struct Books {
    pub now: Power,
    pub before: Power,
    pub exchange: Exchange,
}

/// Where the energy of a run went, in J since its start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Work of the drives.
    pub put_in: f64,
    /// Growth of the kinetic energy.
    pub kinetic: f64,
    /// Growth of the potential energy of gravity.
    pub gravity: f64,
    /// What contacts, friction, springs and other loads took: dissipated, or stored in them.
    pub taken: f64,
    /// `∫ |P| dt`, P the rate of the kinetic energy: how much changed hands.
    pub turned_over: f64,
    /// Largest kinetic energy of a row.
    pub most_kinetic: f64,
    /// By how much the kinetic energy of a row was off at most, of all rows.
    pub imbalance: f64,
}

/// Energies in J below which a balance means nothing: a thousandth of what a hit of 1 g at 1 cm/s has.
const NOTHING: f64 = 5e-11;

impl Energy {
    /// The imbalance as a share of what changed hands.
    pub fn share(&self) -> f64 {
        self.imbalance / self.turned_over.max(self.most_kinetic).max(NOTHING)
    }
}

/// Keeps the balance of a run.
#[derive(Debug)]
pub(in crate::engine) struct Ledger {
    start: [f64; 2],
    done: Option<Exchange>,
    energy: Energy,
}

impl Ledger {
    /// Of a way of stepping that says `exchanged` before its first step: nothing if it keeps no books.
    pub fn new(mechanism: &Mechanism, exchanged: Option<Exchange>) -> Self {
        let states: Vec<BodyState> = mechanism.bodies.iter().map(|body| body.start).collect();
        let start = [kinetic(mechanism, &states), potential(mechanism, &states)];
        Self { start, done: exchanged, energy: Energy::default() }
    }

    /// Takes what a step exchanged, if that is known: otherwise there is no balance.
    pub fn add(&mut self, step: Option<Exchange>) {
        self.done = self.done.zip(step).map(|(done, step)| Exchange {
            total: done.total + step.total,
            drives: done.drives + step.drives,
            turned_over: done.turned_over + step.turned_over,
        });
    }

    /// Draws the balance at the end of a step.
    pub fn draw(&mut self, mechanism: &Mechanism, states: &[BodyState]) -> Option<Energy> {
        let Exchange { total, drives, turned_over } = self.done?;
        let now = kinetic(mechanism, states);
        let gained = now - self.start[0];
        let gravity = potential(mechanism, states) - self.start[1];
        let Energy { most_kinetic, imbalance, .. } = self.energy;
        self.energy = Energy {
            put_in: drives,
            kinetic: gained,
            gravity,
            taken: drives - gravity - total,
            turned_over,
            most_kinetic: most_kinetic.max(now),
            imbalance: imbalance.max((gained - total).abs()),
        };
        Some(self.energy)
    }
}

/// `T = ½ Σ (m v² + I ω²)` in J.
fn kinetic(mechanism: &Mechanism, states: &[BodyState]) -> f64 {
    let of = |(body, state): (&Body, &BodyState)| {
        let (v, spin) = (state.twist.xy(), state.twist.z);
        0.5 * (body.mass * v.norm_squared() + body.inertia * spin * spin)
    };
    mechanism.bodies.iter().zip(states).map(of).sum()
}

/// `V = −Σ m g·x` in J.
fn potential(mechanism: &Mechanism, states: &[BodyState]) -> f64 {
    let bodies = mechanism.bodies.iter().zip(states);
    bodies.map(|(body, state)| -body.mass * mechanism.gravity.dot(&state.position)).sum()
}

/// How far rigid joints have come apart, in m: centres of ideal revolute joints, and prismatic joints across
/// their axis. (Of a prismatic joint's angle, what it makes at the slider's end.)
pub(in crate::engine) fn drift(mechanism: &Mechanism, states: &[BodyState]) -> f64 {
    let ideal = |joint: &&Revolute| matches!(joint.bearing, Bearing::Ideal);
    let gaps =
        mechanism.revolutes.iter().filter(ideal).map(|joint| {
            (joint.journal.frame(states).centre - joint.ring.frame(states).centre).norm()
        });
    let rigid = mechanism.prismatics.iter().filter(|joint| !joint.play);
    let slides = rigid.map(|joint| joint.drift(states));
    gaps.chain(slides).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use crate::engine::{Energy, Instant, Schedule, run, run_balanced};
    use crate::model::assemble;
    use crate::scenario::Scenario;
    use std::ops::ControlFlow::Continue;
    use std::sync::atomic::AtomicBool;

    fn energy(sets: &[&str], duration: f64) -> Energy {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let scenario = Scenario::load(None, &sets).expect("right");
        let machine = assemble(&scenario).expect("put together");
        let schedule = Schedule { duration, interval: 1e-3 };
        let never = AtomicBool::new(false);
        let ended =
            run_balanced(&machine.mechanism, machine.control, schedule, &never, &mut |_| {
                Continue(())
            });
        ended.unwrap_or_else(|halt| *halt.work).energy.expect("under a law")
    }

    /// The balance closes as the tolerance does, whoever drives, and at fixed steps with their square.
    #[test]
    fn the_balance_closes_with_the_error_of_stepping() {
        let gravity = "environment.gravity=[0,-9.81]";
        for (sets, most) in [
            (&["simulation.tolerance=1e-5", gravity][..], 2e-4),
            (&["simulation.tolerance=1e-8"], 1e-6),
            (&["simulation.engine=direct", gravity], 2e-4),
            (&["simulation.engine=direct", "simulation.tolerance=1e-8"], 1e-7),
            (&["simulation.tolerance=1e-5", "drive.mode=servo", gravity], 2e-4),
            (&["simulation.tolerance=1e-5", "joints.friction=0.1", gravity], 2e-4),
            (&["simulation.step=1e-5"], 2e-4),
            (&["simulation.step=5e-6"], 5e-5),
            (&["contact.law=ideal", gravity], 1e-8),
        ] {
            let energy = energy(sets, 0.2);
            assert!(energy.share() < most, "{sets:?}: {:e}", energy.share());
            let sum = energy.kinetic + energy.gravity + energy.taken;
            let left = (energy.put_in - sum).abs();
            assert!(left <= energy.imbalance + 1e-15, "{sets:?}: {energy:?}");
            assert!(energy.turned_over > 1e-5, "{energy:?}");
        }
    }

    /// At a tolerance that no hit is resolved at, energy comes from nowhere.
    #[test]
    fn energy_from_nowhere_is_seen() {
        let energy = energy(&["simulation.tolerance=2e-2", "environment.gravity=[0,-9.81]"], 0.3);
        assert!(energy.share() > 0.05, "{energy:?}");
    }

    /// Dampers far too strong for the masses, whose rattle fed on itself below the tolerance: 27 % of the energy
    /// was off.
    #[test]
    fn strong_dampers_of_contacts_are_stepped_as_they_need() {
        for engine in ["rapier", "direct"] {
            let engine = format!("simulation.engine={engine}");
            let energy = energy(&["contact.c_max=1e6", &engine], 0.3);
            assert!(energy.share() < 1e-3, "{engine}: {energy:?}");
        }
    }

    /// Keeping the balance costs evaluations that nobody else needs, and must not move anything.
    #[test]
    fn the_balance_is_kept_only_where_it_is_asked_for_and_moves_nothing() {
        for (kind, set) in [
            ("3rpr", "drive.mode=servo"),
            ("3rpr", "simulation.step=1e-5"),
            ("four-bar", "simulation.tolerance=1e-5"),
            ("3rpr", "simulation.engine=direct"),
            ("four-bar", "simulation.step=1e-5"),
        ] {
            let text = format!("mechanism.kind = '{kind}'\n");
            let scenario = Scenario::from_text(&text, "t", &[set.to_owned()]).expect("right");
            let machine = assemble(&scenario).expect("put together");
            let schedule = Schedule { duration: 0.05, interval: 1e-3 };
            let (mechanism, control) = (&machine.mechanism, machine.control);
            let [mut without, mut with] = [Vec::new(), Vec::new()];
            let bits = |instant: &Instant| format!("{:?}{:?}", instant.states, instant.tallies);
            let plain = run(mechanism, control, schedule, &mut |i| without.push(bits(i)));
            let never = AtomicBool::new(false);
            let balanced = run_balanced(mechanism, control, schedule, &never, &mut |instant| {
                with.push(bits(instant));
                Continue(())
            });
            let [plain, balanced] = [plain, balanced].map(|work| work.expect("runs to its end"));
            assert!(plain.energy.is_none() && balanced.energy.is_some(), "{kind}, {set}");
            assert!(without == with, "{kind}, {set}: the balance moved the machine");
        }
    }
}
