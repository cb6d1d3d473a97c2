//! What a power cut leaves: nothing gets its name before the disk has its content.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::Path;

/// Waits until the disk has a file.
///
/// # Errors
/// If it cannot take it: some file systems find out only now that they are full.
pub(crate) fn file(path: &Path) -> io::Result<()> {
    // Windows syncs through handles that may write only.
    OpenOptions::new().write(true).open(path)?.sync_all()
}

/// Waits until the disk has the names in a folder. Where a system cannot do that, it sees to it itself.
pub(crate) fn names(folder: &Path) {
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

/// Waits until the disk has all files of a folder.
///
/// # Errors
/// As [`file`].
pub(super) fn files(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_file() {
            file(&entry.path())?;
        }
    }
    Ok(())
}
