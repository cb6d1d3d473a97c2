//! Whether one model is better than another, from errors on the same stretches of recordings.

use crate::measure::student::t95;

/// How much larger the errors of one model are than another's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// Geometric mean of the ratios, stretch by stretch.
    pub mean: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
}

impl Ratio {
    /// Of root mean square errors on the same stretches, one model's over the other's. Errors within a
    /// stretch belong together; stretches count as independent, and their logarithms alike, so that one
    /// bad stretch does not decide (Student's t on paired differences). Stretches without error in one of
    /// both are left out.
    pub fn of(errors: &[f64], others: &[f64]) -> Self {
        let pairs = errors.iter().zip(others).map(|(a, b)| (a / b).ln());
        let logs: Vec<f64> = pairs.filter(|x| x.is_finite()).collect();
        let n = logs.len() as f64;
        if logs.len() < 2 {
            return Self { mean: f64::NAN, ci95: [0.0, f64::INFINITY] };
        }
        let mean = logs.iter().sum::<f64>() / n;
        let variance = logs.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let half = t95(logs.len() - 1) * (variance / n).sqrt();
        Self { mean: mean.exp(), ci95: [(mean - half).exp(), (mean + half).exp()] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_that_of_paired_logarithms() {
        let others = [1.0, 2.0, 4.0, 8.0];
        let logs = [0.1, 0.3, 0.2, 0.2f64];
        let errors: Vec<f64> = others.iter().zip(logs).map(|(b, x)| b * x.exp()).collect();
        let found = Ratio::of(&errors, &others);
        // Mean 0.2, standard deviation √(0.02/3), t for three degrees of freedom 3.182446….
        let half = 3.182_446_305_284_263 * (0.02 / 3.0f64).sqrt() / 2.0;
        assert!((found.mean.ln() - 0.2).abs() < 1e-12);
        assert!((found.ci95[0].ln() - (0.2 - half)).abs() < 1e-12);
        assert!((found.ci95[1].ln() - (0.2 + half)).abs() < 1e-12);
        assert_eq!(Ratio::of(&[1.0], &[2.0]).ci95, [0.0, f64::INFINITY]);
    }
}
