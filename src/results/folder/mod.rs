//! Output folders: written aside, named at the end, and never at the cost of somebody's files.
//!
//! ```text
//! OUT.partial  (claimed: locked by one process) ── finish ──► OUT   exchanged in one step
//! OUT.replaced (the old result for an instant, only where the system cannot exchange)
//! ```
//! A process that is killed leaves its `OUT.partial` behind, unlocked. The next start in the same place finds it so, and
//! clears it; a live one's is locked, and a second process that uses the same `OUT` is told.

mod claim;
mod folder_error;
mod making;
mod mark;
mod marker;
mod swap;
pub(crate) mod sync;

pub use folder_error::FolderError;
pub use making::abandon;

use claim::FolderClaim;
use marker::files_of_result;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A folder of results in the making. Its files are written into a folder beside it, which takes the
/// final name only when all of them are there; dropped before, it leaves nothing behind.
///
/// ```
/// use freeplay::results::Folder;
///
/// let place = tempfile::tempdir()?;
/// let target = place.path().join("result");
/// let folder = Folder::prepare(&target, "result.json", false)?;
/// std::fs::write(folder.file("result.json"), r#"{"program": "freeplay", "files": []}"#)?;
/// assert!(!target.exists(), "nothing has the name before all is there");
/// folder.finish()?;
/// assert!(target.join("result.json").exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Folder {
    /// As the user wrote it.
    target: PathBuf,
    /// The same from the root: the working directory itself may be meant.
    absolute: PathBuf,
    claim: FolderClaim,
    marker: &'static str,
    force: bool,
}

/// Name of the folder of a command's results where the user gives none: command and scenario, with
/// every character that some file system or shell minds replaced by a dash.
pub fn default_name(command: &str, scenario: &str) -> PathBuf {
    let plain = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    // File systems allow 255 bytes, and a character takes up to four.
    let name: String = scenario.chars().map(plain).take(50).collect();
    format!("freeplay-{command}-{name}").into()
}

impl Folder {
    /// Makes sure that results can be written to `target`, and where to put them until then. Missing
    /// folders on the way are made; what a killed process left of an earlier attempt is removed. `marker`
    /// is the JSON file by which a result is known: it says `"program": "freeplay"`, and in `"files"` what
    /// else belongs to the result.
    ///
    /// # Errors
    /// [`FolderError`], before anything is written.
    pub fn prepare(
        target: &Path,
        marker: &'static str,
        force: bool,
    ) -> Result<Folder, FolderError> {
        let claimed = Self::claim(target, marker, force);
        // A name that is taken is the better news where the folder beside it cannot be made either.
        may_replace(target, marker, force)?;
        claimed
    }

    /// Tidies up what a killed process left beside `target`, for those who go on in a folder that is
    /// there already.
    ///
    /// # Errors
    /// [`FolderError::Busy`] if a living process makes a result of that name.
    pub fn mend(target: &Path, marker: &'static str) -> Result<(), FolderError> {
        let absolute = from_root(target)?;
        let left = [claim::place(&absolute), swap::aside(&absolute)];
        if left.iter().any(|path| path.symlink_metadata().is_ok()) {
            drop(Self::claim(target, marker, false)?);
        }
        Ok(())
    }

    fn claim(target: &Path, marker: &'static str, force: bool) -> Result<Folder, FolderError> {
        let absolute = from_root(target)?;
        let (Some(parent), Some(_)) = (absolute.parent(), absolute.file_name()) else {
            // The root of a file system.
            return Err(FolderError::Taken(target.to_owned()));
        };
        fs::create_dir_all(parent).map_err(FolderError::io(parent))?;
        let claim = FolderClaim::new(target, &absolute, marker)?;
        swap::mend(&absolute, marker).map_err(FolderError::io(target))?;
        Ok(Folder { target: target.to_owned(), absolute, claim, marker, force })
    }

    /// Where the files of the result are to be written now.
    pub fn path(&self) -> &Path {
        self.claim.path()
    }

    /// Where a file of the result is to be written now.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path().join(name)
    }

    /// Whether there is an earlier result under the name, which `finish` would replace.
    pub fn replaces(&self) -> bool {
        self.absolute.join(self.marker).exists()
    }

    /// Gives the folder its name, in one step, when the disk has all of its files: a power cut too leaves the
    /// earlier result or the new one.
    ///
    /// # Errors
    /// If the file system refuses, or if files turned up there meanwhile.
    pub fn finish(mut self) -> Result<PathBuf, FolderError> {
        may_replace(&self.target, self.marker, self.force)?;
        let failed = |source| FolderError::Name { folder: self.target.clone(), source };
        sync::files(self.path()).map_err(failed)?;
        // Nobody abandons this between its two names.
        let mut making = making::hold();
        let named = self.claim.unmark().and_then(|()| {
            sync::names(self.path());
            swap::name(self.path(), &self.absolute)
        });
        if named.is_ok() {
            self.claim.let_go(&mut making);
        }
        drop(making);
        named.map_err(failed)?;
        Ok(self.target.clone())
    }
}

/// A path from the root, links resolved where it exists: what a link points at is what is replaced.
fn from_root(target: &Path) -> Result<PathBuf, FolderError> {
    // A name may end in a slash, and what stands beside it does not stand in it.
    let absolute = |_| std::path::absolute(target).map(|path| path.components().collect());
    target.canonicalize().or_else(absolute).map_err(FolderError::io(target))
}

/// Whether `target` is free, empty, or a result that may be replaced.
fn may_replace(target: &Path, marker: &str, force: bool) -> Result<(), FolderError> {
    let entries = match fs::read_dir(target) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(_) if target.is_file() => return Err(FolderError::File(target.to_owned())),
        Err(error) => return Err(FolderError::io(target)(error)),
    };
    let ours = files_of_result(&target.join(marker));
    let mut empty = true;
    for entry in entries {
        let entry = entry.map_err(FolderError::io(target))?;
        let entry = entry.file_name().to_string_lossy().into_owned();
        if !ours.contains(&entry) {
            return Err(FolderError::Foreign { folder: target.to_owned(), entry });
        }
        empty = false;
    }
    if empty || force { Ok(()) } else { Err(FolderError::Taken(target.to_owned())) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MARKER: &str = "summary.json";

    fn write_result(folder: Folder) -> PathBuf {
        let text = r#"{"program": "freeplay", "files": ["summary.json", "a.csv"]}"#;
        fs::write(folder.file(MARKER), text).expect("write");
        fs::write(folder.file("a.csv"), "1").expect("write");
        folder.finish().expect("finish")
    }

    #[test]
    fn a_result_is_replaced_only_when_asked() {
        let dir = tempfile::tempdir().expect("folder");
        let target = dir.path().join("deep/result");
        write_result(Folder::prepare(&target, MARKER, false).expect("free"));
        let again = Folder::prepare(&target, MARKER, false);
        assert!(matches!(again, Err(FolderError::Taken(_))));
        write_result(Folder::prepare(&target, MARKER, true).expect("forced"));
        assert_eq!(fs::read_dir(dir.path().join("deep")).expect("read").count(), 1);
    }

    #[test]
    fn nobodys_files_are_deleted() {
        let dir = tempfile::tempdir().expect("folder");
        let target = dir.path().join("result");
        write_result(Folder::prepare(&target, MARKER, false).expect("free"));
        fs::write(target.join("notes.txt"), "mine").expect("write");
        let refused = Folder::prepare(&target, MARKER, true).expect_err("foreign");
        assert!(refused.to_string().contains("notes.txt"), "{refused}");
        fs::remove_file(target.join(MARKER)).expect("remove");
        fs::remove_file(target.join("notes.txt")).expect("remove");
        assert!(Folder::prepare(&target, MARKER, true).is_err(), "no marker, no result");
        fs::remove_file(target.join("a.csv")).expect("remove");
        assert!(Folder::prepare(&target, MARKER, false).is_ok(), "empty");
    }

    #[test]
    fn files_that_turn_up_meanwhile_are_kept() {
        let dir = tempfile::tempdir().expect("folder");
        let target = dir.path().join("result");
        let folder = Folder::prepare(&target, MARKER, true).expect("free");
        fs::create_dir(&target).expect("make");
        fs::write(target.join("mine"), "").expect("write");
        assert!(folder.finish().is_err());
        assert_eq!(fs::read_dir(dir.path()).expect("read").count(), 1);
    }

    #[test]
    fn names_suit_every_file_system() {
        let name = default_name("run", "a/b c:ä");
        assert_eq!(name, PathBuf::from("freeplay-run-a-b-c-ä"));
        assert!(default_name("run", &"x".repeat(1000)).as_os_str().len() < 100);
    }
}
