//! From a scenario to a machine that can be simulated.
//!
//! A scenario with a `[mechanism] kind` is expanded to a description of its bodies, joints and drives
//! ([`expand`]), the same that a file may give itself; [`assemble`] is the only way from a description to a
//! [`Machine`].

mod assemble;
mod build;
mod commands;
mod declared_drives;
mod drives;
mod guides;
mod ideal;
mod layout;
mod material;
mod motion;
mod names;
mod native;
mod parts;
mod path;
mod shape;
mod templates;

pub use assemble::{Machine, assemble, close, driven, parts_of, radial_clearance, recorded};
pub use declared_drives::drive;
pub use ideal::{Ideal, IdealInstant};
pub use layout::{Layout, Written};
pub use native::FIT_SPEED;
pub use path::{DrivenPath, Singular};
pub use templates::{LegUse, expand, instrumented, laboratory, leg_use};
