//! How far chance alone leads, by draws of noise.

use crate::calibrate::sensed::thresholds::CHANCE;
use crate::measure::student::t;

/// The mean square up to which chance leads, out of those of draws of noise: where journals lean under forces no larger than
/// a sensor's noise they spread over a multiple, and their logarithms are nearer to normal than they are.
pub(in crate::calibrate::sensed) fn squares_up_to(
    draws: impl Iterator<Item = f64>,
    replicas: usize,
) -> f64 {
    // A channel without noise has a mean square of zero.
    let logarithms: Vec<f64> = draws.map(|square| square.max(f64::MIN_POSITIVE).ln()).collect();
    up_to(&logarithms, replicas).exp()
}

/// The value up to which chance leads one more draw of noise, out of those of such draws: the i-th one is of replica i mod
/// `replicas`, and draws of one replica have its rattle in common. That is the limit of prediction of an analysis of variance
/// with one random factor, its degrees of freedom after Satterthwaite (1946), An approximate distribution of estimates of
/// variance components: with means squares `M_b` between and `M_w` within replicas of `n` draws each, a draw's variance is
/// `M_b/n + (1 − 1/n) M_w`.
pub fn up_to(draws: &[f64], replicas: usize) -> f64 {
    let (count, groups) = (draws.len() as f64, replicas as f64);
    let mean = draws.iter().sum::<f64>() / count.max(1.0);
    let squares: f64 = draws.iter().map(|d| (d - mean).powi(2)).sum();
    let alone = || (squares / (count - 1.0), count - 1.0, squares / (count - 1.0) / count);
    let (variance, degrees, of_mean) = if (2..draws.len()).contains(&replicas) {
        let of = |replica: usize| draws.iter().skip(replica).step_by(replicas);
        let sizes: Vec<f64> = (0..replicas).map(|replica| of(replica).count() as f64).collect();
        let between: f64 = (0..replicas)
            .map(|replica| {
                sizes[replica] * (of(replica).sum::<f64>() / sizes[replica] - mean).powi(2)
            })
            .sum();
        let within = (squares - between).max(0.0) / (count - groups);
        let between = between / (groups - 1.0);
        let size = (count - sizes.iter().map(|n| n * n).sum::<f64>() / count) / (groups - 1.0);
        let parts = [between / size, (1.0 - 1.0 / size) * within];
        let variance = parts[0] + parts[1];
        let degrees = variance.powi(2)
            / (parts[0].powi(2) / (groups - 1.0) + parts[1].powi(2) / (count - groups));
        // Replicas that differ by less than their draws do have nothing in common.
        if between > within { (variance, degrees, between / count) } else { alone() }
    } else {
        alone()
    };
    if variance > 0.0 {
        mean + t(1.0 - CHANCE, degrees) * (variance + of_mean).sqrt()
    } else {
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::{squares_up_to, up_to};
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Mean squares of sixteen draws of two residuals of one machine: one of journals that lean under next to no force, of
    /// which another draw was 2.6 and a third 3.5, and one of normal noise.
    #[test]
    fn noise_that_spreads_is_given_room() {
        let leaning = [
            0.40, 0.65, 2.69, 0.57, 0.76, 1.33, 0.73, 0.79, 1.11, 0.57, 1.03, 0.91, 0.72, 2.24,
            0.63, 0.91,
        ];
        let normal = [
            1.01, 0.86, 1.01, 1.00, 1.19, 1.01, 1.12, 1.00, 1.03, 1.11, 0.92, 0.95, 1.11, 1.03,
            0.85, 0.92,
        ];
        let [leaning, normal] = [leaning, normal].map(|draws| squares_up_to(draws.into_iter(), 1));
        assert!((4.0..5.0).contains(&leaning), "{leaning}");
        assert!((1.3..1.4).contains(&normal), "{normal}");
        assert!(squares_up_to([0.0; 16].into_iter(), 1) < 1e-300);
    }

    /// One more draw lies beyond as seldom as it is said to, however much draws of one replica have in common.
    #[test]
    fn replicas_that_differ_are_no_more_than_they_are() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        for common in [0.0, 0.5, 2.0] {
            let trials = 20_000;
            let beyond = |_: &i32| {
                let replicas: [f64; 6] = std::array::from_fn(|_| common * normal());
                let draws: Vec<f64> = (0..16).map(|i| replicas[i % 6] + normal()).collect();
                common * normal() + normal() > up_to(&draws, 6)
            };
            let share = (0..trials).filter(beyond).count() as f64 / f64::from(trials);
            assert!((0.5..2.0).contains(&(share / super::CHANCE)), "{common}: {share}");
        }
    }
}
