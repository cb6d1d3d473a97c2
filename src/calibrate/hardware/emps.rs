//! The drive stage of the EMPS recordings: what its declared model lacks, found one effect after another on one
//! recording and judged on another, by the way of every machine that sampled controllers hold
//! ([`held`](crate::calibrate::sensed::held)).

use super::{Missing, ResultsTable};
use crate::calibrate::results::result::control;
use crate::calibrate::sensed::held::bench::HeldBench;
use crate::calibrate::sensed::held::candidates::of_declared;
use crate::calibrate::sensed::held::model::{HeldModel, share};
use crate::calibrate::sensed::held::plausible;
use crate::calibrate::sensed::held::terms::{HeldTerm, WAYS};
use crate::calibrate::sensed::recording::Recording;
use crate::calibrate::sensed::thresholds::BUILDS_UP;
use crate::model::parts_of;
use crate::report::number;
use crate::scenario::Scenario;
use std::ops::Range;
use std::path::Path;

/// The machine as its authors declare it, its drive and the columns of its recordings, as a scenario: moved mass and
/// viscous friction.
pub const RIG: &str = include_str!("../../../assets/drive-stage-declared.toml");

/// Pitch of the ball screw in m (README of the data).
const PITCH: f64 = 2.5e-3;

/// Places of both recordings in a bench.
const TRAIN: usize = 0;
const PULSES: usize = 1;

/// Reads a recording of a rig.
///
/// # Errors
/// A file that is not there or not what it should be.
pub fn read(path: &Path, rig: &Scenario) -> Result<Recording, Missing> {
    if !path.is_file() {
        return Err(Missing::Absent(path.to_owned()));
    }
    let machine = parts_of(rig).map_err(wrong)?;
    let recording = Recording::read_with_time(path, &machine.sensors, false, rig.time_column())?;
    match plausible::wrong(rig, &machine, &recording).into_iter().next() {
        Some(first) => Err(Missing::Wrong(first)),
        None => Ok(recording),
    }
}

fn wrong(error: impl std::fmt::Display) -> Missing {
    Missing::Wrong(error.to_string())
}

/// A model and how far off it is: shares of the norm of the recorded force.
#[derive(Clone, Debug)]
pub struct StageModel {
    /// What was added.
    pub name: &'static str,
    /// Where its trace was seen.
    pub trace: &'static str,
    /// The model with everything so far, fitted to the training recording.
    pub model: HeldModel,
    /// Inverse model on the training recording, and each half of it by the model of the other half.
    pub train: f64,
    /// See `train`; none of a declared model.
    pub halves: Option<[f64; 2]>,
    /// Inverse model of the training recording on the pulses.
    pub pulses: f64,
    /// Force of the simulated closed loop: training recording, pulses.
    pub simulated: [f64; 2],
    /// What it leaves of the force of the training recording in N, with the time in s.
    pub left: Vec<(f64, f64)>,
}

impl StageModel {
    /// A value of the model by its name; none where it has none.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.model.terms.iter().find(|(term, _)| term.sought == name).map(|(_, value)| *value)
    }
}

/// What of the last model was identified anew on the first half of the pulses.
#[derive(Clone, Debug)]
pub struct Carried {
    /// That model.
    pub model: HeldModel,
    /// Error on the second half, before and after; inverse model.
    pub inverse: [f64; 2],
    /// The same, closed loop.
    pub simulated: [f64; 2],
}

/// What the study comes to.
#[derive(Clone, Debug)]
pub struct StageOutcome {
    /// Step by step.
    pub steps: Vec<StageModel>,
    /// The pulses.
    pub carried: Carried,
}

fn unfit() -> Missing {
    Missing::Wrong("the recording does not tell the model's terms apart: does it move?".to_owned())
}

/// The stage with both recordings: as published, the force acting at once; and as the drive gives it, held from sample
/// to sample.
struct RecordedStage {
    at_once: HeldBench,
    held: HeldBench,
    joint: String,
}

/// A model's terms, and whether the drive gives its force at once.
type StagePlan = (&'static str, &'static str, Vec<HeldTerm>, bool);

impl RecordedStage {
    /// A term that every machine has, by the name of its value.
    fn common(&self, name: &str) -> Vec<HeldTerm> {
        self.held.common().into_iter().filter(|term| term.sought == name).collect()
    }

    /// Terms of each step, friction building up over some speed in m/s.
    fn plan(&self, film: f64) -> [StagePlan; 5] {
        let mass = self.common("mass_kg");
        let friction = |names: &[&'static str]| self.held.friction(&self.joint, names);
        let symmetric =
            [mass.clone(), friction(&["viscous_Ns_m", "coulomb_N", "offset_N"])].concat();
        let asymmetric = [mass, friction(&WAYS)].concat();
        let lag = [asymmetric.clone(), self.common("lag_s")].concat();
        let film = [lag.clone(), self.held.over("film-friction", &self.joint, film)].concat();
        let ripple = [film.clone(), self.held.ripple(&self.joint, PITCH)].concat();
        [
            ("dry friction and an offset", "a force with the sign of the speed", symmetric, true),
            (
                "friction that differs with direction",
                "error grows with speed, one way",
                asymmetric,
                true,
            ),
            ("lag of the drive", "error with the jerk, at 10 to 35 Hz", lag, false),
            (
                "friction that builds up with speed",
                "error below 20 mm/s, against the motion",
                film,
                false,
            ),
            ("ripple of the screw", "error periodic in position, 2.5 mm", ripple, false),
        ]
    }

    fn bench(&self, at_once: bool) -> &HeldBench {
        if at_once { &self.at_once } else { &self.held }
    }

    /// A step, judged.
    fn step(
        &self,
        plan: &StagePlan,
        model: HeldModel,
        halves: Option<[f64; 2]>,
    ) -> Result<StageModel, Missing> {
        let (name, trace, _, at_once) = *plan;
        let bench = self.bench(at_once);
        let error = |run| model.error(bench, run, bench.rows(run));
        let settings = model.settings();
        let simulated = |run| {
            let missed = bench.missed(run, &bench.simulated(run, &settings).map_err(wrong)?);
            Ok::<f64, Missing>(share(&missed, bench.asked(run)))
        };
        let (_, size) = bench.first_output();
        let left = model.left(bench, TRAIN).into_iter().enumerate();
        let left = left.map(|(place, left)| (bench.time(TRAIN, place), left * size)).collect();
        Ok(StageModel {
            name,
            trace,
            train: error(TRAIN),
            halves,
            pulses: error(PULSES),
            simulated: [simulated(TRAIN)?, simulated(PULSES)?],
            left,
            model,
        })
    }
}

/// Does the study; `tell` hears what is being done.
///
/// # Errors
/// Recordings that cannot be used.
pub fn study(
    rig: &Scenario,
    recordings: &[Recording; 2],
    tell: &dyn Fn(&str),
) -> Result<StageOutcome, Missing> {
    let bench =
        |at_once| HeldBench::new(rig, recordings.to_vec(), control(rig), at_once).map_err(wrong);
    let (at_once, held) = (bench(true)?, bench(false)?);
    let joint = held.machine.actuators.first().ok_or_else(unfit)?.name.clone();
    let stage = RecordedStage { at_once, held, joint };
    let fit = |bench: &HeldBench, rows: Range<usize>, terms: &[HeldTerm]| {
        HeldModel::fit(bench, TRAIN, rows, terms, &[]).ok_or_else(unfit)
    };
    tell("as declared");
    let declared = stage.at_once.declared.iter().flat_map(|e| of_declared(&stage.at_once, e));
    let declared = HeldModel { terms: declared.collect() };
    let plain = ("declared: mass and viscous friction", "", Vec::new(), true);
    let mut steps = vec![stage.step(&plain, declared, None)?];

    let rows = stage.held.rows(TRAIN);
    let (_, index) = stage.held.machine.joints().next().ok_or_else(unfit)?;
    let rate = stage.held.rate(index).ok_or_else(unfit)?;
    let mut film = (f64::INFINITY, rate);
    for speed in BUILDS_UP.map(|share| share * rate) {
        let [.., (_, _, terms, _), _] = stage.plan(speed);
        let error = fit(&stage.held, rows.clone(), &terms)?.error(&stage.held, TRAIN, rows.clone());
        if error < film.0 {
            film = (error, speed);
        }
    }
    for plan in stage.plan(film.1) {
        tell(plan.0);
        let (bench, terms) = (stage.bench(plan.3), &plan.2);
        let [first, second] = bench.halves(TRAIN);
        let by_first = fit(bench, first.clone(), terms)?;
        let by_second = fit(bench, second.clone(), terms)?;
        let halves = [by_second.error(bench, TRAIN, first), by_first.error(bench, TRAIN, second)];
        steps.push(stage.step(&plan, fit(bench, rows.clone(), terms)?, Some(halves))?);
    }
    tell("what carries over to the pulses");
    let last = steps.last().map(|step| step.model.clone()).ok_or_else(unfit)?;
    let carried = carry(&last, &stage.held)?;
    Ok(StageOutcome { steps, carried })
}

/// Identifies anew on the first half of the pulses what need not be the same on another day: the phase
/// of the screw (where the encoder's zero is) and the lag (felt more by pulses).
fn carry(model: &HeldModel, bench: &HeldBench) -> Result<Carried, Missing> {
    let anew = |term: &HeldTerm| ["drive-lag", "screw-ripple"].contains(&term.kind().name);
    let (free, fixed): (Vec<_>, Vec<_>) =
        model.terms.iter().cloned().partition(|(term, _)| anew(term));
    let free: Vec<HeldTerm> = free.into_iter().map(|(term, _)| term).collect();
    let [first, second] = bench.halves(PULSES);
    let again = HeldModel::fit(bench, PULSES, first, &free, &fixed).ok_or_else(unfit)?;
    let mut carried = Carried { model: again.clone(), inverse: [0.0; 2], simulated: [0.0; 2] };
    for (k, model) in [model, &again].into_iter().enumerate() {
        carried.inverse[k] = model.error(bench, PULSES, second.clone());
        let simulated = bench.simulated(PULSES, &model.settings()).map_err(wrong)?;
        let missed = bench.missed(PULSES, &simulated);
        carried.simulated[k] = share(&missed[second.clone()], &bench.asked(PULSES)[second.clone()]);
    }
    Ok(carried)
}

/// A share in percent with two decimals.
fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

/// Published relative errors of the force: symmetric on both recordings, asymmetric on the first.
const PUBLISHED: [(&str, &str); 2] = [("4.083 %", "5.982 %"), ("3.112 %", "")];

impl StageOutcome {
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
    pub fn traces(&self) -> ResultsTable {
        let rows = self.steps[1..].iter().map(|s| vec![s.name.to_owned(), s.trace.to_owned()]);
        ResultsTable {
            header: ["effect", "trace"].map(str::to_owned).to_vec(),
            rows: rows.collect(),
        }
    }

    /// Errors on the second half of the pulses.
    pub fn second_half(&self) -> ResultsTable {
        let Carried { inverse, simulated, .. } = &self.carried;
        let row = |name: &str, k: usize| {
            vec![name.to_owned(), percent(inverse[k]), percent(simulated[k])]
        };
        ResultsTable {
            header: ["model", "inverse model", "simulated"].map(str::to_owned).to_vec(),
            rows: vec![row("carried over as it is", 0), row("phase of the screw and lag anew", 1)],
        }
    }

    /// Errors step by step.
    pub fn table(&self) -> ResultsTable {
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
        ResultsTable { header: header.map(str::to_owned).to_vec(), rows: rows.collect() }
    }

    /// Parameters of the last model, and of the pulses.
    pub fn parameters(&self) -> ResultsTable {
        let Some(last) = self.steps.last() else {
            return ResultsTable { header: Vec::new(), rows: Vec::new() };
        };
        let rows = last.model.terms.iter().map(|(term, value)| {
            let there = self.carried.model.value(term);
            let how = if there == *value { "carried over" } else { "anew, first half" };
            let unit = term.kind().parameter(term.sought).map_or("", |parameter| parameter.unit);
            let cell = |value: f64| format!("{} {unit}", number(value));
            vec![in_words(term), cell(*value), cell(there), how.to_owned()]
        });
        ResultsTable {
            header: ["parameter", "training recording", "pulses", ""].map(str::to_owned).to_vec(),
            rows: rows.collect(),
        }
    }
}

/// A term in words; waves have a sine and a cosine.
fn in_words(term: &HeldTerm) -> String {
    let phase =
        term.kind().scan.and_then(|scan| term.fixed().find(|(name, _)| *name == scan.phase));
    let part = match phase {
        Some((_, 0.0)) => ", sine",
        Some(_) => ", cosine",
        None => "",
    };
    let over = term.fixed().find(|(name, _)| *name == "speed_m_s");
    let over =
        over.map_or_else(String::new, |(_, speed)| format!(" over {} mm/s", number(1e3 * speed)));
    format!("{}: {}{over}{part}", term.kind().name, term.sought)
}
