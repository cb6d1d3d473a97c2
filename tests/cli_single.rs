//! `freeplay predict` and `freeplay calibrate` on drive stages and pendulums, with recordings that the
//! program makes itself: what was hidden in them is found, and what cannot be right is refused.

mod cli_common;

use cli_common::Place;
use freeplay::calibrate::sensed::{recording::Recording, released::released, simulate::record};
use freeplay::engine::{Schedule, StepControl, run};
use freeplay::mechanism::Drive;
use freeplay::model::assemble;
use freeplay::scenario::Scenario;
use serde_json::Value;
use std::f64::consts::PI;
use std::fmt::Write as _;

const STAGE: &str = include_str!("../assets/drive-stage-declared.toml");
const ARM: &str = include_str!("../assets/pendulum-declared.toml");

/// Force for each volt of the stage, N/V.
const GAIN: f64 = 35.150_651_882_485_47;

fn scenario(text: &str, sets: &[&str]) -> Scenario {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    Scenario::from_text(text, "made.toml", &sets).expect("a scenario")
}

/// A pseudo-random number between -0.5 and 0.5 by its place: noise of 1 µm or µrad that repeats.
fn noise(i: usize) -> f64 {
    (((i * 2_654_435_761) % 1_000_003) as f64 / 1_000_003.0) - 0.5
}

/// Time, reference, length, volts, added volts of a stage with these effects; `shift` makes another run.
fn stage_rows(sets: &[&str], seconds: f64, shift: f64) -> Vec<[f64; 5]> {
    let model = scenario(STAGE, sets);
    let samples = (seconds * 1e3) as usize;
    let t = |i: usize| i as f64 * 1e-3;
    // Smooth strokes of several speeds, at rest at the start.
    let reference = |t: f64| {
        let grow = 1.0 - (-t * t).exp();
        grow * (0.08 * (1.7 * t + shift).sin() + 0.03 * (4.1 * t).sin() + 0.004 * (11.0 * t).cos())
    };
    let command: Vec<f64> = (0..samples).map(|i| reference(t(i))).collect();
    let pulse = |i: usize| if (i / 500) % 4 == 3 { 1.0 } else { 0.0 };
    let added: Vec<f64> = (0..samples).map(pulse).collect();
    // In the order of the template's sensors; it begins at its first command.
    let length = vec![command[0]; samples];
    let columns = vec![Some(command.clone()), Some(length), None, Some(added.clone())];
    let told = Recording::of("made", 1e-3, samples, columns);
    let control = StepControl::Fixed(2e-4);
    let mechanism = released(&model, &[], &told, control).expect("a stage").machine;
    let rows = record(&mechanism, control, &told, 0).expect("runs");
    let lengths = rows.get(1).expect("lengths").iter().enumerate();
    let seen: Vec<f64> = lengths.map(|(i, q)| q + 1e-8 * noise(i)).collect();
    let Drive::Sampled(cascade) = mechanism.actuators[0].drive else { panic!("sampled") };
    let force = cascade.outputs(&command, &seen, Some(&added));
    (0..samples).map(|i| [t(i), command[i], seen[i], force[i] / GAIN, added[i]]).collect()
}

/// In the columns of the rig.
fn stage_csv(rows: &[[f64; 5]]) -> String {
    let mut text = String::from("t_s,q_ref_m,q_m,u_V,pulse_V\n");
    for [t, reference, q, u, pulse] in rows {
        let _ = writeln!(text, "{t:.3},{reference:.9},{q:.10},{u:.8},{pulse}");
    }
    text
}

/// What the real pendulum has in place of viscous friction.
const FRICTION: &str = "effect=[{kind=\"bristle-friction\",joint=\"A1\",coulomb_Nm=5e-4},\
                        {kind=\"air-drag\",torque_Nms2=1.33e-5}]";

/// Angles of a pendulum with dry friction and drag of the air, 500 a second, with noise of 20 µrad.
fn arm_rows(start: [f64; 2], seconds: f64) -> Vec<[f64; 2]> {
    let [angle, rate] = start;
    let start = [format!("mechanism.angle={angle:?}"), format!("mechanism.rate={rate:?}")];
    let model = scenario(ARM, &[FRICTION, &start[0], &start[1]]);
    let mechanism = assemble(&model).expect("a pendulum").mechanism;
    let schedule = Schedule { duration: seconds, interval: 2e-3 };
    let mut rows: Vec<[f64; 2]> = Vec::new();
    run(&mechanism, StepControl::Fixed(1e-3), schedule, &mut |instant| {
        rows.push([instant.t, instant.angles[0] + 7e-5 * noise(rows.len())]);
    })
    .expect("swings");
    rows
}

fn arm_csv(rows: &[[f64; 2]]) -> String {
    let rows = rows.iter().map(|[t, angle]| format!("{t:.3},{angle:.6}\n"));
    format!("t_s,theta1_rad\n{}", rows.collect::<String>())
}

fn json(place: &Place, file: &str) -> Value {
    serde_json::from_str(&place.read(file)).expect("JSON")
}

fn error(result: &Value, run: &str, channel: &str) -> [f64; 3] {
    let errors = result["errors"].as_array().expect("errors");
    let found = errors.iter().find(|e| e["channel"] == channel && e["run"] == run);
    let found = found.unwrap_or_else(|| panic!("{channel} of {run} in {errors:?}"));
    ["before", "after", "floor"].map(|key| found[key].as_f64().unwrap_or(f64::NAN))
}

const HIDDEN: &str = "effect=[{kind=\"actuator-friction\",joint=\"P1\",viscous_Ns_m=203.5,coulomb_N=18.0,\
                      offset_N=4.0,velocity_m_s=1e-4}]";

#[test]
fn a_stage_is_predicted_in_the_recordings_own_columns_and_units() {
    let place = Place::new();
    let own = STAGE.replace("\"q_m\"", "{ column = \"weg_mm\", scale = 1e-3 }");
    let own = own.replace(
        "{ column = \"u_V\", scale = 35.15065188248547 }",
        "{ column = \"u_mV\", scale = 0.03515065188248547 }",
    );
    place.write("model.toml", &scenario(&own, &[HIDDEN]).to_toml());
    let rows = stage_rows(&[HIDDEN], 6.0, 0.0);
    let mut text = String::from("t_s,q_ref_m,weg_mm,u_mV,pulse_V,note\n");
    for [t, reference, q, u, pulse] in &rows {
        let _ = writeln!(text, "{t:.3},{reference:.9},{:.7},{:.5},{pulse},x", 1e3 * q, 1e3 * u);
    }
    place.write("run.csv", &text);
    let done = place.noted("predict model.toml --data run.csv --out out");
    assert_eq!(done.err, "note: run.csv: columns that no sensor has: note\n");
    let predicted = place.read("out/predicted.csv");
    let (before, after): (Vec<_>, Vec<_>) = (text.lines().collect(), predicted.lines().collect());
    assert_eq!((before[0], before.len()), (after[0], after.len()));
    for (a, b) in before.iter().zip(&after).skip(1) {
        let [a, b] = [a, b].map(|line| line.split(',').collect::<Vec<_>>());
        let off =
            |k: usize| a[k].parse::<f64>().expect("number") - b[k].parse::<f64>().expect("number");
        assert_eq!((a[1], a[5], off(0), off(4)), (b[1], b[5], 0.0, 0.0));
        // Of 10 V and 100 mm.
        assert!(off(3).abs() < 20.0 && off(2).abs() < 1e-3, "{a:?} {b:?}");
    }
    let result = json(&place, "out/errors.json");
    let [without, with, floor] = error(&result, "run.csv", "u_mV");
    assert!(with < 0.02 * without && with < 3.0 * floor, "{without} {with} {floor}");
    let page = place.read("out/index.html");
    assert!(page.contains("drive-stage-declared") && !page.contains("platform"));
    for (file, parts) in [
        ("signals-1.svg", ["measured", "predicted"]),
        ("missed-1.svg", ["without effects", "predicted"]),
    ] {
        let picture = place.read(&format!("out/{file}"));
        for part in parts {
            assert!(
                picture.contains(&format!("\n{part}\n")) && page.contains(file),
                "{file}: {part}"
            );
        }
    }
}

#[test]
fn a_pendulum_that_comes_to_rest_is_predicted_in_the_recordings_own_columns_and_units() {
    let place = Place::new();
    // From the middle of a swing; at rest after some 20 s.
    let rows = arm_rows([PI + 0.1, 1.8], 40.0);
    let last = rows[rows.len() - 1][1] - PI;
    assert!(last.abs() < 0.01);
    let mut text = String::from("zeit_ms,winkel_deg,split\n");
    for [t, angle] in &rows {
        let _ = writeln!(text, "{:.1},{:.5},id", 1e3 * t, angle.to_degrees());
    }
    place.write("run.csv", &text);
    let columns = "[columns]\nt = { column = \"zeit_ms\", scale = 1e-3 }\nphi = { column = \
                   \"winkel_deg\", scale = 0.017453292519943295 }\n";
    let model = ARM.replace("[columns]\nt = \"t_s\"\nphi = \"theta1_rad\"\n", columns);
    place.write("model.toml", &scenario(&model, &[FRICTION]).to_toml());
    let line = "predict model.toml --data run.csv --window 39.9 --fit 0.25 --out out";
    let done = place.noted(line);
    assert!(done.err.contains("columns that no sensor has: split"), "{}", done.err);
    let result = json(&place, "out/errors.json");
    let [without, with, floor] = error(&result, "run.csv", "winkel_deg");
    assert!(with < 0.01 * without && with < 1e-3, "{without} {with} {floor}");
    let predicted = place.read("out/predicted.csv");
    let heads = predicted.lines().next().expect("a header");
    assert_eq!(heads, "zeit_ms,winkel_deg,split");
    // Beyond the window nothing is predicted.
    let rest = predicted.lines().nth(19_900).expect("rows").split(',').collect::<Vec<_>>();
    let (ms, angle) = (rest[0].parse::<f64>(), rest[1].parse::<f64>());
    assert_eq!((ms, rest[2]), (Ok(39_798.0), "id"));
    let off = angle.expect("degrees") - 180.0 - last.to_degrees();
    assert!(off.abs() < 0.05, "{rest:?} {last}");
}

/// What a template says by `[columns]` is what the file that it stands for says by `[[sensor]]`.
#[test]
fn a_template_is_predicted_as_the_file_that_it_stands_for() {
    let place = Place::new();
    place.write("run.csv", &arm_csv(&arm_rows([1.6, 0.0], 6.0)));
    place.write("template.toml", ARM);
    place.write("expanded.toml", &place.good("expand template.toml"));
    let errors = ["template", "expanded"].map(|name| {
        place.good(&format!("predict {name}.toml --data run.csv --out {name} --quiet"));
        json(&place, &format!("{name}/errors.json"))["windows"].clone()
    });
    assert_eq!(errors[0], errors[1]);
}

#[test]
fn what_a_stage_lacks_is_found_and_judged_on_another_run() {
    let place = Place::new();
    place.write("rig.toml", STAGE);
    place.write("a.csv", &stage_csv(&stage_rows(&[HIDDEN], 12.0, 0.0)));
    place.write("b.csv", &stage_csv(&stage_rows(&[HIDDEN], 8.0, 1.0)));
    let said = place.good("calibrate --rig rig.toml --data a.csv --validate b.csv --out out");
    println!("{said}");
    let report = json(&place, "out/report.json");
    let effects = report["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{effects:?}");
    assert_eq!(
        (&effects[0]["kind"], &effects[0]["joint"]),
        (&"actuator-friction".into(), &"P1".into())
    );
    for (name, value, off) in
        [("coulomb_N", 18.0, 0.3), ("viscous_Ns_m", 203.5, 1.5), ("offset_N", 4.0, 0.2)]
    {
        let found = effects[0]["params"][name]["value"].as_f64().expect("value");
        assert!((found - value).abs() < off, "{name}: {found}");
    }
    let [before, after, _] = error(&report, "b.csv", "u_V");
    assert!(after < 0.02 * before, "{before} {after}");
    assert!(["explained", "unexplained"].map(Value::from).contains(&report["verdict"]));
    for file in ["index.html", "calibrated.toml", "predicted-a.csv", "predicted-b.csv"] {
        assert!(!place.read(&format!("out/{file}")).is_empty());
    }
    place.good("predict out/calibrated.toml --data b.csv --out again --quiet");
    let [_, again, _] = error(&json(&place, "again/errors.json"), "b.csv", "u_V");
    assert!((again / after - 1.0).abs() < 1e-6);
    place.good("run out/calibrated.toml --duration 0.5 --out run --quiet");
}

#[test]
fn nothing_is_found_where_nothing_is_hidden() {
    let place = Place::new();
    place.write("rig.toml", STAGE);
    place.write("a.csv", &stage_csv(&stage_rows(&[], 10.0, 0.0)));
    place.good("calibrate --rig rig.toml --data a.csv --out out --quiet");
    let report = json(&place, "out/report.json");
    assert_eq!(report["verdict"], "nothing-missing", "{report:#}");
}

#[test]
fn what_a_pendulum_lacks_is_found() {
    let place = Place::new();
    place.write("rig.toml", ARM);
    place.write("a.csv", &arm_csv(&arm_rows([1.6, 0.0], 20.0)));
    println!("{}", place.good("calibrate --rig rig.toml --data a.csv --out out"));
    let report = json(&place, "out/report.json");
    let effects = report["effects"].as_array().expect("effects");
    let value = |kind: &str, name: &str| {
        let effect = effects.iter().find(|effect| effect["kind"] == kind);
        effect.and_then(|effect| effect["params"][name]["value"].as_f64()).unwrap_or(0.0)
    };
    // Dry friction is that of bristles where this predicts the better; a swing shows one coefficient of the air.
    let dry = value("bristle-friction", "coulomb_Nm") + value("joint-friction", "coulomb");
    let air = value("air-drag", "torque_Nms2")
        + value("air-drag", "force_Ns2_m2") * 0.147_754_901f64.powi(3);
    assert!((dry / 5e-4 - 1.0).abs() < 0.02 && (air / 1.33e-5 - 1.0).abs() < 0.02, "{dry} {air}");
    assert!(value("joint-friction", "viscous") < 5e-6, "{effects:?}");
    let [before, after, _] = error(&report, "a.csv", "theta1_rad");
    assert!(after < 0.02 * before, "{before} {after}");
}

/// A recording must be refused under both commands, with these words.
fn refused(place: &Place, model: &str, text: &str, words: &[&str]) {
    place.write("run.csv", text);
    place.refused(&format!("predict {model} --data run.csv"), words);
    place.refused(&format!("calibrate --rig {model} --data run.csv"), words);
}

#[test]
fn recordings_of_the_stage_that_cannot_be_right_are_refused() {
    let place = Place::new();
    place.write("stage.toml", STAGE);
    let refused = |text: &str, words: &[&str]| refused(&place, "stage.toml", text, words);
    let rows = stage_rows(&[HIDDEN], 4.0, 0.0);
    let good = stage_csv(&rows);
    let other = |head: &str, with: &str| good.replacen(head, with, 1);
    refused(&other("q_ref_m", "q_soll"), &["run.csv:1", "no column `q_ref_m`"]);
    refused(&other("u_V", "u"), &["run.csv:1", "u_V", "the file has"]);
    let scaled = |factors: [f64; 5]| -> String {
        let row = |row: &[f64; 5]| std::array::from_fn(|k| row[k] * factors[k]);
        stage_csv(&rows.iter().map(row).collect::<Vec<_>>())
    };
    let mm = scaled([1.0, 1e3, 1e3, 1.0, 1.0]);
    refused(&mm, &["run.csv", "q_ref_m", "q_m", "scale = 0.001"]);
    refused(&scaled([1.0, 1.0, 1e3, 1.0, 1.0]), &["columns.q1 ", "scale = 0.001"]);
    refused(&scaled([1.0, 1.0, 1.0, 1e3, 1.0]), &["columns.F1", "scale = 0.0351"]);
    refused(&scaled([1e3, 1.0, 1.0, 1.0, 1.0]), &["every 1.0000", "columns.t"]);

    // Two runs put together: at another place, and at the same place with another speed.
    let jump: Vec<[f64; 5]> = (0..3000).map(|i| rows[if i < 1500 { i } else { i + 700 }]).collect();
    let jump: Vec<[f64; 5]> =
        jump.iter().enumerate().map(|(i, r)| [i as f64 * 1e-3, r[1], r[2], r[3], r[4]]).collect();
    refused(&stage_csv(&jump), &["run.csv:150", "two runs", "cut the file"]);
    let turned: Vec<[f64; 5]> = (0..3000)
        .map(|i| {
            let r = if i < 1500 { rows[i] } else { rows[3000 - i] };
            [i as f64 * 1e-3, r[1], r[2], r[3], r[4]]
        })
        .collect();
    refused(&stage_csv(&turned), &["run.csv:150", "two runs"]);
}

#[test]
fn recordings_of_the_pendulum_that_cannot_be_right_are_refused() {
    let place = Place::new();
    place.write("arm.toml", ARM);
    let refused = |text: &str, words: &[&str]| refused(&place, "arm.toml", text, words);
    let rows = arm_rows([1.6, 0.0], 12.0);
    let good = arm_csv(&rows);
    let other = good.replacen("theta1_rad", "theta", 1);
    refused(&other, &["theta1_rad", "the file has t_s, theta"]);
    let scaled = |factor: f64| {
        arm_csv(&rows.iter().map(|[t, angle]| [*t, angle * factor]).collect::<Vec<_>>())
    };
    refused(&scaled(180.0 / PI), &["columns.phi", "scale = 0.01745"]);
    refused(&scaled(1e3), &["columns.phi", "scale = 0.001"]);
    let jump: Vec<[f64; 2]> = (0..5000)
        .map(|i| [rows[i].map(|x| x)[0], rows[if i < 2500 { i } else { i + 150 }][1]])
        .collect();
    refused(&arm_csv(&jump), &["run.csv:250", "two runs", "cut the file"]);
    // Where it swings through a place both ways.
    let near = rows[2500][1];
    let back = (2501..4000)
        .filter(|i| (rows[i + 1][1] - rows[*i][1]) * (rows[2501][1] - rows[2500][1]) < 0.0)
        .min_by(|a, b| (rows[*a][1] - near).abs().total_cmp(&(rows[*b][1] - near).abs()))
        .expect("swings back");
    let turned: Vec<[f64; 2]> = (0..4000)
        .map(|i| [rows[i][0], rows[if i < 2500 { i } else { back + i - 2500 }][1]])
        .collect();
    refused(&arm_csv(&turned), &["run.csv:250", "two runs"]);
    let gap: String = good
        .lines()
        .enumerate()
        .filter(|(i, _)| !(900..1000).contains(i))
        .map(|(_, l)| format!("{l}\n"))
        .collect();
    refused(&gap, &["run.csv:9", "constant rate"]);
    // The other machine's recording.
    refused(&stage_csv(&stage_rows(&[], 1.0, 0.0)), &["theta1_rad", "q_ref_m"]);
    place.refused("predict arm.toml --data none.csv", &["none.csv", "cannot be read"]);
}

/// The real recordings, where they are present: what is found on one is held against another.
#[test]
fn measured_machines_are_calibrated_and_predicted() {
    let folder = freeplay::calibrate::hardware::folder(None);
    let folder = std::path::absolute(folder).expect("a folder");
    let [train, pulses] =
        ["emps_train", "emps_pulses"].map(|f| folder.join(format!("emps/{f}.csv")));
    let swings = folder.join("pendulum/single_pendulum_1kHz.csv");
    for file in [&train, &pulses, &swings] {
        if !file.is_file() {
            println!("skipped: data not present ({})", file.display());
            return;
        }
    }
    let place = Place::new();
    place.write("stage.toml", STAGE);
    place.write("arm.toml", include_str!("../assets/pendulum-calibrated.toml"));
    let (train, pulses) = (train.display(), pulses.display());
    let line = format!("calibrate --rig stage.toml --data {train} --validate {pulses} --out stage");
    println!("{}", place.good(&line));
    let report = json(&place, "stage/report.json");
    assert_eq!(report["verdict"], "unexplained");
    let [before, after, _] = error(&report, "emps_pulses.csv", "u_V");
    assert!(after < 0.083 * before, "{before} {after}");
    let found: Vec<&Value> = report["effects"].as_array().expect("effects").iter().collect();
    let kinds: Vec<&str> = found.iter().filter_map(|effect| effect["kind"].as_str()).collect();
    for kind in ["actuator-friction", "film-friction", "drive-lag"] {
        assert!(kinds.contains(&kind), "{kind} in {kinds:?}");
    }
    // The whole decay, from its first quarter second.
    let line = format!("predict arm.toml --data {} --window 54.9 --fit 0.25", swings.display());
    println!("{}", place.noted(&format!("{line} --out arm")).out);
    let [before, after, _] =
        error(&json(&place, "arm/errors.json"), "single_pendulum_1kHz.csv", "theta1_rad");
    assert!(after < 0.02 && before > 1.0, "{before} {after}");
}
