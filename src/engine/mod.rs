//! The engine room: the only place that knows rapier and parry.
//!
//! * `physics`: [`BearingRing`], the inside of a bearing as a parry shape, and [`RingDispatcher`], its circle-in-ring queries
//!   in closed form, so that rapier's contacts and the laws see one geometry; rings and journals as colliders, and the hook that
//!   takes their pairs away from rapier's solver where a law computes the force; [`ClearanceJoints`] for anybody's rapier world;
//!   a [`Mechanism`](crate::mechanism::Mechanism) as rapier bodies, joints, motors, whose velocities after a step are those of
//!   the half step.
//! * `run`: the driver of a whole run. It knows a `Stepper` by its functions (`stepping`):
//!   * `fixed`: fixed steps, second order (velocity Verlet), on a grid of its own;
//!   * `adaptive`: error control, fourth order where forces are smooth: rapier is handed the average of the forces
//!     along a path predicted by the equations of motion;
//!   * `direct`: no engine, the equations of motion integrated under error control;
//!   * `native`: rapier's own contacts, as rapier steps them.
//! * `account`: impacts and peaks, wear, what a run took. `control`: how the step is chosen. `clock`: when sampled controllers
//!   take their samples. `halt`: what ends a run.

mod account;
mod clock;
mod control;
mod halt;
mod physics;
mod run;
mod stepping;
#[cfg(test)]
mod tests;

pub use account::watch::{Peaks, Tally};
pub use account::wear::WEAR_DIRECTIONS;
pub use account::work::Work;
pub use control::{Engine, StepControl, TYPICAL_IMPACT_SPEED};
pub use halt::{Halt, MOST_STEPS_PER_S};
pub use physics::clearance_joints::{ClearanceJoint, ClearanceJoints};
pub use physics::colliders::{JointColliders, Solver};
pub use physics::dispatcher::RingDispatcher;
pub use physics::ring::BearingRing;
pub use run::{Instant, Schedule, run, run_balanced, run_while, run_without_wear};
pub use stepping::adaptive::LONGEST_STEP;
pub use stepping::energy::Energy;

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
