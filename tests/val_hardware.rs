//! Models against measured hardware. The recordings are not part of the project; without them the tests
//! say so and pass.

mod cli_common;

use cli_common::Place;
use freeplay::calibrate::hardware::{Missing, emps, folder, pendulum, skipped};
use freeplay::engine::{self, Schedule, StepControl};
use freeplay::model::assemble;
use freeplay::scenario::Scenario;
use std::path::PathBuf;

fn rig(text: &str) -> Scenario {
    Scenario::from_text(text, "rig.toml", &[]).expect("a scenario")
}

fn place(name: &str) -> PathBuf {
    folder(None).join(name)
}

/// The value, or nothing where the recording is not there.
fn present<T>(read: Result<T, Missing>) -> Option<T> {
    match read {
        Ok(value) => Some(value),
        Err(Missing::Absent(path)) => {
            println!("{}", skipped("", &path));
            None
        }
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn the_drive_stage_is_found_and_predicts_another_recording() {
    let rig = rig(emps::RIG);
    let [train, pulses] = ["train", "pulses"]
        .map(|name| present(emps::read(&place(&format!("emps/emps_{name}.csv")), &rig)));
    let (Some(train), Some(pulses)) = (train, pulses) else { return };
    let found = emps::study(&rig, &[train, pulses], &|_| ()).expect("usable");
    println!("{:#?}\n{:#?}", found.table(), found.parameters());
    println!("{:?} {:?}", found.carried.inverse, found.carried.simulated);
    let [_, symmetric, asymmetric, .., last] = &found.steps[..] else { panic!("steps") };
    let near = |value: f64, published: f64, share: f64| {
        assert!((value / published - 1.0).abs() < share, "{value}, published {published}");
    };
    near(symmetric.train, 0.0406, 0.01);
    near(asymmetric.train, 0.0309, 0.01);
    // The offset is the rod's, where the authors have that of the drive against it.
    let published = [
        ("mass_kg", 0.0, 95.1089),
        ("viscous_Ns_m", 203.50, 203.50),
        ("coulomb_N", 20.39, 20.39),
        ("offset_N", 3.16, 3.16),
    ];
    for (name, value, size) in published {
        let off = symmetric.value(name).expect(name) - value;
        assert!(off.abs() < 0.02 * size, "{name}: {off} from {value}");
    }
    assert!(last.train <= 0.019);
    assert!(last.halves.expect("fitted").into_iter().all(|half| half <= 0.020));
    // Each step helps where it was not fitted: on the other half, and on the other recording.
    for pair in found.steps[1..].windows(2) {
        let [before, after] = [&pair[0], &pair[1]].map(|step| step.halves.expect("fitted"));
        assert!(after[0] < before[0] && after[1] < before[1], "{}", pair[1].name);
    }
    assert!(last.pulses < 0.8 * symmetric.pulses);
    assert!(last.simulated[1] < symmetric.simulated[1]);
    assert!(found.carried.inverse[1] < found.carried.inverse[0]);
}

#[test]
fn the_pendulum_is_found_and_predicts_what_follows() {
    let file = "pendulum/single_pendulum_1kHz.csv";
    let rig = rig(pendulum::RIG);
    let Some(recordings) = present(pendulum::read(&place(file), &rig)) else { return };
    let found = pendulum::study(&rig, &recordings, &|_| ()).expect("usable");
    println!("{:#?}\n{:#?}", found.table(), found.numbers());
    let [declared_friction, .., last] = &found.steps[..] else { panic!("steps") };
    let value = |kind: &str, name: &str| {
        let of = |(of, _): &(&'static str, _)| *of == name;
        let effect = last.effects.iter().find(|e| e.effect.kind.name == kind).expect(kind);
        effect.params.iter().find(|param| of(param)).expect(name).1.value
    };
    assert!(value("joint-friction", "coulomb") > 0.0 && value("air-drag", "torque_Nms2") > 0.0);
    let declared = found.declared.val;
    assert!(last.val <= 0.55 * declared, "{} of {declared}", last.val);
    assert!(declared_friction.val <= declared * 1.2);
}

/// A recording like the pendulum's, simulated: time and angle.
fn swings() -> Vec<[f64; 2]> {
    let friction = "effect=[{kind=\"bristle-friction\",joint=\"A1\",coulomb_Nm=5e-4}]";
    let sets = [friction, "mechanism.angle=1.6"].map(str::to_owned);
    let model = Scenario::from_text(pendulum::RIG, "rig.toml", &sets).expect("a scenario");
    let mechanism = assemble(&model).expect("a pendulum").mechanism;
    let schedule = Schedule { duration: 6.0, interval: 1e-3 };
    let mut rows: Vec<[f64; 2]> = Vec::new();
    engine::run(&mechanism, StepControl::Fixed(1e-3), schedule, &mut |instant| {
        rows.push([instant.t, instant.angles[0]]);
    })
    .expect("swings");
    rows
}

fn csv(head: &str, rows: &[[f64; 2]]) -> String {
    let rows = rows.iter().map(|[t, angle]| format!("{t:.6},{angle:.7}\n"));
    format!("{head}\n{}", rows.collect::<String>())
}

#[test]
fn wrong_columns_wrong_scales_and_spliced_recordings_are_refused() {
    let place = Place::new();
    let file = "data/pendulum/single_pendulum_1kHz.csv";
    std::fs::create_dir_all(place.path("data/pendulum")).expect("a folder");
    let good = swings();
    let command = "study pendulum --data data --out out";
    let refused = |text: String, words: &[&str]| {
        place.write(file, &text);
        place.refused(command, words);
    };
    refused(csv("t_s,theta", &good), &["theta1_rad", "the file has t_s, theta"]);
    let degrees: Vec<[f64; 2]> = good.iter().map(|[t, angle]| [*t, angle.to_degrees()]).collect();
    refused(csv("t_s,theta1_rad", &degrees), &["columns.phi", "scale = 0.01745"]);
    let spliced: Vec<[f64; 2]> = (0..5000)
        .map(|i| [good[i][0], if i < 2500 { good[i][1] } else { good[i + 300][1] }])
        .collect();
    refused(csv("t_s,theta1_rad", &spliced), &["csv:250", "two runs", "cut the file"]);
    let gap: Vec<[f64; 2]> = good
        .iter()
        .enumerate()
        .filter(|(i, _)| !(2000..2500).contains(i))
        .map(|(_, r)| *r)
        .collect();
    refused(csv("t_s,theta1_rad", &gap), &["csv:2002", "constant rate"]);
}

#[test]
fn without_recordings_the_studies_say_so_and_where_to_get_them() {
    let place = Place::new();
    for (which, words) in [("emps", "nonlinearbenchmark.org"), ("pendulum", "MultiArm-Pendulum")] {
        let said = place.good(&format!("study {which}"));
        assert!(said.starts_with("skipped: data not present") && said.contains(words), "{said}");
        // A folder that somebody names has to be there.
        place.refused(&format!("study {which} --data nowhere"), &["--data: there is no", words]);
    }
}

#[test]
fn both_machines_run_and_are_checked_like_any_other() {
    let place = Place::new();
    for (name, text) in [("stage", emps::RIG), ("arm", pendulum::RIG)] {
        place.write(&format!("{name}.toml"), text);
        let checked = place.good(&format!("check {name}.toml"));
        assert!(checked.contains("kg"), "{checked}");
        place.good(&format!("run {name}.toml --duration 1 --quiet --out {name}"));
        place.good(&format!("run {name}/scenario.toml --quiet --out {name}-again"));
        assert_eq!(
            place.read(&format!("{name}/timeseries.csv")),
            place.read(&format!("{name}-again/timeseries.csv"))
        );
    }
}
