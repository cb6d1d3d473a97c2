//! Means over starts, and what they tend to as the step shrinks.

use crate::measure::student::NORMAL95;
use serde::Serialize;

/// A mean with its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mean {
    /// The mean.
    pub mean: f64,
    /// Its standard error; zero of a single value.
    pub sem: f64,
}

impl Mean {
    /// Of those values that are numbers.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.filter(|v| v.is_finite()).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let sem = match values.len() {
            0 => f64::NAN,
            1 => 0.0,
            _ => (squares / (n - 1.0) / n).sqrt(),
        };
        Self { mean, sem }
    }
}

/// What a quantity does as the step shrinks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Behaviour {
    /// It tends to a limit.
    Settles,
    /// It grows, like a power of the step.
    Grows,
    /// It shrinks, like a power of the step.
    Shrinks,
    /// There is nothing to judge by.
    Unknown,
}

/// A quantity as a function of the step h.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Trend {
    /// What it does.
    pub behaviour: Behaviour,
    /// Power p of the step in y ∝ h^p, over the shorter half of the steps, at least three: about 0 where
    /// there is a limit, −1 where it grows as 1/h.
    pub power: f64,
    /// Standard error of p.
    pub power_std: f64,
    /// The limit as h → 0, where there is one.
    pub limit: Option<f64>,
    /// 95 % interval of the limit, from the scatter over the starts.
    pub ci95: Option<[f64; 2]>,
}

/// Power of the step from which on, if it differs from zero by three standard errors, a quantity is
/// said to have no limit: a tenfold shorter step changes it by more than 1.6.
const POWER: f64 = 0.2;

/// Share of a value that counts as its error at least where starts agree by chance.
const LEAST_ERROR: f64 = 0.005;

/// Smallest error: its inverse square is still a number.
const SMALLEST_ERROR: f64 = 1e-50;

/// The trend of (step in s, mean) pairs. Where there is a limit it is extrapolated as Richardson does,
/// by `y = y₀ + b h^order`, weighted with the errors of the means; the pairs with the longest steps
/// are left out, as long as more than two remain, until the rest fits.
pub fn trend(points: &[(f64, Mean)], order: f64) -> Trend {
    let points: Vec<_> = points.iter().filter(|(_, y)| y.mean.is_finite()).copied().collect();
    let error = |y: &Mean| y.sem.max(LEAST_ERROR * y.mean.abs()).max(SMALLEST_ERROR);
    let positive = points.iter().all(|(_, y)| y.mean > 0.0);
    let (power, power_std) = if positive && points.len() > 1 {
        let log = |(h, y): &(f64, Mean)| (h.ln(), y.mean.ln(), error(y) / y.mean);
        let mut data: Vec<_> = points.iter().map(log).collect();
        data.sort_by(|a, b| a.0.total_cmp(&b.0));
        data.truncate(data.len().div_ceil(2).max(3));
        let fit = line(&data);
        (fit.slope, fit.slope_std)
    } else {
        (f64::NAN, f64::NAN)
    };
    let sure = power.abs() > POWER && power.abs() > 3.0 * power_std;
    let behaviour = match power {
        _ if points.len() < 2 => Behaviour::Unknown,
        p if sure && p < 0.0 => Behaviour::Grows,
        _ if sure => Behaviour::Shrinks,
        _ => Behaviour::Settles,
    };
    if behaviour != Behaviour::Settles {
        return Trend { behaviour, power, power_std, limit: None, ci95: None };
    }
    let mut data: Vec<_> = points.iter().map(|(h, y)| (h.powf(order), y.mean, error(y))).collect();
    data.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut fit = line(&data);
    while data.len() > 3 && fit.misfit > 2.0 {
        data.pop();
        fit = line(&data);
    }
    let half = NORMAL95 * fit.intercept_std;
    let ci95 = Some([fit.intercept - half, fit.intercept + half]);
    Trend { behaviour, power, power_std, limit: Some(fit.intercept), ci95 }
}

/// A straight line through data with errors.
#[derive(Clone, Copy, Debug)]
pub struct FittedLine {
    /// Value at x = 0, and its standard error.
    pub intercept: f64,
    /// See [`FittedLine::intercept`].
    pub intercept_std: f64,
    /// Slope, and its standard error.
    pub slope: f64,
    /// See [`FittedLine::slope`].
    pub slope_std: f64,
    /// χ² per degree of freedom; 1 where there is none left.
    pub misfit: f64,
}

/// Least squares of (x, y, error of y), weighted. Errors are enlarged where the line misses the data
/// by more than they say. All x equal give no numbers.
pub fn line(data: &[(f64, f64, f64)]) -> FittedLine {
    let weight = |e: f64| 1.0 / (e * e);
    let sum = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
        data.iter().map(|&(x, y, e)| weight(e) * f(x, y)).sum()
    };
    let (s, sx, sy) = (sum(&|_, _| 1.0), sum(&|x, _| x), sum(&|_, y| y));
    let (xm, ym) = (sx / s, sy / s);
    let sxx = sum(&|x, _| (x - xm).powi(2));
    let slope = sum(&|x, y| (x - xm) * (y - ym)) / sxx;
    let intercept = ym - slope * xm;
    let free = data.len().saturating_sub(2);
    let chi2 = sum(&|x, y| (y - intercept - slope * x).powi(2));
    let misfit = if free > 0 { chi2 / free as f64 } else { 1.0 };
    let enlarged = misfit.max(1.0).sqrt();
    FittedLine {
        intercept,
        intercept_std: enlarged * (1.0 / s + xm * xm / sxx).sqrt(),
        slope,
        slope_std: enlarged / sxx.sqrt(),
        misfit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(f: impl Fn(f64) -> f64, sem: f64) -> Vec<(f64, Mean)> {
        [1e-4, 5e-5, 2e-5, 1e-5, 5e-6].map(|h| (h, Mean { mean: f(h), sem })).to_vec()
    }

    #[test]
    fn a_limit_is_extrapolated() {
        let trend = trend(&points(|h| 3.0 + 4e3 * h, 0.01), 1.0);
        assert_eq!(trend.behaviour, Behaviour::Settles);
        let [low, high] = trend.ci95.unwrap();
        assert!((trend.limit.unwrap() - 3.0).abs() < 1e-9 && low < 3.0 && 3.0 < high);
    }

    #[test]
    fn growth_has_no_limit() {
        let trend = trend(&points(|h| 5e-4 / h, 1.0), 1.0);
        assert_eq!((trend.behaviour, trend.limit), (Behaviour::Grows, None));
        assert!((trend.power + 1.0).abs() < 1e-9);
    }

    #[test]
    fn little_data_give_no_panic() {
        assert_eq!(trend(&[], 1.0).behaviour, Behaviour::Unknown);
        let one = [(1e-5, Mean { mean: 2.0, sem: 0.1 })];
        assert_eq!(trend(&one, 1.0).behaviour, Behaviour::Unknown);
        let nan = Mean::of([f64::NAN].into_iter());
        assert_eq!(trend(&[(1e-5, nan), (1e-6, nan)], 1.0).behaviour, Behaviour::Unknown);
        assert_eq!(trend(&points(|_| 0.0, 0.0), 1.0).limit, Some(0.0));
    }

    #[test]
    fn means_have_standard_errors() {
        let mean = Mean::of([1.0, 2.0, 3.0, f64::NAN].into_iter());
        assert!((mean.mean - 2.0).abs() < 1e-15 && (mean.sem - (1f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(Mean::of([2.0].into_iter()).sem, 0.0);
    }
}
