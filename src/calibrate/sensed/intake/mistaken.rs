//! Columns that are not what their heads say: measured series, each held against what it should be like.

/// A series is what it is held against where they differ by less than this share of that: gains of sensors
/// and servos are wrong by a tenth, lags and noise come to a few hundredths.
const ALIKE: f64 = 0.3;

/// It is something else rather than itself where it misses itself by so many times what it misses the other by.
const RATHER: f64 = 3.0;

/// A mistake, by the places of the series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mistake {
    /// It has the opposite sign.
    Sign(usize),
    /// Each of the two is what the other should be.
    Exchanged(usize, usize),
    /// It would be right if it were multiplied by this factor.
    Unit(usize, f64),
}

/// Columns beside what they should be like, drive by drive or sensor by sensor.
pub(super) struct FollowedColumns {
    pub sensors: Vec<Option<usize>>,
    pub series: Vec<Option<[Vec<f64>; 2]>>,
}

impl FollowedColumns {
    pub fn of(drives: impl Iterator<Item = Option<(usize, [Vec<f64>; 2])>>) -> Self {
        let (sensors, series) =
            drives.map(|found| (found.as_ref().map(|(s, _)| *s), found.map(|(_, s)| s))).unzip();
        Self { sensors, series }
    }
}

/// Values about their mean.
pub(super) fn about(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| value - mean).collect()
}

/// Mistakes of series, each with what it should be like, in another unit by one of these `factors` at most; a series that is
/// not there, or of which nobody knows what it should be like, is none.
pub fn mistakes(series: &[Option<[Vec<f64>; 2]>], factors: &[f64]) -> Vec<Mistake> {
    // What series `i` times a factor misses that by which `j` should be like, as a share of that.
    let missed = |i: usize, j: usize, factor: f64| {
        let ([own, _], [_, right]) = (series[i].as_ref()?, series[j].as_ref()?);
        let apart = own.iter().zip(right).map(|(own, right)| factor * own - right);
        Some(rms(apart) / rms(right.iter().copied()))
    };
    // Whether `i` is rather like `j` with a factor than like what it should be.
    let rather = |i: usize, j: usize, factor: f64| {
        let (other, own) = (missed(i, j, factor), missed(i, i, 1.0));
        other.zip(own).is_some_and(|(other, own)| other < ALIKE && own > RATHER * other)
    };
    let mut found = Vec::new();
    for i in 0..series.len() {
        let missed_by = |factor: &f64| missed(i, i, *factor).unwrap_or(f64::INFINITY);
        let unit = factors.iter().min_by(|a, b| missed_by(a).total_cmp(&missed_by(b)));
        if rather(i, i, -1.0) {
            found.push(Mistake::Sign(i));
        } else if let Some(&factor) = unit
            && rather(i, i, factor)
        {
            found.push(Mistake::Unit(i, factor));
        }
        let exchanged = |j: &usize| rather(i, *j, 1.0) && rather(*j, i, 1.0);
        found.extend((i + 1..series.len()).filter(exchanged).map(|j| Mistake::Exchanged(i, j)));
    }
    found
}

/// Root mean square.
pub fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_are_told_and_what_is_a_little_wrong_is_none() {
        let wave = |amplitude: f64, rate: f64| -> Vec<f64> {
            (0..500).map(|i| amplitude * (rate * f64::from(i)).sin()).collect()
        };
        let of = |measured: [Vec<f64>; 2]| {
            let right = [wave(1.0, 0.05), wave(2.0, 0.08)];
            let pairs = measured.into_iter().zip(right).map(|(a, b)| Some([a, b]));
            mistakes(&pairs.collect::<Vec<_>>(), &[1e3, 0.01])
        };
        assert_eq!(of([wave(1.1, 0.05), wave(1.8, 0.0801)]), []);
        assert_eq!(of([wave(-1.1, 0.05), wave(2.0, 0.08)]), [Mistake::Sign(0)]);
        assert_eq!(of([wave(1.0, 0.05), wave(200.0, 0.08)]), [Mistake::Unit(1, 0.01)]);
        assert_eq!(of([wave(2.0, 0.08), wave(1.0, 0.05)]), [Mistake::Exchanged(0, 1)]);
        // Something else altogether, or still: nobody knows what was meant.
        assert_eq!(of([wave(1.0, 0.3), wave(0.0, 0.08)]), []);
        assert_eq!(mistakes(&[None, None], &[1e3]), []);
    }
}
