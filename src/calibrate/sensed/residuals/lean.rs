//! How far journals are taken to lean on their rings: forces that are lost in noise do not say where they lie.

use super::problem::{RigProblem, Segment};
use super::residual::ResidualKind;
use crate::calibrate::sensed::motion::simulate::with_noise;
use crate::calibrate::sensed::motion::start::machine;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::View;
use crate::calibrate::values::draws::{Coefficients, difference};

/// Draws of noise of each run that its power is taken from: each has hundreds of frequencies.
const NOISY: u64 = 4;

/// Noise of closure by how far journals are taken to lean: at a share s of it the power is `centred + 2 s mixed + s² lean`, each
/// in units of `centred` and summed over residuals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct LeanNoise {
    centred: f64,
    mixed: f64,
    lean: f64,
}

impl LeanNoise {
    /// The largest share, up to 1, at which the power is at most twice the least that any share leaves. With noise of leaning
    /// that has nothing to do with that of positions, n and p, that is √(p/n) where p is smaller. Positions are then known
    /// within a factor of √2 as well as with centred journals, and what shows in how far journals lean, as wear does, within
    /// the same factor as well as with all of it.
    fn share(&self) -> f64 {
        if self.lean <= 0.0 {
            return 1.0;
        }
        let best = -self.mixed / self.lean;
        let least = (self.centred - self.mixed * self.mixed / self.lean).max(0.0);
        (best + (least / self.lean).sqrt()).clamp(0.0, 1.0)
    }
}

impl RigProblem {
    /// Takes journals to lean as far as the noise of closure allows from now on; `logs` are noiseless recordings of the declared
    /// machine, two replicas of each run or more.
    pub fn lean_as_noise_allows(&mut self, logs: &[Vec<Recording>]) {
        self.basis.lean = self.lean_noise(logs).map_or(1.0, |noise| noise.share());
    }

    /// None where no residual depends on it.
    fn lean_noise(&mut self, logs: &[Vec<Recording>]) -> Option<LeanNoise> {
        let closure = self.closure();
        let mut sums = vec![LeanNoise::default(); closure.len()];
        for (run, logs) in logs.iter().enumerate() {
            // What replicas differ by is noise as well.
            let (own, other) = (logs.first()?, logs.get(1).or(logs.first())?);
            let noisy = |draw| with_noise(own, &self.declared.sensors, 7000 + draw);
            let noisy: Vec<Recording> = (0..NOISY).map(noisy).collect();
            let [centred, leaning] = [0.0, 1.0].map(|lean| {
                self.basis.lean = lean;
                let other = self.seen(other, run)?;
                let noise = |own| Some(difference(&self.seen(own, run)?, &other));
                noisy.iter().map(noise).collect::<Option<Vec<Coefficients>>>()
            });
            for (centred, leaning) in centred?.iter().zip(&leaning?) {
                for (sum, &c) in sums.iter_mut().zip(&closure) {
                    for (a, b) in centred[c].iter().zip(&leaning[c]) {
                        sum.centred += a * a;
                        sum.mixed += a * (b - a);
                        sum.lean += (b - a) * (b - a);
                    }
                }
            }
        }
        let mut total = LeanNoise::default();
        for LeanNoise { centred, mixed, lean } in sums.into_iter().filter(|sum| sum.centred > 0.0) {
            total.centred += 1.0;
            total.mixed += mixed / centred;
            total.lean += lean / centred;
        }
        (total.centred > 0.0).then_some(total)
    }

    /// Which residuals are closure.
    fn closure(&self) -> Vec<usize> {
        let names = self.names().unwrap_or_default();
        (0..names.len()).filter(|&c| names[c].kind == ResidualKind::Closure).collect()
    }

    /// Coefficients of the residuals of a recording like run `run` under the declared model.
    fn seen(&self, recording: &Recording, run: usize) -> Option<Coefficients> {
        let view = View::new(recording, self.declared.sensors.len());
        let segment = Segment { run, rows: self.runs[run].view.rows() };
        let machine = machine(&self.rig, &[], &self.runs[run].recording).ok()?;
        self.coefficients(&view, &machine, &segment)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn journals_lean_as_far_as_that_costs_no_more_than_it_may() {
        let share = |mixed, lean| LeanNoise { centred: 1.0, mixed, lean }.share();
        assert_eq!(share(0.0, 0.0), 1.0, "forces without noise");
        assert!((share(0.0, 25.0) - 0.2).abs() < 1e-12, "five times the noise of positions");
        assert_eq!(share(0.0, 0.5), 1.0, "less than that of positions");
        assert_eq!(share(-0.9, 1.0), 1.0, "positions scatter as journals lean");
        assert_eq!(share(3.0, 10.0), 0.0, "against each other");
    }

    /// A five-bar whose drives' torques are measured with noise: at the share that was chosen closure is twice as uncertain,
    /// by its power, as at the best one, and more so beyond.
    #[test]
    fn the_share_that_is_chosen_costs_a_factor_of_two() {
        let mut problem = RigProblem::planar("planar-3");
        let logs = problem.simulated(&problem.let_go(&[]).unwrap(), 2).unwrap();
        problem.lean_as_noise_allows(&logs);
        let chosen = problem.basis.lean;
        assert!((0.2..0.9).contains(&chosen), "{chosen}");
        let LeanNoise { centred, mixed, lean } = problem.lean_noise(&logs).unwrap();
        let power = |share: f64| centred + share * (2.0 * mixed + share * lean);
        let least = (0..=100).map(|k| power(f64::from(k) / 100.0)).fold(f64::MAX, f64::min);
        assert!((power(chosen) / least - 2.0).abs() < 0.05);
        assert!(power(1.1 * chosen) > 2.0 * least);
    }
}
