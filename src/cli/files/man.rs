//! `freeplay man`: manual pages.

use crate::cli::Cli;
use crate::cli::shared::failure::Failure;
use crate::cli::shared::output;
use clap::{Args, CommandFactory};
use clap_mangen::Man;
use std::fs;
use std::path::PathBuf;

/// Print the manual page, or write those of all commands into a folder
///
/// For man(1): `freeplay man --out ~/.local/share/man/man1`, then `man freeplay-run`
#[derive(Debug, Args)]
pub(in crate::cli) struct Arguments {
    /// Folder that freeplay.1, freeplay-run.1, … are written into, in place of what is there of these names
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let command = Cli::command();
    let Some(folder) = &arguments.out else {
        let mut page = Vec::new();
        Man::new(command).render(&mut page)?;
        return Ok(output::print(&String::from_utf8_lossy(&page))?);
    };
    let refused = |error: std::io::Error| {
        Failure::Input(vec![format!("--out: cannot write to `{}`: {error}", folder.display())])
    };
    fs::create_dir_all(folder).map_err(refused)?;
    clap_mangen::generate_to(command, folder).map_err(refused)
}
