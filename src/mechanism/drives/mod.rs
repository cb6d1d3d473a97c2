//! Drives of joints: what they are told, what their encoders read, how controllers hold them, and what stands between them and
//! their joints.

pub(super) mod actuator;
pub(super) mod cascade;
pub(super) mod command;
pub(super) mod reading;
pub(super) mod reading_error;
pub(super) mod rotor;
pub(super) mod transmission;
