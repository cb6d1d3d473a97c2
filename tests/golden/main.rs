//! What the program gave, kept in `data/`: series, figures and reports of the built-in machines, with
//! which the same commands are compared. A change of the program's structure must not change its results
//! beyond rounding.
//!
//! * `cargo test --release --test golden`: what takes seconds.
//! * `cargo test --release --test golden -- --ignored`: the calibrations of the six rigs and the slower
//!   study of measured hardware, some minutes. With `--nocapture` each test says how far it is from what
//!   is kept.
//! * `FREEPLAY_WRITE_GOLDEN=1` before either command writes the files instead of comparing them, for
//!   changes that are meant to change results. Read the difference before keeping it.
//!
//! A rattling machine is chaotic: differences of rounding grow e-fold in 10 ms, and jump where one of them
//! decides whether a step is repeated. Runs are therefore compared tightly at first, less so later, and
//! only as far as a change of one input in its last bit leaves them alone.

#[path = "../cli_common/mod.rs"]
mod cli_common;
mod commands;
mod every_effect;
mod figures;
mod kept;
mod reports;
mod runs;
mod series;

use cli_common::Place;
use serde_json::Value;

/// The `--json` of a command.
fn json(place: &Place, line: &str) -> Value {
    serde_json::from_str(&place.good(&format!("{line} --json --quiet"))).unwrap()
}

/// A file of the project.
fn asset(name: &str) -> String {
    format!("{}/assets/{name}", env!("CARGO_MANIFEST_DIR"))
}
