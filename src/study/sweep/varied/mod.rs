//! Which keys are varied, and which values each run takes.

pub(super) mod design;
pub(super) mod vary;
