//! `freeplay plan`: motions within limits that tell rivals apart or show an effect. The real binary.

mod cli_common;

use cli_common::Place;
use serde_json::Value;

const RIGS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs-planar");
const PLATFORM: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs/rig-1");

fn json(place: &Place, name: &str) -> Value {
    serde_json::from_str(&place.read(name)).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// A column of a table.
fn column(text: &str, name: &str) -> Vec<f64> {
    let place = text.lines().next().unwrap().split(',').position(|head| head == name).unwrap();
    let cell = |line: &str| line.split(',').nth(place).unwrap().parse().unwrap();
    text.lines().skip(1).map(cell).collect()
}

/// Largest absolute first and second difference quotient of a column of rows `h` s apart.
fn rates(values: &[f64], h: f64) -> [f64; 2] {
    let first: Vec<f64> = values.windows(2).map(|pair| (pair[1] - pair[0]) / h).collect();
    let second = first.windows(2).map(|pair| (pair[1] - pair[0]) / h);
    let largest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
    [largest(&mut first.iter().copied()), largest(&mut second.into_iter())]
}

#[test]
fn a_planned_motion_shows_more_within_its_limits_and_can_be_run() {
    let place = Place::new();
    let rig = format!("{RIGS}/planar-1");
    let limits = "--stroke O=-0.5..1.5 --speed 12 --acceleration 150 --drive-force 4";
    let line = format!(
        "plan --rig {rig}/rig.toml --data {rig}/run-a.csv --detect payload:piston --duration 1.5 --candidates 40 {limits}"
    );
    let text = place.good(&format!("{line} --out planned"));
    assert!(text.contains("payload at piston") && text.contains("one more sensor"), "{text}");
    let planned = json(&place, "planned/plan.json");
    let question = &planned["questions"][0];
    assert!(question["kind"] == "detect" && number(&question["wanted_sigma"]) > 5.0, "{question}");
    assert!(number(&question["after"]["sigma"]) > 0.0 && !question["before"].is_null());
    let shares = question["after"]["carried_by"].as_array().unwrap();
    let sum: f64 = shares.iter().map(|carried| number(&carried["share"])).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    assert!(planned["scenario_hash"].as_str().unwrap().len() == 64);
    assert!(planned["sensors"].as_array().unwrap().len() > 3, "{planned}");
    // What is written stays within what was given, by its rows alone.
    let motion = place.read("planned/motion.csv");
    let q = column(&motion, "q_O");
    assert_eq!(q.len(), 1501);
    assert!(q.iter().all(|q| (-0.5..=1.5).contains(q)));
    let [speed, acceleration] = rates(&q, 1e-3);
    // Rounding to nine decimals makes 2e-3 of second differences.
    assert!(speed <= 12.0 && acceleration <= 150.0 + 4e-3, "{speed} {acceleration}");
    let drive = &planned["drives"][0];
    assert!(number(&drive["used_force"]) <= 4.0 && number(&drive["force"]) == 4.0, "{drive}");
    // The rig with it runs and is recorded.
    place.good("run planned/planned.toml --out run --quiet");
    let run = place.read("run/timeseries.csv");
    let (told, at) = (column(&run, "q_O"), column(&run, "t"));
    for (t, q_run) in at.iter().zip(&told).step_by(97) {
        let row = ((t / 1e-3).round() as usize).min(q.len() - 1);
        // The servo yields under its load.
        assert!((q[row] - q_run).abs() < 0.02, "{t}: {} {q_run}", q[row]);
    }
    place.good("record planned/planned.toml --duration 1.2 --out recorded --quiet");
    // The same motion on one thread.
    let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_freeplay"));
    command.env("RAYON_NUM_THREADS", "1").current_dir(place.path(""));
    command.args(format!("{line} --out again --quiet").split_whitespace()).assert().success();
    assert_eq!(place.read("again/motion.csv"), motion);
    let sigma = |plan: &Value| plan["questions"].clone();
    assert_eq!(sigma(&json(&place, "again/plan.json")), sigma(&planned));
}

/// A platform with three drives, told to move by its pose, and rivals.
#[test]
fn rivals_on_a_platform_come_apart() {
    let place = Place::new();
    place.good(&format!(
        "plan --rig {PLATFORM}/rig.toml --between payload,actuator-friction:P1 --duration 1 --candidates 10 \
         --set contact.law=ideal --out planned --quiet"
    ));
    let planned = json(&place, "planned/plan.json");
    assert_eq!(planned["questions"][0]["effects"].as_array().unwrap().len(), 2);
    assert_eq!(planned["drives"].as_array().unwrap().len(), 3);
    let motion = place.read("planned/motion.csv");
    assert!(motion.starts_with("t,q_P1,q_P2,q_P3,x,y,phi\n0.000000,"), "{}", &motion[..60]);
    for drive in ["q_P1", "q_P2", "q_P3"] {
        assert!(column(&motion, drive).iter().all(|q| (0.2..=0.4).contains(q)));
    }
    // The template follows the pose, its legs the table.
    place.good("run planned/planned.toml --out run --quiet --duration 0.3");
    let run = place.read("run/timeseries.csv");
    let (planned, run) = (column(&motion, "q_P2"), column(&run, "q2"));
    let last = (planned[300] - run.last().unwrap()).abs();
    assert!(last < 1e-4, "{last}");
}

#[test]
fn what_a_report_left_open_is_planned_for() {
    let place = Place::new();
    let rig = format!("{RIGS}/planar-2");
    let plan = |report: &str| {
        format!(
            "plan --rig {rig}/rig.toml --data {rig}/run-a.csv --report {report} --duration 1 --candidates 8"
        )
    };
    let open = r#"{"verdict": "explained", "effects": [{"kind": "payload", "joint": null, "body": "rocker",
        "params": {"mass_kg": {"value": 0.05}}, "as_good": ["joint-friction at D"],
        "not_ruled_out": ["drag at rocker"]}]}"#;
    place.write("report.json", open);
    place.good(&format!("{} --out planned --quiet", plan("report.json")));
    let questions = &json(&place, "planned/plan.json")["questions"];
    // What residuals alone do not rule out is asked about, too.
    assert_eq!(questions.as_array().unwrap().len(), 2, "{questions}");
    let question = &questions[0];
    assert_eq!(question["kind"], "between");
    // The one that comes nearer to the other stands first.
    let effects = question["effects"].as_array().unwrap();
    for kind in ["payload", "joint-friction"] {
        assert!(effects.iter().any(|effect| effect["kind"] == kind), "{question}");
    }
    place.write("nothing.json", r#"{"verdict": "unexplained", "effects": [], "limits": []}"#);
    place.refused(&plan("nothing.json"), &["nothing.json", "leaves nothing open", "--between"]);
    place.write("other.json", "[]");
    place.refused(&plan("other.json"), &["other.json", "is no report of a calibration"]);
    place.write("strange.json", &open.replace("joint-friction at D", "joint-friction at P7"));
    place.refused(&plan("strange.json"), &["P7", "is it a report of this rig?"]);
    place.write("misspelt.json", &open.replace("\"payload\"", "\"paylod\""));
    place.refused(&plan("misspelt.json"), &["misspelt.json", "paylod", "freeplay effects"]);
    place.refused(&plan("missing.json"), &["missing.json", "No such file"]);
}

#[test]
fn what_cannot_be_planned_is_told() {
    let place = Place::new();
    let rig = format!("{RIGS}/planar-1");
    let plan = format!("plan --rig {rig}/rig.toml --data {rig}/run-a.csv");
    for (more, says) in [
        ("", &["nothing is asked", "--report", "--between", "--detect"][..]),
        ("--between payload", &["--between payload", "two effects or more"]),
        (
            "--between payload,joint-frction:slide",
            &["joint-frction", "did you mean joint-friction?"],
        ),
        ("--between payload,payload", &["are the same"]),
        (
            "--between payload,joint-friction:O=3",
            &["joint-friction:O=3", "belongs to the first effect"],
        ),
        ("--between payload,joint-wear", &["--between joint-wear", "can act on", "joint-wear:A"]),
        ("--between payload,screw-ripple:O", &["screw-ripple cannot act on this machine"]),
        (
            "--between payload,joint-wear:slide",
            &["cannot act on \"slide\"", "here it can act on A; B"],
        ),
        ("--detect joint-wear:Z", &["joint-wear cannot act on \"Z\"", "A", "B"]),
        ("--detect payload=much", &["--detect payload=much", "a number other than 0"]),
        ("--detect payload=-1", &["mass_kg would be -1 kg", "from 0 to 20 kg"]),
        ("--detect impulse", &["\"impulse\" is not an effect"]),
        (
            "--detect payload --stroke 2..1",
            &["--stroke", "leaves no motion of O", "LOW below HIGH"],
        ),
        ("--detect payload --speed 0", &["--speed", "leaves no motion of O"]),
        ("--detect payload --drive-force X=3", &["--drive-force X=3", "no such drive", "drives O"]),
        ("--detect payload --acceleration fast", &["--acceleration fast", "a number"]),
        ("--detect payload --stroke=-1e308..1e308", &["--stroke", "at most 1e6 rad either way"]),
        ("--detect payload --stroke=1e9..1e10", &["--stroke", "at most 1e6 rad either way"]),
        ("--report /dev/zero", &["/dev/zero", "at most 16 MB are read"]),
        ("--detect payload --gain 0.5", &["--gain", "from 1 up"]),
        ("--detect payload --duration 0.2", &["--duration: is 0.2 s", "from 1"]),
        (
            "--detect payload --duration 1 --drive-force 1e-6",
            &["the limits leave no motion", "O takes"],
        ),
    ] {
        place.refused(&format!("{plan} {more}"), says);
    }
    // Without recordings and without a motion of its own nothing says how far it may go.
    place.refused(
        &format!("plan --rig {rig}/rig.toml --detect payload"),
        &["--stroke", "nothing says how far the drive of O may go", "--data"],
    );
    place.refused(
        &format!("plan --rig {rig}/rig.toml --detect payload --stroke -1..1 --speed 3"),
        &["--acceleration", "how fast"],
    );
    place.write("fall.toml", "[mechanism]\nkind = \"pendulum\"\n[sensors]\n");
    let done = place.freeplay("plan --rig fall.toml --detect payload");
    assert_eq!(done.code, 2, "{}", done.err);
    place.write("stage.toml", "[mechanism]\nkind = \"drive-stage\"\n");
    place.refused(
        "plan --rig stage.toml --detect payload",
        &["q1, F1: has neither noise nor resolution", "freeplay expand"],
    );
}

/// An effect that leaves every residual as it is: what an encoder that nobody reads gets wrong.
#[test]
fn what_no_sensor_can_see_is_told() {
    let place = Place::new();
    let rig = std::fs::read_to_string(format!("{RIGS}/planar-1/rig.toml")).unwrap();
    // Commands and encoder alone, and the torque by the servo's law: nothing looks at the dynamics.
    place.write("rig.toml", &rig.replace("gravity = [0.0, -9.81]", "gravity = [0.0, 0.0]"));
    place.refused(
        "plan --rig rig.toml --detect contact-damping:A --duration 1 --stroke -1..1 --speed 5 --acceleration 50",
        &["contact-damping at A", "no sensor of this rig can see it", "T_O, a_slider"],
    );
}

/// Calibrates recordings of a motion in which `truth` is hidden, seed by seed; how often it alone is named, and nothing
/// as good.
fn named(place: &Place, rig: &str, truth: &[&str], seeds: std::ops::RangeInclusive<u32>) -> usize {
    let mut right = 0;
    for seed in seeds {
        let sets: String = truth.iter().map(|set| format!(" --set effect.0.{set}")).collect();
        place.good(&format!("record {rig} --set seed={seed}{sets} --out recorded --force --quiet"));
        place.good(
            "calibrate --rig recorded/rig.toml --data recorded/run-a.csv --validate recorded/run-b.csv --out found \
             --force --quiet",
        );
        let report = json(place, "found/report.json");
        let effects = report["effects"].as_array().unwrap();
        let own = |effect: &Value| {
            truth.iter().all(|set| {
                let (key, value) = set.split_once('=').unwrap();
                value.parse::<f64>().is_ok() || effect[key] == value
            })
        };
        let alone = |effect: &Value| {
            ["as_good", "not_ruled_out"]
                .iter()
                .all(|key| effect[*key].as_array().unwrap().is_empty())
        };
        let found = effects.len() == 1
            && own(&effects[0])
            && alone(&effects[0])
            && report["verdict"] == "explained";
        let names: Vec<String> = effects
            .iter()
            .map(|e| format!("{} {} {}", e["kind"], e["as_good"], e["not_ruled_out"]))
            .collect();
        println!("{rig} seed {seed}: {} {names:?}", report["verdict"]);
        right += usize::from(found);
    }
    right
}

/// The rig with the motion of one of its recordings.
fn with_present_motion(place: &Place, rig: &str) {
    let run = std::fs::read_to_string(format!("{RIGS}/{rig}/run-a.csv")).unwrap();
    let (t, q) = (column(&run, "t"), column(&run, "q_O_cmd"));
    let rows: String = t.iter().zip(q).map(|(t, q)| format!("{t:.6},{q:.9}\n")).collect();
    place.write("present.csv", &format!("t,q_O\n{rows}"));
    let text = std::fs::read_to_string(format!("{RIGS}/{rig}/rig.toml")).unwrap();
    place.write(
        "present.toml",
        &format!("{text}\n[motion]\nkind = \"table\"\nfile = \"present.csv\"\n"),
    );
}

/// A delay of the command and a lag of the servo: the present motion is too calm to part them, the planned one is not.
#[test]
#[ignore = "a plan and twenty calibrations: half an hour"]
fn rivals_that_the_present_motion_leaves_open_are_told_apart() {
    let place = Place::new();
    let rig = format!("{RIGS}/planar-1");
    with_present_motion(&place, "planar-1");
    place.good(&format!(
        "plan --rig {rig}/rig.toml --data {rig}/run-a.csv --between command-delay=1.2e-4,servo-lag --speed 40 \
         --acceleration 600 --drive-force 5 --out planned --quiet"
    ));
    let question = &json(&place, "planned/plan.json")["questions"][0];
    println!(
        "{} and {} standard deviations",
        question["before"]["sigma"], question["after"]["sigma"]
    );
    let mut right = [0; 2];
    for (scenario, right) in ["present.toml", "planned/planned.toml"].iter().zip(&mut right) {
        *right += named(&place, scenario, &["kind=command-delay", "delay_s=1.2e-4"], 1..=5);
        *right += named(&place, scenario, &["kind=servo-lag", "time_constant_s=1.2e-4"], 6..=10);
    }
    println!("right in {} of 10 and {} of 10", right[0], right[1]);
    assert!(right[1] >= 9 && right[0] <= 5, "{right:?}");
}

/// A payload of half the present detection limit is not named in recordings of the present motion, and is in those of
/// the planned one.
#[test]
#[ignore = "a plan and twenty calibrations: half an hour"]
fn half_of_what_could_be_seen_becomes_visible() {
    let place = Place::new();
    let rig = format!("{RIGS}/planar-1");
    with_present_motion(&place, "planar-1");
    place.good(&format!(
        "plan --rig {rig}/rig.toml --data {rig}/run-a.csv {rig}/run-b.csv --detect payload:piston --speed 40 \
         --acceleration 600 --drive-force 5 --out planned --quiet"
    ));
    let question = &json(&place, "planned/plan.json")["questions"][0];
    let [before, after] = ["before", "after"].map(|motion| number(&question[motion]["smallest"]));
    println!("smallest payload: {before} kg present, {after} kg planned");
    assert!(after <= 0.5 * before, "{before} {after}");
    let mass = format!("mass_kg={}", 0.5 * before);
    let truth = ["kind=payload", "body=piston", mass.as_str()];
    let old = named(&place, "present.toml", &truth, 1..=10);
    let new = named(&place, "planned/planned.toml", &truth, 1..=10);
    println!("named in {old} of 10 and {new} of 10");
    assert!(new >= 9 && old <= 5, "{old} {new}");
}
