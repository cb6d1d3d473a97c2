//! Clearance joints for anybody's rapier world.

use super::leapfrog::Leapfrog;
use crate::contact::{Clearance, Contact, Touch};
use crate::engine::{JointColliders, Solver, to_rapier};
use crate::mechanism::BodyState;
use nalgebra::{Vector2, Vector3};
use rapier2d_f64::dynamics::RigidBodyHandle;
use rapier2d_f64::pipeline::PhysicsWorld;

/// A revolute joint with clearance between two bodies of a rapier world.
///
/// [`ClearanceJoints`] has an example.
#[derive(Clone, Debug)]
pub struct ClearanceJoint {
    /// The body that carries the bearing ring.
    pub ring_body: RigidBodyHandle,
    /// Centre of the ring in that body's axes, from its centre of mass, in m.
    pub ring_point: Vector2<f64>,
    /// The body that carries the journal.
    pub journal_body: RigidBodyHandle,
    /// Centre of the journal in that body's axes, from its centre of mass, in m.
    pub journal_point: Vector2<f64>,
    /// Radii, force law and friction.
    pub clearance: Clearance,
}

/// The clearance joints of one world, and the stepping that belongs to them.
///
/// Build the world with [`physics_world`](crate::engine::physics_world), insert bodies whose origin is
/// their centre of mass (`can_sleep(false)`, explicit mass properties) and joints of your own, add
/// the clearance joints, then call [`step`](Self::step) in place of the world's own. Forces come
/// from the state at the beginning of the step, without lag; steps are read as a leapfrog, of
/// second order in time.
///
/// ```
/// use freeplay::contact::{Clearance, HertzStep};
/// use freeplay::engine::{ClearanceJoint, ClearanceJoints, physics_world};
/// use nalgebra::Vector2;
/// use rapier2d_f64::{dynamics::*, math::Vector};
/// use std::sync::Arc;
///
/// let mut world = physics_world(1e-5);
/// world.gravity = Vector::new(0.0, -9.81);
/// let mass = MassProperties::new(Vector::ZERO, 0.1, 4.5e-6);
/// let ring_body = world.bodies.insert(RigidBodyBuilder::fixed());
/// let journal_body = world.bodies.insert(RigidBodyBuilder::dynamic().additional_mass_properties(mass));
/// let law = HertzStep { stiffness: 1.6e10, exponent: 1.5, c_max: 500.0, d_max: 1e-5, clip: true };
/// let clearance = Clearance { bearing_radius: 10e-3, journal_radius: 9.5e-3, law: Arc::new(law), friction: None };
/// let (ring_point, journal_point) = (Vector2::zeros(), Vector2::zeros());
/// let mut joints = ClearanceJoints::new();
/// let joint = ClearanceJoint { ring_body, ring_point, journal_body, journal_point, clearance };
/// let joint = joints.add(&mut world, joint);
/// let mut hardest = 0.0_f64;
/// for _ in 0..1100 {
///     joints.step(&mut world);
///     hardest = hardest.max(joints.contact(joint).map_or(0.0, |contact| contact.normal_force));
/// }
/// // √(2 · 0.5 mm/g) is 10.1 ms: it has fallen through its play and hit.
/// assert!(hardest > 1.0 && joints.state(journal_body).unwrap().twist.y > 0.0);
/// ```
#[derive(Clone, Debug, Default)]
pub struct ClearanceJoints {
    joints: Vec<(ClearanceJoint, [usize; 2])>,
    handles: Vec<RigidBodyHandle>,
    colliders: JointColliders,
    contacts: Vec<Contact>,
    /// What each joint remembers of its contact, after the first step.
    touches: Vec<Option<Touch>>,
    /// Length of the last step in s.
    last: f64,
    leapfrog: Option<Leapfrog>,
}

impl ClearanceJoints {
    /// No joints yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a joint and its two colliders; returns its index. Add all joints before the first step.
    pub fn add(&mut self, world: &mut PhysicsWorld, joint: ClearanceJoint) -> usize {
        let bodies = [joint.ring_body, joint.journal_body];
        let clearance = &joint.clearance;
        self.colliders.insert(
            world,
            bodies,
            [joint.ring_point, joint.journal_point],
            [clearance.bearing_radius, clearance.journal_radius],
            0.0,
            Solver::Law,
        );
        let indices = bodies.map(|body| {
            self.handles.iter().position(|h| *h == body).unwrap_or_else(|| {
                self.handles.push(body);
                self.handles.len() - 1
            })
        });
        self.joints.push((joint, indices));
        self.contacts.push(Contact::default());
        self.touches.push(None);
        self.leapfrog = None;
        self.joints.len() - 1
    }

    /// Contact in joint `index` at the beginning of the last step.
    pub fn contact(&self, index: usize) -> Option<&Contact> {
        self.contacts.get(index)
    }

    /// State of a joint's body at the present instant, its velocity synchronised with its position
    /// (rapier's own `linvel()` belongs to the last half step). `None` before the first step or for
    /// a body without clearance joint.
    pub fn state(&self, body: RigidBodyHandle) -> Option<&BodyState> {
        let index = self.handles.iter().position(|h| *h == body)?;
        self.leapfrog.as_ref()?.states().get(index)
    }

    /// Advances the world by its own `dt`. Forces that you gave to bodies beforehand stay as they
    /// were.
    pub fn step(&mut self, world: &mut PhysicsWorld) {
        let leapfrog =
            self.leapfrog.get_or_insert_with(|| Leapfrog::new(self.handles.clone(), &world.bodies));
        let states = leapfrog.states();
        let mut wrenches = vec![Vector3::zeros(); self.handles.len()];
        let memories = self.contacts.iter_mut().zip(&mut self.touches);
        for ((joint, [ring, journal]), (contact, touch)) in self.joints.iter().zip(memories) {
            let memory = touch.map(|touch| touch.after(self.last));
            let ring_frame = states[*ring].frame(joint.ring_point);
            let journal_frame = states[*journal].frame(joint.journal_point);
            let (state, forces) = match memory {
                Some(memory) => joint.clearance.forces_after(memory, &ring_frame, &journal_frame),
                None => joint.clearance.forces(&ring_frame, &journal_frame),
            };
            *contact = state;
            *touch = Some(match memory {
                Some(memory) => joint.clearance.reached(memory, &state, || {
                    joint.clearance.slide(None, &ring_frame, &journal_frame).1
                }),
                None => Touch::begin(state.penetration, state.rate),
            });
            if let Some([on_ring, on_journal]) = forces {
                wrenches[*ring] += on_ring;
                wrenches[*journal] += on_journal;
            }
        }
        let (kick, gravity) = (leapfrog.kick(), world.gravity);
        world.gravity *= kick;
        let mut users = Vec::with_capacity(self.handles.len());
        for (&handle, wrench) in self.handles.iter().zip(&wrenches) {
            let Some(body) = world.bodies.get_mut(handle) else { continue };
            users.push((handle, body.user_force(), body.user_torque()));
            body.add_force(to_rapier(wrench.xy() * kick), true);
            body.add_torque(wrench.z * kick, true);
        }
        world.step_with_events(&self.colliders, &());
        world.gravity = gravity;
        for (handle, force, torque) in users {
            let Some(body) = world.bodies.get_mut(handle) else { continue };
            body.reset_forces(false);
            body.reset_torques(false);
            body.add_force(force, false);
            body.add_torque(torque, false);
        }
        self.last = world.integration_parameters.dt;
        leapfrog.record(&world.bodies, self.last);
    }
}
