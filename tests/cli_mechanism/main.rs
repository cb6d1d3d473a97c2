//! Mechanism files and templates, the real binary.

#[path = "../cli_common/mod.rs"]
mod cli_common;
mod commands;
mod effects;
mod files;
mod refusals;
mod templates;
