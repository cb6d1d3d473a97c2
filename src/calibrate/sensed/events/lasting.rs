//! What a model misses again and again, as functions of the motion: friction of another form, a centre of mass a
//! little off. Against that an event has to stand out.

use super::series::{Freedom, FreedomSeries, means, scatter};
use crate::calibrate::sensed::thresholds::{EVENT_CORNER, RESTING, ROWS_A_FEATURE};
use crate::measure::filter::ZeroPhase;
use nalgebra::{DMatrix, DVector};

/// Shares of a joint's root mean square rate at which friction turns round: steep, and as gears smear it.
const TURNING: [f64; 3] = [0.02, 0.1, 0.4];

/// Time in s over which accelerations are averaged for a feature, and rates to see rest: beyond the noise of their
/// readings.
const SLOW: f64 = 0.08;

/// Passes of reweighting.
const PASSES: usize = 8;

/// Deviations from which values count less (Huber's weights, 95 % efficient).
const OUTSIDE: f64 = 1.345;

/// Share of a feature's own square that is added to it, against features that say the same twice.
const RIDGE: f64 = 1e-5;

/// What recurs with the motion in one recording.
#[derive(Clone, Debug)]
pub struct Lasting {
    /// Root mean square rate of each joint in that recording.
    rates: Vec<f64>,
    /// Whether the recording was long enough for functions of the motion, rather than a constant alone.
    moving: bool,
    /// Factors of the functions, freedom by freedom.
    factors: Vec<DVector<f64>>,
}

impl Lasting {
    /// Of a recording's efforts below [`EVENT_CORNER`].
    pub fn of(series: &FreedomSeries, low: &[Vec<f64>]) -> Self {
        let rates: Vec<f64> = moving(series).map(|(_, [_, rate, _])| rms(rate)).collect();
        let all = features(series, &rates);
        let moving = series.count() >= ROWS_A_FEATURE * all.len();
        let features = if moving { all } else { vec![vec![1.0; series.count()]] };
        let factors = low.iter().map(|low| factors(low, &features)).collect();
        Self { rates, moving, factors }
    }

    /// Efforts of a recording below [`EVENT_CORNER`] without it.
    pub fn cleared(&self, series: &FreedomSeries, low: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let features = match self.moving {
            true => features(series, &self.rates),
            false => vec![vec![1.0; series.count()]],
        };
        let clear = |(low, factors): (&Vec<f64>, &DVector<f64>)| {
            let mut left = low.clone();
            for (feature, factor) in features.iter().zip(factors.iter()) {
                left.iter_mut().zip(feature).for_each(|(left, value)| *left -= factor * value);
            }
            left
        };
        low.iter().zip(&self.factors).map(clear).collect()
    }
}

/// Efforts of each freedom below [`EVENT_CORNER`].
pub fn low(series: &FreedomSeries) -> Vec<Vec<f64>> {
    let nyquist = 0.5 / series.interval;
    let filter = (EVENT_CORNER < 0.9 * nyquist)
        .then(|| ZeroPhase::butterworth(4, EVENT_CORNER, series.interval));
    let pass = |freedom: &Freedom| match &filter {
        Some(filter) => filter.apply(&freedom.effort),
        None => freedom.effort.clone(),
    };
    series.freedoms.iter().map(pass).collect()
}

/// Where joints rest, freedom by freedom: 1 there, 0 where they move.
pub fn rests(series: &FreedomSeries) -> Vec<Vec<f64>> {
    let of = |freedom: &Freedom| {
        let Some([_, rate, _]) = &freedom.motion else { return vec![0.0; series.count()] };
        let still = RESTING * rms(rate);
        let slow = slowed(rate, series).into_iter();
        slow.map(|rate| f64::from(u8::from(rate.abs() < still))).collect()
    };
    series.freedoms.iter().map(of).collect()
}

/// Freedoms whose motion was measured.
fn moving(series: &FreedomSeries) -> impl Iterator<Item = (&Freedom, &[Vec<f64>; 3])> {
    series.freedoms.iter().filter_map(|freedom| Some((freedom, freedom.motion.as_ref()?)))
}

fn rms(values: &[f64]) -> f64 {
    let squares: f64 = values.iter().map(|value| value * value).sum();
    (squares / values.len().max(1) as f64).sqrt().max(f64::MIN_POSITIVE)
}

/// Means over [`SLOW`] at every instant, ends repeated.
fn slowed(values: &[f64], series: &FreedomSeries) -> Vec<f64> {
    let width = series.instants(SLOW).min(values.len());
    let inner = means(values, width);
    let last = inner.len().saturating_sub(1);
    let at = |i: usize| inner.get(i.saturating_sub(width / 2).min(last)).copied();
    (0..values.len()).map(|i| at(i).unwrap_or(0.0)).collect()
}

/// Functions of the motion at all instants: of each joint its direction at several speeds, its rate, drag, place
/// and acceleration; of each pair the product of rates, and of angles their sum.
fn features(series: &FreedomSeries, rates: &[f64]) -> Vec<Vec<f64>> {
    let mut features = vec![vec![1.0; series.count()]];
    let moving: Vec<_> = moving(series).collect();
    let map = |values: &[f64], by: &dyn Fn(f64) -> f64| values.iter().map(|v| by(*v)).collect();
    for (i, (freedom, [place, rate, acceleration])) in moving.iter().enumerate() {
        for share in TURNING {
            features.push(map(rate, &|v| (v / (share * rates[i])).tanh()));
        }
        features.push(rate.clone());
        features.push(map(rate, &|v| v * v.abs()));
        if freedom.turns {
            features.push(map(place, &f64::sin));
            features.push(map(place, &f64::cos));
        } else {
            features.push(place.clone());
            features.push(map(place, &|q| q * q));
        }
        features.push(slowed(acceleration, series));
        for (other, [place2, rate2, _]) in &moving[..i] {
            let pairs = |a: &[f64], b: &[f64], by: &dyn Fn(f64, f64) -> f64| {
                a.iter().zip(b).map(|(a, b)| by(*a, *b)).collect::<Vec<f64>>()
            };
            features.push(pairs(rate, rate2, &|a, b| a * b));
            if freedom.turns && other.turns {
                features.push(pairs(place, place2, &|a, b| (a + b).sin()));
                features.push(pairs(place, place2, &|a, b| (a + b).cos()));
            }
        }
    }
    features
}

/// Factors by which features explain a signal, by least squares in which what stands out counts less (Huber, *Ann.
/// Math. Stat.* 35, 1964).
fn factors(signal: &[f64], features: &[Vec<f64>]) -> DVector<f64> {
    let scales: Vec<f64> = features.iter().map(|feature| rms(feature)).collect();
    let matrix =
        DMatrix::from_fn(signal.len(), features.len(), |row, k| features[k][row] / scales[k]);
    let values = DVector::from_column_slice(signal);
    let mut factors = DVector::zeros(features.len());
    let mut weights = DVector::from_element(signal.len(), 1.0);
    for _ in 0..PASSES {
        let mut weighted = matrix.clone();
        for mut column in weighted.column_iter_mut() {
            column.component_mul_assign(&weights);
        }
        let mut normal = weighted.tr_mul(&matrix);
        for k in 0..features.len() {
            normal[(k, k)] *= 1.0 + RIDGE;
        }
        let Some(solved) = normal.cholesky() else { break };
        factors = solved.solve(&weighted.tr_mul(&values));
        let left = &values - &matrix * &factors;
        let usual = scatter(left.as_slice()).max(f64::MIN_POSITIVE);
        weights = left.map(|value| (OUTSIDE * usual / value.abs()).min(1.0));
    }
    DVector::from_fn(features.len(), |k, _| factors[k] / scales[k])
}
