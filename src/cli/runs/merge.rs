//! `freeplay merge`: the parts of a sweep joined.

use super::sweep::print;
use crate::cli::shared::failure::Failure;
use crate::cli::shared::options::PrintOptions;
use crate::study::sweep::merge;
use clap::Args;
use std::path::PathBuf;

/// Join the parts that `freeplay sweep --shard` made
///
/// The result is that of the sweep in one piece, byte for byte. The parts must belong to the same
/// sweep, must not contradict each other and must have all rows between them; they stay as they are.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// Folders of the parts
    #[arg(value_name = "DIR", required = true)]
    parts: Vec<PathBuf>,
    /// Folder for the whole
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Replace a result that is already there (never any other files)
    #[arg(long)]
    force: bool,
    /// Join what there is although rows are missing; `freeplay sweep` can go on in the result
    #[arg(long)]
    partial: bool,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay merge part-1 part-2 part-3 part-4 --out all
  freeplay merge part-* --out so-far --partial";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { parts, out, force, partial, print: options } = arguments;
    let outcome = merge(parts, out, *force, *partial)?;
    print(&outcome, &format!("merged from {} parts", parts.len()), options)
}
