//! Puts the bodies, joints and motors of a mechanism into a rapier world.

use crate::engine::{JointColliders, Solver, physics_world, to_rapier};
use crate::mechanism::{Attachment, Bearing, Body, Mechanism, NativeContacts, Prismatic, Revolute};
use nalgebra::UnitComplex;
use rapier2d_f64::dynamics::{
    GenericJoint, GenericJointBuilder, ImpulseJointHandle, JointAxesMask, JointAxis,
    MassProperties, MotorModel, PrismaticJointBuilder, RevoluteJointBuilder, RigidBodyBuilder,
    RigidBodyHandle, SpringCoefficients,
};
use rapier2d_f64::math::{Pose, Rotation, Vector};
use rapier2d_f64::pipeline::PhysicsWorld;

/// Largest motor force in N: practically none. (`f64::MAX` overflows when rapier multiplies it.)
pub(super) const MOTOR_FORCE: f64 = 1e30;

/// Joints without give. rapier's default, a spring of 1 MHz, gives way by 2 % of the joint's impulse
/// in a step of 1 µs: an error that grows as the step shrinks.
const RIGID: SpringCoefficients<f64> =
    SpringCoefficients { natural_frequency: 1e15, damping_ratio: 1.0 };

/// A prismatic joint in rapier's world.
pub(super) struct Slide {
    pub handle: ImpulseJointHandle,
    /// Its axis in its base's axes, and where along it the base's attachment point stands, in m.
    pub axis: UnitComplex<f64>,
    pub along: f64,
    /// Whether rapier's motor prescribes its length.
    pub prescribed: bool,
}

/// Who computes the force of a revolute joint.
#[derive(Clone, Copy)]
pub(super) enum Solved {
    /// A force law, outside rapier.
    Law,
    /// rapier's contact between the colliders of this index.
    Contact(usize),
    /// rapier's joint.
    Pivot(ImpulseJointHandle),
}

/// A rapier world that a mechanism's bodies are in, and its joints one after another.
pub(super) struct Inserter {
    pub physics: PhysicsWorld,
    ground: RigidBodyHandle,
    pub handles: Vec<RigidBodyHandle>,
    /// The ideal revolute joints so far.
    pub pivots: Vec<(ImpulseJointHandle, [Attachment; 2])>,
    /// Shapes of rings and journals so far, and of how many joints.
    pub colliders: JointColliders,
    shaped: usize,
}

impl Inserter {
    /// A world with the bodies of `mechanism` at their starts.
    pub fn new(mechanism: &Mechanism) -> Self {
        let mut physics = physics_world(0.0);
        // Nobody reads them, and they cost a clock reading at every stage of a step.
        physics.physics_pipeline.counters.disable();
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
        let bodies = mechanism.bodies.iter();
        let handles = bodies.map(|body| physics.bodies.insert(rigid_body(body))).collect();
        let colliders = JointColliders::default();
        Self { physics, ground, handles, pivots: Vec::new(), colliders, shaped: 0 }
    }

    fn body(&self, attachment: &Attachment) -> RigidBodyHandle {
        attachment.body.map_or(self.ground, |i| self.handles[i])
    }

    /// Inserts a prismatic joint, with a motor that is off.
    pub fn prismatic(&mut self, joint: &Prismatic) -> Slide {
        let builder = PrismaticJointBuilder::new(Vector::X)
            .contacts_enabled(false)
            .softness(RIGID)
            .local_anchor1(to_rapier(joint.base.point))
            .local_anchor2(to_rapier(joint.slider.point))
            .motor_model(MotorModel::AccelerationBased)
            .motor_max_force(MOTOR_FORCE);
        let mut builder = GenericJoint::from(builder);
        let frames = [&mut builder.local_frame1, &mut builder.local_frame2];
        for (frame, axis) in frames.into_iter().zip(joint.axes) {
            frame.rotation = Rotation::from_cos_sin_unchecked(axis.re, axis.im);
        }
        let (base, slider) = (self.body(&joint.base), self.body(&joint.slider));
        let handle = self.physics.impulse_joints.insert(base, slider, builder, true);
        Slide { handle, axis: joint.axes[0], along: joint.points()[0].x, prescribed: false }
    }

    /// Inserts what holds a revolute joint: rapier's joint where it is ideal, where it has clearance the
    /// shapes of ring and journal, if `colliders` are asked for.
    pub fn revolute(
        &mut self,
        joint: &Revolute,
        native: &NativeContacts,
        colliders: bool,
    ) -> Solved {
        let bodies = [self.body(&joint.ring), self.body(&joint.journal)];
        let points = [joint.ring.point, joint.journal.point];
        let (radii, friction, solver, solved) = match &joint.bearing {
            Bearing::Ideal => {
                let builder = RevoluteJointBuilder::new()
                    .contacts_enabled(false)
                    .softness(RIGID)
                    .local_anchor1(to_rapier(points[0]))
                    .local_anchor2(to_rapier(points[1]));
                let handle =
                    self.physics.impulse_joints.insert(bodies[0], bodies[1], builder, true);
                self.pivots.push((handle, [joint.ring, joint.journal]));
                return Solved::Pivot(handle);
            }
            Bearing::Clearance(c) => {
                ([c.bearing_radius, c.journal_radius], 0.0, Solver::Law, Solved::Law)
            }
            Bearing::Native { bearing_radius, journal_radius, friction } => {
                let NativeContacts { restitution, predictive, .. } = *native;
                let solver = Solver::Native { restitution, predictive };
                let solved = Solved::Contact(self.shaped);
                ([*bearing_radius, *journal_radius], *friction, solver, solved)
            }
        };
        if colliders {
            self.colliders.insert(&mut self.physics, bodies, points, radii, friction, solver);
            self.shaped += 1;
        }
        solved
    }

    /// The rapier joint whose motor turns a revolute joint: its own, or one that locks nothing beside a
    /// clearance.
    pub fn motor(&mut self, joint: &Revolute, solved: Solved) -> ImpulseJointHandle {
        let handle = match solved {
            Solved::Pivot(handle) => handle,
            Solved::Law | Solved::Contact(_) => {
                let bodies = [self.body(&joint.ring), self.body(&joint.journal)];
                let free = GenericJointBuilder::new(JointAxesMask::empty())
                    .contacts_enabled(true)
                    .softness(RIGID);
                self.physics.impulse_joints.insert(bodies[0], bodies[1], free, true)
            }
        };
        if let Some(joint) = self.physics.impulse_joints.get_mut(handle, false) {
            let motor = &mut joint.data;
            motor.set_motor_model(JointAxis::AngX, MotorModel::AccelerationBased);
            motor.set_motor_max_force(JointAxis::AngX, MOTOR_FORCE);
        }
        handle
    }
}

/// A body as rapier has it, at its start.
fn rigid_body(body: &Body) -> RigidBodyBuilder {
    let start = &body.start;
    let rotation = Rotation::from_cos_sin_unchecked(start.rotation.re, start.rotation.im);
    let masses = MassProperties::new(Vector::ZERO, body.mass, body.inertia);
    RigidBodyBuilder::dynamic()
        .pose(Pose::from_parts(to_rapier(start.position), rotation))
        .linvel(to_rapier(start.twist.xy()))
        .angvel(start.twist.z)
        .additional_mass_properties(masses)
        .can_sleep(false)
        .allow_fast_rotation(true)
}
