//! Every effect against a closed form, an invariant, or the same thing declared another way; and what
//! is said of wrong ones.

mod all;
#[path = "../cli_common/mod.rs"]
mod cli_common;
mod commands;
mod common;
mod drives;
mod joints;
mod lengths;
mod loads;
