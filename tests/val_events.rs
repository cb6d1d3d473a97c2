//! What does not last. Recordings of measured machines from whose effort a part is hidden, so that the machine really
//! received it and no column says so; they are not part of the project, and without them these tests say so and pass.
//! Simulated recordings of the six rigs with a hidden blow or load; the rigs' own ones, in which there is none.

use freeplay::calibrate::sensed::events::{Event, events, search::beside};
use freeplay::calibrate::sensed::problem::RigProblem;
use freeplay::calibrate::sensed::recording::Recording;
use freeplay::calibrate::sensed::released::released;
use freeplay::calibrate::sensed::simulate::{record, with_noise};
use freeplay::calibrate::sensed::start::machine;
use freeplay::calibrate::sensed::windows::bench::Bench;
use freeplay::effects::{Setting, Target, named};
use freeplay::engine::StepControl;
use freeplay::scenario::Scenario;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const ARM: [&str; 5] = ["fit_00", "fit_02", "fit_05", "validate_03", "validate_04"];

/// Files of measured machines; none where one is not there.
fn measured(files: &[String]) -> Option<Vec<PathBuf>> {
    let folder = freeplay::calibrate::hardware::folder(None);
    let paths: Vec<PathBuf> = files.iter().map(|file| folder.join(file)).collect();
    let missing = paths.iter().find(|path| !path.is_file());
    if let Some(path) = missing {
        println!("skipped: data not present ({})", path.display());
        return None;
    }
    Some(paths)
}

fn read(rig: &Scenario, path: &Path) -> Recording {
    let parts = freeplay::model::parts_of(rig).expect("parts");
    Recording::read(path, &parts.sensors, true).expect("a recording")
}

fn show(events: &[Event]) -> Vec<String> {
    events.iter().map(|event| format!("{} {:.1?}", event.words(), event.scores)).collect()
}

/// A recording from whose column a constant effort is taken for a while.
fn hidden(run: &Recording, column: usize, [from, until]: [f64; 2], size: f64) -> Recording {
    let taken = |(row, value): (usize, &f64)| {
        let t = row as f64 * run.interval;
        value - if (from..until).contains(&t) { size } else { 0.0 }
    };
    let columns = (0..run.sensors()).map(|i| {
        let values = run.get(i)?;
        Some(match i == column {
            true => values.iter().enumerate().map(taken).collect(),
            false => values.to_vec(),
        })
    });
    run.with(columns.collect())
}

/// Numbers from 0 to 1, spread evenly: the golden ratio's multiples.
fn even(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749_895).fract()
}

/// Recordings of a measured arm: nothing is found in them; of torques that are hidden for a while those at the elbow
/// from 0.5 N·m on are, at the shoulder, which the whole arm's inertia and its gear's play blur, half of those of 1 N·m.
#[test]
fn torques_that_no_column_of_a_measured_arm_says_are_found() {
    let Some(files) = measured(&ARM.map(|name| format!("two-link-arm/{name}.csv"))) else { return };
    let text = include_str!("val_events/two-link-arm.toml");
    let rig = Scenario::from_text(text, "two-link-arm.toml", &[]).expect("a rig");
    let runs: Vec<Recording> = files.iter().map(|file| read(&rig, file)).collect();
    let bench = Bench::new(&rig, runs.clone()).expect("a bench");
    let none = bench.events();
    println!("as recorded: {:?}", show(&none));
    let zeros = bench.own_zeros(&bench.declared, &bench.zeros_of_runs()).expect("zeros");
    let plain = |run: &Vec<[f64; 2]>| run.iter().map(|[zero, _]| *zero).collect();
    let zeros: Vec<Vec<f64>> = zeros.iter().map(plain).collect();
    let column = |name: &str| {
        let place = bench.mechanism.sensors.iter().position(|sensor| sensor.column == name);
        place.expect("a column")
    };
    let torques = ["tau1_Nm", "tau2_Nm"].map(column);
    let (mut k, mut false_alarms, mut large) = (0, 0, [[0u32; 2]; 2]);
    for size in [0.2, 0.35, 0.5, 0.7, 1.0] {
        for lasts in [0.05, 0.1, 0.2, 0.3] {
            let mut hits = [0; 2];
            let mut placed = [0; 2];
            let mut off = Vec::new();
            for trial in 0..10 {
                let (run, joint) = (trial % 5, trial / 5);
                let at = 0.5 + 8.5 * even(k);
                let push = if k % 2 == 0 { -size } else { size };
                k += 1;
                let mut changed = runs.clone();
                changed[run] = hidden(&runs[run], torques[joint], [at, at + lasts], push);
                let bench = Bench::new(&rig, changed).expect("a bench");
                let machines = bench.machines(&bench.declared).expect("machines");
                let changed = bench.series(&machines, &zeros, run).expect("a series");
                let mut hit = false;
                for Event { history, .. } in events(std::slice::from_ref(&changed)) {
                    let there = history.at_s < at + lasts + 0.05 && history.until_s > at - 0.05;
                    if !there {
                        false_alarms += 1;
                        continue;
                    }
                    hit = true;
                    placed[joint] += usize::from(history.joint == ["shoulder", "elbow"][joint]);
                    let share = 100.0 * history.impulse / (push * lasts);
                    off.push(format!("{:+.0} ms {share:.0} %", 1e3 * (history.at_s - at)));
                }
                hits[joint] += usize::from(hit);
                if size >= [1.0, 0.5][joint] {
                    large[joint][0] += 1;
                    large[joint][1] += u32::from(hit);
                }
            }
            println!("{size} N m, {lasts} s: found {hits:?} of 5, joint right {placed:?}: {off:?}");
        }
    }
    println!("{k} trials, false alarms {false_alarms}; large ones {large:?}");
    assert!(none.is_empty(), "{:?}", show(&none));
    assert!(false_alarms <= k / 20, "{false_alarms}");
    let [shoulder, elbow] = large.map(|[all, found]| f64::from(found) / f64::from(all));
    assert!(elbow >= 0.9 && shoulder >= 0.5, "{shoulder} {elbow}");
}

const STAGE: &str = r#"name = "stage"
environment = { gravity = [0.0, 0.0] }
[ground.points]
base = [0.0, 0.0]
[[body]]
name = "carriage"
mass = 95.1089
inertia = 1.0
center_of_mass = [0.0, 0.0]
points = { P = [0.0, 0.0] }
[[joint]]
name = "slide"
kind = "prismatic"
base = "ground.base"
axis = 0.0
slider = "carriage.P"
[[drive]]
joint = "slide"
kind = "force"
[[sensor]]
column = "q_m"
quantity = "position"
of = "slide"
resolution = 5e-8
[[sensor]]
column = "force_N"
quantity = "force"
of = "slide"
std = 1.0
"#;

/// A recording of the EMPS stage with its force in place of the command, pulses of 5 V left out; beginnings of those.
fn stage(path: &Path, folder: &Path) -> (PathBuf, Vec<f64>) {
    const FORCE: f64 = 35.150_651_882_485_47;
    let text = std::fs::read_to_string(path).expect("a recording");
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next().expect("heads").split(',').collect();
    let place = |name: &str| heads.iter().position(|head| *head == name);
    let [t, q, u] = ["t_s", "q_m", "u_V"].map(|name| place(name).expect("a column"));
    let pulse = place("pulse_V");
    let (mut csv, mut begins, mut last) = (String::from("t_s,q_m,force_N\n"), Vec::new(), 0.0);
    for line in lines {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().expect("a number")).collect();
        let now = pulse.map_or(0.0, |pulse| values[pulse]);
        if now > last {
            begins.push(values[t]);
        }
        last = now;
        let _ = writeln!(csv, "{},{},{:.6}", values[t], values[q], FORCE * (values[u] - now));
    }
    let file = folder.join(path.file_name().expect("a name"));
    std::fs::write(&file, csv).expect("written");
    (file, begins)
}

/// The EMPS stage: pulses of 175.75 N for half a second in every one, recorded and hidden here, beside a recording
/// without them.
#[test]
fn recorded_disturbances_of_a_drive_are_found_with_time_and_size() {
    let names = ["emps/emps_train.csv", "emps/emps_pulses.csv"].map(str::to_owned);
    let Some(files) = measured(&names) else { return };
    let folder = std::env::temp_dir().join("freeplay-val-events");
    std::fs::create_dir_all(&folder).expect("a folder");
    let rig = Scenario::from_text(STAGE, "stage.toml", &[]).expect("a rig");
    let (train, _) = stage(&files[0], &folder);
    let (pulses, begins) = stage(&files[1], &folder);
    let runs = vec![read(&rig, &train), read(&rig, &pulses)];
    let found = Bench::new(&rig, runs).expect("a bench").events();
    println!("{:#?}", show(&found));
    let mut hits = 0;
    for begin in &begins {
        let near = found.iter().find(|e| (e.history.at_s - begin).abs() < 0.02);
        if let Some(event) = near {
            let lasts = event.history.until_s - event.history.at_s;
            let share = event.history.impulse / (175.75 * 0.5);
            println!("{begin} s: lasts {lasts:.3} s, impulse {:.0} %", 100.0 * share);
            hits += usize::from((share - 1.0).abs() < 0.2 && (lasts - 0.5).abs() < 0.05);
        }
    }
    println!("{hits} of {} pulses, {} events", begins.len(), found.len());
    assert!(found.iter().all(|e| e.history.run.as_deref() == Some("emps_pulses.csv")));
    assert!(hits * 10 >= begins.len() * 8, "{hits}");
}

fn rig(name: &str) -> (Scenario, Vec<Recording>) {
    let folder = Path::new("assets/rigs-planar").join(name);
    let rig = Scenario::load(Some(&folder.join("rig.toml")), &[]).expect("a rig");
    let sensors = freeplay::model::parts_of(&rig).expect("parts").sensors;
    let run = |file: &str| Recording::read(&folder.join(file), &sensors, false).expect("a run");
    (rig, vec![run("run-a.csv"), run("run-b.csv")])
}

const CONTROL: StepControl = StepControl::Tolerance(1e-5);

/// What is found in recordings of a rig by its declared model.
fn found(rig: Scenario, runs: Vec<Recording>) -> Vec<Event> {
    let problem = RigProblem::new(rig, runs, CONTROL).expect("a problem");
    let starts = problem.let_go(&[]).expect("starts");
    let simulated = problem.simulated(&starts, 2).expect("simulations");
    beside(&problem, &[], &simulated).expect("a look")
}

/// What the six rigs lack lasts.
#[test]
fn nothing_that_passes_is_found_in_the_six_rigs() {
    let names = ["planar-1", "planar-2", "planar-3", "planar-4", "planar-5", "planar-6"];
    let of = |name: &str| {
        let (rig, runs) = rig(name);
        let found = found(rig, runs);
        println!("{name}: {:?}", show(&found));
        found.len()
    };
    assert_eq!(names.map(of), [0; 6]);
}

/// Blows and loads on two rigs, simulated with noise: run a has them, run b has not.
#[test]
fn blows_and_loads_in_simulated_recordings_are_found() {
    let blow = |at: f64, i: f64| vec![("at_s", at), ("iphi_Nms", i)];
    let load = |at: f64, torque: f64| vec![("at_s", at), ("torque_Nm", torque)];
    let cases = [
        ("planar-2", "impulse", "crank", blow(1.3, 4e-3), 4e-3),
        ("planar-2", "impulse", "crank", blow(2.1, -0.01), -0.01),
        ("planar-2", "load-change", "crank", load(2.2, 0.1), 0.1 * 0.74),
        ("planar-1", "impulse", "crank", blow(0.9, 4e-3), 4e-3),
        ("planar-1", "load-change", "crank", load(2.5, -0.1), -0.1 * 0.44),
    ];
    let mut missed = Vec::new();
    for (name, kind, body, values, impulse) in cases {
        let (rig, runs) = rig(name);
        let kind = named(kind).expect("a kind");
        let hidden = Setting::on(kind, Target::Body(body.to_owned()), &values);
        let sensors = machine(&rig, &[], &runs[0]).expect("a machine").sensors;
        let simulate = |run: &Recording, effects: &[Setting], seed| {
            let machine = released(&rig, effects, run, CONTROL).expect("a start").machine;
            with_noise(&record(&machine, CONTROL, run, 7).expect("a run"), &sensors, seed)
        };
        let a = simulate(&runs[0], std::slice::from_ref(&hidden), 11);
        let b = simulate(&runs[1], &[], 12);
        let found = found(rig.clone(), vec![a, b]);
        println!("{name} {hidden} {values:?}, {impulse:.4}: {:?}", show(&found));
        let at = values[0].1;
        let right = match found.as_slice() {
            [event] => {
                let own = &event.history;
                (own.at_s - at).abs() < 0.015
                    && own.joint == "O"
                    && (own.impulse / impulse - 1.0).abs() < 0.2
            }
            _ => false,
        };
        if !right {
            missed.push(format!("{name} {hidden} {values:?}"));
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}
