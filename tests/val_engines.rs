//! The two engines hold the same physics: rapier's steps, and the equations of motion integrated directly.

mod common;

use common::{Case, Curve, SERVO, platform_error};
use freeplay::effects::{ALL, Kind, Parameter, Setting};
use freeplay::engine::{Schedule, StepControl, run, run_balanced};
use freeplay::mechanism::Mechanism;
use freeplay::model::{Machine, assemble};
use freeplay::scenario::Scenario;
use nalgebra::Vector2;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Positions of all bodies in m, row by row, and hits all in all.
struct Track {
    rows: Vec<Vec<Vector2<f64>>>,
    hits: u64,
    /// Energy that contacts took, in J.
    lost: f64,
}

fn track(mechanism: &Mechanism, control: StepControl, duration: f64, interval: f64) -> Track {
    let mut track = Track { rows: Vec::new(), hits: 0, lost: 0.0 };
    run(mechanism, control, Schedule { duration, interval }, &mut |instant| {
        track.rows.push(instant.states.iter().map(|state| state.position).collect());
        track.hits = instant.tallies.iter().map(|tally| tally.impacts).sum();
        track.lost = instant.tallies.iter().map(|tally| tally.energy).sum();
    })
    .unwrap_or_else(|halt| panic!("{control:?}: {halt}"));
    track
}

/// Largest distance in m of a body from itself in another run.
fn apart(a: &Track, b: &Track) -> f64 {
    let rows = a.rows.iter().zip(&b.rows);
    let pairs = rows.flat_map(|(a, b)| a.iter().zip(b));
    pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

fn loaded(file: &str) -> Machine {
    let path = format!("{}/assets/{file}", env!("CARGO_MANIFEST_DIR"));
    let scenario = Scenario::load(Some(Path::new(&path)), &[]).unwrap();
    assemble(&scenario).unwrap()
}

/// Machines from files beside the 3-RPR: loops, chains, play in one joint or in all, friction.
const PLANAR: [&str; 5] =
    ["slider_crank", "slider_crank_friction", "four_bar", "five_bar", "double_pendulum"];

/// Both engines follow one motion while it can be predicted. What is left between them is what the finer
/// tolerance of either changes: chaos multiplies it by e every 10 ms.
#[test]
fn both_engines_follow_the_same_motion() {
    let servo = Case { drive: SERVO, ..Case::default() };
    let cases = [Case::default(), servo, Case { gravity: -9.81, ..servo }];
    let mut machines: Vec<(String, Mechanism)> =
        cases.iter().map(|case| (format!("{case:?}"), case.mechanism())).collect();
    machines.extend(
        PLANAR.map(|name| {
            (name.to_owned(), loaded(&format!("reference/planar/{name}.toml")).mechanism)
        }),
    );
    for (name, mechanism) in &machines {
        let of = |control| track(mechanism, control, 0.05, 1e-3);
        let [rapier, direct] = [StepControl::Tolerance(1e-8), StepControl::Direct(1e-8)].map(of);
        let far = apart(&rapier, &direct);
        println!("{name}: {far:.1e} m, hits {} {}", rapier.hits, direct.hits);
        assert!(far < 1e-9, "{name}: {far:.1e} m");
        assert_eq!(rapier.hits, direct.hits, "{name}");
        assert!((rapier.lost - direct.lost).abs() <= 1e-3 * rapier.lost.abs(), "{name}");
    }
}

/// A four-bar with play in its coupler pins, and what stands in its `[contact]` and at its joint A.
fn four_bar(contact: &str, joint: &str) -> Mechanism {
    let text = format!(
        "{}\n[contact]\n{contact}\n",
        include_str!("four_bar_with_play.toml").replace("# of joint A", joint)
    );
    let scenario = Scenario::from_text(&text, "four-bar", &[]).unwrap_or_else(|p| panic!("{p}"));
    assemble(&scenario).unwrap().mechanism
}

/// What stands beside the contact law in a joint acts alike in both: rings of any profile, oil films, friction that
/// remembers; and both count the same rubbing.
#[test]
fn rings_films_and_bristles_act_alike_in_both() {
    let profile = "profile = [0.0, 4e-5, -3e-5, 6e-5, 1e-5, -2e-5, 5e-5, 0.0]";
    let oil = "viscosity = 0.02\nlength = 0.01\nfilm_eccentricity_max = 0.8";
    let cases = [
        ("profile", four_bar("", profile)),
        ("squeeze", four_bar(&format!("film = \"squeeze\"\n{oil}"), "")),
        ("short bearing", four_bar(&format!("film = \"short-bearing\"\n{oil}"), profile)),
        ("bristles", four_bar("friction_law = \"lugre\"", "friction = 0.1")),
        (
            "bristles under a law that remembers",
            four_bar("friction_law = \"lugre\"\nlaw = \"flores\"", "friction = 0.1"),
        ),
    ];
    for (name, mechanism) in &cases {
        let of = |control| {
            let track = track(mechanism, control, 0.02, 1e-3);
            let schedule = Schedule { duration: 0.02, interval: 1e-3 };
            let never = AtomicBool::new(false);
            let work = run_balanced(mechanism, control, schedule, &never, &mut |_| {
                ControlFlow::Continue(())
            })
            .unwrap();
            let rubbed = work.rubbed.unwrap();
            (track, rubbed.iter().map(|around| around.iter().sum::<f64>()).collect::<Vec<_>>())
        };
        let [(a, rubbed), (b, again)] =
            [StepControl::Tolerance(1e-7), StepControl::Direct(1e-7)].map(of);
        let far = apart(&a, &b);
        println!("{name}: {far:.1e} m, hits {} {}, rubbed {rubbed:?} {again:?}", a.hits, b.hits);
        assert!(a.hits > 0, "{name}");
        assert!(far < 1e-7, "{name}: {far:.1e} m");
        for (a, b) in rubbed.iter().zip(&again) {
            assert!((a - b).abs() <= 0.01 * b + 1e-9, "{name}: {a} {b}");
        }
    }
}

/// Against the curves of an independent solver, at a tolerance from coarse to tight.
#[test]
fn the_error_falls_with_the_tolerance() {
    for (drive, file) in
        [(Case::default().drive, "prescribed_c5e-4.csv"), (SERVO, "servo_c5e-4.csv")]
    {
        let mechanism = Case { drive, ..Case::default() }.mechanism();
        let curve = Curve::read(file);
        let error =
            |tolerance| platform_error(&mechanism, StepControl::Direct(tolerance), &curve, 0.05).0;
        for (tolerance, most) in [(1e-4, 2e-6), (1e-5, 2e-7), (1e-6, 2e-8), (1e-7, 5e-9)] {
            let found = error(tolerance);
            println!("{file} {tolerance:.0e}: {found:.1e}");
            assert!(found < most, "{file} at {tolerance:.0e}: {found:.1e} m");
        }
    }
}

/// An effect on the first target that it has on a machine, at the last values that a search begins with; where
/// there are none, a step from those that change nothing.
fn begun(kind: &'static Kind, mechanism: &Mechanism) -> Option<Setting> {
    let target = kind.targets_of(mechanism).into_iter().next()?;
    if kind.name == "unnamed" {
        return None;
    }
    if let Some(variant) = kind.variants_of(mechanism, &target).into_iter().next() {
        let zeros: Vec<_> = variant.iter().map(|name| (*name, 0.0)).collect();
        let setting = Setting::on(kind, target.clone(), &zeros);
        if let Some(start) = setting.starts(mechanism).last() {
            return Some(setting.with(start));
        }
    }
    let stepped = |p: &Parameter| {
        (p.name, (p.default.unwrap_or(0.0) + p.step).clamp(p.bounds[0], p.bounds[1]))
    };
    let values: Vec<_> = kind.parameters.iter().map(stepped).collect();
    Some(Setting::on(kind, target, &values))
}

/// Machines of every sort that effects act on: with clearance and without, driven and free, with sensors.
const MACHINES: [&str; 8] = [
    "default.toml",
    "reference/planar/slider_crank.toml",
    "drive-stage.toml",
    "pendulum.toml",
    "two-link-arm-declared.toml",
    "double-pendulum-declared.toml",
    "rigs-planar/planar-1/rig.toml",
    "mechanisms/slider-crank.toml",
];

/// Every effect of the catalogue, at the values that a search for it begins with, on every sort of machine
/// that it can act on: it does the same in both.
#[test]
fn every_effect_acts_alike_in_both() {
    let mut tried = std::collections::BTreeSet::new();
    for file in MACHINES {
        let machine = loaded(file);
        for kind in ALL {
            let Some(setting) = begun(kind, &machine.mechanism) else { continue };
            let mut mechanism = machine.mechanism.clone();
            setting.apply(&mut mechanism).unwrap_or_else(|wrong| panic!("{setting}: {wrong:?}"));
            mechanism.close(0.0).unwrap();
            let of = |control| track(&mechanism, control, 0.01, 1e-3);
            let [rapier, direct] =
                [StepControl::Tolerance(1e-7), StepControl::Direct(1e-7)].map(of);
            let far = apart(&rapier, &direct);
            println!("{file} {setting}: {far:.1e}");
            assert!(far < 1e-8, "{file} {setting}: {far:.1e} m");
            tried.insert(kind.name);
        }
    }
    let left: Vec<_> =
        ALL.iter().map(|kind| kind.name).filter(|name| !tried.contains(name)).collect();
    // Acts through a table that a calibration makes.
    assert_eq!(left, ["unnamed"]);
}
