//! Recorded runs as files, each with the name that users gave it.

use crate::measure::log::{Channel, Log, LogError};
use std::path::{Path, PathBuf};

/// A log and where it came from.
#[derive(Clone, Debug)]
pub struct LegsRecording {
    /// The file as the user called it.
    pub path: String,
    /// What it holds; its name is that of the file, or the whole path where names are not unique.
    pub log: Log,
}

/// Reads a log.
///
/// # Errors
/// What [`Log::read`] finds.
pub fn read_one(path: &Path) -> Result<LegsRecording, LogError> {
    let log = Log::read(path, &Channel::all(3))?;
    Ok(LegsRecording { path: path.display().to_string(), log })
}

/// Reads logs. Everything wrong with all of them is found before any is refused.
///
/// # Errors
/// What [`read_one`] finds, file by file.
pub fn read(paths: &[&Path]) -> Result<Vec<LegsRecording>, Vec<LogError>> {
    let (mut recordings, mut errors) = (Vec::new(), Vec::new());
    for path in paths {
        match read_one(path) {
            Ok(recording) => recordings.push(recording),
            Err(error) => errors.push(error),
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    tell_apart(recordings.iter_mut().map(|r| (&mut r.log, r.path.as_str())).collect());
    Ok(recordings)
}

/// Calls logs of one name by their paths.
pub fn tell_apart(logs: Vec<(&mut Log, &str)>) {
    let names: Vec<String> = logs.iter().map(|(log, _)| log.name.clone()).collect();
    for (log, path) in logs {
        if names.iter().filter(|name| **name == log.name).count() > 1 {
            path.clone_into(&mut log.name);
        }
    }
}

/// The name of a log without folders' separators and without `.csv`: what files about it are called
/// after.
pub fn stem(log: &Log) -> String {
    stem_of(&log.name)
}

/// The same of the name of a log.
pub fn stem_of(name: &str) -> String {
    let path = PathBuf::from(name);
    let bare = match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("csv") => path.with_extension(""),
        _ => path,
    };
    let plain = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    bare.to_string_lossy().chars().map(plain).collect()
}

/// Joins three columns of a kind, if a log has all of them.
pub fn triple(log: &Log, channel: fn(usize) -> Channel) -> Option<[&[f64]; 3]> {
    Some([log.get(channel(0))?, log.get(channel(1))?, log.get(channel(2))?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logs_of_one_name_are_told_apart() {
        let dir = tempfile::tempdir().expect("folder");
        let text = "t,q1_cmd\n0,0.3\n0.001,0.3\n0.002,0.3\n";
        let paths = ["a/run.csv", "b/run.csv", "b/other.csv"].map(|name| dir.path().join(name));
        for path in &paths {
            std::fs::create_dir_all(path.parent().expect("folder")).expect("made");
            std::fs::write(path, text).expect("written");
        }
        let paths: Vec<&Path> = paths.iter().map(PathBuf::as_path).collect();
        let read = read(&paths).expect("good logs");
        assert_eq!(read[2].log.name, "other.csv");
        assert_eq!(stem(&read[2].log), "other");
        assert_ne!(stem(&read[0].log), stem(&read[1].log));
        assert!(stem(&read[0].log).ends_with("-a-run"), "{}", stem(&read[0].log));
    }

    #[test]
    fn what_is_written_reads_back() {
        let ramp = |scale: f64| (0..50).map(|i| scale * (0.1 + f64::from(i))).collect();
        let channels = Channel::all(3).into_iter().zip(1..);
        let channels = channels.map(|(c, k)| (c, ramp(1e-3 * f64::from(k)))).collect();
        let log = Log::new("run.csv", 0.25, 1e-3, channels);
        let dir = tempfile::tempdir().expect("folder");
        let path = dir.path().join("run.csv");
        std::fs::write(&path, log.to_csv()).expect("written");
        let again = read_one(&path).expect("a good log").log;
        assert_eq!((again.start, again.samples, &again.name), (0.25, 50, &log.name));
        assert!((again.interval - 1e-3).abs() < 1e-12);
        for channel in log.channels() {
            let [a, b] = [&log, &again].map(|log| log.get(channel).expect("column"));
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6), "{channel}");
        }
    }
}
