//! # freeplay
//!
//! Planar mechanisms whose revolute joints have clearance (free play): a journal flies and hits
//! inside its bearing ring, and the motion turns chaotic. Links are rapier2d rigid bodies, journals
//! and rings collide through a force law of their own choosing (Hertz plus STEP damping by
//! default), prismatic drives follow the inverse kinematics. SI units everywhere.
//!
//! ## A tour
//! A [`Scenario`](scenario::Scenario) is a TOML text with every number checked; [`assemble`](model::assemble) makes a
//! [`Machine`](model::Machine) of it; [`run`](engine::run()) hands out [`Instant`](engine::Instant)s, row by row:
//! ```
//! use freeplay::prelude::*;
//!
//! let scenario = Scenario::load(None, &["joints.clearance=2e-4".to_owned(), "simulation.duration=0.01".to_owned()])?;
//! let machine = assemble(&scenario)?;
//! let mut deepest = 0.0_f64;
//! run(&machine.mechanism, machine.control, machine.schedule, &mut |instant| {
//!     let contacts = instant.evaluation.contacts.iter();
//!     deepest = contacts.map(|contact| contact.penetration).fold(deepest, f64::max);
//! })?;
//! assert!(deepest < 1e-6, "contacts give way by less than a micrometre");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! A contact law is a plain function, to be asked without a machine:
//! ```
//! use freeplay::prelude::*;
//!
//! let law = HertzStep { stiffness: 1.6e10, exponent: 1.5, c_max: 500.0, d_max: 1e-5, clip: true };
//! // 16 N at a penetration of 1 µm at rest, K δ^1.5; more while the journal still goes in.
//! assert!((law.normal_force(1e-6, 0.0) - 16.0).abs() < 1e-9);
//! assert!(law.normal_force(1e-6, 0.1) > 16.0);
//! ```
//! What a machine may lack undeclared is an effect, a change of its mechanism:
//! ```
//! use freeplay::prelude::*;
//!
//! let scenario = Scenario::load(None, &[])?;
//! let mut mechanism = assemble(&scenario)?.mechanism;
//! let before = mechanism.bodies[mechanism.output].mass;
//! let payload = Setting::on(freeplay::effects::named("payload").unwrap(), Target::Machine, &[("mass_kg", 0.1)]);
//! payload.apply(&mut mechanism).unwrap();
//! assert!((mechanism.bodies[mechanism.output].mass - before - 0.1).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! [`ClearanceJoints`](engine::ClearanceJoints) put such joints into a rapier world of your own; `examples/` holds programs to read
//! from top to bottom.
//!
//! ## Rooms
//! Bottom to top; each uses only what stands before it:
//!
//! | room | holds |
//! |---|---|
//! | [`measure`] | thinning of long signals, interpolation, statistics |
//! | [`contact`] | force laws as plain functions, and the forces in one clearance joint |
//! | [`mechanism`] | bodies, joints, drives, motions as plain data; equations of motion |
//! | [`effects`] | what may act on a machine undeclared: payloads, friction, worn joints, late servos |
//! | [`engine`] | the only room that knows rapier: ring shape, contact hook, stepping |
//! | [`scenario`] | the TOML file, validated |
//! | [`model`] | scenario → bodies, joints, drives → a machine put together |
//! | [`simulate`] | checks beforehand, rows, summary |
//! | [`report`] | pictures and the page, from plain data |
//! | [`results`] | folders of results, which appear whole or not at all |
//! | [`study`] | what users come for: a run and its files, comparisons, sweeps |
//! | [`calibrate`] | what a declared model lacks, by recorded runs of the machine |
//! | [`cli`] | one file per command |

pub mod calibrate;
pub mod cli;
pub mod contact;
pub mod effects;
pub mod engine;
pub mod measure;
pub mod mechanism;
pub mod model;
pub mod report;
pub mod results;
pub mod scenario;
pub mod simulate;
pub mod study;

/// What most programs need: `use freeplay::prelude::*;`.
pub mod prelude {
    pub use crate::contact::{Clearance, ForceLaw, HertzStep};
    pub use crate::effects::{Setting, Target};
    pub use crate::engine::{ClearanceJoint, ClearanceJoints, Instant, Schedule, StepControl, run};
    pub use crate::mechanism::{BodyState, Mechanism};
    pub use crate::model::{Machine, assemble};
    pub use crate::scenario::Scenario;
    pub use crate::simulate::{Recorder, Summary};
}
