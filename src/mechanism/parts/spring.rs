//! Springs with dampers between points and in joints, and the end stops of joints.

use crate::contact::{ForceLaw, HertzStep};
use crate::mechanism::{JointIndex, Load, Mark, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use std::sync::Arc;

/// A spring and damper along the line between two points: with r from the first to the second and n = r/|r|,
/// the first is pulled by `F n`, the second by `−F n`, `F = k (|r| − l₀) + c d|r|/dt`.
///
/// ```
/// use freeplay::mechanism::{Body, BodyState, Dynamics, Evaluation, Mark, Mechanism, PointSpring};
/// use nalgebra::Vector2;
/// use std::sync::Arc;
///
/// let start = BodyState { position: Vector2::new(0.3, 0.0), ..BodyState::ground() };
/// let mut mechanism = Mechanism::free(vec![Body::new("weight", 2.0, 0.1, start)]);
/// let ends = [None, Some(0)].map(|body| Mark { body, point: Vector2::zeros() });
/// let spring = PointSpring { ends, stiffness: 100.0, damping: 0.0, free_length: 0.2, pull_only: false };
/// mechanism.loads.push(Arc::new(spring));
/// let mut now = Evaluation::new(&mechanism);
/// Dynamics::new(&mechanism).forces(&mechanism, 0.0, &[start], &mut now);
/// assert!((now.wrenches[0].x + 10.0).abs() < 1e-12, "10 cm too long, 100 N/m");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PointSpring {
    /// The two points.
    pub ends: [Mark; 2],
    /// k in N/m.
    pub stiffness: f64,
    /// c in N·s/m.
    pub damping: f64,
    /// l₀ in m.
    pub free_length: f64,
    /// A rope: F is zero while |r| < l₀, and never below zero.
    pub pull_only: bool,
}

impl Load for PointSpring {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let [a, b] = self.ends.map(|end| end.attachment(at.mechanism).frame(at.states));
        let r = b.centre - a.centre;
        let length = r.norm();
        if length == 0.0 {
            return;
        }
        let n = r / length;
        let rate = (b.velocity - a.velocity).dot(&n);
        let mut force = self.stiffness * (length - self.free_length) + self.damping * rate;
        if self.pull_only {
            force = if length > self.free_length { force.max(0.0) } else { 0.0 };
        }
        for ((end, frame), f) in self.ends.iter().zip([a, b]).zip([n * force, n * -force]) {
            if let Some(body) = end.body {
                wrenches[body] += Vector3::new(f.x, f.y, frame.arm.perp(&f));
            }
        }
    }

    fn with_end_moved(&self, end: usize, by: Vector2<f64>) -> Option<Arc<dyn Load>> {
        let mut moved = *self;
        moved.ends[end].point += by;
        Some(Arc::new(moved))
    }

    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        let lightness: f64 =
            self.ends.iter().map(|end| mechanism.point_lightness(&end.attachment(mechanism))).sum();
        explicit_limit(lightness, self.stiffness, self.damping)
    }
}

/// The longest explicit step in s of a spring k and a damper c on a body that 1 N (or N·m) accelerates by
/// `lightness`: `h ≤ 1/√(k l)` and `h ≤ 1/(c l)`, half of where it turns unstable.
fn explicit_limit(lightness: f64, stiffness: f64, damping: f64) -> Option<f64> {
    let limit = 1.0 / (stiffness * lightness).sqrt().max(damping * lightness);
    limit.is_finite().then_some(limit)
}

/// A spring and damper in a joint: effort `−k (q − q₀) − c q̇` on the journal's body or the slider.
#[derive(Clone, Copy, Debug)]
pub struct JointSpring {
    /// The joint.
    pub joint: JointIndex,
    /// k in N/m or N·m/rad.
    pub stiffness: f64,
    /// c in N·s/m or N·m·s/rad.
    pub damping: f64,
    /// q₀ in m or rad.
    pub free: f64,
}

/// End stops of a joint: beyond either end of its range an effort back into it, `k δ + STEP(δ) δ̇`, never
/// outward; δ is how far the joint is beyond, and STEP the cubic that rises to the damping over a depth.
///
/// ```
/// use freeplay::contact::HertzStep;
/// use freeplay::mechanism::{Bearing, BodyState, Dynamics, Evaluation, JointIndex, JointSpring, Stop};
/// use freeplay::mechanism::pendulum::{Arm, build};
/// use nalgebra::Vector2;
/// use std::sync::Arc;
///
/// // A pendulum turned by 0.5 rad: a spring of 2 N·m/rad pulls it back, a stop at 0.4 rad with 10 N·m/rad as well.
/// let arm = Arm { mass: 1.0, inertia: 0.01, length: 0.3 };
/// let mut pendulum = build(arm, Bearing::Ideal, [0.5, 0.0], Vector2::zeros());
/// let joint = JointIndex::Revolute(0);
/// let law = HertzStep { stiffness: 10.0, exponent: 1.0, c_max: 0.0, d_max: 0.1, clip: true };
/// pendulum.loads.push(Arc::new(JointSpring { joint, stiffness: 2.0, damping: 0.0, free: 0.0 }));
/// pendulum.loads.push(Arc::new(Stop { joint, range: [-0.4, 0.4], law }));
/// let mut now = Evaluation::new(&pendulum);
/// let start: [BodyState; 1] = [pendulum.bodies[0].start];
/// Dynamics::new(&pendulum).forces(&pendulum, 0.0, &start, &mut now);
/// assert!((now.wrenches[0].z + 2.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// The joint.
    pub joint: JointIndex,
    /// Where the stops stand, in m or rad.
    pub range: [f64; 2],
    /// The effort over depth and rate: exponent 1, damping and depth in the joint's units.
    pub law: HertzStep,
}

/// What pushes in a joint by its coordinate and rate.
trait JointEffort {
    fn joint(&self) -> JointIndex;
    fn effort(&self, coordinate: f64, rate: f64) -> f64;
    /// Steepest slopes by coordinate and by rate.
    fn slopes(&self) -> [f64; 2];
}

impl JointEffort for JointSpring {
    fn joint(&self) -> JointIndex {
        self.joint
    }

    fn effort(&self, coordinate: f64, rate: f64) -> f64 {
        -self.stiffness * (coordinate - self.free) - self.damping * rate
    }

    fn slopes(&self) -> [f64; 2] {
        [self.stiffness, self.damping]
    }
}

impl JointEffort for Stop {
    fn joint(&self) -> JointIndex {
        self.joint
    }

    fn effort(&self, coordinate: f64, rate: f64) -> f64 {
        let [low, high] = self.range;
        if coordinate > high {
            -self.law.normal_force(coordinate - high, rate)
        } else if coordinate < low {
            self.law.normal_force(low - coordinate, -rate)
        } else {
            0.0
        }
    }

    fn slopes(&self) -> [f64; 2] {
        [self.law.stiffness, self.law.c_max]
    }
}

/// A load of a [`JointEffort`]; its memory is the angle of the last step's end.
macro_rules! joint_load {
    ($kind:ty) => {
        impl Load for $kind {
            fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
                self.add_after(at, self.begin(at), wrenches);
            }

            fn begin(&self, at: Situation) -> [f64; 2] {
                [at.counted_from(self.joint()), 0.0]
            }

            fn remember(&self, at: Situation, memory: [f64; 2]) -> [f64; 2] {
                [at.coordinate(self.joint(), memory[0])[0], 0.0]
            }

            fn add_after(&self, at: Situation, memory: [f64; 2], wrenches: &mut [Vector3<f64>]) {
                let [position, rate] = at.coordinate(self.joint(), memory[0]);
                at.push_joint(self.joint(), self.effort(position, rate), wrenches);
            }

            fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
                let [stiffness, damping] = self.slopes();
                explicit_limit(mechanism.lightness(self.joint()), stiffness, damping)
            }
        }
    };
}

joint_load!(JointSpring);
joint_load!(Stop);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::{Attachment, Bearing, Body, BodyState, Revolute};
    use std::f64::consts::TAU;

    /// A body that turns about the origin, at 0.3 rad with 2 rad/s.
    fn turning() -> Mechanism {
        let start = BodyState {
            rotation: nalgebra::UnitComplex::new(0.3),
            twist: Vector3::new(0.0, 0.0, 2.0),
            ..BodyState::ground()
        };
        let origin = |body| Attachment { body, point: Vector2::zeros() };
        Mechanism {
            revolutes: vec![Revolute {
                name: "O".to_owned(),
                ring: origin(None),
                journal: origin(Some(0)),
                bearing: Bearing::Ideal,
                out_of_round: None,
            }],
            ..Mechanism::free(vec![Body::new("body", 2.0, 0.5, start)])
        }
    }

    /// Who knows how often a body went round says so to a load that remembers it otherwise.
    #[test]
    fn springs_are_wound_up_by_whole_turns_that_are_known() {
        let mechanism = turning();
        let spring = JointSpring {
            joint: JointIndex::Revolute(0),
            stiffness: 10.0,
            damping: 0.0,
            free: 0.1,
        };
        let (states, turned) = ([mechanism.bodies[0].start], [0.3 + 2.0 * TAU]);
        let mut wrenches = vec![Vector3::zeros()];
        let at =
            Situation { t: 0.0, mechanism: &mechanism, states: &states, angles: Some(&turned) };
        spring.add(at, &mut wrenches);
        assert!((wrenches[0].z + 10.0 * (0.2 + 2.0 * TAU)).abs() < 1e-12);
    }

    fn wrench(mechanism: &Mechanism, load: &dyn Load) -> Vector3<f64> {
        let states = vec![mechanism.bodies[0].start];
        let mut wrenches = vec![Vector3::zeros()];
        load.add(Situation { t: 0.0, mechanism, states: &states, angles: None }, &mut wrenches);
        wrenches[0]
    }

    #[test]
    fn springs_pull_towards_their_free_coordinate() {
        let mechanism = turning();
        let joint = JointIndex::Revolute(0);
        let spring = JointSpring { joint, stiffness: 10.0, damping: 0.5, free: 0.1 };
        assert!((wrench(&mechanism, &spring).z + 10.0 * 0.2 + 0.5 * 2.0).abs() < 1e-12);
        let end = Mark { body: Some(0), point: Vector2::new(1.0, 0.0) };
        let wall = Mark { body: None, point: Vector2::new(3.0, 0.0) };
        let rope = PointSpring {
            ends: [end, wall],
            stiffness: 7.0,
            damping: 0.0,
            free_length: 1.0,
            pull_only: true,
        };
        let tip = Vector2::new(0.3f64.cos(), 0.3f64.sin());
        let r = Vector2::new(3.0, 0.0) - tip;
        let force = r.normalize() * (7.0 * (r.norm() - 1.0));
        let expected = Vector3::new(force.x, force.y, tip.perp(&force));
        assert!((wrench(&mechanism, &rope) - expected).norm() < 1e-12);
        let slack = PointSpring { free_length: 5.0, ..rope };
        assert_eq!(wrench(&mechanism, &slack), Vector3::zeros());
    }

    #[test]
    fn stops_push_back_and_never_pull() {
        let mechanism = turning();
        let law =
            HertzStep { stiffness: 100.0, exponent: 1.0, c_max: 3.0, d_max: 1e-3, clip: true };
        let stop = |range| Stop { joint: JointIndex::Revolute(0), range, law };
        assert_eq!(wrench(&mechanism, &stop([0.0, 0.4])).z, 0.0);
        assert!((wrench(&mechanism, &stop([0.0, 0.2])).z + 100.0 * 0.1 + 3.0 * 2.0).abs() < 1e-12);
        // Moving back into the range faster than the spring would: the damper does not hold it.
        assert_eq!(wrench(&mechanism, &stop([0.305, 1.0])).z, 0.0);
    }
}
