//! The sections of a scenario file, one type each. SI units; every number's meaning, unit, default
//! and the reason for that default stand at its field.

mod columns;
mod contact;
mod described;
mod drive;
mod environment;
mod joints;
mod legs;
mod mechanism;
mod motion;
mod native;
mod sensors;
mod simulation;
mod templates;

pub use crate::contact::StiffnessForm;
pub use crate::engine::StepControl;
pub use columns::Columns;
pub use contact::{ContactKeys, FilmKind, FrictionLaw, Law, is_law_key};
pub use described::drives::{Force, JointDrive, On, SampledDrive, Servo};
pub use described::joints::{Fixed, Joint, Prismatic, Revolute};
pub use described::{
    Body, Described, GROUND, Ground, Output, Quantity, Sensor, Shape, Spring, Stop,
};
pub use drive::{Drive, DriveMode, Sampled};
pub use environment::Environment;
pub use joints::{Joints, PerJoint};
pub use legs::Legs;
pub use mechanism::Mechanism;
pub use motion::{
    Circle, JointLine, JointMotion, JointMultisine, JointPath, JointQuintic, JointTable, Line,
    Motion, MotionTarget, Multisine, Quintic, Table, Term, Term1,
};
pub use native::Native;
pub use sensors::Sensors;
pub use simulation::Simulation;
pub use templates::*;
