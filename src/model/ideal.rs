//! The machine without clearance: where it would be, and the forces it would take.

use super::ideal_past::{Past, Said};
use crate::engine::{self, Schedule, StepControl};
use crate::mechanism::{BodyState, Dynamics, Evaluation, Mechanism, TelescopicLegs, Tracker};
use nalgebra::{Vector2, Vector3};

/// A machine with ideal joints and prescribed drives. Where its motion leaves it no freedom its states follow
/// from that alone, its forces from the equations of motion at those states; otherwise it is simulated.
///
/// ```
/// use freeplay::prelude::*;
///
/// let mut machine = assemble(&Scenario::load(None, &[])?)?;
/// let now = machine.ideal.at(0.1);
/// assert_eq!(now.drive_forces.len(), 3);
/// let asked = machine.motion.at(0.1);
/// assert!((now.acceleration - asked.acceleration).norm() < 1e-6 * asked.acceleration.norm().max(1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Ideal {
    mechanism: Mechanism,
    states: States,
    dynamics: Dynamics,
    now: Evaluation,
    said: Said,
    pub(super) past: Past,
}

/// Where the states of the ideal machine come from.
#[derive(Debug)]
pub(super) enum States {
    /// Legs in closed form.
    Legs(TelescopicLegs),
    /// Newton's method from the pose before, so that loops stay on their branch.
    Tracked(Box<Tracker>),
    /// A simulation at the rows of the schedule, once somebody asks.
    Simulated { schedule: Schedule, control: StepControl, rows: Vec<Vec<BodyState>> },
}

/// The ideal machine at one instant.
#[derive(Clone, Copy, Debug)]
pub struct IdealInstant<'a> {
    /// Position of the output in m.
    pub position: Vector2<f64>,
    /// Its velocity in m/s.
    pub velocity: Vector2<f64>,
    /// Acceleration of the output (m/s², m/s², rad/s²).
    pub acceleration: Vector3<f64>,
    /// Effort of each drive in N or N·m.
    pub drive_forces: &'a [f64],
}

impl Ideal {
    /// `mechanism` has ideal joints and prescribed drives only.
    pub(super) fn new(mechanism: Mechanism, states: States) -> Self {
        let (dynamics, now) = (Dynamics::new(&mechanism), Evaluation::new(&mechanism));
        let (said, past) = (Said::of(now.drive_forces.len()), Past::default());
        Self { mechanism, states, dynamics, now, said, past }
    }

    /// Whether the motion alone says where the machine is.
    pub fn is_kinematic(&self) -> bool {
        !matches!(self.states, States::Simulated { .. })
    }

    /// The mechanism without clearance.
    pub fn mechanism(&self) -> &Mechanism {
        &self.mechanism
    }

    /// States of all bodies at time `t` in s; of a simulated machine at the row next to it. None where it
    /// cannot be.
    pub fn states(&mut self, t: f64) -> Option<Vec<BodyState>> {
        match &mut self.states {
            States::Legs(legs) => Some(legs.states(t)),
            States::Tracked(tracker) => {
                tracker.advance(t).ok()?;
                Some(tracker.states().to_vec())
            }
            States::Simulated { schedule, control, rows } => {
                if rows.is_empty() {
                    // A run that breaks down has fewer rows: what lies beyond is not known.
                    let _broken_down =
                        engine::run(&self.mechanism, *control, *schedule, &mut |instant| {
                            rows.push(instant.states.to_vec());
                        });
                }
                rows.get((t / schedule.interval).round() as usize).or(rows.last()).cloned()
            }
        }
    }

    /// The ideal machine at time `t` in s; not a number where it cannot be.
    pub fn at(&mut self, t: f64) -> IdealInstant<'_> {
        match self.past.next(t) {
            Some(said) => self.said.clone_from(said),
            None => {
                self.look(t);
                self.past.keep(&self.said);
            }
        }
        let Said { position, velocity, acceleration, drive_forces, .. } = &self.said;
        let (position, velocity, acceleration) = (*position, *velocity, *acceleration);
        IdealInstant { position, velocity, acceleration, drive_forces }
    }

    /// Looks at it at time `t` in s.
    fn look(&mut self, t: f64) {
        let states = self.states(t);
        let said = &mut self.said;
        said.t = t;
        let Some(states) = states else {
            (said.position, said.velocity) = (Vector2::repeat(f64::NAN), Vector2::repeat(f64::NAN));
            said.acceleration = Vector3::repeat(f64::NAN);
            said.drive_forces.fill(f64::NAN);
            return;
        };
        self.dynamics.forces(&self.mechanism, t, &states, &mut self.now);
        self.dynamics.accelerations(&self.mechanism, &states, &mut self.now);
        self.dynamics.remember(&self.mechanism, t, &states);
        let output = self.mechanism.output_state(&states);
        (said.position, said.velocity) = (output.position, output.twist.xy());
        said.acceleration = self.mechanism.output_acceleration(&states, &self.now.accelerations);
        said.drive_forces.copy_from_slice(&self.now.drive_forces);
    }
}

#[cfg(test)]
mod tests {
    use crate::model::assemble;
    use crate::scenario::Scenario;

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
