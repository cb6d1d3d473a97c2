//! The drive stage of the EMPS recordings: what its declared model lacks, found one effect after another
//! on one recording and judged on another.

use super::Table;
use crate::identify::Missing;
use crate::identify::inverse::{Model, Motion, Term};
use crate::identify::stage::{PITCH, halves, simulated_force, stage};
use std::ops::Range;

pub use crate::identify::stage::Recording;

/// The machine, its drive and the columns of its recordings, as a scenario.
pub const RIG: &str = include_str!("../../../assets/drive-stage.toml");

/// Declared: moved mass in kg and viscous friction in N·s/m, as published.
pub const DECLARED: [f64; 2] = [95.1089, 203.50];

/// Speeds v_f in m/s that are tried for friction which builds up.
const FILM_SPEEDS: [f64; 8] = [2e-3, 4e-3, 6e-3, 8e-3, 1e-2, 1.4e-2, 2e-2, 3e-2];

/// A model and how far off it is: shares of the norm of the recorded force.
#[derive(Clone, Debug)]
pub struct Step {
    /// What was added.
    pub name: &'static str,
    /// Where its trace was seen.
    pub trace: &'static str,
    /// The model with everything so far, fitted to the training recording.
    pub model: Model,
    /// Inverse model on the training recording, and each half of it by the model of the other half.
    pub train: f64,
    /// See `train`; none of a declared model.
    pub halves: Option<[f64; 2]>,
    /// Inverse model of the training recording on the pulses.
    pub pulses: f64,
    /// Force of the simulated closed loop: training recording, pulses.
    pub simulated: [f64; 2],
}

/// What of the last model was identified anew on the first half of the pulses.
#[derive(Clone, Debug)]
pub struct Carried {
    /// That model.
    pub model: Model,
    /// Error on the second half, before and after; inverse model.
    pub inverse: [f64; 2],
    /// The same, closed loop.
    pub simulated: [f64; 2],
}

/// What the study comes to.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Step by step.
    pub steps: Vec<Step>,
    /// The pulses.
    pub carried: Carried,
}

fn unfit() -> Missing {
    Missing::Wrong("the recording does not tell the model's terms apart: does it move?".to_owned())
}

/// Terms of each step.
fn plan(film: f64) -> [(&'static str, &'static str, Vec<Term>); 5] {
    let symmetric = vec![Term::Mass, Term::Viscous, Term::Coulomb, Term::Offset];
    let asymmetric = vec![
        Term::Mass,
        Term::ViscousWay(true),
        Term::ViscousWay(false),
        Term::CoulombWay(true),
        Term::CoulombWay(false),
    ];
    let lag = [asymmetric.clone(), vec![Term::Lag]].concat();
    let film = [lag.clone(), vec![Term::Film(film)]].concat();
    let ripple = [film.clone(), [true, false].map(|s| Term::Ripple(PITCH, s)).to_vec()].concat();
    [
        ("dry friction and an offset", "a force with the sign of the speed", symmetric),
        ("friction that differs with direction", "error grows with speed, one way", asymmetric),
        ("lag of the drive", "error with the jerk, at 10 to 35 Hz", lag),
        ("friction that builds up with speed", "error below 20 mm/s, against the motion", film),
        ("ripple of the screw", "error periodic in position, 2.5 mm", ripple),
    ]
}

/// Does the study.
///
/// # Errors
/// Recordings that cannot be used.
pub fn study(train: &Recording, pulses: &Recording) -> Result<Outcome, Missing> {
    let (rows, other) = (train.motion.rows(), pulses.motion.rows());
    let fit = |motion: &Motion, rows: Range<usize>, terms: &[Term]| {
        Model::fit(motion, rows, terms, &[]).ok_or_else(unfit)
    };
    let step = |name, trace, model: Model, halves| -> Result<Step, Missing> {
        let mut simulated = [0.0; 2];
        for (error, recording) in simulated.iter_mut().zip([train, pulses]) {
            let force = simulated_force(&stage(&model, recording)?, recording)?;
            *error = recording.motion.relative_error(&force, recording.motion.rows());
        }
        let (train, pulses) =
            (model.error(&train.motion, rows.clone()), model.error(&pulses.motion, other.clone()));
        Ok(Step { name, trace, model, train, halves, pulses, simulated })
    };
    let declared = Model { terms: [Term::Mass, Term::Viscous].into_iter().zip(DECLARED).collect() };
    let mut steps = vec![step("declared: mass and viscous friction", "", declared, None)?];

    let mut film = (f64::INFINITY, FILM_SPEEDS[0]);
    for speed in FILM_SPEEDS {
        let [.., (_, _, terms), _] = plan(speed);
        let error = fit(&train.motion, rows.clone(), &terms)?.error(&train.motion, rows.clone());
        if error < film.0 {
            film = (error, speed);
        }
    }
    for (name, trace, terms) in plan(film.1) {
        let [first, second] = halves(&rows);
        let by_first = fit(&train.motion, first.clone(), &terms)?;
        let by_second = fit(&train.motion, second.clone(), &terms)?;
        let halves = [by_second.error(&train.motion, first), by_first.error(&train.motion, second)];
        steps.push(step(name, trace, fit(&train.motion, rows.clone(), &terms)?, Some(halves))?);
    }

    let last = steps.last().map(|step| step.model.clone()).ok_or_else(unfit)?;
    let carried = carry(&last, pulses)?;
    Ok(Outcome { steps, carried })
}

/// Identifies anew on the first half of the pulses what need not be the same on another day: the phase
/// of the screw (where the encoder's zero is), the lag (felt more by pulses), the dry friction.
fn carry(model: &Model, pulses: &Recording) -> Result<Carried, Missing> {
    let anew = |term: &Term| matches!(term, Term::Lag | Term::Ripple(..));
    let (free, fixed): (Vec<_>, Vec<_>) =
        model.terms.iter().copied().partition(|(term, _)| anew(term));
    let free: Vec<Term> = free.into_iter().map(|(term, _)| term).collect();
    let [first, second] = halves(&pulses.motion.rows());
    let again = Model::fit(&pulses.motion, first, &free, &fixed).ok_or_else(unfit)?;
    let mut carried = Carried { model: again.clone(), inverse: [0.0; 2], simulated: [0.0; 2] };
    for (k, model) in [model, &again].into_iter().enumerate() {
        carried.inverse[k] = model.error(&pulses.motion, second.clone());
        let force = simulated_force(&stage(model, pulses)?, pulses)?;
        carried.simulated[k] = pulses.motion.relative_error(&force, second.clone());
    }
    Ok(carried)
}

/// A share in percent with two decimals.
fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

/// Published relative errors of the force: symmetric on both recordings, asymmetric on the first.
const PUBLISHED: [(&str, &str); 2] = [("4.083 %", "5.982 %"), ("3.112 %", "")];

impl Outcome {
    /// The result in words.
    pub fn lead(&self) -> String {
        let [_, symmetric, .., last] = &self.steps[..] else { return String::new() };
        format!(
            "The force of the drive is explained to {} where dry friction alone leaves {} (each half by \
             the other: {}); on another recording with pulses, without anything identified anew, to {} \
             where it leaves {}.",
            percent(last.train),
            percent(symmetric.train),
            last.halves.map_or(String::new(), |halves| halves.map(percent).join(" and ")),
            percent(last.pulses),
            percent(symmetric.pulses),
        )
    }

    /// What pointed to each effect.
    pub fn traces(&self) -> Table {
        let rows = self.steps[1..].iter().map(|s| vec![s.name.to_owned(), s.trace.to_owned()]);
        Table { header: ["effect", "trace"].map(str::to_owned).to_vec(), rows: rows.collect() }
    }

    /// Errors on the second half of the pulses.
    pub fn second_half(&self) -> Table {
        let Carried { inverse, simulated, .. } = &self.carried;
        let row = |name: &str, k: usize| {
            vec![name.to_owned(), percent(inverse[k]), percent(simulated[k])]
        };
        Table {
            header: ["model", "inverse model", "simulated"].map(str::to_owned).to_vec(),
            rows: vec![row("carried over as it is", 0), row("phase of the screw and lag anew", 1)],
        }
    }

    /// Errors step by step.
    pub fn table(&self) -> Table {
        let header = [
            "model",
            "training recording, inverse model",
            "each half by the other",
            "published",
            "training recording, simulated",
            "pulses, inverse model",
            "published",
            "pulses, simulated",
        ];
        let rows = self.steps.iter().enumerate().map(|(i, step)| {
            let published = i.checked_sub(1).and_then(|i| PUBLISHED.get(i)).unwrap_or(&("", ""));
            let halves =
                step.halves.map_or(String::new(), |halves| halves.map(percent).join(" / "));
            let name = if i == 0 { step.name.to_owned() } else { format!("+ {}", step.name) };
            vec![
                name,
                percent(step.train),
                halves,
                published.0.to_owned(),
                percent(step.simulated[0]),
                percent(step.pulses),
                published.1.to_owned(),
                percent(step.simulated[1]),
            ]
        });
        Table { header: header.map(str::to_owned).to_vec(), rows: rows.collect() }
    }

    /// Parameters of the last model, and of the pulses.
    pub fn parameters(&self) -> Table {
        let Some(last) = self.steps.last() else {
            return Table { header: Vec::new(), rows: Vec::new() };
        };
        let rows = last.model.terms.iter().map(|(term, factor)| {
            let there = self.carried.model.factor(*term);
            let how = if there == *factor { "carried over" } else { "anew, first half" };
            let (name, unit, scale) = named_term(*term, last.model.factor(Term::Mass));
            vec![
                name,
                format!("{:.4} {unit}", factor * scale),
                format!("{:.4} {unit}", there * scale),
                how.to_owned(),
            ]
        });
        Table {
            header: ["parameter", "training recording", "pulses", ""].map(str::to_owned).to_vec(),
            rows: rows.collect(),
        }
    }
}

/// A term in words, the unit of its factor, and what the factor is to be multiplied by for it.
fn named_term(term: Term, mass: f64) -> (String, &'static str, f64) {
    let way = |outward: bool| if outward { "outward" } else { "inward" };
    match term {
        Term::Mass => ("moved mass".to_owned(), "kg", 1.0),
        Term::Lag => {
            ("lag of the force, half a sample of it by holding".to_owned(), "ms", 1e3 / mass)
        }
        Term::Offset => ("offset".to_owned(), "N", 1.0),
        Term::Viscous => ("viscous friction".to_owned(), "N s/m", 1.0),
        Term::ViscousWay(outward) => (format!("viscous friction {}", way(outward)), "N s/m", 1.0),
        Term::Coulomb => ("dry friction".to_owned(), "N", 1.0),
        Term::CoulombWay(outward) => (format!("dry friction {}", way(outward)), "N", 1.0),
        Term::Film(speed) => {
            (format!("friction that builds up over {} mm/s", 1e3 * speed), "N", 1.0)
        }
        Term::Stribeck(speed) => {
            (format!("friction that falls over {} mm/s", 1e3 * speed), "N", 1.0)
        }
        Term::Drag => ("drag".to_owned(), "N s²/m²", 1.0),
        Term::Ripple(_, sine) => {
            (format!("ripple of the screw, {}", if sine { "sine" } else { "cosine" }), "N", 1.0)
        }
    }
}
