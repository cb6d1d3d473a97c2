//! What a seed hides where.

use super::dice::Dice;
use super::families::{FAMILIES, Family};
use super::motion::like;
use super::rig::{of_family, rig};
use super::{Case, NOISE, Trial};
use crate::calibrate::sensed::motion::basis::Basis;
use crate::calibrate::sensed::motion::start::machine;
use crate::calibrate::sensed::values::candidates::candidates;
use crate::mechanism::Mechanism;
use crate::model::parts_of;
use crate::scenario::Problem;

/// Shares of the cases.
const CASES: [(Case, f64); 5] = [
    (Case::Nothing, 0.15),
    (Case::One, 0.50),
    (Case::Two, 0.10),
    (Case::Withheld, 0.10),
    (Case::Instrument, 0.15),
];

/// Sizes of machines.
const SIZES: [f64; 2] = [0.2, 5.0];

/// Radial play in m, and its largest share of the bearing's radius (in m at size one).
const PLAY: [f64; 2] = [5e-5, 5e-4];
const SHARE_OF_BEARING: [f64; 2] = [0.05, 8e-3];

/// Noise in that of the family's sensors.
const NOISES: [f64; 2] = [0.3, 5.0];

/// Lengths of runs in s, and rows in a second.
const DURATIONS: [f64; 2] = [1.5, 6.0];
const RATES: [f64; 2] = [300.0, 2000.0];

/// Floors by which what is hidden shows.
const FLOORS: [f64; 2] = [1.5, 12.0];

/// Share of the sensors that are left out.
const LEFT_OUT: f64 = 0.3;

/// How often sensors are left out anew where the others do not say how the machine stands; all stay after that.
const DRAWS: usize = 20;

impl Trial {
    /// The trial of a seed. It hides nothing in a machine that cannot be put together, which says so when it is tried.
    pub fn draw(seed: u64) -> Self {
        let mut dice = Dice::new(seed, 0);
        let family = dice.one_of(FAMILIES).map_or(&FAMILIES[0], |family| family);
        let [smallest, largest] = SIZES;
        let size = dice.log_between(smallest, largest);
        let most = PLAY[1].min(SHARE_OF_BEARING[0] * SHARE_OF_BEARING[1] * size).max(PLAY[0]);
        let friction = dice.between(0.02, 0.1);
        let mut trial = Self {
            seed,
            machine: family.name.to_owned(),
            size,
            mass_exponent: dice.between(2.0, 3.0),
            clearance_m: dice.log_between(PLAY[0], most),
            friction: if dice.chance(0.5) { friction } else { 0.0 },
            gravity: dice.chance(0.6) || !family.floats,
            noise: dice.log_between(NOISES[0], NOISES[1]),
            duration_s: (dice.between(DURATIONS[0], DURATIONS[1]) * 10.0).round() / 10.0,
            rate: (dice.log_between(RATES[0], RATES[1]) / 50.0).round() * 50.0,
            columns: Vec::new(),
            case: Case::Nothing,
            hidden: Vec::new(),
            wanted: Vec::new(),
        };
        let Ok(mechanism) = trial.instruments(family, &mut dice) else { return trial };
        trial.case = case(&mut dice);
        trial.hidden = kinds(trial.case, &mechanism, &mut dice);
        trial.wanted =
            trial.hidden.iter().map(|_| dice.log_between(FLOORS[0], FLOORS[1])).collect();
        trial
    }

    /// Leaves out sensors, but so that the others say how the machine stands. The machine with those that are left.
    fn instruments(&mut self, family: &Family, dice: &mut Dice) -> Result<Mechanism, Problem> {
        let all = columns(family)?;
        for _ in 0..DRAWS {
            self.columns = all.iter().filter(|_| !dice.chance(LEFT_OUT)).cloned().collect();
            let rig = rig(self)?;
            let like = like(self, &parts_of(&rig)?, 0);
            let mechanism = machine(&rig, &[], &like)?;
            if Basis::of(&mechanism, &like).is_some() {
                return Ok(mechanism);
            }
        }
        self.columns = all;
        let rig = rig(self)?;
        machine(&rig, &[], &like(self, &parts_of(&rig)?, 0))
    }
}

/// Columns of everything that a family's sensors measure.
fn columns(family: &Family) -> Result<Vec<String>, Problem> {
    let rig = of_family(family)?;
    let sensors = parts_of(&rig)?.sensors.into_iter();
    let measured = sensors.filter(|sensor| !sensor.tells());
    Ok(measured.map(|sensor| sensor.column).collect())
}

fn case(dice: &mut Dice) -> Case {
    let mut left = dice.between(0.0, 1.0);
    for (case, share) in CASES {
        left -= share;
        if left < 0.0 {
            return case;
        }
    }
    Case::One
}

/// The kinds of effects that a case hides: any that the catalogue has for the machine, each as likely.
fn kinds(case: Case, mechanism: &Mechanism, dice: &mut Dice) -> Vec<String> {
    let instrument = case == Case::Instrument;
    let all = candidates(mechanism, &[]);
    let fitting =
        all.iter().map(|effect| effect.kind).filter(|kind| kind.is_instrument() == instrument);
    let mut kinds: Vec<&str> = fitting.map(|kind| kind.name).collect();
    kinds.dedup();
    if instrument {
        kinds.push(NOISE);
    }
    let count = match case {
        Case::Nothing => 0,
        Case::Two => 2,
        _ => 1,
    };
    let mut hidden: Vec<String> = Vec::new();
    for _ in 0..count {
        kinds.retain(|kind| hidden.iter().all(|other| other != kind));
        hidden.extend(dice.one_of(&kinds).map(|kind| (*kind).to_owned()));
    }
    hidden
}

/// A case in words.
pub(super) fn word(case: Case) -> &'static str {
    match case {
        Case::Nothing => "nothing",
        Case::One => "one effect",
        Case::Two => "two effects",
        Case::Withheld => "no candidate",
        Case::Instrument => "instrument",
    }
}

/// The first `count` trials of a `seed` whose machine is one of `machines` and whose hidden effects are one of `only`
/// (`nothing`, a kind, [`NOISE`], or `a+b`); of an empty list any. Fewer where they are too rare.
pub fn trials(seed: u64, count: usize, machines: &[String], only: &[String]) -> Vec<Trial> {
    let wanted = |trial: &Trial| {
        let hidden = match &trial.hidden[..] {
            [] => "nothing".to_owned(),
            kinds => kinds.join("+"),
        };
        (machines.is_empty() || machines.contains(&trial.machine))
            && (only.is_empty() || only.contains(&hidden))
    };
    let numbers = 0..(count * RAREST) as u64;
    numbers.map(|number| Trial::draw(seed * MOST + number)).filter(wanted).take(count).collect()
}

/// Trials that one seed of a self-test has, at most.
const MOST: u64 = 1_000_000;

/// Trials that are drawn for one that is wanted, at most: an effect is hidden in one of a hundred, and a machine is
/// one of six.
const RAREST: usize = 3000;
