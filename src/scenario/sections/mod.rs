//! The sections of a scenario file, one type each. SI units; every number's meaning, unit, default
//! and the reason for that default stand at its field.

mod columns;
mod contact;
mod drive;
mod environment;
mod joints;
mod legs;
mod mechanism;
mod motion;
mod native;
mod sensors;
mod simulation;

pub use crate::contact::StiffnessForm;
pub use crate::engine::StepControl;
pub use columns::{Columns, Sources};
pub use contact::{Contact, Law};
pub use drive::{Drive, DriveMode, Sampled};
pub use environment::Environment;
pub use joints::{JOINTS, Joints};
pub use legs::Legs;
pub use mechanism::{DriveStage, Mechanism, Pendulum, ThreeRpr};
pub use motion::{Circle, Line, Motion, Multisine, Quintic, Table, Term};
pub use native::Native;
pub use sensors::Sensors;
pub use simulation::Simulation;
