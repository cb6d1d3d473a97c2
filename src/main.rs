//! The `freeplay` command; see `freeplay --help`.

use std::process::ExitCode;

fn main() -> ExitCode {
    freeplay::cli::main()
}
