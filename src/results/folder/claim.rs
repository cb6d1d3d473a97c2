//! The folder in which a result is made: one for each name, of one process at a time.
//!
//! It is locked by an advisory lock on the folder itself, which the system lets go of however its process
//! ends. (A process number in the name would say less: numbers are given again, and mean nothing on
//! another computer that shares the file system.) No file has to stand for the lock, so none is left
//! over, and the lock moves with the folder when that gets its name.

use super::folder_error::FolderError;
use super::making;
use super::mark::{MARK, MARK_TEXT, clear, remove};
use super::marker::files_of_result;
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// What is added to the name of a result in the making.
const PARTIAL: &str = ".partial";

/// How often a folder may vanish between finding and locking it.
const ATTEMPTS: usize = 100;

/// A folder in the making that belongs to this process. Dropped, it is removed.
#[derive(Debug)]
pub(super) struct FolderClaim {
    path: PathBuf,
    /// Holds the lock, where the file system has any.
    _lock: Option<File>,
}

/// Where the result called `absolute` is made.
pub(super) fn place(absolute: &Path) -> PathBuf {
    beside(absolute, PARTIAL)
}

/// The same path with something added to its name.
pub(super) fn beside(absolute: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(absolute);
    name.push(ending);
    name.into()
}

impl FolderClaim {
    /// Claims the place of the result `absolute`, which the user calls `target`, for this process. What
    /// a dead one left there, or beside it, is removed.
    ///
    /// # Errors
    /// [`FolderError`] if another process holds it, if it holds files that are not ours, or if the file
    /// system refuses.
    pub fn new(target: &Path, absolute: &Path, marker: &str) -> Result<FolderClaim, FolderError> {
        let path = place(absolute);
        for _ in 0..ATTEMPTS {
            // Nobody abandons what is made here before it is on the list.
            let mut making = making::hold();
            let made = match fs::create_dir(&path) {
                Ok(()) => true,
                Err(error) if error.kind() == ErrorKind::AlreadyExists => false,
                Err(error) => {
                    return Err(FolderError::io(absolute.parent().unwrap_or(target))(error));
                }
            };
            let lock = match lock(&path) {
                Lock::Ours(file) => Some(file),
                Lock::Gone => continue,
                Lock::Held => return Err(FolderError::Busy(target.to_owned())),
                Lock::Unknown if made => None,
                Lock::Unknown => return Err(FolderError::Left(path)),
            };
            if !made && let Some(entry) = foreign(&path, marker) {
                return Err(FolderError::Foreign { folder: path, entry });
            }
            making.push(path.clone());
            drop(making);
            let claim = FolderClaim { path, _lock: lock };
            fs::write(claim.path.join(MARK), MARK_TEXT)
                .and_then(|()| clear(&claim.path))
                .map_err(FolderError::io(target))?;
            claim.clear_beside();
            return Ok(claim);
        }
        Err(FolderError::Busy(target.to_owned()))
    }

    /// Removes what dead processes left beside this place, under whatever names: hundreds of MB each. What cannot be
    /// removed is left; it is not what was asked for.
    fn clear_beside(&self) {
        let Some(Ok(beside)) = self.path.parent().map(fs::read_dir) else { return };
        for path in beside.flatten().map(|entry| entry.path()) {
            let partial = path.extension().is_some_and(|ending| ending == &PARTIAL[1..]);
            if partial && path != self.path && path.join(MARK).is_file() {
                // A living one holds its lock before it writes its mark.
                if let Lock::Ours(_held) = lock(&path) {
                    let _ = remove(&path);
                }
            }
        }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Takes the mark away: the folder holds a result, by whose own marker it is known.
    pub fn unmark(&self) -> io::Result<()> {
        fs::remove_file(self.path.join(MARK))
    }

    /// Forgets the place: the folder has its final name, and what has this one may be another's.
    pub fn let_go(&mut self, making: &mut Vec<PathBuf>) {
        making.retain(|path| *path != self.path);
        self.path.clear();
    }
}

impl Drop for FolderClaim {
    fn drop(&mut self) {
        let mut making = making::hold();
        if !self.path.as_os_str().is_empty() {
            // A failure to tidy up is no news: the next start tries again.
            let _ = remove(&self.path);
            self.let_go(&mut making);
        }
    }
}

enum Lock {
    Ours(File),
    /// Another process has it.
    Held,
    /// The folder vanished, or got another name, meanwhile.
    Gone,
    /// The file system, or the system, has no locks on folders.
    Unknown,
}

fn lock(path: &Path) -> Lock {
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Lock::Gone,
        Err(_) => return Lock::Unknown,
    };
    match file.try_lock() {
        Ok(()) if is_at(&file, path) => Lock::Ours(file),
        Ok(()) => Lock::Gone,
        Err(TryLockError::WouldBlock) => Lock::Held,
        Err(TryLockError::Error(_)) => Lock::Unknown,
    }
}

/// Keeps other processes away from a folder while this one moves it to the place of one in the making.
pub(super) fn keep_locked(path: &Path) -> Option<File> {
    match lock(path) {
        Lock::Ours(file) => Some(file),
        Lock::Held | Lock::Gone | Lock::Unknown => None,
    }
}

/// Whether an open folder is still the one at `path`.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |metadata: fs::Metadata| (metadata.dev(), metadata.ino());
    match (file.metadata(), path.symlink_metadata()) {
        (Ok(open), Ok(there)) => identity(open) == identity(there),
        _ => false,
    }
}

/// Elsewhere folders cannot be opened, nor renamed while they are.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

/// What lies in a folder and is neither part of a result nor of one in the making.
fn foreign(path: &Path, marker: &str) -> Option<String> {
    let entries = match fs::read_dir(path) {
        Ok(entries) => entries,
        Err(error) => return Some(error.to_string()),
    };
    if path.join(MARK).is_file() {
        return None;
    }
    let ours = files_of_result(&path.join(marker));
    let mut names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.find(|name| !ours.contains(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MARKER: &str = "summary.json";

    #[cfg(unix)]
    #[test]
    fn a_dead_process_leaves_its_place_and_a_living_one_keeps_it() {
        let dir = tempfile::tempdir().expect("folder");
        let target = dir.path().join("r");
        let claim = || FolderClaim::new(&target, &target, MARKER);
        let living = claim().expect("free");
        assert!(matches!(claim(), Err(FolderError::Busy(_))));
        fs::write(living.path().join("rows.csv"), "half").expect("write");
        // As a kill does: the lock goes, the folder stays.
        let mut dead = living;
        let path = std::mem::take(&mut dead.path);
        drop(dead);
        assert!(path.join("rows.csv").exists());
        let next = claim().expect("cleared");
        assert!(!path.join("rows.csv").exists());
        drop(next);
        assert_eq!(fs::read_dir(dir.path()).expect("read").count(), 0);
    }

    #[cfg(unix)]
    #[test]
    fn what_dead_processes_left_under_other_names_is_removed_too() {
        let dir = tempfile::tempdir().expect("folder");
        let claim = |name: &str| {
            let target = dir.path().join(name);
            FolderClaim::new(&target, &target, MARKER).expect("free")
        };
        let [living, mut dead] = ["living", "dead"].map(claim);
        let left = std::mem::take(&mut dead.path);
        drop(dead);
        let mine = dir.path().join("mine.partial");
        fs::create_dir(&mine).expect("make");
        assert!(left.is_dir());
        let _next = claim("next");
        assert!(!left.exists() && living.path().is_dir() && mine.is_dir());
    }

    #[test]
    fn somebodys_folder_of_that_name_is_left_alone() {
        let dir = tempfile::tempdir().expect("folder");
        let target = dir.path().join("r");
        let place = place(&target);
        fs::create_dir(&place).expect("make");
        fs::write(place.join("mine"), "").expect("write");
        assert!(FolderClaim::new(&target, &target, MARKER).is_err());
        assert!(place.join("mine").exists());
    }
}
