//! Mechanism files and templates, the real binary.

#[path = "../cli_common/mod.rs"]
mod cli_common;
mod commands;
mod effects;
mod files;
mod long;
mod mixed;
mod odd;
mod refusals;
mod refused_motions;
mod templates;
