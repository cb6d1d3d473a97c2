//! What must hold of any good calibration, on the recordings in `assets/rigs`: an independent simulator's,
//! whose hidden effects are written nowhere in this repository.
//!
//! Slow: a calibration takes a minute or two. Trials with effects that are known are ignored unless asked for
//! (`cargo test --release --test val_calibrate -- --ignored`).

use freeplay::calibrate::evidence::{as_good, evidence};
use freeplay::calibrate::left::{is_noise, left};
use freeplay::calibrate::model::{LegsCase, LegsRun, LegsSegment};
use freeplay::calibrate::outcome::{LegsOutcome, MOST, Verdict, calibrate};
use freeplay::calibrate::rattle::Rattle;
use freeplay::calibrate::recording;
use freeplay::calibrate::report::{LegsReport, Sources, calibrated};
use freeplay::calibrate::result::{LegsPrepared, case, prepare};
use freeplay::calibrate::self_test::{self, HiddenValue as Estimated, LegsTrial};
use freeplay::calibrate::sensed::problem::RigProblem;
use freeplay::calibrate::sensed::recording::Recording;
use freeplay::calibrate::sensed::search::Search;
use freeplay::calibrate::settle::{FitData, refined, settle};
use freeplay::calibrate::start::{SwingStart, as_seen};
use freeplay::calibrate::way::name;
use freeplay::effects::Setting;
use freeplay::scenario::Scenario;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

struct Done {
    case: LegsCase,
    rattle: Rattle,
    outcome: LegsOutcome,
}

fn folder(rig: usize) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("assets/rigs/rig-{rig}"))
}

fn prepared(rig: usize) -> LegsPrepared {
    let [toml, a, b] = ["rig.toml", "run-a.csv", "run-b.csv"].map(|name| folder(rig).join(name));
    let scenario = Scenario::load(Some(&toml), &[]).unwrap();
    prepare(scenario, recording::read(&[&a, &b]).unwrap()).unwrap()
}

/// Each rig is calibrated once, whichever tests ask for it.
fn done(rig: usize) -> &'static Done {
    static DONE: [OnceLock<Done>; 6] = [const { OnceLock::new() }; 6];
    DONE[rig - 1].get_or_init(|| {
        let (case, rattle) = case(prepared(rig)).unwrap();
        let outcome = calibrate(&case, &[], &|_| {}).unwrap();
        Done { case, rattle, outcome }
    })
}

/// Errors after calibration, in units of what is left to any model, and its work.
fn check(rig: usize) {
    let Done { case, outcome, .. } = done(rig);
    for error in &outcome.errors {
        let (before, after, floor) = (error.before, error.after, error.floor);
        println!(
            "rig {rig}: {:?} {} {} {}: {before:.3e} -> {after:.3e}, floor {floor:.3e}, {:.2} of it",
            outcome.verdict,
            error.run,
            error.role,
            error.channel,
            after / floor
        );
    }
    println!("rig {rig}: {} runs simulated", outcome.simulations);
    assert!(outcome.simulations <= MOST as usize, "{} runs simulated", outcome.simulations);
    let mut broken = Vec::new();
    for error in &outcome.errors {
        let ratio = error.after / error.floor;
        let limit = match outcome.verdict {
            Verdict::Explained | Verdict::NothingMissing => 1.3,
            Verdict::Unexplained => 2.0,
        };
        if error.role == "validation" && ratio > limit {
            broken.push(format!("{} is {ratio:.2} times its floor, limit {limit}", error.channel));
        }
        // What one noisy recording of the floor's size may add by chance.
        if error.after > 1.05 * error.before + 0.1 * error.floor {
            broken.push(format!(
                "{} of {} went from {:.3e} to {:.3e}",
                error.channel, error.run, error.before, error.after
            ));
        }
    }
    assert!(broken.is_empty(), "rig {rig}, {:?}: {}", outcome.verdict, broken.join("; "));
    assert_eq!(outcome.errors.len(), 2 * 9, "every measured channel of both runs");
    for (log, run) in outcome.predictions.iter().zip(&case.runs) {
        assert_eq!(log.samples, run.log.samples);
        assert!(log.channels().eq(run.log.channels()), "the log's columns");
    }
    schema(rig);
    let found = outcome.effects.iter().filter(|(effect, _)| effect.efforts().is_none()).count();
    match outcome.verdict {
        Verdict::NothingMissing => assert!(outcome.effects.is_empty()),
        Verdict::Explained => assert!(found > 0 && found == outcome.effects.len()),
        Verdict::Unexplained => {}
    }
    // What is written is a scenario, and says the same.
    let toml = calibrated(&case.rig, outcome).to_toml();
    let again = Scenario::from_text(&toml, "calibrated.toml", &[]).unwrap();
    assert_eq!(again.effects.len(), outcome.effects.len());
    assert_eq!(again.to_toml(), toml);
}

/// Keys that are promised to scripts.
fn schema(rig: usize) {
    let Done { case, rattle, outcome } = done(rig);
    let report = LegsReport::new(Sources { case, outcome, rattle, without: &[] });
    let json = serde_json::to_value(&report).unwrap();
    let words = ["explained", "nothing-missing", "unexplained"];
    assert!(words.contains(&json["verdict"].as_str().unwrap()));
    for effect in json["effects"].as_array().unwrap() {
        assert!(effect["kind"].is_string() && effect["evidence"].is_string(), "{effect}");
        assert!(effect["joint"].is_null() || effect["joint"].is_string(), "{effect}");
        for (name, fitted) in effect["params"].as_object().unwrap() {
            let value = fitted["value"].as_f64().unwrap();
            let ends = [&fitted["ci95"][0], &fitted["ci95"][1]].map(|v| v.as_f64().unwrap());
            assert!(ends[0] <= value && value <= ends[1], "{name}: {fitted}");
            assert!(fitted["std"].as_f64().unwrap() > 0.0, "{name}: {fitted}");
        }
        assert!(effect["kind"] != "unnamed" || effect["depends_on"].is_string(), "{effect}");
    }
    for error in json["errors"].as_array().unwrap() {
        for key in ["run", "role", "channel", "unit"] {
            assert!(error[key].is_string(), "{key}: {error}");
        }
        for key in ["before", "after", "floor"] {
            assert!(error[key].as_f64().unwrap() > 0.0, "{key}: {error}");
        }
    }
    let ranking = json["ranking"].as_array().unwrap();
    for candidate in ranking {
        let score = candidate["validation_score"].as_f64().unwrap();
        assert!(candidate["kind"].is_string() && (0.0..=1.0).contains(&score), "{candidate}");
        assert!(candidate["kept"].is_boolean(), "{candidate}");
    }
    for effect in json["effects"].as_array().unwrap() {
        let kept = |c: &&Value| {
            c["kept"] == true && c["kind"] == effect["kind"] && c["joint"] == effect["joint"]
        };
        assert_eq!(ranking.iter().filter(kept).count(), 1, "{effect} in the ranking");
    }
}

#[test]
fn rig_1() {
    check(1);
}

#[test]
fn rig_2() {
    check(2);
}

#[test]
fn rig_3() {
    check(3);
}

#[test]
fn rig_4() {
    check(4);
}

/// Two things are missing there, the first of which is mistaken for a rival as long as the second is
/// unknown, and its recordings begin with a swing that no release gives which we know.
#[test]
fn rig_5() {
    check(5);
    assert_eq!(done(5).outcome.verdict, Verdict::Explained);
    assert_eq!(done(5).outcome.effects.len(), 2);
}

/// With 29 g on the platform a leg is nearly unloaded now and then. A journal that crossed over at another
/// time in the model than in the recording drew the fit to a payload three times as far out, and the
/// verdict was `unexplained`.
#[test]
fn a_payload_that_nearly_unloads_a_leg_is_found() {
    let hidden = vec!["payload".into()];
    let trial = LegsTrial { hidden, size: 1.0, gravity: true, withheld: false, seed: 2000 };
    let result = self_test::run(&trial).unwrap();
    assert!(result.right, "{:?}: {:?}", result.verdict, result.found);
    assert_eq!(result.values.len(), 3);
    for Estimated { name, truth, value, std } in result.values {
        let std = std.unwrap();
        assert!(
            (value - truth).abs() < 0.03 * truth.abs(),
            "{name}: {value} ± {std}, hidden {truth}"
        );
        assert!((value - truth).abs() < 4.0 * std, "{name}: {value} ± {std}, hidden {truth}");
    }
}

/// Where joints rattle, the lens reads off flying forces which way a journal leans. Least squares made the
/// clearance of a worn joint small that such noise is multiplied by (attenuation): 0.2 mm for 0.27 mm, and
/// the verdict was `unexplained`.
#[test]
fn a_worn_joint_that_rattles_settles_at_its_clearance() {
    let hidden = vec!["joint-wear".into()];
    let trial = LegsTrial { hidden, size: 3.0, gravity: false, withheld: false, seed: 11_050 };
    let (case, hidden) = self_test::recorded(&trial).unwrap();
    let truth = hidden[0].value("clearance_m").unwrap();
    let [on, hold] = [0, 1].map(|run| vec![LegsSegment { run, rows: case.runs[run].rows() }]);
    let question = FitData { on: &on, hold: &hold, without: &[] };
    let start = vec![hidden[0].with(&[1.5e-4])];
    let settled = settle(&case, &question, &start, 3, None).unwrap();
    let found = settled.fit.effects[0].value("clearance_m").unwrap();
    println!("hidden {truth:.3e} m, found {found:.3e} m");
    assert!((found - truth).abs() < 0.06 * truth, "{found} m, hidden {truth} m");
    let left = left(&case, &question, &settled);
    assert!(is_noise(&left), "{left:?}");
}

/// The same by its sensors alone, as any mechanism.
#[test]
#[ignore = "two minutes"]
fn by_sensors_a_worn_joint_that_rattles_settles_at_its_clearance() {
    let hidden = vec!["joint-wear".into()];
    let trial = LegsTrial { hidden, size: 3.0, gravity: false, withheld: false, seed: 11_050 };
    let (case, hidden) = self_test::recorded(&trial).unwrap();
    let truth = hidden[0].value("clearance_m").unwrap();
    let mut problem = by_sensors(&case);
    let logs = problem.simulated(&problem.let_go(&[]).unwrap(), 2).unwrap();
    assert!(problem.rattle(&logs) > 1.0);
    problem.lean_as_noise_allows(&logs);
    let split = problem.split();
    let search = Search::new(&problem, &split, &[], &|_| {});
    let settled = search.settle(&[hidden[0].with(&[1.5e-4])], 3).unwrap().unwrap();
    let found = settled.fit.effects[0].value("clearance_m").unwrap();
    println!("hidden {truth:.3e} m, found {found:.3e} m");
    assert!((found - truth).abs() < 0.06 * truth, "{found} m, hidden {truth} m");
    assert!(search.is_noise(&settled), "{:?}", search.left(&settled));
}

/// A case of the 3-RPR's own method as one of any mechanism with its sensors.
fn by_sensors(case: &LegsCase) -> RigProblem {
    let rig = freeplay::model::expand(&case.rig).unwrap();
    let sensors = freeplay::model::parts_of(&rig).unwrap().sensors;
    let folder = tempfile::tempdir().unwrap();
    let recording = |run: &LegsRun| {
        let path = folder.path().join(&run.log.name);
        std::fs::write(&path, run.log.to_csv()).unwrap();
        Recording::read(&path, &sensors, false).unwrap()
    };
    let recordings = case.runs.iter().map(recording).collect();
    RigProblem::new(rig, recordings, case.simulator.control).unwrap()
}

/// A regression: a model that is off swings with another frequency than the machine, so kicks found no
/// start, but took the swing away; the swing then counted as residual, and was taken over from models of
/// another frequency. The values of a payload and a worn joint stood still far off (the payload 30 mm
/// beside its place), and an anchor offset was nearer.
#[test]
#[ignore = "two minutes"]
fn a_payload_and_a_worn_joint_settle_from_far_off() {
    let hidden = vec!["payload".into(), "joint-wear".into()];
    let trial = LegsTrial { hidden, size: 3.0, gravity: true, withheld: false, seed: 16_000 };
    let (case, hidden) = self_test::recorded(&trial).unwrap();
    let [on, hold] = [0, 1].map(|run| vec![LegsSegment { run, rows: case.runs[run].rows() }]);
    let question = FitData { on: &on, hold: &hold, without: &[] };
    let start = vec![hidden[0].with(&[0.083, -0.017, -0.049]), hidden[1].with(&[2.36e-4])];
    let payload = settle(&case, &question, &start[..1], 1, None).unwrap();
    let settled = settle(&case, &question, &start, 4, Some(&payload.baseline)).unwrap();
    let whole = refined(&case, &question, settled).unwrap();
    println!("{:?}", left(&case, &question, &whole));
    assert!(is_noise(&left(&case, &question, &whole)));
    for (found, hidden) in whole.fit.effects.iter().zip(&hidden) {
        for ((name, found), (_, hidden)) in found.values().zip(hidden.values()) {
            println!("{name}: hidden {hidden:.4e}, found {found:.4e}");
            assert!((found - hidden).abs() < 0.05 * hidden.abs(), "{name}: {found}, not {hidden}");
        }
    }
}

/// An anchor moved along its leg and an encoder's wrong zero are one and the same where joints rattle. The
/// difference of two noisy misfits decided, half of the time for what is seldom met.
#[test]
#[ignore = "two minutes"]
fn of_two_effects_that_do_as_well_the_common_one_is_named_and_the_other_said() {
    let hidden = vec!["anchor-offset".into()];
    let trial = LegsTrial { hidden, size: 1.0, gravity: false, withheld: false, seed: 12_040 };
    let (case, hidden) = self_test::recorded(&trial).unwrap();
    let outcome = calibrate(&case, &[], &|_| {}).unwrap();
    assert_eq!(outcome.verdict, Verdict::Explained);
    let [(found, _)] = &outcome.effects[..] else { panic!("{:?}", outcome.effects) };
    assert!(found.is(&hidden[0]), "{found:?}");
    let others: Vec<String> = as_good(&outcome, found).into_iter().map(name).collect();
    assert!(others.contains(&"sensor-offset at P1".to_owned()), "{others:?}");
    let evidence = evidence(&outcome, found);
    assert!(evidence.contains("cannot be told from"), "{evidence}");
}

/// An unbalance near the swing of the platform makes joints rattle that gravity keeps loaded in the declared
/// machine. A regression: whether joints rattle was decided on the declared machine, so that the truth itself
/// missed the recording by eight times noise, and the verdict was `unexplained`, 126 floors off.
#[test]
#[ignore = "three minutes"]
fn a_machine_that_rattles_under_what_it_lacks_is_understood() {
    let hidden = vec!["unbalance".into()];
    let trial = LegsTrial { hidden, size: 1.0, gravity: true, withheld: false, seed: 40_130 };
    let result = self_test::run(&trial).unwrap();
    println!("{} floors before, {} after", result.floors, result.worst_ratio);
    assert!(result.right, "{:?}: {:?}", result.verdict, result.found);
    assert!(result.worst_ratio < 1.3, "{} floors", result.worst_ratio);
    assert_eq!(result.values.len(), 3);
    for Estimated { name, truth, value, std } in result.values {
        let std = std.unwrap();
        assert!((value - truth).abs() < 4.0 * std, "{name}: {value} ± {std}, hidden {truth}");
    }
}

/// A model that is complete at last swings as released. A regression: it was not asked for its release where
/// a model like it was known to need kicks, kept those, and missed the recording by a quarter more than noise.
#[test]
fn a_complete_model_is_let_go_although_one_like_it_was_kicked() {
    let hidden = vec!["servo-lag".into(), "joint-wear".into()];
    let trial = LegsTrial { hidden, size: 3.0, gravity: true, withheld: false, seed: 40_701 };
    let (case, hidden) = self_test::recorded(&trial).unwrap();
    let run = &case.runs[0];
    let start = |effects: &[Setting], like: Option<&SwingStart>| {
        let machine = run.released(&case.rig, effects).unwrap();
        as_seen(&case.simulator, machine, &run.log, like, false).unwrap()
    };
    let incomplete = start(&hidden[..1], None);
    assert!(incomplete.kicks.is_some(), "the test rests on an incomplete model being kicked");
    let complete = start(&hidden, Some(&incomplete));
    assert!(complete.kicks.is_none() && complete.shown, "{:?}", complete.kicks);
}

/// A worn joint that must not be named passes for play in a drive, which a lens cannot tell from it where the
/// load does not turn. A regression: that was the verdict, although the platform swings otherwise under it
/// and its simulation missed the recording by 3.3 floors.
#[test]
#[ignore = "two minutes"]
fn what_simulations_miss_is_not_explained() {
    let hidden = vec!["joint-wear".into()];
    let trial = LegsTrial { hidden, size: 3.0, gravity: true, withheld: true, seed: 40_055 };
    let result = self_test::run(&trial).unwrap();
    println!("{} floors before, {} after", result.floors, result.worst_ratio);
    assert_eq!(result.verdict, Verdict::Unexplained, "{:?}", result.found);
    assert!(result.worst_ratio < 0.1 * result.floors, "{} floors", result.worst_ratio);
}

/// Friction in journals beside drag, whose torque takes up what of it moves the platform: what is left under drag
/// alone is noise, only that recorded joints hardly rattle. A regression: a residual that is noise ended the
/// search, friction was not found, and the drag's torque was wrong by a fifth.
#[test]
#[ignore = "two minutes"]
fn what_calms_joints_is_found_where_nothing_stands_above_noise() {
    let hidden = vec!["drag".into(), "journal-friction".into()];
    let trial = LegsTrial { hidden, size: 3.0, gravity: false, withheld: false, seed: 40_701 };
    let (case, hidden) = self_test::recorded(&trial).unwrap();
    let outcome = calibrate(&case, &[], &|_| {}).unwrap();
    assert_eq!(outcome.verdict, Verdict::Explained);
    assert_eq!(outcome.effects.len(), 2, "{:?}", outcome.effects);
    for ((found, _), hidden) in outcome.effects.iter().zip(&hidden) {
        assert!(found.is(hidden), "{found:?}");
        for ((name, found), (_, hidden)) in found.values().zip(hidden.values()) {
            println!("{name}: hidden {hidden:.4e}, found {found:.4e}");
            assert!((found - hidden).abs() < 0.02 * hidden, "{name}: {found}, not {hidden}");
        }
    }
    let evidence = evidence(&outcome, &outcome.effects[1].0);
    assert!(evidence.contains("joints rattle more than the recorded ones"), "{evidence}");
}

/// What it lacks has no name here: a table of forces stands in for it.
#[test]
fn rig_6() {
    check(6);
    assert_eq!(done(6).outcome.verdict, Verdict::Unexplained);
}

/// A method that always finds something finds nothing.
#[test]
fn one_rig_lacks_nothing() {
    let verdicts = [1, 3, 4].map(|rig| done(rig).outcome.verdict);
    assert!(verdicts.contains(&Verdict::NothingMissing), "{verdicts:?}");
}

/// Whether a machine rattles is found out: only where gravity keeps its joints loaded do two runs that
/// start alike stay alike.
#[test]
fn machines_without_gravity_rattle() {
    for rig in 1..=6 {
        let (case, rattle) = case(prepared(rig)).unwrap();
        let weightless = case.rig.environment.gravity == [0.0, 0.0];
        assert_eq!(rattle.chaotic, weightless, "rig {rig}: {}", rattle.difference);
        assert_eq!(case.replicas(), rattle.replicas);
    }
}
