//! A fault at every call of the file system: an error, a full disk, or the end of the process, by `strace`'s
//! injection. What has a result's name is whole, finished work is kept, nothing foreign is touched, and the next start
//! tidies up.
#![cfg(target_os = "linux")]

mod cli_common;

use cli_common::{Place, names};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, ExitStatus, Output};

/// Calls that change files, and the error that each can end with.
const CALLS: [(&str, &str); 9] = [
    ("openat", "ENOSPC"),
    ("write", "ENOSPC"),
    ("rename", "EIO"),
    ("renameat2", "EIO"),
    ("mkdir", "ENOSPC"),
    ("fsync", "EIO"),
    ("unlink", "EIO"),
    ("unlinkat", "EIO"),
    ("rmdir", "EIO"),
];

/// A command that is disturbed.
struct Case {
    /// What has to be there before.
    before: &'static [&'static str],
    /// It has to succeed afterwards.
    line: &'static str,
    /// The file that says what belongs to the result; none where an unfinished one has its name, too.
    marker: Option<&'static str>,
}

const RUN: Case = Case {
    before: &["run --duration 0.01 --out r --quiet"],
    line: "run --duration 0.02 --out r --force --quiet",
    marker: Some("summary.json"),
};

const COMPARE: Case = Case {
    before: &["compare --duration 0.01 --steps 2e-5 --starts 2 --out r --quiet"],
    line: "compare --duration 0.02 --steps 2e-5 --starts 2 --out r --force --quiet",
    marker: Some("compare.json"),
};

const SWEEP: Case = Case {
    before: &[],
    line: "sweep --vary motion.phase=0..1:4 --duration 0.01 --threads 1 --out r --quiet",
    marker: None,
};

const MERGE: Case = Case {
    before: &[
        "sweep --vary motion.phase=0..1:4 --duration 0.01 --shard 1/2 --out a --quiet",
        "sweep --vary motion.phase=0..1:4 --duration 0.01 --shard 2/2 --out b --quiet",
    ],
    line: "merge a b --out r --force --quiet",
    marker: Some("sweep.json"),
};

/// A command under `strace` with these options; none where there is no such tool, or it may not trace.
fn traced(place: &Place, trace: &Path, options: &[String], line: &str) -> Option<Output> {
    let mut strace = Command::new("strace");
    strace.current_dir(place.path("")).args(["-f", "-y", "-qq", "-o"]).arg(trace);
    let run = strace.args(options).arg(env!("CARGO_BIN_EXE_freeplay"));
    run.args(line.split_whitespace()).output().ok()
}

/// A call on a file.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Call {
    name: &'static str,
    error: &'static str,
    /// Its place among its thread's calls of that name: strace counts each thread's.
    when: usize,
    /// Whether a folder is removed by it, or looked into for that.
    removes: bool,
}

/// Calls on files of `folder`.
fn calls(trace: &str, folder: &Path) -> Vec<Call> {
    let mut counts: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    let mut found = Vec::new();
    for line in trace.lines() {
        let Some((thread, call)) = line.split_once(char::is_whitespace) else { continue };
        let called = |(name, _): &&(&str, &str)| call.trim_start().starts_with(&format!("{name}("));
        let Some((name, error)) = CALLS.iter().find(called) else { continue };
        let count = counts.entry((thread, name)).or_default();
        *count += 1;
        if call.contains(folder.to_str().unwrap()) {
            let removes = ["unlink", "rmdir", "O_DIRECTORY"].iter().any(|word| call.contains(word));
            found.push(Call { name, error, when: *count, removes });
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// That a result is whole: every file that it names is there, and nothing else.
fn is_whole(folder: &Path, marker: &str, fault: &str) {
    let text = std::fs::read_to_string(folder.join(marker)).expect("half a result");
    let json: Value = serde_json::from_str(&text).expect("half a file");
    let files = json["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap());
    // Of a sweep's these are not always there.
    let always = |file: &&str| !["sweep.parquet", "unfinished.tmp"].contains(file);
    let mut files: Vec<&str> = files.filter(always).collect();
    files.sort_unstable();
    assert_eq!(names(folder), files, "{fault}");
}

/// What has to hold after a fault, whatever it was.
fn check(place: &Place, case: &Case, status: ExitStatus, fault: &str, removes: bool) {
    let kill = fault.contains("KILL");
    let code = status.code();
    assert!(kill || matches!(code, Some(0..=2 | 75)), "{}: {fault}: {status}", case.line);
    let result = place.path("r");
    if result.exists()
        && let Some(marker) = case.marker
    {
        is_whole(&result, marker, fault);
    }
    assert!(code != Some(0) || result.exists(), "{}: {fault}: no result", case.line);
    assert_eq!(place.read("mine.txt"), "years of work");
    let foreign = |entry: &&String| !["mine.txt", "r", "a", "b"].contains(&entry.as_str());
    let left: Vec<String> = place.entries().iter().filter(foreign).cloned().collect();
    // What a killed process has in the making the next start removes, and what could not be removed.
    let excused = kill || removes;
    assert!(
        left.is_empty() || excused && left == ["r.partial"],
        "{}: {fault}: {left:?}",
        case.line
    );
    place.good(case.line);
    let left: Vec<String> = place.entries().iter().filter(foreign).cloned().collect();
    assert!(left.is_empty(), "{}: {fault}: {left:?}", case.line);
}

/// Disturbs a command at one in `every` of its calls, by the call's error and by the end of the process.
fn survives(case: &Case, every: usize) {
    let (place, traces) = (Place::new(), Place::new());
    let trace = traces.path("trace.txt");
    let traced = |options: &[String]| traced(&place, &trace, options, case.line);
    let told = || std::fs::read_to_string(&trace).unwrap();
    let prepare = || {
        for name in place.entries() {
            let path = place.path(&name);
            let _ = std::fs::remove_dir_all(&path).or_else(|_| std::fs::remove_file(&path));
        }
        place.write("mine.txt", "years of work");
        case.before.iter().for_each(|line| drop(place.good(line)));
    };
    prepare();
    let names: Vec<&str> = CALLS.iter().map(|(name, _)| *name).collect();
    let done = traced(&[format!("-etrace={}", names.join(","))]);
    let said = done.as_ref().map(|done| String::from_utf8_lossy(&done.stderr).into_owned());
    let Some(said) = said.filter(|said| !said.contains("ptrace")) else {
        println!("strace is not installed, or may not trace: nothing was disturbed");
        return;
    };
    assert!(done.is_some_and(|done| done.status.success()), "{said}");
    let (mut tried, mut met) = (0, 0);
    for Call { name, error, when, removes } in
        calls(&told(), &place.path("")).into_iter().step_by(every)
    {
        for fault in [format!("error={error}"), "signal=KILL".to_owned()] {
            prepare();
            let inject = format!("-einject={name}:{fault}:when={when}");
            let done = traced(&[format!("-etrace={name}"), inject.clone()]);
            check(&place, case, done.unwrap().status, &inject, removes);
            tried += 1;
            let told = told();
            met += usize::from(told.contains("(INJECTED)") || told.contains("killed by SIGKILL"));
        }
    }
    println!("{}: {tried} faults, {met} of them met", case.line);
    assert!(2 * met > tried);
}

#[test]
fn a_run_survives_some_faults() {
    survives(&RUN, 12);
}

#[test]
#[ignore = "minutes: every call"]
fn every_command_survives_every_fault() {
    for case in [RUN, COMPARE, SWEEP, MERGE] {
        survives(&case, 1);
    }
}
