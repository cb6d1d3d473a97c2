//! Effects in sensors: encoders, those of drives as well, trackers, force sensors. [`encoder`] holds what those of joints share.

pub(super) mod actuator_scale;
pub(super) mod encoder;
pub(super) mod encoder_eccentricity;
pub(super) mod encoder_scale;
pub(super) mod encoder_zero;
pub(super) mod force_offset;
pub(super) mod force_scale;
pub(super) mod sensor_latency;
pub(super) mod sensor_offset;
pub(super) mod tracker_frame;
