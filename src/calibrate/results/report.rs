//! `report.json`: what a calibration came to.

use super::evidence::{as_good, evidence};
use super::outcome::{LegsOutcome, Verdict};
use super::summary::summary;
use crate::calibrate::measured::rattle::Rattle;
use crate::calibrate::rounds::left::LegsLeft;
use crate::calibrate::rounds::way::name;
use crate::calibrate::values::errors::ChannelError;
use crate::calibrate::values::model::LegsCase;
use crate::effects::{Over, OverTime, Setting, Target};
use crate::measure::student::NORMAL95;
use crate::scenario::Scenario;
use crate::simulate::Provenance;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

/// The report. Keys are promised to scripts; see the README.
#[derive(Clone, Debug, Serialize)]
pub struct LegsReport {
    /// Program, versions, rig as declared.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What the calibration comes to.
    pub verdict: Verdict,
    /// The same in a sentence or two.
    pub summary: String,
    /// What the model was given.
    pub effects: Vec<EffectReport>,
    /// Errors by run and channel.
    pub errors: Vec<ChannelError>,
    /// Candidates, round by round, the best first in each.
    pub ranking: Vec<Ranked>,
    /// Residuals on data not used for fits, under the declared and under the calibrated model.
    pub residuals: Vec<ResidualReport>,
    /// Whether the declared machine rattles by more than its sensors see, and what follows.
    pub rattle: RattleReport,
    /// Kinds of effects that were excluded by `--without`.
    pub without: Vec<String>,
    /// Velocity error allowed for one step of a simulation in m/s.
    pub tolerance_m_s: f64,
    /// Seeds.
    pub seeds: Seeds,
    /// Simulations that it took, searches for starts among them, in runs like the recorded ones with steps of
    /// 0.1 ms.
    pub simulations: usize,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
}

/// What an effect acts on, by the key that names it in a file; `joint` is null where it is no joint.
#[derive(Clone, Debug, PartialEq)]
pub struct ActsOn(Target, Option<String>);

impl ActsOn {
    /// The whole machine.
    pub fn machine() -> Self {
        Self(Target::Machine, None)
    }

    /// Of an effect.
    pub fn of(effect: &Setting) -> Self {
        let run = effect.history().and_then(|history| history.run.clone());
        Self(effect.target.clone(), run)
    }

    /// What a target names.
    pub fn at(target: &Target) -> Self {
        Self(target.clone(), None)
    }

    /// In words, as in " at A1"; empty of the whole machine.
    pub fn words(&self) -> String {
        match self.0 {
            Target::Machine => String::new(),
            _ => format!(" at {}", self.0),
        }
    }
}

impl Serialize for ActsOn {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = Map::from_iter([("joint".to_owned(), Value::Null)]);
        if let Some(key) = self.0.key() {
            let names = match self.0.names() {
                [name] => json!(name),
                names => json!(names),
            };
            map.insert(key.to_owned(), names);
        }
        if let Some(run) = &self.1 {
            map.insert("run".to_owned(), json!(run));
        }
        map.serialize(serializer)
    }
}

/// What an effect without a name is a function of.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(untagged)]
pub enum Depends {
    /// A table of efforts or forces.
    Efforts(Over),
    /// A history of efforts.
    History(OverTime),
}

impl Depends {
    /// Of an effect, if it has no name.
    pub fn of(effect: &Setting) -> Option<Self> {
        let table = effect.efforts().map(|table| Self::Efforts(table.depends_on));
        table.or_else(|| effect.history().map(|history| Self::History(history.depends_on)))
    }
}

/// An effect that was found.
#[derive(Clone, Debug, Serialize)]
pub struct EffectReport {
    /// Its name.
    pub kind: &'static str,
    /// What it acts on.
    #[serde(flatten)]
    pub on: ActsOn,
    /// What it is a function of, if it has no name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depends_on: Option<Depends>,
    /// Its fitted values.
    #[serde(serialize_with = "by_name")]
    pub params: Vec<(&'static str, Fitted)>,
    /// What it rests on.
    pub evidence: String,
    /// Effects that explain these recordings as well.
    pub as_good: Vec<String>,
    /// Its equation.
    pub equation: &'static str,
}

/// A fitted value, in the unit that its name ends with.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Fitted {
    /// The value.
    pub value: f64,
    /// Its standard deviation; none where the data do not tell.
    pub std: f64,
    /// The interval that holds the true value 95 times in 100.
    pub ci95: [f64; 2],
}

impl Fitted {
    /// A value with its standard deviation.
    pub fn new(value: f64, std: f64) -> Self {
        Self { value, std, ci95: [value - NORMAL95 * std, value + NORMAL95 * std] }
    }
}

fn by_name<S: Serializer>(params: &[(&str, Fitted)], serializer: S) -> Result<S::Ok, S::Error> {
    let entry = |(name, fitted): &(&str, Fitted)| {
        let value = json!({"value": fitted.value, "std": fitted.std, "ci95": fitted.ci95});
        ((*name).to_owned(), value)
    };
    params.iter().map(entry).collect::<Map<String, Value>>().serialize(serializer)
}

/// A candidate in a round.
#[derive(Clone, Debug, Serialize)]
pub struct Ranked {
    /// Its name.
    pub kind: &'static str,
    /// What it acts on.
    #[serde(flatten)]
    pub on: ActsOn,
    /// Share of the residual's weighted variance above the floor that it removes on data not used for
    /// its fit, 0…1; of what the rounds before left.
    pub validation_score: f64,
    /// Whether the calibrated model has it from this round.
    pub kept: bool,
    /// Round, from 1.
    pub round: usize,
    /// Whether the machine was simulated with it, rather than looked at through inverse dynamics alone.
    pub simulated: bool,
    /// Drop of Σ of squares in units of noise on data not used for its fit, less what its number of
    /// values may bring by chance.
    pub gain: f64,
}

/// What stands above noise in one of the residuals, on data not used for fits.
#[derive(Clone, Debug, Serialize)]
pub struct ResidualReport {
    /// Which: servo, closure, dynamics.
    pub residual: String,
    /// Mean square in units of noise under the declared model: 1 for noise.
    pub mean_square_before: f64,
    /// Under the named effects.
    pub mean_square_after: f64,
    /// Up to where noise reaches.
    pub noise_up_to: f64,
    /// Largest coefficient in units of noise under the declared model.
    pub largest_before: f64,
    /// Under the named effects.
    pub largest_after: f64,
}

/// Whether the machine rattles.
#[derive(Clone, Debug, Serialize)]
pub struct RattleReport {
    /// Whether two replicas of the declared model differ by more than sensors see.
    pub chaotic: bool,
    /// Root mean square of their difference in units of the sensor's noise, in the worst channel.
    pub difference: f64,
    /// That channel.
    pub channel: String,
    /// Replicas that means and floors were taken from.
    pub replicas: usize,
}

/// Seeds of random numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Seeds {
    /// The rig's own.
    pub scenario: u64,
    /// Those of the replicas' starts.
    pub replicas: Vec<u64>,
}

/// What a report is made of.
#[derive(Clone, Copy, Debug)]
pub struct Sources<'a> {
    /// The rig and its runs.
    pub case: &'a LegsCase,
    /// What became of them.
    pub outcome: &'a LegsOutcome,
    /// What two replicas said.
    pub rattle: &'a Rattle,
    /// Kinds that were excluded.
    pub without: &'a [&'a str],
}

impl LegsReport {
    /// The report, but for the time it took and the files beside it.
    pub fn new(from: Sources) -> Self {
        let Sources { case, outcome, rattle, without } = from;
        let rig = &case.rig;
        Self {
            provenance: Provenance::of(rig),
            verdict: outcome.verdict,
            summary: summary(outcome),
            effects: outcome
                .effects
                .iter()
                .map(|(effect, _)| effect_report(outcome, effect))
                .collect(),
            errors: outcome.errors.clone(),
            ranking: ranking(outcome),
            residuals: residuals(&outcome.before, &outcome.after),
            rattle: RattleReport {
                chaotic: rattle.chaotic,
                difference: rattle.difference,
                channel: rattle.channel.to_string(),
                replicas: case.replicas(),
            },
            without: without.iter().map(|kind| (*kind).to_owned()).collect(),
            tolerance_m_s: case.simulator.control.tolerance().unwrap_or(f64::NAN),
            seeds: Seeds { scenario: rig.seed, replicas: (0..case.replicas() as u64).collect() },
            simulations: outcome.simulations + rattle.logs.len(),
            wall_s: 0.0,
            files: Vec::new(),
        }
    }
}

/// The rig with what was found: a scenario like any other.
pub fn calibrated(rig: &Scenario, outcome: &LegsOutcome) -> Scenario {
    let mut scenario = rig.clone();
    scenario.effects = outcome.effects.iter().map(|(effect, _)| effect.clone()).collect();
    scenario
}

fn effect_report(outcome: &LegsOutcome, effect: &Setting) -> EffectReport {
    let estimates = outcome.effects.iter().find(|(e, _)| e == effect).map(|(_, e)| e.as_slice());
    let params = estimates.unwrap_or_default().iter().map(|estimate| {
        let fitted = Fitted { value: estimate.value, std: estimate.std, ci95: estimate.ci95() };
        (estimate.name, fitted)
    });
    EffectReport {
        kind: effect.kind.name,
        on: ActsOn::of(effect),
        depends_on: Depends::of(effect),
        params: params.collect(),
        evidence: evidence(outcome, effect),
        as_good: as_good(outcome, effect).into_iter().map(name).collect(),
        equation: effect.kind.equation,
    }
}

/// Every candidate of every round once: of several variants at one joint the best.
fn ranking(outcome: &LegsOutcome) -> Vec<Ranked> {
    let mut all = Vec::new();
    for (i, round) in outcome.rounds.iter().enumerate() {
        let mut seen: Vec<&Setting> = Vec::new();
        for scored in &round.ranking {
            if seen.iter().any(|other| other.is(&scored.effect)) {
                continue;
            }
            seen.push(&scored.effect);
            let in_model = outcome.effects.iter().any(|(effect, _)| effect.is(&scored.effect));
            let added = round.added.as_ref().is_some_and(|added| added.is(&scored.effect));
            all.push(Ranked {
                kind: scored.effect.kind.name,
                on: ActsOn::of(&scored.effect),
                validation_score: scored.share,
                kept: in_model && added,
                round: i + 1,
                simulated: scored.simulated,
                gain: scored.gain,
            });
        }
    }
    if let Some(described) = &outcome.described {
        all.push(Ranked {
            kind: described.effect.kind.name,
            on: ActsOn::of(&described.effect),
            validation_score: described.share,
            kept: true,
            round: outcome.rounds.len() + 1,
            simulated: true,
            gain: f64::NAN,
        });
    }
    all
}

fn residuals(before: &[LegsLeft], after: &[LegsLeft]) -> Vec<ResidualReport> {
    let join = |(before, after): (&LegsLeft, &LegsLeft)| ResidualReport {
        residual: before.residual.to_owned(),
        mean_square_before: before.mean_square,
        mean_square_after: after.mean_square,
        noise_up_to: after.limit,
        largest_before: before.largest,
        largest_after: after.largest,
    };
    before.iter().zip(after).map(join).collect()
}
