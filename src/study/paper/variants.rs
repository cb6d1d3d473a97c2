//! What the study varies: clearances, starts, and everything that the paper leaves open.

use crate::scenario::{Law, Mechanism, Motion, PerJoint, Problem, Problems, Scenario, Source};
use crate::simulate::{Machine, Severity, assemble, findings};
use crate::study::StudyError;
use crate::study::compare::SAMPLE_INTERVAL;
use nalgebra::{Rotation2, Vector2};
use std::f64::consts::TAU;

/// The clearance of the paper's machine in m.
pub const LARGE: f64 = 5e-4;

/// The smallest clearance of the paper in m, 0.00001 mm.
pub const SMALL: f64 = 1e-8;

/// The clearances of the study in m, smallest first: the paper's two, and three between them.
pub const CLEARANCES: [f64; 5] = [SMALL, 1e-6, 1e-5, 1e-4, LARGE];

/// One choice of what the paper leaves open.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Name in `paper.json`.
    pub key: &'static str,
    /// What it is in words.
    pub label: &'static str,
    /// What it sets in the scenario, as `--set` takes it.
    pub sets: Vec<String>,
}

/// The scenario as it stands first, then one change at a time.
///
/// The line takes 0.1 m through the middle at constant velocity, in 1 s or in `duration` s if that is
/// more: the path stays within the stroke. At π/3 and π/2 the legs are nearly at their end in the middle
/// already; only smaller circles stay within their 0.4 m.
pub fn variants(duration: f64) -> Vec<Variant> {
    let velocity = 0.1 / duration.max(1.0);
    let line = format!("motion.velocity=[{velocity:?},0]");
    let table: [(&str, &str, &[&str]); 13] = [
        ("assumed", "the assumed values", &[]),
        (
            "adams-damping",
            "ADAMS' default damping: C_max = 1e4 N·s/m, d_max = 1e-4 m",
            &["contact.c_max=1e4", "contact.d_max=1e-4"],
        ),
        ("light-damping", "C_max = 100 N·s/m", &["contact.c_max=100"]),
        ("heavy-damping", "C_max = 2000 N·s/m", &["contact.c_max=2000"]),
        ("pulling", "eq. 4 as printed: contacts may pull", &["contact.clip=false"]),
        (
            "line",
            "a straight line at constant velocity, 0.1 m/s",
            &["motion.kind=line", "motion.start=[-0.05,0]", &line],
        ),
        (
            "small-circle",
            "a circle of half the radius, 25 mm",
            &["motion.kind=circle", "motion.radius=0.025"],
        ),
        (
            "fast-circle",
            "a circle in half the time, 0.5 s",
            &["motion.kind=circle", "motion.period=0.5"],
        ),
        ("phi-15", "phi = π/12", &["motion.phi=0.2617993877991494"]),
        (
            "phi-60",
            "phi = π/3, a circle of 25 mm",
            &["motion.kind=circle", "motion.radius=0.025", "motion.phi=1.0471975511965976"],
        ),
        (
            "phi-90",
            "phi = π/2, a circle of 10 mm",
            &["motion.kind=circle", "motion.radius=0.01", "motion.phi=1.5707963267948966"],
        ),
        ("gravity", "gravity along −y", &["environment.gravity=[0,-9.81]"]),
        (
            "thick-bars",
            "bars of 1.5 times the diameter, 2.25 times the mass",
            &["legs.cylinder_diameter=0.03", "legs.rod_diameter=0.018"],
        ),
    ];
    let owned = |sets: &[&str]| sets.iter().map(|&set| set.to_owned()).collect();
    table.map(|(key, label, sets)| Variant { key, label, sets: owned(sets) }).into()
}

/// The scenarios of all variants, each checked from all its starts, on top of what the user set.
///
/// # Errors
/// What is wrong with the text, with the overrides, or with a variant on top of them.
pub fn scenarios(
    source: &Source,
    sets: &[String],
    starts: usize,
) -> Result<Vec<(Variant, Scenario)>, StudyError> {
    let base = source.scenario(sets)?;
    if !matches!(base.mechanism, Mechanism::ThreeRpr(_)) {
        let help =
            "expected \"3rpr\", the paper's machine: its figures and claims are about no other";
        return Err(base.problem("mechanism.kind", "is not the paper's machine", help).into());
    }
    if !matches!(base.motion, Motion::Circle(_) | Motion::Line(_)) {
        let help = "expected \"circle\" or \"line\": statistics are taken over starts around a \
                    circle, or over directions of a line";
        return Err(base.problem("motion.kind", "does not suit the paper's study", help).into());
    }
    let help = format!("the study sets it to {}", CLEARANCES.map(|c| format!("{c:e}")).join(", "));
    if (0..base.mechanism.revolute_names().len()).any(|joint| base.clearance(joint) != LARGE) {
        return Err(base
            .problem("joints.clearance", "is not for the user to choose here", help)
            .into());
    }
    variants(base.simulation.duration)
        .into_iter()
        .map(|variant| {
            let kept = sets.iter().filter(|set| suits(set, &variant, &base.motion));
            let all: Vec<String> = kept.chain(&variant.sets).cloned().collect();
            let mut scenario = source.scenario(&all)?;
            scenario.contact.law = Law::HertzStep;
            for start in 0..starts {
                let started = started(&scenario, LARGE, start, starts);
                let found = findings(&started, &mut assemble(&started)?);
                if let Some(error) = found.into_iter().find(|f| f.severity == Severity::Error) {
                    return Err(in_variant(&variant, error.problem).into());
                }
            }
            Ok((variant, scenario))
        })
        .collect()
}

/// Whether something that the user set has a meaning in a variant: one with another kind of motion
/// knows none of the keys of the scenario's own, but the angle.
fn suits(set: &str, variant: &Variant, motion: &Motion) -> bool {
    let kind = if matches!(motion, Motion::Line(_)) { "line" } else { "circle" };
    let chosen = variant.sets.iter().find_map(|set| set.strip_prefix("motion.kind="));
    chosen.is_none_or(|chosen| chosen == kind)
        || !set.starts_with("motion.")
        || set.starts_with("motion.phi=")
}

/// A complaint about a variant names it.
fn in_variant(variant: &Variant, problem: Problem) -> Problems {
    let message = if variant.sets.is_empty() {
        problem.message
    } else {
        format!("{} (in the study's variant `{}`)", problem.message, variant.key)
    };
    Problem { message, ..problem }.into()
}

/// A scenario at start `start` of `starts`, all joints with one clearance in m. A circle begins at
/// `starts` points around it, a line runs in `starts` directions through the origin: both are the
/// same motion to a reader of the paper.
fn started(scenario: &Scenario, clearance: f64, start: usize, starts: usize) -> Scenario {
    let mut scenario = scenario.clone();
    scenario.joints.clearance = Some(PerJoint::all(clearance));
    scenario.simulation.output_interval = SAMPLE_INTERVAL;
    let turn = TAU * start as f64 / starts as f64;
    match &mut scenario.motion {
        Motion::Circle(circle) => circle.phase += turn,
        Motion::Line(line) => {
            let turned = |v: [f64; 2]| (Rotation2::new(turn) * Vector2::from(v)).into();
            (line.start, line.velocity) = (turned(line.start), turned(line.velocity));
        }
        // Refused in `scenarios`.
        _ => {}
    }
    scenario
}

/// The machine of [`started`].
///
/// # Errors
/// A motion table that cannot be read.
pub fn machine(
    scenario: &Scenario,
    clearance: f64,
    start: usize,
    starts: usize,
) -> Result<Machine, Problem> {
    assemble(&started(scenario, clearance, start, starts))
}
