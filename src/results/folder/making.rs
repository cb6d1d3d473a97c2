//! The folders that this process has in the making, so that a signal can end it without litter.

use super::mark::remove;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

static MAKING: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// How often a folder into which others still write is emptied before it is left to the next start.
const ATTEMPTS: usize = 20;

/// The list; as long as it is held, nothing is abandoned.
pub(super) fn hold() -> MutexGuard<'static, Vec<PathBuf>> {
    MAKING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every folder that this process has in the making, for a process that is about to end: no
/// result gets its name from now on, and threads that would name or drop one wait for the end. Returns
/// how many there were.
pub fn abandon() -> usize {
    let making = hold();
    for path in making.iter() {
        // Other threads may be writing: what they add between two looks goes with the next.
        (0..ATTEMPTS).any(|_| remove(path).is_ok());
    }
    let count = making.len();
    std::mem::forget(making);
    count
}
