//! `freeplay run`: the series and the figures.

use crate::asset;
use crate::cli_common::Place;
use crate::series::Limits;
use crate::{figures, json, series};

/// Where journals have only begun to hit.
const USUAL: Limits = &[(0.02, 1e-9), (0.05, 1e-6)];
/// Where gravity or stiff contacts let them hit at once.
const LOADED: Limits = &[(0.01, 1e-9), (0.05, 1e-6)];
/// Where nothing rattles.
const SMOOTH: Limits = &[(1.0, 1e-9)];

/// Rows of slow machines.
const COARSE: &str = "--set simulation.output_interval=4e-3";

/// A run, its rows as they are written, against what is kept; figures may differ by a share `share`.
fn check(name: &str, line: &str, limits: Limits, share: f64) {
    let place = Place::new();
    let summary = json(&place, &format!("run {line} --out r"));
    series::compare(name, &place.read("r/timeseries.csv"), limits);
    figures::compare(name, summary, share);
}

#[test]
fn default() {
    check("default", "--duration 0.05", USUAL, 1e-6);
}

#[test]
fn servo_with_gravity() {
    let line = "--duration 0.05 --set drive.mode=servo --set environment.gravity=[0,-9.81]";
    check("servo", line, LOADED, 1e-5);
}

#[test]
fn ideal() {
    check("ideal", "--duration 0.03 --set contact.law=ideal", SMOOTH, 1e-9);
}

#[test]
fn native() {
    let line = "--duration 0.03 --set contact.law=native --set simulation.step=2e-5";
    check("native", line, &[(0.03, 1e-6)], 1e-6);
}

#[test]
fn fixed_step() {
    check("fixed-step", "--duration 0.05 --set simulation.step=1e-5", USUAL, 1e-6);
}

#[test]
fn friction() {
    check("friction", "--duration 0.05 --set joints.friction=0.1", USUAL, 1e-6);
}

#[test]
fn drive_stage() {
    let line = format!("{} --duration 0.3 {COARSE}", asset("drive-stage.toml"));
    check("drive-stage", &line, SMOOTH, 1e-9);
}

#[test]
fn pendulum() {
    let line = format!("{} --duration 0.3 {COARSE}", asset("pendulum.toml"));
    check("pendulum", &line, SMOOTH, 1e-9);
}

/// It falls on its bearing and rattles at once: after 0.2 s two runs a last bit apart are strangers.
#[test]
fn pendulum_with_clearance() {
    let line = format!("{} --set contact.law=hertz-step", asset("pendulum.toml"));
    let place = Place::new();
    place.good(&format!("run {line} --duration 0.15 --quiet --out r"));
    let limits = &[(0.03, 1e-9), (0.1, 1e-6), (0.15, 1e-4)];
    series::compare("pendulum-clearance", &place.read("r/timeseries.csv"), limits);
    let summary = json(&place, &format!("run {line} --duration 0.1 --out s"));
    figures::compare("pendulum-clearance", summary, 1e-5);
}

/// An effect, once where steps follow the tolerance and journals fly, once where a servo carries the
/// machine's weight in equal steps.
fn effect(settings: &str) {
    let kind = settings.split_once(' ').unwrap().0;
    let set: Vec<String> = format!("kind={settings}")
        .split_whitespace()
        .map(|setting| format!("--set effect.0.{setting}"))
        .collect();
    let line = format!("--duration 0.03 --set simulation.output_interval=1e-3 {}", set.join(" "));
    check(&format!("{kind}-flying"), &line, &[(0.02, 1e-9), (0.03, 1e-4)], 1e-4);
    let servo =
        "--set drive.mode=servo --set environment.gravity=[0,-9.81] --set simulation.step=1e-5";
    check(&format!("{kind}-carried"), &format!("{line} {servo}"), LOADED, 1e-6);
}

#[test]
fn payload() {
    effect("payload mass_kg=0.3 com_x_m=0.02 com_y_m=0.01");
}

#[test]
fn actuator_friction() {
    effect("actuator-friction joint=P2 coulomb_N=3 viscous_Ns_m=10");
}

#[test]
fn joint_wear() {
    effect("joint-wear joint=C2 clearance_m=8e-4");
}

#[test]
fn command_delay() {
    effect("command-delay delay_s=2e-3");
}

#[test]
fn drive_backlash() {
    effect("drive-backlash joint=P1 play_m=1e-4");
}

#[test]
fn screw_ripple() {
    effect("screw-ripple joint=P3 amplitude_m=2e-5 amplitude_N=1.5");
}
