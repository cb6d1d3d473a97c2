//! The engine room: the only place that knows rapier and parry.
//!
//! * `ring`, `dispatcher`: [`BearingRing`], the inside of a bearing as a parry shape, and [`RingDispatcher`], its
//!   circle-in-ring queries in closed form, so that rapier's contacts and the laws see one geometry.
//! * `colliders`: rings and journals as colliders, and the physics hook that takes their pairs away from rapier's
//!   solver where a law computes the force.
//! * `clearance_joints`: [`ClearanceJoints`] for anybody's rapier world. `leapfrog` reads that world's velocities: rapier's
//!   velocity after a step is that of the half step.
//! * `world`: a [`Mechanism`](crate::mechanism::Mechanism) as rapier bodies, joints, motors.
//! * `run`: the driver of a whole run: rows, account of impacts and peaks (`watch`), wear (`wear`). It knows a `Stepper` by its
//!   functions:
//!   * `fixed`: fixed steps, second order (velocity Verlet), on a grid of its own;
//!   * `adaptive`: error control, fourth order where forces are smooth: rapier is handed the average of the forces
//!     along a path predicted by the equations of motion;
//!   * `direct`: no engine, the equations of motion integrated under error control;
//!   * `native`: rapier's own contacts, as rapier steps them.
//! * `between`: rows between the ends of steps. `energy`: the balance of a run. `halt`: what ends one.
//!   `control`: how the step is chosen. `work`: what it took.

mod adaptive;
mod between;
mod clearance_joints;
mod clock;
mod colliders;
mod control;
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
mod work;
mod world;

pub use adaptive::LONGEST_STEP;
pub use clearance_joints::{ClearanceJoint, ClearanceJoints};
pub use colliders::{JointColliders, Solver};
pub use control::{Engine, StepControl, TYPICAL_IMPACT_SPEED};
pub use dispatcher::RingDispatcher;
pub use energy::Energy;
pub use halt::{Halt, MOST_STEPS_PER_S};
pub use ring::BearingRing;
pub use run::{Instant, Schedule, run, run_balanced, run_while};
pub use watch::{Peaks, Tally};
pub use wear::WEAR_DIRECTIONS;
pub use work::Work;

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
