//! Printing that survives a reader who has gone away.

use crate::measure::shown::shown;
use std::fmt::Write as _;
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

/// Columns of a line of text.
const WIDTH: usize = 100;

/// Words after `first`, lines after the first one after `next`.
pub(super) fn paragraph(first: &str, next: &str, words: &str) -> String {
    let (mut text, mut line) = (String::new(), first.to_owned());
    let mut empty = true;
    for word in words.split_whitespace() {
        if !empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
            text += line.trim_end();
            text.push('\n');
            next.clone_into(&mut line);
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line += word;
        empty = false;
    }
    text + line.trim_end() + "\n"
}

/// Parameters in columns, and what each is about behind them.
pub(super) fn parameters(rows: &[([String; 4], &str)]) -> String {
    let width = |i: usize| rows.iter().map(|(row, _)| row[i].len()).max().unwrap_or(0);
    let mut text = String::new();
    for (row, about) in rows {
        let mut line = String::from("    ");
        for (i, cell) in row.iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = write!(line, "{cell:<width$}  ", width = width(i));
        }
        let start = line.chars().count();
        text += &paragraph(&line, &" ".repeat(start), about);
    }
    text
}
