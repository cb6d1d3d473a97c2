//! `freeplay completions`: tab completion for shells.

use crate::cli::Cli;
use crate::cli::shared::failure::Failure;
use crate::cli::shared::output;
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Print a script that lets a shell complete commands and options
///
/// For bash: `freeplay completions bash > ~/.local/share/bash-completion/completions/freeplay`
#[derive(Debug, Args)]
pub(in crate::cli) struct Arguments {
    /// The shell
    shell: Shell,
}

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "freeplay", &mut script);
    Ok(output::print(&String::from_utf8_lossy(&script))?)
}
