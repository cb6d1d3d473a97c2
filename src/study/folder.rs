//! Output folders: written aside, named at the end, and never at the cost of somebody's files.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A folder of results in the making. Its files are written into a folder beside it, which takes the
/// final name only when all of them are there; dropped before, it leaves nothing behind.
#[derive(Debug)]
pub struct Folder {
    /// As the user wrote it.
    target: PathBuf,
    /// The same from the root: the working directory itself may be meant.
    absolute: PathBuf,
    partial: PathBuf,
    marker: &'static str,
    force: bool,
}

/// Why a folder cannot take results.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// It holds a result, and nobody said to replace it.
    #[error(
        "`{0}` already holds a result; replace it with --force, or choose another folder with --out"
    )]
    Taken(PathBuf),
    /// It holds something else.
    #[error(
        "`{folder}` holds `{entry}`, which is not part of a result: nothing there is replaced, not \
         even with --force; choose another folder with --out"
    )]
    Foreign {
        /// The folder.
        folder: PathBuf,
        /// What lies in it.
        entry: String,
    },
    /// There is a file of that name.
    #[error("`{0}` is a file; --out needs the name of a folder")]
    File(PathBuf),
    /// The file system refuses.
    #[error("cannot write to `{folder}`: {source}; choose another folder with --out")]
    Io {
        /// The folder.
        folder: PathBuf,
        /// Why.
        source: io::Error,
    },
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
    /// folders on the way are made. `marker` is the JSON file by which a result is known: it says
    /// `"program": "freeplay"`, and in `"files"` what else belongs to the result.
    ///
    /// # Errors
    /// [`FolderError`], before anything is written.
    pub fn prepare(
        target: &Path,
        marker: &'static str,
        force: bool,
    ) -> Result<Folder, FolderError> {
        may_replace(target, marker, force)?;
        let refused = |folder: &Path| {
            let folder = folder.to_owned();
            |source| FolderError::Io { folder, source }
        };
        let absolute = std::path::absolute(target).map_err(refused(target))?;
        let (Some(parent), Some(name)) = (absolute.parent(), absolute.file_name()) else {
            // The root of a file system.
            return Err(FolderError::Taken(target.to_owned()));
        };
        fs::create_dir_all(parent).map_err(refused(parent))?;
        let name = name.to_string_lossy();
        let partial = parent.join(format!("{name}.partial-{}", std::process::id()));
        fs::create_dir(&partial).map_err(refused(parent))?;
        Ok(Folder { target: target.to_owned(), absolute, partial, marker, force })
    }

    /// Where the files of the result are to be written now.
    pub fn path(&self) -> &Path {
        &self.partial
    }

    /// Where a file of the result is to be written now.
    pub fn file(&self, name: &str) -> PathBuf {
        self.partial.join(name)
    }

    /// Gives the folder its name.
    ///
    /// # Errors
    /// If the file system refuses, or if files turned up there meanwhile.
    pub fn finish(self) -> Result<PathBuf, FolderError> {
        may_replace(&self.target, self.marker, self.force)?;
        let refused = |source| FolderError::Io { folder: self.target.clone(), source };
        if self.absolute.exists() {
            // Moved aside first: at no time is there half a result under the name.
            let mut old = self.partial.clone().into_os_string();
            old.push("-old");
            fs::rename(&self.absolute, &old).map_err(refused)?;
            if let Err(error) = fs::rename(&self.partial, &self.absolute) {
                fs::rename(&old, &self.absolute).map_err(refused)?;
                return Err(refused(error));
            }
            fs::remove_dir_all(&old).map_err(refused)?;
        } else {
            fs::rename(&self.partial, &self.absolute).map_err(refused)?;
        }
        Ok(self.target.clone())
    }
}

impl Folder {
    /// Leaves what was written under the name that it has now, and says that name: half a result is
    /// worth more than none, but it is not the result.
    pub fn keep(mut self) -> PathBuf {
        std::mem::take(&mut self.partial)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // After `finish` there is nothing left under this name, after `keep` there is no name. A
        // failure to tidy up is no news.
        let _ = fs::remove_dir_all(&self.partial);
    }
}

/// Whether `target` is free, empty, or a result that may be replaced.
fn may_replace(target: &Path, marker: &str, force: bool) -> Result<(), FolderError> {
    let refused = |source| FolderError::Io { folder: target.to_owned(), source };
    let entries = match fs::read_dir(target) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(_) if target.is_file() => return Err(FolderError::File(target.to_owned())),
        Err(error) => return Err(refused(error)),
    };
    let ours = files_of_result(&target.join(marker));
    let mut empty = true;
    for entry in entries {
        let entry = entry.map_err(refused)?.file_name().to_string_lossy().into_owned();
        if !ours.contains(&entry) {
            return Err(FolderError::Foreign { folder: target.to_owned(), entry });
        }
        empty = false;
    }
    if empty || force { Ok(()) } else { Err(FolderError::Taken(target.to_owned())) }
}

/// The names of the files of a result, or none if `marker` is not a result's.
fn files_of_result(marker: &Path) -> Vec<String> {
    let text = fs::read_to_string(marker).unwrap_or_default();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    if value["program"] != env!("CARGO_PKG_NAME") {
        return Vec::new();
    }
    let files = value["files"].as_array().map(Vec::as_slice).unwrap_or_default();
    files.iter().filter_map(|name| name.as_str().map(str::to_owned)).collect()
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
