//! The real binary in a temporary folder.

// Every test file compiles this by itself and uses its own part of it.
#![allow(dead_code)]

use assert_cmd::Command;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder of its own, with the command started in it.
pub struct Place {
    folder: TempDir,
}

/// What a command did.
#[derive(Debug)]
pub struct Done {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Place {
    pub fn new() -> Self {
        Self { folder: TempDir::new().unwrap() }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// Names of everything in the folder, sorted.
    pub fn entries(&self) -> Vec<String> {
        names(self.folder.path())
    }

    /// Runs `freeplay` with arguments given as one line, split at blanks.
    pub fn freeplay(&self, line: &str) -> Done {
        let mut command = Command::new(env!("CARGO_BIN_EXE_freeplay"));
        // Recordings of hardware are found where a test says.
        command.env_remove("FREEPLAY_MEASURED");
        let output =
            command.current_dir(self.folder.path()).args(line.split_whitespace()).output().unwrap();
        Done {
            code: output.status.code().unwrap(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// The same, which must succeed without a word on standard error.
    pub fn good(&self, line: &str) -> String {
        let done = self.freeplay(line);
        assert_eq!((done.code, done.err.as_str()), (0, ""), "{line}\n{}", done.out);
        done.out
    }

    /// The same with notes on standard error, of what is to be known of recordings, and no other word.
    pub fn noted(&self, line: &str) -> Done {
        let done = self.freeplay(line);
        let notes = done.err.lines().all(|line| line.starts_with("note: "));
        assert!(
            done.code == 0 && notes && !done.err.is_empty(),
            "{line}\n{}\n{}",
            done.err,
            done.out
        );
        done
    }

    /// The same, which must fail with exit code 2, say all `fragments` and write nothing.
    pub fn refused(&self, line: &str, fragments: &[&str]) {
        let before = self.entries();
        let done = self.freeplay(line);
        assert_eq!(done.code, 2, "{line}\n{}\n{}", done.out, done.err);
        assert!(done.err.starts_with("error: "), "{line}\n{}", done.err);
        for fragment in fragments {
            assert!(
                done.err.contains(fragment),
                "{line}\n  says: {}\n  lacks: {fragment}",
                done.err
            );
        }
        assert_eq!(self.entries(), before, "{line} left something behind");
    }
}

/// Names of everything in a folder, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Arguments that are wrong, and what the message must contain.
pub const WRONG: &[(&str, &[&str])] = &[
    ("--set mechanism.platform_mass=-1", &["--set mechanism.platform_mass: is -1", "above 0 kg"]),
    ("--set joints.clearance=0.02", &["0.02 at A1", "below the bearing radius"]),
    ("--set joints.clearence=1e-4", &["unknown key", "did you mean `clearance`?"]),
    ("--set motion.radius=0.09", &["motion.radius: leg 1", "0.4223 m", "t = ", "0.2 to 0.4 m"]),
    ("--set motion.phi=0", &["motion.phi: ", "similar triangles", "phi = 0 and phi = pi"]),
    ("--set motion.phi=3.141592653589793", &["singularity", "phi = 0 and phi = pi"]),
    (
        "--set motion.kind=quintic --set motion.from=[0,0,0.4] --set motion.to=[0,0,-0.4]",
        &["--set motion.to: the platform reaches a singularity at t = 0.5", "phi"],
    ),
    ("--set simulation.step=1e-4", &["simulation.step: is 1e-4 s, too long", "at most 2.0e-5 s"]),
    (
        "--set contact.law=native --set simulation.tolerance=1e-5",
        &["simulation.tolerance: ", "native", "simulation.step"],
    ),
    ("--duration 1e-4", &["simulation.output_interval", "simulation.duration, 0.0001 s"]),
    ("--duration 5e-4", &["fewer than two rows", "simulate longer"]),
    ("--duration -1", &["--set simulation.duration: is -1"]),
    ("--set motion.kind=table --set motion.file=no.csv", &["motion.file: no.csv: No such file"]),
    ("missing.toml", &["missing.toml: cannot be read"]),
    ("syntax.toml", &["syntax.toml:2:8: ", "TOML"]),
    ("no-such-kind.toml", &["no-such-kind.toml:2: mechanism.kind", "did you mean `3rpr`?"]),
];

/// The files that [`WRONG`] names.
pub fn write_wrong_files(place: &Place) {
    place.write("syntax.toml", "[mechanism]\nkind = 3rpr\n");
    place.write("no-such-kind.toml", "[mechanism]\nkind = \"3rpp\"\n");
}
