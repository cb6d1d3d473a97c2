//! Rings and journals as colliders, and the hook that decides who computes their force.

use crate::engine::{BearingRing, to_rapier};
use nalgebra::Vector2;
use rapier2d_f64::dynamics::RigidBodyHandle;
use rapier2d_f64::geometry::{ColliderBuilder, ColliderHandle, SharedShape, SolverFlags};
use rapier2d_f64::pipeline::{
    ActiveHooks, ContactModificationContext, ModifiableContacts, PairFilterContext, PhysicsHooks,
    PhysicsWorld,
};

/// Who computes the force of a journal–bearing pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solver {
    /// A force law, outside rapier: the hook takes the pair away from rapier's solver.
    Law,
    /// rapier's own contact solver.
    Native {
        /// Share of the normal speed that a hit after a flight returns.
        restitution: f64,
        /// Whether it may also stop journals that have not arrived yet, see
        /// [`NativeContacts::predictive`](crate::mechanism::NativeContacts::predictive).
        predictive: bool,
    },
}

/// The colliders of all clearance joints of a world. Give it to rapier as its physics hooks: it
/// lets each ring touch its own journal only, and clears the solver contacts of pairs whose force
/// comes from a law (their manifolds stay readable), or, where rapier is not to predict, of journals
/// in flight.
#[derive(Clone, Debug, Default)]
pub struct JointColliders {
    pairs: Vec<([ColliderHandle; 2], Solver)>,
}

impl JointColliders {
    /// Adds a ring of inner radius `radii[0]` to the first body and a journal of radius `radii[1]`
    /// (m) to the second, each at a point in its body's axes (m). The colliders weigh nothing.
    pub fn insert(
        &mut self,
        world: &mut PhysicsWorld,
        bodies: [RigidBodyHandle; 2],
        points: [Vector2<f64>; 2],
        radii: [f64; 2],
        friction: f64,
        solver: Solver,
    ) {
        let restitution = match solver {
            Solver::Law => 0.0,
            Solver::Native { restitution, .. } => restitution,
        };
        let shapes =
            [SharedShape::new(BearingRing { radius: radii[0] }), SharedShape::ball(radii[1])];
        let mut handles = [ColliderHandle::invalid(); 2];
        for (side, shape) in shapes.into_iter().enumerate() {
            let collider = ColliderBuilder::new(shape)
                .translation(to_rapier(points[side]))
                .density(0.0)
                .friction(friction)
                .restitution(restitution)
                .active_hooks(
                    ActiveHooks::FILTER_CONTACT_PAIRS | ActiveHooks::MODIFY_SOLVER_CONTACTS,
                );
            handles[side] =
                world.colliders.insert_with_parent(collider, bodies[side], &mut world.bodies);
        }
        self.pairs.push((handles, solver));
    }

    /// Ring and journal colliders of joint `index`, in order of insertion.
    pub fn pair(&self, index: usize) -> Option<[ColliderHandle; 2]> {
        self.pairs.get(index).map(|(handles, _)| *handles)
    }

    fn solver(&self, a: ColliderHandle, b: ColliderHandle) -> Option<Solver> {
        let found = self.pairs.iter().find(|(pair, _)| *pair == [a, b] || *pair == [b, a]);
        found.map(|(_, solver)| *solver)
    }
}

impl PhysicsHooks for JointColliders {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        self.solver(context.collider1, context.collider2)
            .map(|_| SolverFlags::COMPUTE_RIGID_IMPULSES)
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let ModifiableContacts::Rigid(manifold) = &mut context.contacts else { return };
        match self.solver(context.collider1, context.collider2) {
            Some(Solver::Law) => manifold.solver_contacts.clear(),
            Some(Solver::Native { predictive: false, .. }) => {
                manifold.solver_contacts.retain(|contact| contact.dist <= 0.0);
            }
            Some(Solver::Native { predictive: true, .. }) | None => {}
        }
    }
}
