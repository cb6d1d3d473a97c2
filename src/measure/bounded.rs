//! Files of other people: read as a stream, and no farther than a program can hold what stands in them.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Most bytes of a scenario: two hundred times the longest that came with a machine.
pub const SCENARIO: u64 = 1 << 20;

/// Most bytes of a recording or of a table of a motion: an hour of ten columns at 500 rows a second.
pub const TABLE: u64 = 256 << 20;

/// Most bytes of a calibration's report, which is held as a tree that takes many times the room of its text.
pub const REPORT: u64 = 16 << 20;

/// A file that is read up to a bound, and refused beyond.
#[derive(Debug)]
pub struct Bounded {
    file: File,
    read: u64,
    most: u64,
}

/// Opens what a user names, a pipe as well as a file, of at most so many bytes.
///
/// # Errors
/// What the system says; a file that is larger, by its size. A pipe that goes on beyond the bound fails while it
/// is read.
pub fn open(path: &Path, most: u64) -> io::Result<Bounded> {
    let file = File::open(path)?;
    let about = file.metadata()?;
    if about.is_dir() {
        return Err(io::Error::new(ErrorKind::IsADirectory, "is a folder, not a file"));
    }
    if about.len() > most {
        return Err(too_large(&bytes(about.len()), most));
    }
    Ok(Bounded { file, read: 0, most })
}

/// Opens a file that another file names: never a pipe or a device, which may wait or go on forever.
///
/// # Errors
/// As of [`open`]; anything but a plain file.
pub fn open_plain(path: &Path, most: u64) -> io::Result<Bounded> {
    // Before it is opened: that alone may wait.
    if std::fs::metadata(path)?.is_file() {
        return open(path, most);
    }
    Err(io::Error::new(ErrorKind::InvalidInput, "is no plain file"))
}

/// All of what a user names as text.
///
/// ```
/// use freeplay::measure::bounded;
///
/// let folder = tempfile::tempdir()?;
/// let file = folder.path().join("note.txt");
/// std::fs::write(&file, "twelve bytes")?;
/// assert_eq!(bounded::text(&file, 12)?, "twelve bytes");
/// assert!(bounded::text(&file, 11).is_err(), "never more than asked for");
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// As of [`open`]; anything but UTF-8.
pub fn text(path: &Path, most: u64) -> io::Result<String> {
    let mut text = String::new();
    open(path, most)?.read_to_string(&mut text)?;
    Ok(text)
}

impl Read for Bounded {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.read += count as u64;
        if self.read > self.most {
            return Err(too_large("more", self.most));
        }
        Ok(count)
    }
}

fn too_large(size: &str, most: u64) -> io::Error {
    let message = format!("holds {size}, and at most {} are read", bytes(most));
    io::Error::new(ErrorKind::FileTooLarge, message)
}

/// A size in words.
fn bytes(count: u64) -> String {
    match count {
        0..1_048_576 => format!("{count} bytes"),
        _ => format!("{:.0} MB", count as f64 / 1_048_576.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_up_to_the_bound_and_refused_with_their_size_beyond() {
        let dir = tempfile::tempdir().expect("folder");
        let path = dir.path().join("log.csv");
        std::fs::write(&path, "12345").expect("written");
        assert_eq!(text(&path, 5).expect("read"), "12345");
        let said = text(&path, 4).expect_err("too large").to_string();
        assert_eq!(said, "holds 5 bytes, and at most 4 bytes are read");
        // A hole of a gigabyte takes no room.
        File::create(&path).and_then(|file| file.set_len(1 << 30)).expect("made");
        let said = open(&path, TABLE).expect_err("too large").to_string();
        assert_eq!(said, "holds 1024 MB, and at most 256 MB are read");
        let said = open(dir.path(), TABLE).expect_err("a folder").to_string();
        assert_eq!(said, "is a folder, not a file");
    }

    #[cfg(unix)]
    #[test]
    fn devices_end_at_the_bound_and_are_no_plain_files() {
        let zeros = Path::new("/dev/zero");
        let said = text(zeros, 1000).expect_err("endless").to_string();
        assert_eq!(said, "holds more, and at most 1000 bytes are read");
        assert_eq!(open_plain(zeros, 1000).expect_err("device").to_string(), "is no plain file");
    }
}
