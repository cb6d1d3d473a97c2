//! `freeplay schema`: what editors need to complete and check scenario files.

use crate::cli::shared::failure::Failure;
use crate::cli::shared::output;
use crate::scenario::schema;
use clap::Args;

/// Print the schema of scenario and rig files, for editors that complete and check TOML
///
/// A JSON Schema (draft 7) made of the types that freeplay reads files into: every section and key with its
/// meaning, unit and default, contact laws, effects with their parameters and bounds. Editors with a TOML
/// language server (Even Better TOML, taplo) follow a first line `#:schema freeplay.schema.json` in the file.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {}

const EXAMPLES: &str = "\
Examples:
  freeplay schema > freeplay.schema.json
  freeplay schema | jq '.properties.joints.properties | keys'";

pub(in crate::cli) fn main(_: &Arguments) -> Result<(), Failure> {
    Ok(output::print(&format!("{:#}\n", schema()))?)
}
