//! Drives of joints: what they are told, how encoders err, how controllers hold them, and what stands between them and
//! their joints.

pub(super) mod actuator;
pub(super) mod cascade;
pub(super) mod command;
pub(super) mod reading_error;
pub(super) mod transmission;
