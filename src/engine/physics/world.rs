//! A [`Mechanism`] as bodies, joints and motors of a rapier world.

use super::inserter::{Inserter, MOTOR_FORCE, Slide, Solved};
use super::leapfrog::read;
use crate::engine::{JointColliders, to_rapier};
use crate::mechanism::{Attachment, BodyState, Drive, JointIndex, Mechanism, Prismatic};
use nalgebra::{Vector2, Vector3};
use rapier2d_f64::dynamics::{ImpulseJointHandle, JointAxis, RigidBodyHandle};
use rapier2d_f64::pipeline::PhysicsWorld;

/// Where a prismatic joint goes in one step, along and across the axis that its base has at the
/// step's beginning, in m.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) struct MotorTarget {
    /// Length of the joint along that axis; what a motor is told.
    pub length: f64,
    /// Across: where the base's attachment point would have to be for the slider's to go straight.
    pub side: f64,
}

impl MotorTarget {
    /// Where rapier must be sent for `joint` to have the length `length` (m) at the end of a step
    /// in which it turns by `turn` rad from the length `before`.
    ///
    /// rapier's joint rows are linear in the step, and turn by T = tan `turn` (see [`excess`]). With
    /// d from the base's centre of mass to the slider's, u and n along and across the axis that was,
    /// L = d·u (q = L + κ), w = d·n as the joint holds it, and w' what rapier is told for w, they ask
    /// for
    ///
    /// `d·n = w' + T L_before`, `d·u + T w' + κ = length`
    ///
    /// at the end, where the truth is `d·u = L cos turn − w sin turn`, `d·n = L sin turn + w cos
    /// turn`. The difference, of second order in the step, is put into the targets.
    pub fn new(joint: &Prismatic, length: f64, before: f64, turn: f64) -> Self {
        let [base, slider] = joint.points();
        let (offset, w) = (slider.x - base.x, base.y - slider.y);
        let (sin, cos) = turn.sin_cos();
        let (now, before, tan) = (length - offset, before - offset, sin / cos);
        let side = now * sin + w * cos - before * tan;
        Self { length: offset + now * cos - w * sin + tan * side, side: slider.y + side }
    }
}

/// What rapier's angular velocity of a joint must be, times the step, for the joint to turn by `advance`
/// rad in a step in which the ring's body turns by `turn` rad: rapier turns each body by the arc tangent
/// of what its angular velocity says (see [`excess`]).
pub(in crate::engine) fn joint_advance(advance: f64, turn: f64) -> f64 {
    (turn + advance).tan() - turn.tan()
}

/// By how much rapier's angular velocity must exceed the mean one of a step in which a body turns by
/// `turn` rad, times the step: `tan turn − turn`.
///
/// rapier turns a body by the arc tangent of what its angular velocity says (it adds a perpendicular
/// to the axes and makes them unit vectors again), a relative error of `turn²/3`.
fn excess(turn: f64) -> f64 {
    // Beyond a radian in one step nothing is resolved, and the tangent ends at a quarter turn.
    let turn = turn.clamp(-1.0, 1.0);
    if turn.abs() > 0.01 {
        return turn.tan() - turn;
    }
    // Exact to the last digit, and a fifth of the cost.
    let s = turn * turn;
    turn * s / 3.0 * (1.0 + s * (0.4 + s * (17.0 / 105.0)))
}

/// A rapier world that holds one mechanism, gravity included in the wrenches it is given.
pub(in crate::engine) struct World {
    physics: PhysicsWorld,
    inertias: Vec<f64>,
    /// By how much rapier's angular velocities exceed the mean ones of the last step, in rad/s.
    excess: Vec<f64>,
    pub handles: Vec<RigidBodyHandle>,
    /// None of those that nothing holds but contacts.
    prismatics: Vec<Option<Slide>>,
    /// The joint and the axis of each prescribed drive's motor.
    motors: Vec<Option<(ImpulseJointHandle, JointAxis)>>,
    /// The ideal revolute joints.
    pivots: Vec<(ImpulseJointHandle, [Attachment; 2])>,
    /// Who computes the force of each revolute joint.
    revolutes: Vec<Solved>,
    pub colliders: JointColliders,
}

impl World {
    /// Builds the world. `colliders` gives rings and journals a shape each; only rapier's own
    /// contacts need them.
    pub fn new(mechanism: &Mechanism, colliders: bool) -> Self {
        let mut inserter = Inserter::new(mechanism);
        let mut prismatics: Vec<Option<Slide>> = mechanism
            .prismatics
            .iter()
            .map(|joint| (!joint.play).then(|| inserter.prismatic(joint)))
            .collect();
        let revolutes: Vec<Solved> = mechanism
            .revolutes
            .iter()
            .map(|joint| inserter.revolute(joint, &mechanism.native, colliders))
            .collect();
        let motors = mechanism
            .actuators
            .iter()
            .map(|actuator| {
                if actuator.drive != Drive::Prescribed {
                    return None;
                }
                Some(match actuator.joint {
                    JointIndex::Prismatic(i) => {
                        let slide = prismatics[i].as_mut()?;
                        slide.prescribed = true;
                        (slide.handle, JointAxis::LinX)
                    }
                    JointIndex::Revolute(i) => {
                        (inserter.motor(&mechanism.revolutes[i], revolutes[i]), JointAxis::AngX)
                    }
                })
            })
            .collect();
        let Inserter { physics, handles, pivots, colliders, .. } = inserter;
        Self {
            physics,
            inertias: mechanism.bodies.iter().map(|body| body.inertia).collect(),
            excess: vec![0.0; mechanism.bodies.len()],
            handles,
            prismatics,
            motors,
            pivots,
            revolutes,
            colliders,
        }
    }

    /// States as rapier holds them: the twists are those of the last half step.
    pub fn read(&self, states: &mut [BodyState]) {
        for ((state, &handle), excess) in states.iter_mut().zip(&self.handles).zip(&self.excess) {
            *state = read(&self.physics.bodies, handle);
            state.twist.z -= excess;
        }
    }

    /// Impulse in N·s that rapier gave revolute joint `index` in the last step; none where a law computes
    /// its force.
    pub fn joint_impulse(&self, index: usize) -> Option<f64> {
        match self.revolutes[index] {
            Solved::Law => None,
            Solved::Contact(pair) => {
                let pair = self.colliders.pair(pair);
                let contact = pair.and_then(|[a, b]| self.physics.narrow_phase.contact_pair(a, b));
                Some(contact.map_or(0.0, |pair| pair.total_impulse_magnitude()))
            }
            Solved::Pivot(handle) => {
                let joint = self.physics.impulse_joints.get(handle);
                joint.map(|joint| joint.impulses.x.hypot(joint.impulses.y))
            }
        }
    }

    /// Impulse in N·s (N·m·s) of the motor of prescribed drive `index` in the last step.
    pub fn motor_impulse(&self, index: usize) -> f64 {
        let motor = self.motors[index].and_then(|(handle, axis)| {
            let joint = self.physics.impulse_joints.get(handle)?;
            joint.data.motor(axis)
        });
        motor.map_or(0.0, |motor| -motor.impulse)
    }

    /// One rapier step of `dt` s under the given wrench on each body. `turns` says by how many rad
    /// each body is predicted to turn in it, `targets` where each prismatic joint goes, and `advances` by
    /// how many rad the joint of each prescribed drive of an angle turns; without
    /// them, bodies and joints move as rapier moves them.
    pub fn step(
        &mut self,
        dt: f64,
        wrenches: &[Vector3<f64>],
        turns: Option<&[f64]>,
        targets: impl Fn(usize) -> Option<MotorTarget>,
        advances: impl Fn(usize) -> f64,
    ) {
        for (i, (&handle, wrench)) in self.handles.iter().zip(wrenches).enumerate() {
            if let Some(body) = self.physics.bodies.get_mut(handle) {
                let mut torque = wrench.z;
                if let Some(turns) = turns {
                    let next = excess(turns[i]) / dt;
                    torque += self.inertias[i] * (next - self.excess[i]) / dt;
                    self.excess[i] = next;
                }
                body.reset_forces(false);
                body.reset_torques(false);
                body.add_force(to_rapier(wrench.xy()), false);
                body.add_torque(torque, false);
            }
        }
        let joints = &mut self.physics.impulse_joints;
        for (i, slide) in self.prismatics.iter().enumerate() {
            let Some(slide) = slide else { continue };
            if let (Some(target), Some(joint)) = (targets(i), joints.get_mut(slide.handle, false)) {
                if slide.prescribed {
                    // A stiffness far beyond any mass over dt² makes the spring a constraint.
                    joint.data.set_motor(JointAxis::LinX, target.length, 0.0, MOTOR_FORCE, 0.0);
                }
                let anchor = slide.axis * Vector2::new(slide.along, target.side);
                joint.data.local_frame1.translation = to_rapier(anchor);
            }
        }
        for (i, motor) in self.motors.iter().enumerate() {
            if let Some((handle, axis @ JointAxis::AngX)) = motor
                && let Some(joint) = joints.get_mut(*handle, false)
            {
                // A damping far beyond any inertia over dt makes the damper a constraint on the rate.
                joint.data.set_motor(*axis, 0.0, advances(i) / dt, 0.0, MOTOR_FORCE);
            }
        }
        for (handle, sides) in &self.pivots {
            if let (Some(turns), Some(joint)) = (turns, joints.get_mut(*handle, false)) {
                // rapier's rows carry an arm r linearly, in complex numbers to r' (1 + i tan turn),
                // where the truth is r e^(i turn): both are the same for r' = r cos turn.
                let [ring, journal] = sides
                    .map(|side| to_rapier(side.point * side.body.map_or(1.0, |i| turns[i].cos())));
                joint.data.local_frame1.translation = ring;
                joint.data.local_frame2.translation = journal;
            }
        }
        self.physics.integration_parameters.dt = dt;
        self.physics.step_with_events(&self.colliders, &());
    }
}
