//! What an effect of the catalogue looks like in a trial: its target, and how its values grow from neutral.

use super::dice::Dice;
use crate::effects::{Parameter, ScanRange, Setting};
use crate::mechanism::{Mechanism, Sensor};
use std::f64::consts::TAU;

/// What is hidden in a trial.
#[derive(Clone, Debug)]
pub(super) struct Hidden {
    /// Effects.
    pub effects: Vec<Setting>,
    /// Sensors with the noise that they really have.
    pub sensors: Vec<Sensor>,
    /// The column whose noise is not as declared, if there is one.
    pub noisier: Option<String>,
    /// Floors of all of it together.
    pub floors: f64,
    /// Floors of the effect that shows least of several.
    pub least: Option<f64>,
}

/// Steps of a parameter by which a value is off at size one: ten times what can hardly be told from nothing.
const STEPS: f64 = 10.0;

/// Frequencies in Hz of what repeats in time: below the highest that residuals are looked at.
const FREQUENCIES: [f64; 2] = [3.0, 40.0];

/// Waves in a turn of what repeats with an angle, at most: finer ones are over before a servo feels them.
const WAVES: f64 = 16.0;

/// An effect without its size.
#[derive(Clone, Debug)]
pub(super) struct HiddenShape {
    /// The effect where it changes nothing, but with all values that have no size: places, phases, frequencies.
    neutral: Setting,
    /// Change of each value at a size of one; none of a value that has no size.
    growing: Vec<f64>,
}

impl HiddenShape {
    /// Draws where an effect sits and which way its values go, by what the catalogue says of them: what a search
    /// scans, where it starts, and what is neutral.
    pub fn draw(effect: &Setting, mechanism: &Mechanism, dice: &mut Dice) -> Self {
        let parameters: Vec<Parameter> =
            effect.values().filter_map(|(name, _)| effect.kind.parameter(name).copied()).collect();
        let mut values: Vec<f64> = effect.values().map(|(_, value)| value).collect();
        let mut growing = vec![0.0; values.len()];
        let starts = effect.starts(mechanism);
        if let Some(scan) = effect.kind.scan {
            for (i, parameter) in parameters.iter().enumerate() {
                if parameter.name == scan.over {
                    values[i] = repeating(scan.range, dice);
                } else if parameter.name == scan.phase {
                    values[i] = dice.between(0.0, TAU);
                } else {
                    growing[i] = change(parameter, values[i], dice);
                }
            }
        } else if let Some(start) = dice.one_of(&starts) {
            let sizes = effect.sizes();
            for (i, parameter) in parameters.iter().enumerate() {
                if sizes.contains(&i) && start[i] != 0.0 {
                    growing[i] = STEPS * parameters[0].step * start[i] / start[0].abs();
                } else {
                    values[i] = placed(parameter, start[i], dice);
                }
            }
        } else {
            for (i, parameter) in parameters.iter().enumerate() {
                growing[i] = change(parameter, values[i], dice);
            }
        }
        Self { neutral: effect.with(&values), growing }
    }

    /// The effect in this size; none where a value would be out of bounds.
    pub fn at(&self, size: f64) -> Option<Setting> {
        let values = self.neutral.values().zip(&self.growing);
        let values = values.map(|((name, value), growing)| {
            let value = value + size * growing;
            let [low, high] = self.neutral.kind.parameter(name)?.bounds;
            (low..=high).contains(&value).then_some(value)
        });
        Some(self.neutral.with(&values.collect::<Option<Vec<f64>>>()?))
    }
}

/// Change of a value at a size of one: either way, unless there is room on one side alone.
fn change(parameter: &Parameter, neutral: f64, dice: &mut Dice) -> f64 {
    let [low, high] = parameter.bounds;
    let size = STEPS * parameter.step * dice.between(0.4, 1.0);
    let down = if neutral - low < size { false } else { high - neutral < size || dice.chance(0.5) };
    if down { -size } else { size }
}

/// A value near one from which a search starts: places are off by some steps, sizes by a quarter.
fn placed(parameter: &Parameter, start: f64, dice: &mut Dice) -> f64 {
    let [low, high] = parameter.bounds;
    let value = if low < 0.0 {
        start + STEPS * parameter.step * dice.between(-1.0, 1.0)
    } else {
        start * dice.between(0.8, 1.25)
    };
    value.clamp(low, high)
}

/// Where something repeats: a frequency, a period or a number of waves in a turn.
fn repeating(range: ScanRange, dice: &mut Dice) -> f64 {
    match range {
        ScanRange::Frequencies => dice.log_between(FREQUENCIES[0], FREQUENCIES[1]),
        ScanRange::WaveNumbers([from, to, _]) => 1.0 / dice.log_between(2.0 * from, 0.5 * to),
        ScanRange::Orders([from, to, _]) => dice.log_between(from, to.min(WAVES)).round(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::record::TrialBench;
    use super::super::{NOISE, Trial};
    use super::*;
    use crate::calibrate::sensed::values::candidates::candidates;

    /// Every effect that a search has for a machine can be hidden in it: a size of nothing changes nothing, and a
    /// small one gives a machine.
    #[test]
    fn every_candidate_has_a_shape() {
        let mut dice = Dice::new(1, 0);
        for seed in 0..12 {
            let trial = Trial::draw(seed);
            let Ok(bench) = TrialBench::new(&trial) else { continue };
            for effect in candidates(&bench.declared, &[]) {
                let shape = HiddenShape::draw(&effect, &bench.declared, &mut dice);
                let small = shape.at(1e-3).unwrap_or_else(|| panic!("{effect}: out of bounds"));
                assert!(small != shape.neutral, "{effect} has no size");
                let mut machine = bench.declared.clone();
                small.apply(&mut machine).unwrap_or_else(|wrong| panic!("{effect}: {wrong:?}"));
            }
        }
    }

    /// A trial is its seed's; all cases and machines come up.
    #[test]
    fn seeds_draw_all_sorts_of_trials() {
        let all: Vec<Trial> = (0..60).map(Trial::draw).collect();
        assert_eq!(all[7], Trial::draw(7));
        let count = |is: &dyn Fn(&Trial) -> bool| all.iter().filter(|trial| is(trial)).count();
        for machine in super::super::machines() {
            assert!(count(&|trial| trial.machine == machine) > 2, "{machine}");
        }
        assert!(count(&|trial| trial.hidden.is_empty()) > 2);
        assert!(count(&|trial| trial.hidden.len() == 2) > 1);
        assert!(count(&|trial| trial.hidden.iter().any(|kind| kind == NOISE)) > 0);
        let extremes = all.iter().map(|trial| trial.size);
        let (low, high) = extremes.fold((f64::MAX, 0.0f64), |(l, h), s| (l.min(s), h.max(s)));
        assert!(low < 0.3 && high > 3.5, "{low} {high}");
    }
}
