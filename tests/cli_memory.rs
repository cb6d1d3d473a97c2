//! Memory is constant in the length of a run: what a run takes for 2 s it takes for 40 s, twenty
//! times the rows. A sweep holds its rows of the table, and nothing else of a run. (Linux: the kernel
//! keeps a process's highest memory in /proc.)
#![cfg(target_os = "linux")]

mod cli_common;

use cli_common::Place;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Highest resident memory of a command in kB; its arguments are one line, split at blanks.
fn peak_memory(place: &Place, line: &str) -> u64 {
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("freeplay"))
        .current_dir(place.path(""))
        .args(line.split_whitespace())
        .arg("--quiet")
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    while child.try_wait().unwrap().is_none() {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let value = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse().ok());
        peak = value.unwrap_or(0).max(peak);
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(child.wait().unwrap().success());
    peak
}

#[test]
fn a_long_run_takes_no_more_memory_than_a_short_one() {
    let place = Place::new();
    let [short, long] = ["2", "40"].map(|duration| {
        let line = format!("run --duration {duration} --out {duration}");
        peak_memory(&place, &(line + " --set simulation.tolerance=1e-3"))
    });
    println!("peak memory: {short} kB for 2 s, {long} kB for 40 s");
    assert!(short > 0 && long < short + 8192, "{short} kB for 2 s, {long} kB for 40 s");
}

/// The rows of the table are held until it is written, a kilobyte or two each; machines, or their rows over time, would show.
#[test]
fn ten_times_the_runs_of_a_sweep_take_little_more_memory() {
    let place = Place::new();
    let [few, many] = [100u64, 1000].map(|runs| {
        let vary = format!("--vary joints.clearance=1e-4..5e-4:{runs}");
        let line = format!("sweep --duration 2e-3 --set simulation.settle=0 {vary} --threads 1");
        peak_memory(&place, &format!("{line} --out {runs}"))
    });
    println!("peak memory: {few} kB for 100 runs, {many} kB for 1000");
    assert!(few > 0 && many < few + 8192, "{few} kB for 100 runs, {many} kB for 1000");
}
