//! Residuals of draws of noise, by channel and frequency, and their means.

/// Residuals by channel and frequency.
pub type Coefficients = Vec<Vec<f64>>;

/// One less the other.
pub fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> Coefficients {
    a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect()).collect()
}

/// The mean of draws.
pub fn mean(draws: &[Coefficients]) -> Coefficients {
    let mut sum = draws[0].clone();
    for draw in &draws[1..] {
        for (sum, value) in sum.iter_mut().flatten().zip(draw.iter().flatten()) {
            *sum += value;
        }
    }
    sum.iter_mut().flatten().for_each(|value| *value /= draws.len() as f64);
    sum
}

/// The mean of `count` draws with one of them left out, if that leaves any.
pub fn without(mean: &[Vec<f64>], own: &[Vec<f64>], count: usize) -> Coefficients {
    if count < 2 {
        return own.to_vec();
    }
    let part = 1.0 / count as f64;
    let left = |(all, own): (&f64, &f64)| (all - part * own) / (1.0 - part);
    mean.iter().zip(own).map(|(all, own)| all.iter().zip(own).map(left).collect()).collect()
}
