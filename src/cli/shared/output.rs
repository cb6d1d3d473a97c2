//! Printing that survives a reader who has gone away.

use super::table::{self, paragraph};
use crate::measure::shown::shown;
use std::fmt::Write as _;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Prints `text` on standard output, what would act on a terminal as numbers. A reader who closed the pipe (`| head`) has seen
/// enough: that is no error.
pub(in crate::cli) fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(shown(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// Writes a file aside and gives it its name: at no time is there half of it, and none at all where the disk is full. What
/// is no file, such as a pipe, is written to as it is, and a link stays one: what it points at is replaced.
pub(in crate::cli) fn whole(file: &Path, text: &str) -> io::Result<()> {
    if file.exists() && !file.is_file() {
        return fs::write(file, text);
    }
    let (file, aside) = beside(file);
    fs::write(&aside, text)
        .and_then(|()| fs::rename(&aside, &file))
        // The error is that of the writing.
        .inspect_err(|_| drop(fs::remove_file(&aside)))
}

/// Whether [`whole`] can write a file, found out before there is anything to be written.
pub(in crate::cli) fn can_hold(file: &Path) -> io::Result<()> {
    if file.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if file.exists() && !file.is_file() {
        return Ok(());
    }
    let (_, aside) = beside(file);
    fs::write(&aside, "")?;
    fs::remove_file(&aside)
}

/// What a name stands for, and the name under which it is written first.
fn beside(file: &Path) -> (PathBuf, PathBuf) {
    let file = file.canonicalize().unwrap_or_else(|_| file.to_owned());
    let mut aside = file.as_os_str().to_owned();
    aside.push(".partial");
    (file, PathBuf::from(aside))
}

/// Characters after which a complaint is cut: it quotes a file that is no text for people.
const LONGEST: usize = 10_000;

/// Prints a line on standard error, what would act on a terminal as numbers, wrapped by words on a terminal. If that is impossible there is nobody to tell.
pub(in crate::cli) fn complain(line: &str) {
    let end = line.char_indices().nth(LONGEST).map_or(line.len(), |(end, _)| end);
    let cut = if end < line.len() { " …" } else { "" };
    let line = format!("{}{cut}", shown(&line[..end]));
    let _ = writeln!(io::stderr(), "{}", table::for_stderr(&line).unwrap_or(line));
}

/// Columns that words need to be read beside what they are about, and where they begin below it.
const LEAST_WORDS: usize = 35;
const BELOW: usize = 8;

/// Parameters in columns, and what each is about behind them.
pub(in crate::cli) fn parameters(rows: &[([String; 4], &str)]) -> String {
    let width = |i: usize| rows.iter().map(|(row, _)| row[i].len()).max().unwrap_or(0);
    let mut text = String::new();
    for (row, about) in rows {
        let mut line = String::from("    ");
        for (i, cell) in row.iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = write!(line, "{cell:<width$}  ", width = width(i));
        }
        let start = line.chars().count();
        if start + LEAST_WORDS <= table::width() {
            text += &paragraph(&line, &" ".repeat(start), about);
        } else {
            text += &format!("{}\n", line.trim_end());
            text += &paragraph(&" ".repeat(BELOW), &" ".repeat(BELOW), about);
        }
    }
    text
}
