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

/// Where a prescribed joint goes in one step, along and across the axis that its cylinder has at the
/// step's beginning, in m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    /// Length of the joint along that axis.
    pub length: f64,
    /// Across: where the cylinder's attachment point would have to be for the rod's to go straight.
    pub side: f64,
}

impl Target {
    /// Where rapier must be sent for `joint` to have the length `length` (m) at the end of a step
    /// in which it turns by `turn` rad from the length `before`.
    ///
    /// rapier's joint rows are linear: they send the rod's centre to `κ + L cos 0` along the axis
    /// that was and to `turn·L_before` across it, where the truth is `L cos turn` and `L sin turn`
    /// (L the distance of the centres, q = L + κ). The difference, of second order in the step, is
    /// put into the targets.
    pub fn new(joint: &Prismatic, length: f64, before: f64, turn: f64) -> Self {
        let offset = joint.rod.point.x - joint.cylinder.point.x;
        let (sin, cos) = turn.sin_cos();
        Self {
            length: offset + (length - offset) * cos,
            side: joint.cylinder.point.y + (length - offset) * sin - (before - offset) * turn,
        }
    }
}

/// A rapier world that holds one mechanism, gravity included in the wrenches it is given.
pub(super) struct World {
    physics: PhysicsWorld,
    stepped: bool,
    pub handles: Vec<RigidBodyHandle>,
    motors: Vec<Option<ImpulseJointHandle>>,
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
        let motors = mechanism
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
                (joint.drive == Drive::Prescribed).then_some(handle)
            })
            .collect();
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
                    physics.impulse_joints.insert(bodies[0], bodies[1], builder, true);
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
        Self { physics, stepped: false, handles, motors, colliders: joint_colliders }
    }

    /// States as rapier holds them: the twists are those of the last half step.
    pub fn read(&self, states: &mut [BodyState]) {
        for (state, &handle) in states.iter_mut().zip(&self.handles) {
            *state = read(&self.physics.bodies, handle);
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
        let joint = self.motors[index].and_then(|h| self.physics.impulse_joints.get(h));
        let motor = joint.and_then(|j| j.data.motor(JointAxis::LinX));
        motor.map_or(0.0, |motor| -motor.impulse)
    }

    /// One rapier step of `dt` s under the given wrench on each body. `targets` says where each
    /// prescribed joint goes.
    pub fn step(&mut self, dt: f64, wrenches: &[Vector3<f64>], targets: impl Fn(usize) -> Target) {
        for (&handle, wrench) in self.handles.iter().zip(wrenches) {
            if let Some(body) = self.physics.bodies.get_mut(handle) {
                body.reset_forces(false);
                body.reset_torques(false);
                body.add_force(to_rapier(wrench.xy()), false);
                body.add_torque(wrench.z, false);
            }
        }
        for (i, motor) in self.motors.iter().enumerate() {
            if let Some(joint) = motor.and_then(|h| self.physics.impulse_joints.get_mut(h, false)) {
                let target = targets(i);
                // A stiffness far beyond any mass over dt² makes the spring a constraint.
                joint.data.set_motor(JointAxis::LinX, target.length, 0.0, MOTOR_FORCE, 0.0);
                joint.data.local_frame1.translation.y = target.side;
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
