//! The engine room: the only place that knows rapier and parry.
//!
//! * [`BearingRing`], [`RingDispatcher`]: a parry shape for the inside of a bearing, with exact
//!   circle-in-ring queries, so that rapier's own contacts and our law see the same geometry.
//! * [`ClearanceJoints`]: clearance joints for anybody's rapier world.
//! * [`run`]: a whole [`Mechanism`](crate::mechanism::Mechanism) from start to end.

mod adaptive;
mod between;
mod clearance_joints;
mod clock;
mod colliders;
mod direct;
mod dispatcher;
mod energy;
mod fixed;
mod halt;
mod inserter;
mod leapfrog;
mod looks;
mod native;
mod ring;
mod run;
mod stepper;
#[cfg(test)]
mod tests;
mod watch;
mod wear;
mod world;

pub use adaptive::LONGEST_STEP;
pub use clearance_joints::{ClearanceJoint, ClearanceJoints};
pub use colliders::{JointColliders, Solver};
pub use dispatcher::RingDispatcher;
pub use energy::Energy;
pub use halt::{Halt, MOST_STEPS_PER_S};
pub use ring::BearingRing;
pub use run::{
    Engine, Instant, Schedule, StepControl, TYPICAL_IMPACT_SPEED, Work, run, run_balanced,
    run_while,
};
pub use watch::{Peaks, Tally};
pub use wear::WEAR_DIRECTIONS;

use nalgebra::Vector2;
use rapier2d_f64::dynamics::IntegrationParameters;
use rapier2d_f64::geometry::NarrowPhase;
use rapier2d_f64::math::Vector;
use rapier2d_f64::parry::query::{DefaultQueryDispatcher, QueryDispatcher};
use rapier2d_f64::pipeline::PhysicsWorld;

/// Version of the physics engine underneath, as pinned in `Cargo.toml`.
pub const RAPIER_VERSION: &str = "0.36.1";

/// An empty rapier world fit for clearances: no gravity, step `dt` (s), ring shapes understood,
/// and every feature off that would alter a force behind the law's back.
///
/// * one solver iteration: substeps do not refine a force that is frozen over the step;
/// * no stabilisation pass: it moves the joints by 1e-9 m after the solve;
/// * no continuous collision detection, recycling or speed limit: they are for fast games;
/// * joints keep rapier's default softness, which corrects a drift within one step.
pub fn physics_world(dt: f64) -> PhysicsWorld {
    let integration_parameters = IntegrationParameters {
        dt,
        num_solver_iterations: 1,
        num_internal_stabilization_iterations: 0,
        max_ccd_substeps: 0,
        contact_recycling: false,
        normalized_max_linear_velocity: f64::MAX,
        ..IntegrationParameters::default()
    };
    PhysicsWorld {
        gravity: Vector::ZERO,
        integration_parameters,
        narrow_phase: NarrowPhase::with_query_dispatcher(
            RingDispatcher.chain(DefaultQueryDispatcher),
        ),
        ..PhysicsWorld::default()
    }
}

/// rapier's vector of ours.
fn to_rapier(v: Vector2<f64>) -> Vector {
    Vector::new(v.x, v.y)
}

/// Our vector of rapier's.
fn from_rapier(v: Vector) -> Vector2<f64> {
    Vector2::new(v.x, v.y)
}
