//! What commands share: options, failures, printing, tables, progress, signals, work in parts, lists of kinds.

pub(super) mod catalogue;
pub(super) mod failure;
pub(super) mod options;
pub(super) mod output;
pub(super) mod parts;
pub(super) mod progress;
pub(super) mod signals;
pub(super) mod table;
