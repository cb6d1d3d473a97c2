//! How a finished folder gets its name, also where an earlier result has it.

use super::claim::{beside, keep_locked};
use super::mark::remove;
use super::{files_of_result, sync};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Where the earlier result is for an instant, on systems that cannot exchange two folders.
pub(super) fn aside(absolute: &Path) -> PathBuf {
    beside(absolute, ".replaced")
}

/// Gives the folder `made` the name `absolute`. What had it before is then called `made`, or gone.
///
/// # Errors
/// If the file system refuses; the earlier result stands then.
pub(super) fn name(made: &Path, absolute: &Path) -> io::Result<()> {
    let parent = absolute.parent().unwrap_or(absolute);
    if !absolute.exists() {
        fs::rename(made, absolute)?;
        sync::names(parent);
        return Ok(());
    }
    // The earlier result gets the name of one in the making, where nobody else may find it unlocked.
    let earlier = keep_locked(absolute);
    exchange(made, absolute).or_else(|_| in_two_steps(made, absolute))?;
    // The earlier result goes when the disk has the new one's name.
    sync::names(parent);
    // A failure to tidy up is no news: the new result stands, and the next start tries again.
    let _ = remove(made);
    drop(earlier);
    Ok(())
}

/// Two folders change their names in one step.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn exchange(one: &Path, other: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE)?)
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn exchange(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// The same where the system cannot: the earlier result is kept until the new one stands. Killed in
/// between, the next start finds it aside and puts it back.
fn in_two_steps(made: &Path, absolute: &Path) -> io::Result<()> {
    let aside = aside(absolute);
    fs::rename(absolute, &aside)?;
    if let Err(error) = fs::rename(made, absolute) {
        fs::rename(&aside, absolute)?;
        return Err(error);
    }
    sync::names(absolute.parent().unwrap_or(absolute));
    let _ = remove(&aside);
    Ok(())
}

/// Mends what a kill between the two steps left: the earlier result gets its name back, or is removed if
/// the new one has it.
pub(super) fn mend(absolute: &Path, marker: &str) -> io::Result<()> {
    let aside = aside(absolute);
    let ours = files_of_result(&aside.join(marker));
    if ours.is_empty() {
        // Somebody else's, or nothing.
        return Ok(());
    }
    if absolute.exists() { remove(&aside) } else { fs::rename(&aside, absolute) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MARKER: &str = "summary.json";

    fn result(path: &Path, what: &str) {
        fs::create_dir(path).expect("make");
        let text = r#"{"program": "freeplay", "files": ["summary.json", "a"]}"#;
        fs::write(path.join(MARKER), text).expect("write");
        fs::write(path.join("a"), what).expect("write");
    }

    #[test]
    fn both_ways_replace_a_result_and_leave_nothing_else() {
        for way in [name, in_two_steps] {
            let dir = tempfile::tempdir().expect("folder");
            let [made, target] = ["r.partial", "r"].map(|name| dir.path().join(name));
            result(&made, "new");
            result(&target, "old");
            way(&made, &target).expect("replaced");
            assert_eq!(fs::read_to_string(target.join("a")).expect("there"), "new");
            assert_eq!(fs::read_dir(dir.path()).expect("read").count(), 1);
        }
    }

    #[test]
    fn a_kill_between_two_steps_is_mended() {
        let dir = tempfile::tempdir().expect("folder");
        let target = dir.path().join("r");
        result(&aside(&target), "old");
        mend(&target, MARKER).expect("mended");
        assert_eq!(fs::read_to_string(target.join("a")).expect("back"), "old");
        result(&aside(&target), "older");
        mend(&target, MARKER).expect("mended");
        assert_eq!(fs::read_to_string(target.join("a")).expect("stands"), "old");
        assert_eq!(fs::read_dir(dir.path()).expect("read").count(), 1);
        fs::create_dir(aside(&target)).expect("make");
        mend(&target, MARKER).expect("not ours");
        assert!(aside(&target).exists());
    }
}
