//! Commands on recordings of machines: how they are made, planned, explained and predicted.

pub(super) mod calibrate;
pub(super) mod plan;
pub(super) mod predict;
pub(super) mod record;
pub(super) mod self_test;
pub(super) mod study;
