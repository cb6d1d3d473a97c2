//! Oil films in joints: the load that a turning journal carries at rest, and how long one is squeezed out, against the
//! closed forms of short bearings (G. B. DuBois, F. W. Ocvirk, NACA Report 1157 (1953); J. F. Booker, J. Basic Eng. 87
//! (1965) 537–546). What the film itself pushes is tested against them and against Reynolds' integral beside it.

mod cli_common;

use cli_common::Place;
use freeplay::engine::{Schedule, StepControl, run};
use freeplay::mechanism::Mechanism;
use freeplay::model::assemble;
use freeplay::scenario::Scenario;
use std::f64::consts::PI;

const RADIUS: f64 = 0.02;
const LENGTH: f64 = 0.02;
const CLEARANCE: f64 = 1e-4;
const SPIN: f64 = 200.0;
/// From here on films grow no stiffer: beyond all that is asked for, and steps stay long.
const MOST: f64 = 0.9;

/// A disc of a mass (kg) on oil of a viscosity (Pa s) in a ring at rest, under its weight (N) and a drive that turns it.
fn journal(film: &str, [viscosity, mass]: [f64; 2], weight: f64, spin: f64) -> Mechanism {
    let text = format!(
        "[environment]\ngravity = [0.0, {}]\n[ground.points]\nO = [0.0, 0.0]\n\
         [[body]]\nname = \"disc\"\nmass = {mass}\ninertia = 2e-4\npoints = {{ O = [0.0, 0.0] }}\n\
         [[joint]]\nname = \"O\"\nkind = \"revolute\"\nring = \"ground.O\"\njournal = \"disc.O\"\n\
         clearance = {CLEARANCE:e}\nbearing_radius = {RADIUS}\n\
         [motion]\njoint = \"O\"\nkind = \"line\"\nvelocity = {spin}\n\
         [contact]\nfilm = \"{film}\"\nviscosity = {viscosity}\nlength = {LENGTH}\nfilm_eccentricity_max = {MOST}\n",
        -weight / mass
    );
    let scenario = Scenario::from_text(&text, "film", &[]).unwrap_or_else(|p| panic!("{p}"));
    assemble(&scenario).unwrap().mechanism
}

const BOTH: [StepControl; 2] = [StepControl::Tolerance(1e-6), StepControl::Direct(1e-6)];

/// Where the journal lies after a time, as ε and as the angle behind the load.
fn rest(mechanism: &Mechanism, control: StepControl, duration: f64) -> [f64; 2] {
    let mut last = [0.0; 2];
    run(mechanism, control, Schedule { duration, interval: duration }, &mut |instant| {
        let e = instant.evaluation.contacts[0].eccentricity;
        last = [e.norm() / CLEARANCE, e.x.atan2(-e.y)];
    })
    .unwrap();
    last
}

#[test]
fn a_turning_journal_rests_where_ocvirk_says() {
    let (viscosity, mass) = (0.005, 1.0);
    for ratio in [0.5f64, 0.7, 0.85] {
        let square = ratio * ratio;
        let load = viscosity * SPIN * RADIUS * LENGTH.powi(3) * ratio
            / (4.0 * CLEARANCE.powi(2) * (1.0 - square).powi(2))
            * (16.0 * square + PI * PI * (1.0 - square)).sqrt();
        let attitude = (PI * (1.0 - square).sqrt() / (4.0 * ratio)).atan();
        let mechanism = journal("short-bearing", [viscosity, mass], load, SPIN);
        for control in BOTH {
            let [found, behind] = rest(&mechanism, control, 0.5);
            assert!((found - ratio).abs() < 1e-5, "{control:?}: {found}, expected {ratio}");
            assert!((behind - attitude).abs() < 1e-4, "{control:?}: {behind}, expected {attitude}");
        }
    }
}

/// A full film under a constant load, by momentum: `W t = m v + ∫ C (1 + 2ε²)/(1 − ε²)^(5/2) c dε`, and the integral is
/// `C c ε/(1 − ε²)^(3/2)`. The momentum is a thousandth of it.
#[test]
fn a_journal_at_rest_is_squeezed_out_in_bookers_time() {
    let (viscosity, mass, load) = (0.05, 10.0, 10.0);
    let damping = PI * viscosity * RADIUS * (LENGTH / CLEARANCE).powi(3);
    let mechanism = journal("squeeze", [viscosity, mass], load, 0.0);
    for control in BOTH {
        let schedule = Schedule { duration: 0.3, interval: 0.1 };
        let mut looks = 0;
        run(&mechanism, control, schedule, &mut |instant| {
            let ratio = instant.evaluation.contacts[0].eccentricity.norm() / CLEARANCE;
            let momentum = -mass * instant.states[0].twist.y;
            let squeezed = damping * CLEARANCE * ratio / (1.0 - ratio * ratio).powf(1.5);
            if instant.t > 0.0 {
                let sum = (momentum + squeezed) / (load * instant.t);
                assert!((sum - 1.0).abs() < 1e-5, "{control:?}: {sum} at ε = {ratio}");
                looks += 1;
            }
        })
        .unwrap();
        assert_eq!(looks, 3);
    }
}

#[test]
fn a_film_softens_the_hit_that_it_cannot_prevent() {
    let peak = |film: &str, viscosity: f64| {
        let place = Place::new();
        let set = format!("--set contact.film={film} --set contact.viscosity={viscosity}");
        let line =
            format!("run --duration 0.05 --set simulation.settle=0 {set} --quiet --json --out r");
        let summary: serde_json::Value = serde_json::from_str(&place.good(&line)).unwrap();
        summary["peak_contact_force_N"].as_f64().unwrap()
    };
    let place = Place::new();
    let dry = "run --duration 0.05 --set simulation.settle=0 --quiet --json --out r";
    let dry: serde_json::Value = serde_json::from_str(&place.good(dry)).unwrap();
    let dry = dry["peak_contact_force_N"].as_f64().unwrap();
    let thin = peak("squeeze", 1e-10);
    assert!((thin / dry - 1.0).abs() < 0.05, "{thin} {dry}");
    let thick = peak("short-bearing", 0.02);
    assert!(thick < 0.7 * dry, "{thick} {dry}");
}

#[test]
fn films_that_cannot_be_are_told() {
    let place = Place::new();
    let film = "run --duration 0.001 --set contact.film=squeeze --out r";
    place.refused(film, &["contact.film: needs the oil's viscosity", "Pa s"]);
    place.refused(&format!("{film} --set contact.viscosity=0"), &["contact.viscosity: is 0"]);
    place.refused("run --set contact.viscosity=0.1", &["means nothing without an oil film"]);
    let most = "--set contact.viscosity=0.1 --set contact.film_eccentricity_max=1.5";
    place.refused(&format!("{film} {most}"), &["is 1.5", "above 0 and below 1"]);
    let native = "--set contact.viscosity=0.1 --set contact.law=native";
    place.refused(&format!("{film} {native}"), &["not possible under the law \"native\""]);
    let told = |line: &str| {
        let done = place.freeplay(line);
        done.out + &done.err
    };
    // A thick oil in a thin gap: a full film would have to pull with more than a bar.
    let told_full = told("check --set contact.film=squeeze --set contact.viscosity=1");
    assert!(told_full.contains("cavitates"), "{told_full}");
    let told_short = told("check --set contact.film=short-bearing --set contact.viscosity=1");
    assert!(!told_short.contains("cavitates"), "{told_short}");
    let long = "check --set contact.film=short-bearing --set contact.viscosity=0.1 --set contact.length=0.05";
    let told_long = told(long);
    assert!(told_long.contains("2.50 times as long as wide"), "{told_long}");
}
