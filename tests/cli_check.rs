//! `freeplay check`, help and completions, the real binary.

mod cli_common;

use cli_common::{Place, WRONG, write_wrong_files};
use serde_json::Value;

#[test]
fn the_default_machine_is_described() {
    let place = Place::new();
    let text = place.good("check");
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for fragment in [
        "platform 0.2 kg 1.67e-4 kg m²",
        "0.2823 to 0.3823 m stroke 0.2 to 0.4 m",
        "from singularity 32.2 mm",
        "K = 3.73e9 N/m^n",
        "longest fixed step 2.06e-5 s",
        "prescribed",
        "-0.492 to 0.426 N",
    ] {
        assert!(words.contains(fragment), "{text}\nlacks: {fragment}");
    }
    assert!(place.entries().is_empty());
    assert_eq!(place.good("check --quiet"), "");
}

#[test]
fn json_says_the_same() {
    let place = Place::new();
    let json: Value =
        serde_json::from_str(&place.good("check --json --set drive.mode=servo")).unwrap();
    assert_eq!(json["ok"], true);
    assert_eq!(json["findings"], Value::Array(Vec::new()));
    assert_eq!(json["legs"].as_array().unwrap().len(), 3);
    assert_eq!(json["servo_stiffness_N_m"], 5e5);
    let stiffness = json["joints"][0]["stiffness_N_m_n"].as_f64().unwrap();
    assert!((stiffness / 3.7327999e9 - 1.0).abs() < 1e-7);
    assert!((json["ideal"]["actuator_forces_N"][0][0].as_f64().unwrap() + 0.4922).abs() < 1e-4);
}

#[test]
fn what_a_run_would_refuse_is_refused() {
    let place = Place::new();
    write_wrong_files(&place);
    for (arguments, fragments) in WRONG {
        place.refused(&format!("check {arguments}"), fragments);
        let done = place.freeplay(&format!("check --json {arguments}"));
        let json: Value = serde_json::from_str(&done.out).unwrap();
        assert_eq!((done.code, &json["ok"]), (2, &Value::Bool(false)), "{arguments}");
        assert_eq!(json["findings"][0]["severity"], "error");
    }
}

/// What is hardly meant, and what is said of it.
const DOUBTFUL: &[(&str, &str)] = &[
    ("--set motion.phi=0.15", "warning: --set motion.phi: the platform comes within 9.9 mm"),
    (
        "--set contact.stiffness_form=conformal --set joints.clearance=1e-8 \
         --set simulation.tolerance=1e-5",
        "grows without bound",
    ),
    ("--set environment.gravity=[0,-9810]", "environment.gravity: is 9810 m/s²"),
    ("--set contact.youngs_modulus=206", "contact.youngs_modulus: is 2.06e2 Pa"),
    ("--set joints.friction=10", "joints.friction: is 10, more than rubber has"),
    ("--set joints.bearing_radius=10", "is 10 m, in a machine of 0.660 m"),
    ("--set legs.density=7.8", "7.8 g/cm³ are 7800"),
    ("--set mechanism.platform_mass=200", "mechanism.platform_mass: makes \"platform\""),
    ("--set motion.phi=44.9", "44.9 degrees are 0.7837"),
    (
        "--set drive.stiffness=1e5",
        "--set drive.stiffness: changes nothing: no drive is a servo; set drive.mode=servo, or leave it out",
    ),
    ("--set native.frequency=30", "--set native.frequency: changes nothing: no contact is the"),
    ("--set contact.friction_velocity=1e-2", "no joint with a contact law has friction"),
    ("--set contact.law=ideal --set joints.clearance=1e-4", "all joints are ideal"),
    (
        "--set contact.stiffness=1e9 --set contact.youngs_modulus=1e11",
        "contact.youngs_modulus: changes nothing: contact.stiffness is given",
    ),
    ("--set effect.0.kind=payload", "effect.0: payload has no values, and does nothing without"),
    ("--set effect.0.kind=gravity", "effect.0: gravity has no values, and does nothing"),
    (
        "--set effect.0.kind=base-vibration --set effect.0.frequency_Hz=12",
        "base-vibration has no ax_m_s2 and no ay_m_s2, and does nothing without",
    ),
    (
        "--set effect.0.kind=payload --set effect.0.mass_kg=0",
        "effect.0: payload does nothing: with mass_kg = 0 all is as declared",
    ),
    (
        "--set effect.0.kind=joint-wear --set effect.0.joint=A1 --set effect.0.clearance_m=5e-4",
        "joint-wear at A1 does nothing: with clearance_m = 0.0005 all is as declared",
    ),
    ("--set mechanism.platform_inertia=1", "platform_inertia: of 1 kg m² makes the radius"),
    ("--set motion.phase=90", "--set motion.phase: has an angle of 90 rad"),
    ("--set contact.stiffness=1", "contact.stiffness: is 1 N/m^n, softer than any rubber"),
    ("--set sensors.pose_std=4", "sensors.pose_std: is 4 m, and more than 0.066 m tells"),
    ("--set sensors.angle_std=0.03", "sensors.angle_std: is 0.03 rad, and more than 0.020 rad"),
    ("--set sensors.force_std=150", "sensors.force_std: is 150 N, and more than 76.707 N tells"),
    (
        "--set mechanism.kind=pendulum --set mechanism.inertia=109",
        "mechanism.inertia: of 109 kg m² makes the radius of gyration of \"arm\"",
    ),
    ("--set mechanism.kind=pendulum --set mechanism.length=147", "147 mm are 0.147"),
    (
        "--set mechanism.kind=pendulum --set mechanism.angle=30",
        "--set mechanism.angle: has an angle of 30 rad, more than a whole turn; angles are in rad: 30 \
         degrees are 0.5236",
    ),
    (
        "--set mechanism.kind=pendulum --set motion.radius=0.1",
        "--set motion.radius: is not used: it means nothing to this machine",
    ),
];

#[test]
fn doubtful_scenarios_are_warned_about() {
    let place = Place::new();
    for (arguments, fragment) in DOUBTFUL {
        let done = place.freeplay(&format!("check {arguments}"));
        assert_eq!(done.code, 0, "{}", done.err);
        assert!(done.err.starts_with("warning: ") && done.err.contains(fragment), "{}", done.err);
        assert_eq!(done.err.lines().count(), 1, "told once: {}", done.err);
    }
}

/// Commands that do not run the motion tell of keys that cannot act, too, but for the speed at which a friction sets in
/// that they may look for.
#[test]
fn keys_that_cannot_act_are_told_where_no_motion_is_run() {
    let place = Place::new();
    let told = |set: &str| place.freeplay(&format!("expand --set {set}")).err;
    let idle = told("drive.stiffness=1e5");
    assert!(idle.starts_with("warning: --set drive.stiffness: changes nothing"), "{idle}");
    assert_eq!(told("contact.friction_velocity=1e-2"), "");
}

#[test]
fn what_is_told_of_zeros_and_first() {
    let place = Place::new();
    // Runs are not told of a zero that is written: who sweeps over it means it.
    let run =
        "run --duration 0.01 --quiet --out r --set effect.0.kind=payload --set effect.0.mass_kg=0";
    assert_eq!(place.freeplay(run).err, "");
    let plain = place.freeplay("check");
    assert_eq!((plain.code, plain.err.as_str()), (0, ""));

    // The likely cause before what follows from it; the same of commands that take their motion from a log.
    let done = place.freeplay("check --set mechanism.base_side=350");
    let told = "warning: --set mechanism.base_side: makes a machine of 350 m; expected m: 350 mm are 0.35\nerror: ";
    assert!(done.code == 2 && done.err.starts_with(told), "{}", done.err);
    let rig = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs/rig-1");
    let done = place.freeplay(&format!(
        "predict {rig}/rig.toml --data {rig}/run-a.csv --set contact.youngs_modulus=206 --quiet"
    ));
    assert!(done.err.contains("contact.youngs_modulus: is 2.06e2 Pa"), "{}", done.err);
}

/// A motion is looked at as finely as it turns, however long it lasts: a circle of 20 ms was seen at one point
/// of itself in 40 s.
#[test]
fn a_fast_motion_is_seen_however_long_it_lasts() {
    let place = Place::new();
    let fast = "check --set motion.radius=0.07 --set motion.period=0.02 --duration";
    for duration in ["1", "40", "1000"] {
        place.refused(&format!("{fast} {duration}"), &["legs.stroke", "leg 1"]);
    }
    let forces = |duration: &str| {
        let text = place.good(&format!("check --duration {duration}"));
        text.lines().filter(|line| line.contains("drive P")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(forces("1"), forces("1000"));
}

#[test]
fn help_and_completions_are_there() {
    let place = Place::new();
    for line in ["--help", "run --help", "check --help"] {
        let text = place.good(line);
        assert!(text.contains("Examples:") && text.contains("freeplay "), "{text}");
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = place.good(&format!("completions {shell}"));
        assert!(script.contains("duration") && script.contains("check"), "{shell}");
    }
    assert_eq!(place.freeplay("").code, 2);
}

/// `freeplay check | head -1`: nobody reads on.
#[test]
fn a_closed_pipe_is_no_error() {
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_freeplay"))
        .args(["check"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), err.as_str()), (Some(0), ""));
}

/// The engines by name: what only one of them has is not done by the other without a word.
#[test]
fn engines_are_held_against_each_other_and_do_what_they_can() {
    let place = Place::new();
    let said = place.good("check --engines --set simulation.tolerance=1e-8 --duration 0.05");
    assert!(said.contains("Physics engine against direct integration"), "{said}");
    assert!(said.contains("all of the 0.05 s looked at"), "{said}");
    let json = place.good("check --engines --duration 0.05 --json");
    let json: Value = serde_json::from_str(&json).unwrap();
    let apart = json["engines"]["apart"]["position_m"].as_f64().unwrap();
    assert!(apart > 0.0 && apart < 1e-6, "{apart}");

    place.good("run --engine direct --duration 0.05 --quiet --out d");
    let summary: Value = serde_json::from_str(&place.read("d/summary.json")).unwrap();
    assert_eq!(summary["engine"], "direct");
    assert!(place.read("d/index.html").contains("without the physics engine"));
    for (line, fragment) in [
        ("run --engine direct --set contact.law=native", "does not go with contact.law"),
        ("run --engine direct --set simulation.step=1e-5", "which controls its error"),
        ("compare --engine direct", "has no contacts of the physics engine's own"),
        ("check --engines --set simulation.step=1e-5", "compares steps under error control"),
        ("run --engine bullet", "possible values: rapier, direct"),
    ] {
        place.refused(line, &[fragment]);
    }
}
