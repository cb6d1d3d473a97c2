//! Mechanism files and templates, the real binary.

#[path = "../cli_common/mod.rs"]
mod cli_common;
mod commands;
mod files;
mod mixed;
mod odd;
mod refusals;
mod templates;
