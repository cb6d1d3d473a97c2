//! Parts of `report.json` that all ways of calibrating share.

use crate::effects::{Over, OverDistance, OverTime, Setting, Target};
use crate::measure::student::NORMAL95;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

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
    /// A central force.
    Central(OverDistance),
    /// A history of efforts.
    History(OverTime),
}

impl Depends {
    /// Of an effect, if it has no name.
    pub fn of(effect: &Setting) -> Option<Self> {
        let table = effect.efforts().map(|table| Self::Efforts(table.depends_on));
        let central = || effect.central().map(|table| Self::Central(table.depends_on));
        table
            .or_else(central)
            .or_else(|| effect.history().map(|history| Self::History(history.depends_on)))
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
    /// Effects that explain these recordings as well, as whole simulations showed.
    pub as_good: Vec<String>,
    /// Effects that residuals alone do not rule out in its place, and that were not simulated.
    pub not_ruled_out: Vec<String>,
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
    /// Mean square up to which that is noise.
    pub noise_up_to: f64,
    /// Largest coefficient in units of noise under the declared model.
    pub largest_before: f64,
    /// Under the named effects.
    pub largest_after: f64,
    /// Largest coefficient up to which that is noise.
    pub largest_noise_up_to: f64,
}

/// Whether the machine rattles.
#[derive(Clone, Debug, Serialize)]
pub struct RattleReport {
    /// Whether two replicas of the declared model differ by more than sensors see.
    pub chaotic: bool,
    /// Root mean square of their difference in units of the sensor's noise, in the worst channel.
    pub difference: f64,
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
