//! Models against measured hardware. The recordings are not part of the project; without them the tests
//! say so and pass.

use freeplay::identify::inverse::Term;
use freeplay::study::hardware::{Missing, emps, folder, pendulum, skipped};
use std::path::PathBuf;

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
    let train = emps::Recording::read(&place("emps/emps_train.csv"), false);
    let pulses = emps::Recording::read(&place("emps/emps_pulses.csv"), true);
    let (Some(train), Some(pulses)) = (present(train), present(pulses)) else { return };
    let found = emps::study(&train, &pulses).expect("usable");
    println!("{}\n{}", found.table().text(), found.parameters().text());
    println!("{:?} {:?}", found.carried.inverse, found.carried.simulated);
    let [_, symmetric, asymmetric, .., last] = &found.steps[..] else { panic!("steps") };
    let near = |value: f64, published: f64, share: f64| {
        assert!((value / published - 1.0).abs() < share, "{value}, published {published}");
    };
    near(symmetric.train, 0.0406, 0.01);
    near(asymmetric.train, 0.0309, 0.01);
    let published = [
        (Term::Mass, 95.1089),
        (Term::Viscous, 203.50),
        (Term::Coulomb, 20.39),
        (Term::Offset, -3.16),
    ];
    for (term, value) in published {
        near(symmetric.model.factor(term), value, 0.02);
    }
    assert!(last.train <= 0.029);
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
    let Some(recording) = present(pendulum::Recording::read(&place(file))) else { return };
    let found = pendulum::study(&recording);
    println!("{}\ndeclared {}\n{:?}", found.table().text(), found.declared, found.carried);
    for step in &found.steps {
        println!("{} {:?}", step.name, step.windows);
    }
    let (viscous, chosen) = (&found.steps[0], &found.steps[found.chosen]);
    assert!(chosen.swinger.dry > 0.0 && chosen.swinger.air > 0.0);
    assert!(chosen.val <= 0.55 * viscous.val, "{} of {}", chosen.val, viscous.val);
    assert!(viscous.val <= found.declared * 1.2);
}
