//! Why a folder cannot take results.

use std::io;
use std::path::{Path, PathBuf};

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
    /// Another process makes a result of that name.
    #[error(
        "another freeplay is at work on `{0}`; wait for it, or choose another folder with --out"
    )]
    Busy(PathBuf),
    /// Somebody's unfinished result is there, and nothing says whether its process lives.
    #[error(
        "`{0}` was left by a freeplay that was killed, or one is at work there (this file system \
         has no locks to tell): delete it if none is, or choose another folder with --out"
    )]
    Left(PathBuf),
    /// The file system refuses.
    #[error("cannot write to `{folder}`: {source}; choose another folder with --out")]
    Io {
        /// The folder.
        folder: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file system refuses the finished result its name.
    #[error("cannot give the result its name `{folder}`: {source}")]
    Name {
        /// The folder.
        folder: PathBuf,
        /// Why.
        source: io::Error,
    },
}

impl FolderError {
    pub(super) fn io(folder: &Path) -> impl FnOnce(io::Error) -> FolderError {
        let folder = folder.to_owned();
        |source| FolderError::Io { folder, source }
    }
}
