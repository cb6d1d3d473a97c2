//! What a scenario file means.

mod mistakes;

use super::*;

fn sets(list: &[&str]) -> Vec<String> {
    list.iter().map(|set| (*set).to_owned()).collect()
}

fn load_text(text: &str, list: &[&str]) -> Result<Scenario, Problems> {
    Scenario::from_text(text, "my.toml", &sets(list))
}

fn good(text: &str, list: &[&str]) -> Scenario {
    load_text(text, list).unwrap_or_else(|problems| panic!("refused:\n{problems}"))
}

fn built_in(list: &[&str]) -> Scenario {
    Scenario::load(None, &sets(list)).unwrap_or_else(|problems| panic!("refused:\n{problems}"))
}

fn clearances(scenario: &Scenario) -> [f64; 6] {
    std::array::from_fn(|joint| scenario.clearance(joint))
}

const MINIMAL: &str = "[mechanism]\nkind = \"3rpr\"\n";

/// A rig as its maker declares it, in the form of the rigs in the project's test data.
const RIG: &str = r#"name = "rig-1"
[mechanism]
kind = "3rpr"
base_side = 0.66
platform_inertia = 1.6666666666666667e-4
[joints]
bearing_radius = 0.01
clearance = [0.0001, 0.0002, 0.0003, 0.0004, 0.0005, 0.0006]
[drive]
mode = "servo"
[sensors]
pose_std = 4e-6
force_lowpass = 400
"#;

#[test]
fn the_default_file_says_what_the_defaults_are() {
    let written = Scenario::load(None, &[]).expect("the built-in default is right");
    assert_eq!(written.to_toml(), good(MINIMAL, &[]).to_toml());
}

#[test]
fn every_key_turned_off_in_the_default_file_exists() {
    let text = DEFAULT_TOML
        .replace("# tolerance", "#tolerance")
        .lines()
        .map(|line| match line.strip_prefix("# ") {
            Some(key) if key.contains(" = ") && !key.starts_with('"') => key,
            Some(key) if key.starts_with("[sensors]") => key,
            _ => line,
        })
        .collect::<Vec<_>>()
        .join("\n");
    let scenario = good(&text, &[]);
    assert_eq!(scenario.sensors.map(|s| s.force_lowpass), Some(400.0));
    assert_eq!(scenario.contact.stiffness, Some(3.7e9));
    assert_eq!(scenario.simulation.step, Some(1e-5));
}

#[test]
fn a_rig_is_a_scenario() {
    let rig = good(RIG, &[]);
    assert_eq!(rig.name, "rig-1");
    assert_eq!(clearances(&rig), [1e-4, 2e-4, 3e-4, 4e-4, 5e-4, 6e-4]);
    assert_eq!(rig.drive.mode, DriveMode::Servo);
    let sensors = rig.sensors.expect("declared");
    assert_eq!((sensors.pose_std, sensors.force_lowpass), (4e-6, 400.0));
}

#[test]
fn the_effective_text_loads_back_to_the_same_scenario() {
    let cases: [&[&str]; 10] = [
        &[],
        &["joints.clearance=1e-8", "contact.stiffness=1e9", "seed=9223372036854775807"],
        &["joints.clearance=[1e-4,2e-4,3e-4,1e-4,1e-4,0.1e-3]", "contact.law=native"],
        &["motion.kind=line", "motion.velocity=[0.123456789012345678,-1e-300]"],
        &["motion.kind=quintic", "simulation.tolerance=1e-7"],
        &["motion.kind=multisine", "sensors.force_std=0.15", "drive.mode=servo"],
        &["motion.kind=table", "motion.file=path with \"quotes\".csv"],
        &["name=Größe \\ \"x\"", "contact.clip=false", "contact.stiffness_form=conformal"],
        &["contact.law=hunt-crossley", "contact.damping=0.3"],
        &["contact.law=johnson", "contact.length=0.03", "contact.restitution=0.9"],
    ];
    for list in cases {
        let first = built_in(list);
        let again = good(&first.to_toml(), &[]);
        assert_eq!(first.to_toml(), again.to_toml(), "{list:?}");
        assert_eq!(first.hash(), again.hash());
        let parts = |s: &Scenario| {
            (
                (s.name.clone(), s.seed, s.legs.clone(), s.joints.clone()),
                (s.contact.clone(), s.drive.clone(), s.environment.clone(), s.sensors.clone()),
                (s.simulation.settle(), s.step_control(), s.simulation.duration),
            )
        };
        assert_eq!(parts(&first), parts(&again), "{list:?}");
        if !matches!(first.motion, Motion::Table(_)) {
            assert_eq!(first.motion, again.motion);
        }
    }
}

#[test]
fn the_hash_follows_the_meaning_not_the_spelling() {
    let hash = good(MINIMAL, &[]).hash();
    assert_eq!(hash.len(), 64);
    let spelled = "mechanism.kind='3rpr'\njoints.clearance=[5e-4,0.0005,5e-4,5e-4,5e-4,5e-4] # c\n";
    assert_eq!(hash, good(spelled, &[]).hash());
    assert_ne!(hash, good(MINIMAL, &["joints.clearance=5.000001e-4"]).hash());
}

/// A file that `init` wrote, or a result's, says one of them: an override means the other instead.
#[test]
fn a_step_that_is_set_takes_the_place_of_a_files_tolerance() {
    let with = |line: &str, set: &[&str]| {
        let text = format!("[mechanism]\nkind = \"3rpr\"\n[simulation]\n{line}\n");
        Scenario::from_text(&text, "my.toml", &sets(set)).map(|scenario| scenario.simulation)
    };
    let fixed = with("tolerance = 1e-6", &["simulation.step=1e-5"]).unwrap();
    assert_eq!((fixed.step, fixed.tolerance), (Some(1e-5), None));
    let adaptive = with("step = 1e-5", &["simulation.tolerance=1e-6"]).unwrap();
    assert_eq!((adaptive.step, adaptive.tolerance), (None, Some(1e-6)));
    assert!(with("", &["simulation.tolerance=1e-6", "simulation.step=1e-5"]).is_err());
}

#[test]
fn overrides_take_toml_or_a_bare_word() {
    let scenario = built_in(&[
        "joints.clearance = 1e-4",
        "drive.mode=servo",
        "environment.gravity=[0,-9.81]",
        "sensors.pose_std=1e-6",
        "name=a run",
    ]);
    assert_eq!(clearances(&scenario), [1e-4; 6]);
    assert_eq!(scenario.drive.mode, DriveMode::Servo);
    assert_eq!(scenario.environment.gravity, [0.0, -9.81]);
    assert_eq!(scenario.sensors.map(|s| s.pose_std), Some(1e-6));
    assert_eq!(scenario.name, "a run");
    let one = good(RIG, &["joints.clearance.2=9e-4"]);
    assert_eq!(clearances(&one), [1e-4, 2e-4, 9e-4, 4e-4, 5e-4, 6e-4]);
}

/// `--set motion.kind=line` on a file with a circle's keys would otherwise be refused for them.
#[test]
fn another_kind_starts_its_section_afresh() {
    let scenario = built_in(&["motion.velocity=[0.2,0]", "motion.kind=line"]);
    let expected = Line { velocity: [0.2, 0.0], ..Line::default() };
    assert_eq!(scenario.motion, Motion::Line(expected));
    // The same kind keeps what the file says.
    let text = format!("{MINIMAL}[motion]\nkind = \"circle\"\nradius = 0.02\n");
    let Motion::Circle(circle) = good(&text, &["motion.kind=circle"]).motion else {
        panic!("not a circle");
    };
    assert_eq!(circle.radius, 0.02);
}

#[test]
fn derived_defaults_follow_what_they_derive_from() {
    let Mechanism::ThreeRpr(machine) = built_in(&["mechanism.platform_mass=0.4"]).mechanism else {
        panic!("the built-in machine is a 3-RPR");
    };
    assert!((machine.platform_inertia() - 0.4 * 0.01 / 12.0).abs() < 1e-18);
    assert_eq!(built_in(&[]).simulation.settle(), 0.2);
    assert_eq!(built_in(&["simulation.duration=0.1"]).simulation.settle(), 0.05);
    let control = |set: &str| built_in(&[set]).simulation.step_control();
    assert_eq!(control("simulation.step=1e-6"), StepControl::Fixed(1e-6));
    assert_eq!(control("simulation.tolerance=1e-6"), StepControl::Tolerance(1e-6));
}

#[test]
fn a_later_complaint_still_knows_file_and_line() {
    let scenario = good(RIG, &["motion.radius=0.3"]);
    let said = |path: &str| scenario.problem(path, "is bad", "make it good").to_string();
    assert_eq!(said("mechanism.base_side"), "my.toml:4: mechanism.base_side: is bad; make it good");
    assert_eq!(said("motion.radius"), "--set motion.radius: is bad; make it good");
    // A default is not in the file: its section is, or only the file.
    assert!(said("joints.friction").starts_with("my.toml:6: joints.friction: "));
    assert!(said("motion.period").starts_with("my.toml: motion.period: "));
    assert!(said("legs.stroke").starts_with("my.toml: legs.stroke: "));
    assert!(
        built_in(&[]).problem("seed", "is bad", "").to_string().starts_with("built-in default:")
    );
}

#[test]
fn files_are_read_from_where_they_are() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let path = folder.path().join("s.toml");
    std::fs::write(&path, format!("{MINIMAL}[motion]\nkind='table'\nfile='p.csv'\n"))
        .expect("write");
    let scenario = Scenario::load(Some(&path), &[]).expect("right");
    assert_eq!(scenario.resolve("p.csv"), folder.path().join("p.csv"));
    assert!(scenario.to_toml().contains(&folder.path().join("p.csv").display().to_string()));

    let missing = folder.path().join("no.toml");
    let problems = Scenario::load(Some(&missing), &[]).expect_err("missing").to_string();
    assert!(problems.contains("no.toml: cannot be read: "), "{problems}");
    std::fs::write(&path, [0xff, 0xfe]).expect("write");
    let problems = Scenario::load(Some(&path), &[]).expect_err("not text").to_string();
    assert!(problems.contains("UTF-8"), "{problems}");
    let problems = Scenario::load(Some(folder.path()), &[]).expect_err("a folder").to_string();
    assert!(problems.contains("cannot be read"), "{problems}");
}
