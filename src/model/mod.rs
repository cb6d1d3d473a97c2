//! From a scenario to a machine that can be simulated.
//!
//! A scenario with a `[mechanism] kind` is expanded to a description of its bodies, joints and drives
//! ([`expand`]), the same that a file may give itself; [`assemble`] is the only way from a description to a
//! [`Machine`]. `built` makes a mechanism of the description, `drives` and `commands` say what it is told, along a [`path`](DrivenPath)
//! of the machine without clearance.

mod assemble;
mod built;
mod commands;
mod drives;
mod ideal;
mod ideal_past;
mod motion;
mod native;
mod path;
mod shared_ideal;
mod templates;

pub use assemble::{Machine, assemble, close, driven, parts_of, radial_clearance, recorded};
pub use built::declared_drives::drive;
pub use built::layout::{Layout, Written};
pub use ideal::{Ideal, IdealInstant};
pub use native::FIT_SPEED;
pub use path::{DrivenPath, Singular};
pub use shared_ideal::SharedIdeal;
pub use templates::{LegUse, expand, instrumented, laboratory, leg_use};
