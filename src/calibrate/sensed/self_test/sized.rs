//! How large what is hidden is: so that the declared model misses the validation run by as many floors as drawn.

use super::dice::Dice;
use super::hidden::{Hidden, HiddenShape};
use super::record::TrialBench;
use super::{Case, NOISE, Trial};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Stopped};
use crate::calibrate::sensed::thresholds::SEEN;
use crate::calibrate::sensed::values::candidates::candidates;
use crate::calibrate::sensed::values::errors::of_run;
use crate::effects::Setting;
use crate::mechanism::Sensor;

/// How often another target or way of an effect is drawn that does not show.
const DRAWS: usize = 3;

/// Sizes of one draw that are simulated, at most.
const STEPS: usize = 5;

/// Share of the wanted floors by which those of a size may differ from them: they are drawn over a factor of eight.
const NEAR: f64 = 0.3;

/// The same of the last size that was tried, where a rattle scatters them.
const NEAR_ENOUGH: f64 = 0.5;

/// Replicas of a machine that rattles: of two, one and the same machine showed by six floors now and then, and a size
/// was taken for what chance did.
const REPLICAS: u64 = 4;

/// Factor by which noise is larger than declared where that is hidden.
const NOISIER: f64 = 2.0;

/// Run that errors are looked at of.
const VALIDATION: usize = 1;

/// Hides what a trial has drawn; none where nothing of these kinds shows as it should.
///
/// # Errors
/// A rig that cannot be simulated.
pub(super) fn hide(trial: &Trial, bench: &TrialBench) -> Result<Option<Hidden>, Stopped> {
    let mut dice = Dice::new(trial.seed, 1);
    let mut sensors = bench.declared.sensors.clone();
    let noisier = match trial.hidden.first() {
        Some(kind) if kind == NOISE => Some(make_noisy(&mut sensors, &mut dice)),
        _ => None,
    };
    let look = MissedLook::new(bench)?;
    let mut effects = Vec::new();
    let mut floors: Vec<f64> = Vec::new();
    for (kind, wanted) in trial.hidden.iter().zip(&trial.wanted) {
        if noisier.is_some() {
            break;
        }
        let Some((effect, shows)) = sized(&look, kind, *wanted, &mut dice)? else {
            return Ok(None);
        };
        effects.push(effect);
        floors.push(shows);
    }
    let least =
        (trial.case == Case::Two).then(|| floors.iter().copied().fold(f64::INFINITY, f64::min));
    let all = match floors[..] {
        [one] => one,
        _ => look.floors(&effects)?,
    };
    Ok(Some(Hidden { effects, sensors, noisier, floors: all, least }))
}

/// Makes one of the measuring sensors noisier; its column.
fn make_noisy(sensors: &mut [Sensor], dice: &mut Dice) -> String {
    let measuring: Vec<usize> = (0..sensors.len()).filter(|&i| !sensors[i].tells()).collect();
    let sensor = &mut sensors[dice.one_of(&measuring).copied().unwrap_or_default()];
    let rounding = sensor.resolution.powi(2) / 12.0;
    let square = NOISIER.powi(2) * (sensor.std.powi(2) + rounding) - rounding;
    sensor.std = square.max(0.0).sqrt();
    sensor.column.clone()
}

/// An effect of a kind, somewhere on the machine, that shows by so many floors; and by how many it does.
fn sized(
    look: &MissedLook,
    kind: &str,
    wanted: f64,
    dice: &mut Dice,
) -> Result<Option<(Setting, f64)>, Stopped> {
    let mut all = candidates(&look.bench.declared, &[]);
    all.retain(|effect| effect.kind.name == kind);
    for _ in 0..DRAWS {
        let Some(effect) = drawn(&all, dice) else { return Ok(None) };
        let shape = HiddenShape::draw(&effect, &look.bench.declared, dice);
        if let Some(found) = grown(look, &shape, wanted)? {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

/// One of the targets, and one of the variants there.
fn drawn(all: &[Setting], dice: &mut Dice) -> Option<Setting> {
    let mut targets: Vec<&Setting> = Vec::new();
    for effect in all {
        if !targets.iter().any(|known| known.is(effect)) {
            targets.push(effect);
        }
    }
    let target = dice.one_of(&targets)?;
    let variants: Vec<&Setting> = all.iter().filter(|effect| effect.is(target)).collect();
    dice.one_of(&variants).map(|effect| (*effect).clone())
}

/// A shape in the size in which it shows by so many floors, if there is one.
fn grown(
    look: &MissedLook,
    shape: &HiddenShape,
    wanted: f64,
) -> Result<Option<(Setting, f64)>, Stopped> {
    // Beside the noise, whose square is one.
    let beyond = |floors: f64| (floors * floors - 1.0).max(0.04).sqrt();
    let (mut size, mut largest) = (1.0, f64::INFINITY);
    let mut last = None;
    for _ in 0..STEPS {
        let there = match shape.at(size) {
            // A machine that cannot be, or breaks down, has too much of it.
            Some(effect) => look.floors(std::slice::from_ref(&effect)).ok().map(|f| (effect, f)),
            None => None,
        };
        let Some((effect, floors)) = there.filter(|(_, floors)| floors.is_finite()) else {
            largest = size;
            size *= 0.3;
            continue;
        };
        let off = (floors / wanted).ln().abs();
        last = Some((effect, floors));
        if off < NEAR {
            return Ok(last);
        }
        let factor = (beyond(wanted) / beyond(floors)).clamp(0.02, 50.0);
        // Between what shows too little and what cannot be there is room for half.
        size = if size * factor < largest { size * factor } else { 0.5 * (size + largest) };
    }
    Ok(last.filter(|(_, floors)| (floors / wanted).ln().abs() < NEAR_ENOUGH))
}

/// Looks at what the declared model misses.
struct MissedLook<'a> {
    bench: &'a TrialBench,
    /// Replicas of each model.
    replicas: u64,
    /// What the declared model shows; none of a machine that falls, whose start is fitted to each recording.
    declared: Option<Vec<Recording>>,
}

impl<'a> MissedLook<'a> {
    fn new(bench: &'a TrialBench) -> Result<Self, Stopped> {
        let clean = bench.clean(&[], VALIDATION, 1)?;
        let mut problem = bench.of(clean)?;
        let rattles = problem.look_for_rattle(&[])? > SEEN;
        let replicas = if rattles { REPLICAS } else { 1 };
        problem.replicas = replicas as usize;
        let driven = !bench.declared.actuators.is_empty();
        let declared = if driven { Some(shown(&problem, &[])?) } else { None };
        Ok(Self { bench, replicas, declared })
    }

    /// The largest error of the declared model on the validation run of one with these effects, in floors of that: the root
    /// mean square over replicas of the truth, so that none counts for what its rattle happens to do.
    fn floors(&self, effects: &[Setting]) -> Result<f64, Stopped> {
        let truth = self.bench.clean(effects, VALIDATION, self.replicas)?;
        let mut squares: Vec<f64> = Vec::new();
        // Where a machine falls from is fitted to each recording anew, which costs more than to simulate it.
        let recorded = if self.declared.is_some() { truth.len() } else { 1 };
        for clean in &truth[..recorded] {
            let noisy = self.bench.noisy(clean, &self.bench.declared.sensors, VALIDATION);
            let mut problem = self.bench.of(vec![noisy])?;
            problem.replicas = self.replicas as usize;
            let (before, known) = match &self.declared {
                Some(declared) => (declared.clone(), truth.clone()),
                None => (shown(&problem, &[])?, shown(&problem, effects)?),
            };
            let recording = &problem.runs[0].recording;
            let errors = of_run(&problem.declared, recording, "validation", &before, &known);
            squares.resize(errors.len(), 0.0);
            let ratios = errors.iter().map(|error| (error.before / error.floor).powi(2));
            squares.iter_mut().zip(ratios).for_each(|(sum, square)| *sum += square);
        }
        Ok(squares.into_iter().fold(0.0, f64::max).sqrt() / (recorded as f64).sqrt())
    }
}

/// What a model with these effects shows of a problem's one run, as many replicas as the problem takes.
fn shown(problem: &RigProblem, effects: &[Setting]) -> Result<Vec<Recording>, Stopped> {
    Ok(problem.simulated(&problem.let_go(effects)?, problem.replicas)?.swap_remove(0))
}
