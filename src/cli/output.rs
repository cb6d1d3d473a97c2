//! Printing that survives a reader who has gone away.

use crate::measure::shown::shown;
use std::io::{self, ErrorKind, Write};

/// Prints `text` on standard output, what would act on a terminal as numbers. A reader who closed the pipe (`| head`) has seen
/// enough: that is no error.
pub(super) fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(shown(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// Characters after which a complaint is cut: it quotes a file that is no text for people.
const LONGEST: usize = 10_000;

/// Prints a line on standard error, what would act on a terminal as numbers. If that is impossible there is nobody to tell.
pub(super) fn complain(line: &str) {
    let end = line.char_indices().nth(LONGEST).map_or(line.len(), |(end, _)| end);
    let cut = if end < line.len() { " …" } else { "" };
    let _ = writeln!(io::stderr(), "{}{cut}", shown(&line[..end]));
}
