//! A [`Mechanism`] as bodies, joints and motors of a rapier world.

use super::leapfrog::read;
use super::{JointColliders, Solver, physics_world, to_rapier};
use crate::mechanism::{
    Attachment, Bearing, BodyState, Drive, Mechanism, NativeContacts, Prismatic,
};
use nalgebra::Vector3;
use rapier2d_f64::dynamics::{
    ImpulseJointHandle, JointAxis, MassProperties, MotorModel, PrismaticJointBuilder,
    RevoluteJointBuilder, RigidBodyBuilder, RigidBodyHandle, SpringCoefficients,
};
use rapier2d_f64::math::{Pose, Rotation, Vector};
use rapier2d_f64::pipeline::PhysicsWorld;

/// Largest motor force in N: practically none. (`f64::MAX` overflows when rapier multiplies it.)
const MOTOR_FORCE: f64 = 1e30;

/// Joints without give. rapier's default, a spring of 1 MHz, gives way by 2 % of the joint's impulse
/// in a step of 1 µs: an error that grows as the step shrinks.
const RIGID: SpringCoefficients<f64> =
    SpringCoefficients { natural_frequency: 1e15, damping_ratio: 1.0 };

/// Where a prismatic joint goes in one step, along and across the axis that its cylinder has at the
/// step's beginning, in m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    /// Length of the joint along that axis; what a motor is told.
    pub length: f64,
    /// Across: where the cylinder's attachment point would have to be for the rod's to go straight.
    pub side: f64,
}

impl Target {
    /// Where rapier must be sent for `joint` to have the length `length` (m) at the end of a step
    /// in which it turns by `turn` rad from the length `before`.
    ///
    /// rapier's joint rows are linear in the step, and turn by T = tan `turn` (see [`excess`]). With
    /// d from the cylinder's centre of mass to the rod's, u and n along and across the axis that was,
    /// L = d·u (q = L + κ), w = d·n as the joint holds it, and w' what rapier is told for w, they ask
    /// for
    ///
    /// `d·n = w' + T L_before`, `d·u + T w' + κ = length`
    ///
    /// at the end, where the truth is `d·u = L cos turn − w sin turn`, `d·n = L sin turn + w cos
    /// turn`. The difference, of second order in the step, is put into the targets.
    pub fn new(joint: &Prismatic, length: f64, before: f64, turn: f64) -> Self {
        let [cylinder, rod] = [joint.cylinder.point, joint.rod.point];
        let (offset, w) = (rod.x - cylinder.x, cylinder.y - rod.y);
        let (sin, cos) = turn.sin_cos();
        let (now, before, tan) = (length - offset, before - offset, sin / cos);
        let side = now * sin + w * cos - before * tan;
        Self { length: offset + now * cos - w * sin + tan * side, side: rod.y + side }
    }
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
pub(super) struct World {
    physics: PhysicsWorld,
    stepped: bool,
    inertias: Vec<f64>,
    /// By how much rapier's angular velocities exceed the mean ones of the last step, in rad/s.
    excess: Vec<f64>,
    pub handles: Vec<RigidBodyHandle>,
    /// The prismatic joints, and whether their length is prescribed.
    prismatics: Vec<(ImpulseJointHandle, bool)>,
    /// The ideal revolute joints.
    pivots: Vec<(ImpulseJointHandle, [Attachment; 2])>,
    pub colliders: JointColliders,
}

impl World {
    /// Builds the world. `colliders` gives rings and journals a shape each; only rapier's own
    /// contacts need them.
    pub fn new(mechanism: &Mechanism, colliders: bool) -> Self {
        let mut physics = physics_world(0.0);
        let native = &mechanism.native;
        let softness = SpringCoefficients {
            natural_frequency: native.frequency,
            damping_ratio: native.damping_ratio,
        };
        let parameters = &mut physics.integration_parameters;
        parameters.contact_softness = softness;
        // rapier's default is twice as stiff against fixed bodies; a bearing is a bearing.
        parameters.static_contact_softness = softness;
        parameters.num_internal_pgs_iterations = native.iterations;
        let ground = physics.bodies.insert(RigidBodyBuilder::fixed());
        let handles: Vec<_> = mechanism
            .bodies
            .iter()
            .map(|body| {
                let start = &body.start;
                let rotation =
                    Rotation::from_cos_sin_unchecked(start.rotation.re, start.rotation.im);
                let pose = Pose::from_parts(to_rapier(start.position), rotation);
                physics.bodies.insert(
                    RigidBodyBuilder::dynamic()
                        .pose(pose)
                        .linvel(to_rapier(start.twist.xy()))
                        .angvel(start.twist.z)
                        .additional_mass_properties(MassProperties::new(
                            Vector::ZERO,
                            body.mass,
                            body.inertia,
                        ))
                        .can_sleep(false)
                        .allow_fast_rotation(true),
                )
            })
            .collect();
        let of = |a: &Attachment| a.body.map_or(ground, |i| handles[i]);
        let prismatics = mechanism
            .prismatics
            .iter()
            .map(|joint| {
                let builder = PrismaticJointBuilder::new(Vector::X)
                    .contacts_enabled(false)
                    .softness(RIGID)
                    .local_anchor1(to_rapier(joint.cylinder.point))
                    .local_anchor2(to_rapier(joint.rod.point))
                    .motor_model(MotorModel::AccelerationBased)
                    .motor_max_force(MOTOR_FORCE);
                let (cylinder, rod) = (of(&joint.cylinder), of(&joint.rod));
                let handle = physics.impulse_joints.insert(cylinder, rod, builder, true);
                (handle, joint.drive == Drive::Prescribed)
            })
            .collect();
        let mut pivots = Vec::new();
        let mut joint_colliders = JointColliders::default();
        for joint in &mechanism.revolutes {
            let bodies = [of(&joint.ring), of(&joint.journal)];
            let points = [joint.ring.point, joint.journal.point];
            let (radii, friction, solver) = match &joint.bearing {
                Bearing::Ideal => {
                    let builder = RevoluteJointBuilder::new()
                        .contacts_enabled(false)
                        .softness(RIGID)
                        .local_anchor1(to_rapier(points[0]))
                        .local_anchor2(to_rapier(points[1]));
                    let handle = physics.impulse_joints.insert(bodies[0], bodies[1], builder, true);
                    pivots.push((handle, [joint.ring, joint.journal]));
                    continue;
                }
                Bearing::Clearance(c) => ([c.bearing_radius, c.journal_radius], 0.0, Solver::Law),
                Bearing::Native { bearing_radius, journal_radius, friction } => {
                    let NativeContacts { restitution, predictive, .. } = *native;
                    let solver = Solver::Native { restitution, predictive };
                    ([*bearing_radius, *journal_radius], *friction, solver)
                }
            };
            if colliders {
                joint_colliders.insert(&mut physics, bodies, points, radii, friction, solver);
            }
        }
        Self {
            physics,
            stepped: false,
            inertias: mechanism.bodies.iter().map(|body| body.inertia).collect(),
            excess: vec![0.0; mechanism.bodies.len()],
            handles,
            prismatics,
            pivots,
            colliders: joint_colliders,
        }
    }

    /// States as rapier holds them: the twists are those of the last half step.
    pub fn read(&self, states: &mut [BodyState]) {
        for ((state, &handle), excess) in states.iter_mut().zip(&self.handles).zip(&self.excess) {
            *state = read(&self.physics.bodies, handle);
            state.twist.z -= excess;
        }
    }

    /// Impulse in N·s that rapier's own contact gave joint `index` in the last step. The index counts
    /// the joints that have colliders.
    pub fn contact_impulse(&self, index: usize) -> f64 {
        let pair = self.colliders.pair(index);
        let contact = pair.and_then(|[a, b]| self.physics.narrow_phase.contact_pair(a, b));
        contact.map_or(0.0, |pair| pair.total_impulse_magnitude())
    }

    /// Impulse in N·s of the motor of prismatic joint `index` on its rod in the last step.
    pub fn motor_impulse(&self, index: usize) -> f64 {
        let joint = self.physics.impulse_joints.get(self.prismatics[index].0);
        let motor = joint.and_then(|j| j.data.motor(JointAxis::LinX));
        motor.map_or(0.0, |motor| -motor.impulse)
    }

    /// One rapier step of `dt` s under the given wrench on each body. `turns` says by how many rad
    /// each body is predicted to turn in it, and `targets` where each prismatic joint goes; without
    /// them, bodies and joints move as rapier moves them.
    pub fn step(
        &mut self,
        dt: f64,
        wrenches: &[Vector3<f64>],
        turns: Option<&[f64]>,
        targets: impl Fn(usize) -> Option<Target>,
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
        for (i, (handle, prescribed)) in self.prismatics.iter().enumerate() {
            if let (Some(target), Some(joint)) = (targets(i), joints.get_mut(*handle, false)) {
                if *prescribed {
                    // A stiffness far beyond any mass over dt² makes the spring a constraint.
                    joint.data.set_motor(JointAxis::LinX, target.length, 0.0, MOTOR_FORCE, 0.0);
                }
                joint.data.local_frame1.translation.y = target.side;
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
        // A step rebuilds rapier's joint assembly when a body with joints was touched; the collision
        // pipeline, asked first, takes note of touched bodies without that. Same result to the last
        // bit, an eighth cheaper. Before the first step it would freeze the world.
        if self.stepped && self.physics.colliders.is_empty() {
            self.physics.detect_collisions(&(), &());
        }
        self.stepped = true;
        self.physics.integration_parameters.dt = dt;
        self.physics.step_with_events(&self.colliders, &());
    }
}
