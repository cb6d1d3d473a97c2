//! Commands that are ended at any moment, by the real binary and real signals: no half result has a
//! result's name, nothing foreign is touched, and the next start tidies up and goes on.
#![cfg(unix)]

mod cli_common;

use cli_common::{Place, names};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde_json::Value;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Signals by name, and the exit code that follows, where there is one. Where these tests run under `nohup` the end of a
/// terminal ends nothing.
fn signals() -> Vec<(&'static str, Option<i32>)> {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    let hangup = ignored.is_some_and(|mask| mask & 1 == 0).then_some(("HUP", Some(129)));
    [("KILL", None), ("TERM", Some(143)), ("INT", Some(130))].into_iter().chain(hangup).collect()
}

/// Moments at which each command is ended.
const MOMENTS: usize = 18;

fn start(place: &Place, line: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_freeplay"))
        .current_dir(place.path(""))
        .args(line.split_whitespace())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn signal(child: &Child, name: &str) {
    // It fails where the process has ended before.
    let _ = Command::new("kill")
        .args([format!("-{name}"), child.id().to_string()])
        .stderr(Stdio::null())
        .status();
}

/// Starts a command and ends it after a share of the time that it takes, which is brought up to date where
/// it has ended by itself.
fn end_after(
    place: &Place,
    line: &str,
    name: &str,
    share: f64,
    takes: &mut Duration,
) -> ExitStatus {
    let started = Instant::now();
    let mut child = start(place, line);
    while started.elapsed() < takes.mul_f64(share) {
        if let Some(status) = child.try_wait().unwrap() {
            *takes = (*takes).min(started.elapsed());
            return status;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    signal(&child, name);
    child.wait().unwrap()
}

/// How long a command takes.
fn time(place: &Place, line: &str) -> Duration {
    let started = Instant::now();
    assert!(start(place, line).wait().unwrap().success());
    started.elapsed()
}

/// Signals in turn, at shares of a command's time that follow from a seed.
fn moments() -> impl Iterator<Item = (&'static str, Option<i32>, f64)> {
    let mut random = ChaCha8Rng::seed_from_u64(20);
    let signals = signals();
    (0..MOMENTS).map(move |i| {
        let share = f64::from(random.next_u32()) / f64::from(u32::MAX);
        let (name, code) = signals[i % signals.len()];
        (name, code, share)
    })
}

/// The JSON of a result of which every file is there and nothing else; none without the folder.
fn whole(folder: &Path, marker: &str) -> Option<Value> {
    if !folder.exists() {
        return None;
    }
    let text = std::fs::read_to_string(folder.join(marker)).expect("half a result");
    let json: Value = serde_json::from_str(&text).expect("half a file");
    let mut files: Vec<&str> =
        json["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap()).collect();
    files.sort_unstable();
    assert_eq!(names(folder), files);
    Some(json)
}

/// Ends `line` (which writes into `r`) at many moments; `next` must then succeed and leave nothing else.
fn survives(place: &Place, line: &str, marker: &str, next: &str) {
    place.write("mine.txt", "years of work");
    let mut takes = time(place, line);
    let mut ended = 0;
    for (name, code, share) in moments() {
        let status = end_after(place, line, name, share, &mut takes);
        ended += usize::from(!status.success());
        if let (Some(code), false) = (code, status.success()) {
            // A process that had not yet come to listen ends as any does.
            assert!(status.code().is_none_or(|is| is == code), "{line}: {name} {status}");
        }
        whole(&place.path("r"), marker);
        let dead = name == "KILL" || status.code().is_none();
        let others = |entry: &&String| !["mine.txt", "r"].contains(&entry.as_str());
        let left: Vec<String> = place.entries().iter().filter(others).cloned().collect();
        assert!(left.is_empty() || (dead && left == ["r.partial"]), "{name}: {left:?}");
        place.good(next);
        assert_eq!(place.entries(), ["mine.txt", "r"], "{line}: {name} at {share}");
        assert_eq!(place.read("mine.txt"), "years of work");
        std::fs::remove_dir_all(place.path("r")).unwrap();
    }
    println!("{line}: {ended} of {MOMENTS} ended before their end");
}

#[test]
fn a_run_survives_any_end() {
    let place = Place::new();
    let next = "run --duration 0.02 --out r --force --quiet";
    survives(&place, "run --duration 0.3 --out r --force", "summary.json", next);
}

#[test]
fn a_comparison_survives_any_end() {
    let place = Place::new();
    let line = "compare --duration 0.03 --steps 2e-5 --starts 2 --out r --force";
    let next = "compare --duration 0.02 --steps 2e-5 --starts 2 --out r --force --quiet";
    survives(&place, line, "compare.json", next);
}

/// The result before is there until the new one is, and the other way round.
#[test]
fn a_replaced_result_is_always_one_or_the_other() {
    let place = Place::new();
    let [short, long] =
        ["0.02", "0.2"].map(|d| format!("run --duration {d} --out r --force --quiet"));
    let mut takes = time(&place, &long);
    for (name, _, share) in moments() {
        place.good(&short);
        end_after(&place, &long, name, share, &mut takes);
        let json = whole(&place.path("r"), "summary.json").expect("one of them");
        let duration = json["simulated_s"].as_f64().unwrap();
        assert!([0.02, 0.2].contains(&duration) && json["interrupted"] == false, "{json}");
    }
    place.good(&short);
    assert_eq!(place.entries(), ["r"]);
}

#[test]
fn a_sweep_goes_on_where_it_was_ended() {
    let place = Place::new();
    let line = "sweep --vary joints.clearance=1e-4..5e-4:12 --duration 0.05 --threads 2 --quiet";
    let mut takes = time(&place, &format!("{line} --out whole"));
    for (i, (name, code, share)) in moments().enumerate() {
        let ended = end_after(&place, &format!("{line} --out r"), name, 0.6 * share, &mut takes);
        // Told to end, it says that the same command goes on; before there is a row, the signal itself.
        assert!(code.is_none() || [Some(0), Some(75), code].contains(&ended.code()), "{ended}");
        if let Ok(text) = std::fs::read_to_string(place.path("r/sweep.json")) {
            let json: Value = serde_json::from_str(&text).expect("half a file");
            assert!(json["complete"] == false || place.path("r/sweep.csv").exists());
        }
        if i % 3 < 2 {
            // Ended again, where it had come to.
            continue;
        }
        place.good(&format!("{line} --out r"));
        assert_eq!(place.read("r/sweep.csv"), place.read("whole/sweep.csv"), "{name} {share}");
        assert_eq!(place.entries(), ["r", "whole"]);
        assert_eq!(names(&place.path("r")), names(&place.path("whole")));
        std::fs::remove_dir_all(place.path("r")).unwrap();
    }
}

/// Waits until `what` holds.
fn until(what: impl Fn() -> bool) {
    let started = Instant::now();
    while !what() {
        assert!(started.elapsed() < Duration::from_secs(20), "waited in vain");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn an_interrupted_run_keeps_what_it_has_and_says_so() {
    for (name, code) in &signals()[1..] {
        let place = Place::new();
        let mut child = start(&place, "run --duration 100 --out r --quiet");
        let rows = place.path("r.partial/timeseries.csv");
        until(|| std::fs::metadata(&rows).is_ok_and(|file| file.len() > 100_000));
        signal(&child, name);
        assert_eq!(child.wait().unwrap().code(), *code);
        assert_eq!(place.entries(), ["r"]);
        let json = whole(&place.path("r"), "summary.json").unwrap();
        assert_eq!(json["interrupted"], true);
        assert!(place.read("r/index.html").contains("The run was interrupted"));
        let last = place.read("r/timeseries.csv").lines().last().unwrap().to_owned();
        let t: f64 = last.split(',').next().unwrap().parse().unwrap();
        assert!((json["simulated_s"].as_f64().unwrap() - t).abs() < 1e-3, "{last}");
        place.refused("run --duration 0.02 --out r", &["already holds a result", "--force"]);
    }
}

#[test]
fn a_second_process_is_told_of_the_first() {
    let place = Place::new();
    let mut first = start(&place, "run --duration 100 --out r --quiet");
    until(|| place.path("r.partial/timeseries.csv").exists());
    place.refused("run --duration 0.02 --out r --force", &["another freeplay is at work on `r`"]);
    place.refused("compare --out r", &["another freeplay is at work on `r`"]);
    signal(&first, "KILL");
    first.wait().unwrap();
    place.good("run --duration 0.02 --out r --quiet");
    assert_eq!(place.entries(), ["r"]);
}

/// Commands that have nothing to keep.
#[test]
fn other_commands_leave_nothing() {
    let place = Place::new();
    let rig = |file: &str| format!("{}/assets/rigs/rig-1/{file}", env!("CARGO_MANIFEST_DIR"));
    let (rig_file, log) = (rig("rig.toml"), rig("run-a.csv"));
    place.write("two.toml", "[mechanism]\nkind = \"3rpr\"\n[simulation]\nduration = 2\n");
    for line in [
        "paper --out r".to_owned(),
        "compare --laws all --out r".to_owned(),
        "wear --cycles 1e6 --set contact.wear_coefficient=1e-14 --out r".to_owned(),
        "diff two.toml two.toml --out r".to_owned(),
        format!("record {rig_file} --duration 20 --out r"),
        format!("calibrate --rig {rig_file} --data {log} --out r"),
        format!("predict {rig_file} --data {log} --out r"),
    ] {
        for (name, code) in &signals()[1..] {
            let mut child = start(&place, &line);
            until(|| place.path("r.partial").exists() || place.path("r").exists());
            signal(&child, name);
            let status = child.wait().unwrap();
            assert!(status.code() == *code || place.path("r").exists(), "{line}: {status}");
            assert!(!place.path("r.partial").exists(), "{line}: {:?}", place.entries());
            let _ = std::fs::remove_dir_all(place.path("r"));
        }
    }
}

/// Nothing can be made under /proc, whoever asks.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_cannot_be_written_is_refused() {
    let place = Place::new();
    for command in ["run --duration 0.02", "compare", "sweep --vary motion.phase=1,2"] {
        place.refused(&format!("{command} --out /proc/r"), &["cannot write to", "--out"]);
    }
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let place = Place::new();
    for line in ["effects", "check", "--help", "run --duration 0.02 --json"] {
        let script = format!("{{ \"$0\" {line}; echo $? >code; }} | :");
        let status = Command::new("sh")
            .args(["-c", &script, env!("CARGO_BIN_EXE_freeplay")])
            .current_dir(place.path(""))
            .stderr(Stdio::null())
            .status()
            .unwrap();
        assert!(status.success());
        assert_eq!(place.read("code"), "0\n", "{line}");
    }
}

/// A file system of 1 MB at `disk` in a place, as long as this lives.
#[cfg(target_os = "linux")]
struct Disk(std::path::PathBuf);

#[cfg(target_os = "linux")]
impl Disk {
    fn new(place: &Place) -> Self {
        let path = place.path("disk");
        std::fs::create_dir(&path).unwrap();
        let mount = "-t tmpfs -o size=1m tmpfs".split(' ');
        let done = Command::new("mount").args(mount).arg(&path).status().unwrap();
        assert!(done.success(), "only root may mount");
        Self(path)
    }

    /// Fills it up to so many free bytes.
    fn leave(&self, free: usize) {
        let fill = self.0.join("fill");
        let _ = std::fs::write(&fill, vec![0; 1 << 20]);
        let file = std::fs::OpenOptions::new().write(true).open(&fill).unwrap();
        let taken = file.metadata().unwrap().len();
        file.set_len(taken.saturating_sub(free as u64)).unwrap();
    }
}

#[cfg(target_os = "linux")]
impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

/// Wherever the disk gets full: an earlier result stands, nothing else is left, and finished rows of a sweep are kept.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "mounts a file system of 1 MB, which takes root"]
fn a_full_disk_leaves_nothing_half_done() {
    let place = Place::new();
    let disk = Disk::new(&place);
    place.good("run --duration 0.03 --out disk/old --quiet");
    let sweep = "sweep --vary motion.phase=0..1:9 --duration 0.02 --quiet";
    for free in [0, 8, 20, 50, 100, 200] {
        disk.leave(1024 * free);
        for command in [
            "run --duration 0.02 --out disk/old --force",
            "run --duration 0.02 --out disk/new",
            "run --duration 5 --set simulation.tolerance=1e-3 --out disk/new",
            "compare --duration 0.06 --steps 1e-4 --starts 2 --out disk/new",
        ] {
            let old = place.read("disk/old/timeseries.csv");
            let done = place.freeplay(&format!("{command} --quiet"));
            if done.code == 0 {
                // It fitted after all.
                let _ = std::fs::remove_dir_all(place.path("disk/new"));
                continue;
            }
            assert!(matches!(done.code, 1 | 2), "{free} kB, {command}: {}", done.code);
            assert!(done.err.contains("No space left"), "{free} kB, {command}: {}", done.err);
            assert_eq!(names(&disk.0), ["fill", "old"], "{free} kB, {command}");
            assert_eq!(place.read("disk/old/timeseries.csv"), old, "{free} kB, {command}");
            assert!(whole(&place.path("disk/old"), "summary.json").is_some());
        }
        if free == 0 {
            let line = "evaluate --duration 0.02 --figures peak_contact_force_N --results disk/out";
            let done = place.freeplay(line);
            assert!(done.code != 0 && done.err.contains("No space left"), "{}", done.err);
            assert_eq!(names(&disk.0), ["fill", "old"]);
        }
        let done = place.freeplay(&format!("{sweep} --out disk/rows"));
        assert!(done.code == 0 || done.err.contains("No space left"), "{}", done.err);
        assert!(!place.path("disk/rows/unfinished.tmp").exists());
        disk.leave(1 << 20);
        place.good(&format!("{sweep} --out disk/rows"));
        std::fs::remove_dir_all(place.path("disk/rows")).unwrap();
    }
}
