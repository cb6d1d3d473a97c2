//! Effects that act on bodies, or on all of them: masses, points, loads, drag, gravity, the base.

pub(super) mod air_drag;
pub(super) mod base_vibration;
pub(super) mod drag;
pub(super) mod gravity;
pub(super) mod impulse;
pub(super) mod leg_density;
pub(super) mod load_change;
pub(super) mod mass_properties;
pub(super) mod payload;
pub(super) mod point_offset;
pub(super) mod tether;
pub(super) mod unbalance;
