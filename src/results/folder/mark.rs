//! The mark of a folder in which a result is made, and how such a folder is emptied and removed.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

/// Says to people and to us what the folder is; the last file that is removed.
pub(super) const MARK: &str = ".freeplay-unfinished";

/// What stands in it.
pub(super) const MARK_TEXT: &str = "freeplay is writing a result here. If none is at work, one was killed: the next that writes a \
     result beside this folder clears it, and so may you.\n";

/// Removes everything but the mark.
pub(super) fn clear(path: &Path) -> io::Result<()> {
    for entry in fs::read_dir(path)? {
        let entry = entry?;
        if entry.file_name() == MARK {
            continue;
        }
        if entry.file_type()?.is_dir() {
            fs::remove_dir_all(entry.path())?;
        } else {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Removes a folder of ours so that, interrupted anywhere, what is left is known as ours.
pub(super) fn remove(path: &Path) -> io::Result<()> {
    if !path.is_dir() {
        return Ok(());
    }
    // A full disk may refuse the mark; it does not refuse to be emptied.
    let mark = path.join(MARK);
    let _ = mark.exists() || fs::write(&mark, MARK_TEXT).is_ok();
    clear(path)?;
    match fs::remove_file(mark) {
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    fs::remove_dir(path)
}
