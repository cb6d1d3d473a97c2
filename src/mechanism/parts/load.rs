//! What acts on a mechanism beside gravity, contacts and drives.

use crate::mechanism::{BodyState, JointIndex, Mark, Mechanism, angle_near};
use nalgebra::{Vector2, Vector3};
use std::fmt::Debug;
use std::sync::Arc;

/// A mechanism at one instant.
///
/// [`Load`] has an example.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a> {
    /// Time in s.
    pub t: f64,
    /// What moves.
    pub mechanism: &'a Mechanism,
    /// State of each body.
    pub states: &'a [BodyState],
    /// Angle of each body in rad, whole turns included, where these are known by themselves: what remembers them for itself has
    /// no need.
    pub angles: Option<&'a [f64]>,
}

/// What a load remembers of the end of the last step, where its wrenches depend on the way there: two
/// numbers of its own.
pub type Memory = [f64; 2];

/// A load on the bodies that follows from time and their states, and, of a load with a memory, from what
/// it remembers.
///
/// ```
/// use freeplay::mechanism::{Body, BodyState, Dynamics, Evaluation, Load, Mechanism, Situation};
/// use nalgebra::Vector3;
/// use std::sync::Arc;
///
/// /// A wind that grows with time.
/// #[derive(Debug)]
/// struct Wind;
///
/// impl Load for Wind {
///     fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
///         wrenches[0].x += 3.0 * at.t;
///     }
/// }
///
/// let mut mechanism = Mechanism::free(vec![Body::new("sail", 2.0, 0.1, BodyState::ground())]);
/// mechanism.loads.push(Arc::new(Wind));
/// let mut now = Evaluation::new(&mechanism);
/// Dynamics::new(&mechanism).forces(&mechanism, 2.0, &[BodyState::ground()], &mut now);
/// assert_eq!(now.wrenches[0].x, 6.0);
/// ```
pub trait Load: Debug + Send + Sync {
    /// Adds the load's wrenches (N, N, N·m about each centre of mass) to those of the bodies. A load with
    /// a memory adds what it would if all had moved as now for long.
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]);

    /// What the load remembers at the start of a run.
    fn begin(&self, _at: Situation) -> Memory {
        Memory::default()
    }

    /// What it remembers from the end of a step on, with the memory of the step's start.
    fn remember(&self, _at: Situation, memory: Memory) -> Memory {
        memory
    }

    /// Adds the load's wrenches at a state that lies within one step of the memory.
    fn add_after(&self, at: Situation, _memory: Memory, wrenches: &mut [Vector3<f64>]) {
        self.add(at, wrenches);
    }

    /// The same load with one of its two ends moved by a vector (m) in the axes of the body there, if it has
    /// ends.
    fn with_end_moved(&self, _end: usize, _by: Vector2<f64>) -> Option<Arc<dyn Load>> {
        None
    }

    /// The longest step in s (fixed step, explicit) that the load stands on this mechanism, or `None`
    /// where it sets no limit: a damper c on a mass m needs `h c/m ≤ 1` (unstable from 2).
    fn longest_step(&self, _mechanism: &Mechanism) -> Option<f64> {
        None
    }

    /// The same at an instant, where a load is steep in some states only and the step is free to change.
    fn longest_step_at(&self, at: Situation) -> Option<f64> {
        self.longest_step(at.mechanism)
    }
}

impl Situation<'_> {
    /// Position and velocity of a point.
    pub fn point(self, mark: Mark) -> BodyState {
        let body = mark.body.map_or_else(BodyState::ground, |body| self.states[body]);
        body.at(mark.attachment(self.mechanism).point)
    }

    /// Adds a force (N) at a point, and a torque (N·m) on its body.
    pub fn push_point(
        self,
        mark: Mark,
        force: Vector2<f64>,
        torque: f64,
        wrenches: &mut [Vector3<f64>],
    ) {
        let Some(body) = mark.body else { return };
        let arm = self.states[body].rotation * mark.attachment(self.mechanism).point;
        wrenches[body] += Vector3::new(force.x, force.y, torque + arm.perp(&force));
    }

    /// Coordinate (m or rad) and rate of a joint, of angles the one nearest to `near`.
    pub fn coordinate(self, joint: JointIndex, near: f64) -> [f64; 2] {
        match joint {
            JointIndex::Prismatic(i) => self.length(i),
            JointIndex::Revolute(i) => [
                angle_near(self.mechanism.revolutes[i].rotation(self.states), near),
                self.turning(i),
            ],
        }
    }

    /// Where a joint's coordinate (m or rad) is counted from: as its bodies are known to have turned, or else as they start.
    pub fn counted_from(self, joint: JointIndex) -> f64 {
        match (joint, self.angles) {
            (JointIndex::Revolute(i), Some(angles)) => {
                let [ring, journal] = self.mechanism.revolutes[i].bodies();
                let of = |body: Option<usize>| body.map_or(0.0, |body| angles[body]);
                of(journal) - of(ring)
            }
            _ => self.mechanism.start_coordinate(joint),
        }
    }

    /// Adds an effort (N or N·m) on the slider or the journal's body of a joint, against the other body.
    pub fn push_joint(self, joint: JointIndex, effort: f64, wrenches: &mut [Vector3<f64>]) {
        match joint {
            JointIndex::Prismatic(i) => self.push_rod(i, effort, wrenches),
            JointIndex::Revolute(i) => self.push_turn(i, effort, wrenches),
        }
    }

    /// Adds a force (N) at the reference point of the output body, and a torque (N·m).
    pub fn push_output(self, force: Vector2<f64>, torque: f64, wrenches: &mut [Vector3<f64>]) {
        let output = self.mechanism.output;
        let arm = self.states[output].rotation * self.mechanism.bodies[output].reference;
        wrenches[output] += Vector3::new(force.x, force.y, torque + arm.perp(&force));
    }

    /// Length (m) and rate (m/s) that prismatic joint `index` really has.
    pub fn length(self, index: usize) -> [f64; 2] {
        let joint = self.mechanism.prismatics[index].telescope(self.states);
        [joint.length, joint.length_rate]
    }

    /// Length in m that the encoder of prismatic joint `index` reads at a true length (m) and rate (m/s);
    /// the true one where it has no drive.
    pub fn reading(self, index: usize, [length, rate]: [f64; 2]) -> f64 {
        let mut drives = self.mechanism.actuators.iter();
        let drive = drives.find(|actuator| actuator.joint == JointIndex::Prismatic(index));
        drive.map_or(length, |actuator| actuator.read(length, rate)[0])
    }

    /// Rate in rad/s at which revolute joint `index` turns: of the journal's body against the ring's.
    pub fn turning(self, index: usize) -> f64 {
        self.mechanism.revolutes[index].spin(self.states)
    }

    /// Adds a torque (N·m) on the journal's body of revolute joint `index`, against the ring's.
    pub fn push_turn(self, index: usize, torque: f64, wrenches: &mut [Vector3<f64>]) {
        let joint = &self.mechanism.revolutes[index];
        for (attachment, torque) in [(&joint.journal, torque), (&joint.ring, -torque)] {
            if let Some(body) = attachment.body {
                wrenches[body].z += torque;
            }
        }
    }

    /// Adds a force (N, positive when it extends) between base and slider of prismatic joint `index`.
    pub fn push_rod(self, index: usize, force: f64, wrenches: &mut [Vector3<f64>]) {
        let joint = &self.mechanism.prismatics[index];
        let pair = joint.telescope(self.states).drive(force);
        for (body, wrench) in [joint.base.body, joint.slider.body].into_iter().zip(pair) {
            if let Some(body) = body {
                wrenches[body] += wrench;
            }
        }
    }
}
