//! `freeplay calibrate` and `freeplay predict`, the real binary: what they write, and that they refuse
//! recordings that cannot be right.

#[path = "../cli_common/mod.rs"]
mod cli_common;
mod incomplete;
mod instruments;
mod predictions;
mod recording;
mod refusals;
mod results;
mod self_test;
