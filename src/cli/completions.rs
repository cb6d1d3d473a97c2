//! `freeplay completions`: tab completion for shells.

use super::failure::Failure;
use super::{Cli, output};
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Print a script that lets a shell complete commands and options
///
/// For bash: `freeplay completions bash > ~/.local/share/bash-completion/completions/freeplay`
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The shell
    shell: Shell,
}

pub(super) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "freeplay", &mut script);
    Ok(output::print(&String::from_utf8_lossy(&script))?)
}
