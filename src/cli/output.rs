//! Printing that survives a reader who has gone away.

use std::io::{self, ErrorKind, Write};

/// Prints `text` as it is on standard output. A reader who closed the pipe (`| head`) has seen
/// enough: that is no error.
pub(super) fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// Prints a line on standard error. If that is impossible there is nobody to tell.
pub(super) fn complain(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}
