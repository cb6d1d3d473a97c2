//! The `freeplay` command; see `freeplay --help`.

use std::process::ExitCode;

/// Looks at recordings and rapier's steps ask for many small pieces of memory, on all threads.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    freeplay::cli::main()
}
