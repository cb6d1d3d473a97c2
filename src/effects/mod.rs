//! Physical effects that a declared machine may lack: a payload nobody mentioned, a worn joint, a
//! servo that lags. One file each, all of them in [`ALL`]; an effect changes a
//! [`Mechanism`](crate::mechanism::Mechanism) after it was built, so that whatever simulates or
//! inverts mechanisms knows it already.

mod actuator_friction;
mod actuator_scale;
mod anchor_offset;
mod base_vibration;
mod command_delay;
mod drag;
mod gravity;
mod joint_wear;
mod journal_friction;
mod kind;
mod payload;
mod screw_ripple;
mod servo_lag;
mod setting;
mod tether;
mod unbalance;

pub use kind::{Joints, Kind, Parameter, Range, Scan};
pub use setting::{Setting, Wrong};

/// Every effect there is, in the order in which they are listed.
pub const ALL: &[&Kind] = &[
    &payload::KIND,
    &gravity::KIND,
    &actuator_friction::KIND,
    &journal_friction::KIND,
    &anchor_offset::KIND,
    &joint_wear::KIND,
    &command_delay::KIND,
    &servo_lag::KIND,
    &actuator_scale::KIND,
    &screw_ripple::KIND,
    &tether::KIND,
    &drag::KIND,
    &base_vibration::KIND,
    &unbalance::KIND,
];

/// The effect called `name`.
pub fn named(name: &str) -> Option<&'static Kind> {
    ALL.iter().find(|kind| kind.name == name).copied()
}
