//! The machine without clearance: where it would be, and the forces it would take.

use crate::mechanism::{BodyState, Dynamics, Evaluation, Mechanism};
use nalgebra::{Vector2, Vector3};
use std::fmt;

/// States of all bodies of the ideal machine at a time in s.
type StatesAt = Box<dyn Fn(f64) -> Vec<BodyState> + Send + Sync>;

/// A machine with ideal joints and prescribed drives. Its states follow from the motion alone, its
/// forces from the equations of motion at those states: nothing is integrated.
pub struct Ideal {
    mechanism: Mechanism,
    states_at: StatesAt,
    dynamics: Dynamics,
    now: Evaluation,
}

/// The ideal machine at one instant.
#[derive(Clone, Copy, Debug)]
pub struct IdealInstant<'a> {
    /// Position of the output body's centre of mass in m.
    pub position: Vector2<f64>,
    /// Its velocity in m/s.
    pub velocity: Vector2<f64>,
    /// Acceleration of the output body (m/s², m/s², rad/s²).
    pub acceleration: Vector3<f64>,
    /// Force of each drive in N.
    pub drive_forces: &'a [f64],
}

impl Ideal {
    /// `mechanism` has ideal joints and prescribed drives only; `states_at` says where its bodies
    /// are at a time.
    pub(super) fn new(mechanism: Mechanism, states_at: StatesAt) -> Self {
        let (dynamics, now) = (Dynamics::new(&mechanism), Evaluation::new(&mechanism));
        Self { mechanism, states_at, dynamics, now }
    }

    /// The ideal machine at time `t` in s.
    pub fn at(&mut self, t: f64) -> IdealInstant<'_> {
        let states = (self.states_at)(t);
        self.dynamics.forces(&self.mechanism, t, &states, &mut self.now);
        self.dynamics.accelerations(&self.mechanism, &states, &mut self.now);
        let output = self.mechanism.output;
        IdealInstant {
            position: states[output].position,
            velocity: states[output].twist.xy(),
            acceleration: self.now.accelerations[output],
            drive_forces: &self.now.drive_forces,
        }
    }
}

impl fmt::Debug for Ideal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Ideal").field("mechanism", &self.mechanism).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use crate::scenario::Scenario;
    use crate::simulate::assemble;

    /// Drive forces against an independent solver's, platform acceleration against the motion's.
    #[test]
    fn forces_are_those_of_the_independent_solver() {
        for (set, file) in [("0,0", "ideal.csv"), ("0,-9.81", "ideal_gravity.csv")] {
            let set = format!("environment.gravity=[{set}]");
            let scenario = Scenario::load(None, &[set]).expect("right");
            let mut machine = assemble(&scenario).expect("no table to read");
            let path = format!("{}/assets/reference/{file}", env!("CARGO_MANIFEST_DIR"));
            let mut reader = csv::Reader::from_path(path).expect("reference");
            for record in reader.records() {
                let row: Vec<f64> =
                    record.expect("row").iter().map(|f| f.parse().expect("number")).collect();
                let instant = machine.ideal.at(row[0]);
                for (force, expected) in instant.drive_forces.iter().zip(&row[4..7]) {
                    assert!((force - expected).abs() < 1e-8, "{file} {row:?}: {force}");
                }
                let motion = machine.motion.at(row[0]);
                assert!((instant.acceleration - motion.acceleration).norm() < 1e-9);
                assert!((instant.position - motion.pose.xy()).norm() < 1e-15);
            }
        }
    }
}
