//! How likely it is that a recording swings otherwise than its model.

use crate::calibrate::sensed::thresholds::MISSED;
use crate::calibrate::values::draws::{Coefficients, difference};
use crate::calibrate::values::spectrum::{Covariances, Noise};
use std::f64::consts::SQRT_2;

/// What of the residual is a swing. Where loads keep joints in contact, bodies swing in their play, and nobody knows how they
/// were let go: what the same machine does without a swing tells where that shows.
pub(super) fn swing(bias: &[Vec<f64>], still: Option<&Coefficients>) -> Coefficients {
    let nothing = || bias.iter().map(|c| vec![0.0; c.len()]).collect();
    still.map_or_else(nothing, |still| difference(bias, still))
}

/// Shares of the model's swing by which the recorded one may differ from it: from those of models that swing as recorded
/// to one of the same size and any phase.
fn shares() -> [f64; SHARES] {
    let step = |k: usize| k as f64 / (SHARES - 1) as f64;
    std::array::from_fn(|k| MISSED * (SQRT_2 / MISSED).powf(step(k)))
}

/// Number of these: each half again as large as the one before.
const SHARES: usize = 5;

/// The likeliest noise, by the share of the swing in it.
pub(super) struct Likeliest {
    pub share: f64,
    pub noise: Noise,
    /// What the noise has more of, as a logarithm of its determinant, than that of a model that swings as recorded.
    pub lost: f64,
}

impl Likeliest {
    /// That of what is `left` of the data.
    pub fn of(draws: &[Coefficients], left: &[Vec<f64>], swing: &[Vec<f64>]) -> Self {
        let covariances = Covariances::from_draws(draws, swing);
        let near = covariances.noise(MISSED);
        if swing.iter().flatten().all(|value| *value == 0.0) {
            return Self { share: MISSED, noise: near, lost: 0.0 };
        }
        let least = near.swinging();
        let likelihood = |noise: &Noise| noise.whiten(left).norm_squared() + noise.swinging();
        let mut best = (likelihood(&near), MISSED, near);
        for share in shares().into_iter().skip(1) {
            let noise = covariances.noise(share);
            let own = likelihood(&noise);
            if own < best.0 {
                best = (own, share, noise);
            }
        }
        let (_, share, noise) = best;
        Self { share, lost: noise.swinging() - least, noise }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::thresholds::DRAWS;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// A recorded swing of the model's size and another phase is noise of its size; one that is nearly the model's is not taken
    /// for more.
    #[test]
    fn a_swing_is_as_likely_as_it_is_large() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let mut normal = || Distribution::<f64>::sample(&StandardNormal, &mut random);
        let draws: Vec<Coefficients> =
            (0..DRAWS).map(|_| vec![(0..400).map(|_| normal()).collect()]).collect();
        let sharp = |k: usize| 30.0 * (-((k as f64 - 200.0) / 20.0).powi(2)).exp();
        let swing = vec![(0..400).map(|k| sharp(k) * (0.3 * k as f64).sin()).collect::<Vec<_>>()];
        let mut likeliest = |size: f64| {
            let other = |k: usize| size * sharp(k) * (0.3 * k as f64 + 1.5).sin();
            let left = vec![(0..400).map(|k| other(k) + normal()).collect()];
            let found = Likeliest::of(&draws, &left, &swing);
            (found.share, found.noise.whiten(&left).norm_squared() / 400.0, found.lost)
        };
        let (share, mean_square, lost) = likeliest(0.1);
        assert!(share == MISSED && mean_square < 1.2 && lost == 0.0, "{share} {mean_square}");
        let (share, mean_square, lost) = likeliest(0.7);
        assert!((0.4..1.1).contains(&share) && (0.7..1.3).contains(&mean_square) && lost > 0.0);
        let (share, mean_square, _) = likeliest(1.4);
        assert!(share > 0.9 && (0.7..1.3).contains(&mean_square), "{share} {mean_square}");
    }
}
