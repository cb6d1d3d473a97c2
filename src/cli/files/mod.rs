//! Commands on scenario files and on what these may hold: no simulation.

pub(super) mod check;
pub(super) mod check_text;
pub(super) mod completions;
pub(super) mod effects;
pub(super) mod expand;
pub(super) mod init;
pub(super) mod laws;
pub(super) mod man;
pub(super) mod schema;
