//! Commands that simulate scenarios, and that compare what came of them.

pub(super) mod compare;
pub(super) mod compare_laws;
pub(super) mod compare_options;
pub(super) mod diff;
pub(super) mod evaluate;
pub(super) mod merge;
pub(super) mod paper;
pub(super) mod run;
pub(super) mod sweep;
pub(super) mod wear;
