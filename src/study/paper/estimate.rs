//! Means and ratios over a few starts, with 95 % intervals.

use crate::measure::student::t95;
use crate::study::compare::{ComparedQuantity, in_words};
use serde::Serialize;

/// A value and where it lies with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The value; infinite for a ratio to nothing, NaN where there are no data.
    pub value: f64,
    /// Lower and upper end of the interval.
    pub ci95: [f64; 2],
}

/// A mean of independent runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RunMean {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
    pub sem: f64,
    /// Lower and upper end of its 95 % interval (Student's t).
    pub ci95: [f64; 2],
    /// Number of runs.
    pub runs: usize,
}

/// Ratios above this count as infinite: the denominator is rounding noise.
const ENDLESS: f64 = 1e9;

/// Standard errors below this share of the mean are not worth a word.
const ROUNDING: f64 = 1e-6;

impl RunMean {
    /// Of those values that are numbers; no interval from fewer than two.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.filter(|v| v.is_finite()).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let sem = if values.len() < 2 { f64::NAN } else { (squares / (n - 1.0) / n).sqrt() };
        let half = t95(values.len().saturating_sub(1)) * sem;
        Self { mean, sem, ci95: [mean - half, mean + half], runs: values.len() }
    }

    /// The mean as an estimate.
    pub fn estimate(&self) -> Estimate {
        Estimate { value: self.mean, ci95: self.ci95 }
    }

    /// Mean ± standard error, the error left out where it is rounding.
    pub(super) fn in_words(&self, quantity: &ComparedQuantity) -> String {
        let mean = in_words(quantity, self.mean);
        if self.sem > ROUNDING * self.mean.abs() {
            format!("{mean} ± {}", in_words(quantity, self.sem))
        } else {
            mean
        }
    }

    /// The ratio to another mean, its interval by the relative errors of both: symmetrical in the
    /// logarithm, with the fewer degrees of freedom of the two. Infinite if the other is nothing.
    pub fn over(&self, other: &RunMean) -> Estimate {
        let value = self.mean / other.mean;
        if self.ci95[0] > 0.0 && other.mean.abs() * ENDLESS < self.mean {
            return Estimate { value: f64::INFINITY, ci95: [f64::INFINITY; 2] };
        }
        let relative = (self.sem / self.mean).hypot(other.sem / other.mean);
        let factor = (t95(self.runs.min(other.runs).saturating_sub(1)) * relative).exp();
        Estimate { value, ci95: [value / factor, value * factor] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_use_students_t() {
        let mean = RunMean::of([1.0, 2.0, 3.0, f64::NAN].into_iter());
        let sem = (1f64 / 3.0).sqrt();
        assert!((mean.sem - sem).abs() < 1e-15);
        assert_eq!(mean.runs, 3);
        // Of two degrees of freedom t = (2p − 1) √(2/α), α = 4p (1 − p), at p = 0.975.
        let t = 0.95 * (2.0 / 0.0975f64).sqrt();
        assert!((mean.ci95[1] - (2.0 + t * sem)).abs() < 1e-12);
        // t(30) = 2.042, t(31) = 2.040.
        assert!((t95(31) - 2.0395).abs() < 1e-3);
    }

    #[test]
    fn ratios_carry_both_errors() {
        let exact = |mean| RunMean { mean, sem: 0.0, ci95: [mean; 2], runs: 8 };
        let ratio = exact(6.0).over(&exact(2.0));
        assert_eq!((ratio.value, ratio.ci95), (3.0, [3.0, 3.0]));
        let rough = RunMean { sem: 0.1, ..exact(1.0) };
        let [low, high] = rough.over(&rough).ci95;
        let half = 2.364_624_251_592_785 * 0.1 * 2f64.sqrt();
        assert!((high.ln() - half).abs() < 1e-12 && (low * high - 1.0).abs() < 1e-12);
        assert_eq!(exact(1.0).over(&exact(1e-15)).value, f64::INFINITY);
    }

    #[test]
    fn one_run_proves_nothing() {
        let mean = RunMean::of([1.0].into_iter());
        assert!(mean.mean == 1.0 && mean.ci95[0].is_nan());
        assert!(RunMean::of(std::iter::empty()).mean.is_nan());
    }
}
