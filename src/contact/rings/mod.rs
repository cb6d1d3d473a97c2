//! Bearing rings that are not circles: waves, tables, worn ones, and how journals slide on any of them.

pub(super) mod out_of_round;
pub(super) mod ring_shape;
pub(super) mod ring_table;
pub(super) mod worn;
