//! Memory is constant in the length of a run: what a run takes for 2 s it takes for 40 s, twenty
//! times the rows. (Linux: the kernel keeps a process's highest memory in /proc.)
#![cfg(target_os = "linux")]

mod cli_common;

use cli_common::Place;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Highest resident memory of a run in kB.
fn peak_memory(place: &Place, duration: &str) -> u64 {
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("freeplay"))
        .args(["run", "--quiet", "--duration", duration, "--out"])
        .arg(place.path(duration))
        .args(["--set", "simulation.tolerance=1e-3"])
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
    let (short, long) = (peak_memory(&place, "2"), peak_memory(&place, "40"));
    println!("peak memory: {short} kB for 2 s, {long} kB for 40 s");
    assert!(short > 0 && long < short + 8192, "{short} kB for 2 s, {long} kB for 40 s");
}
