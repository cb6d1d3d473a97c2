//! The search for the numbers of a motion: an evolution strategy without derivatives.
//!
//! R. Ros, N. Hansen, "A simple modification in CMA-ES achieving linear time and space complexity", PPSN X (2008)
//! 296–305 (sep-CMA-ES), with the default parameters of N. Hansen, "The CMA evolution strategy: a tutorial",
//! arXiv:1604.00772, table 1: numbers are drawn about a mean with a standard deviation each, and both follow the better
//! half of what was drawn. Own code of some lines: crates of this method bring another nalgebra, and only ranks of what
//! is drawn count, so that candidates that cannot be are simply last.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

/// How much is tried.
#[derive(Clone, Copy, Debug)]
pub struct SearchEffort {
    /// Random candidates, of which the best are starts.
    pub random: usize,
    /// Starts that are followed.
    pub starts: usize,
    /// Candidates of a start in a generation.
    pub children: usize,
    /// Generations.
    pub generations: usize,
}

impl SearchEffort {
    /// About so many candidates: a sixth of them random, the rest children of the three best.
    pub fn of(candidates: usize) -> Self {
        let (starts, children) = (3, 8);
        let random = (candidates / 6).max(children);
        let generations = candidates.saturating_sub(random) / (starts * children);
        Self { random, starts, children, generations }
    }

    /// Candidates altogether.
    pub fn candidates(&self) -> usize {
        self.random + self.starts * self.children * self.generations
    }
}

/// Standard deviation of a start's children at first, of numbers that are drawn with one of one.
const STEP: f64 = 0.4;

/// A candidate and its worth.
#[derive(Clone, Debug)]
pub struct ScoredNumbers {
    /// Its numbers.
    pub numbers: Vec<f64>,
    /// The larger, the better; negative infinity of one that cannot be.
    pub worth: f64,
}

/// The best candidates by `worth`, one of each start, the best first; the same on any number of threads. `tell` hears how
/// many were tried and what the best is worth.
pub fn best(
    count: usize,
    seed: u64,
    effort: SearchEffort,
    worth: &(dyn Fn(&[f64]) -> Option<f64> + Sync),
    tell: &(dyn Fn(usize, f64) + Sync),
) -> Vec<ScoredNumbers> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let all = |drawn: Vec<Vec<f64>>| -> Vec<ScoredNumbers> {
        let scored = |numbers: Vec<f64>| {
            let found = worth(&numbers).filter(|worth| worth.is_finite());
            ScoredNumbers { worth: found.unwrap_or(f64::NEG_INFINITY), numbers }
        };
        drawn.into_par_iter().map(scored).collect()
    };
    let drawn = (0..effort.random).map(|_| normal(count, &mut random)).collect();
    let mut first = all(drawn);
    first.sort_by(|a, b| b.worth.total_cmp(&a.worth));
    first.retain(|candidate| candidate.worth.is_finite());
    first.truncate(effort.starts);
    let mut starts: Vec<FollowedStart> =
        first.into_iter().map(|best| FollowedStart::new(best, effort.children)).collect();
    for generation in 0..effort.generations {
        let tried = effort.random + generation * effort.starts * effort.children;
        tell(tried, starts.iter().map(|start| start.best.worth).fold(f64::NEG_INFINITY, f64::max));
        let steps: Vec<Vec<f64>> = starts
            .iter()
            .flat_map(|_| {
                (0..effort.children).map(|_| normal(count, &mut random)).collect::<Vec<_>>()
            })
            .collect();
        let drawn =
            steps.iter().enumerate().map(|(i, z)| starts[i / effort.children].child(z)).collect();
        let scored = all(drawn);
        let parts = scored.chunks(effort.children).zip(steps.chunks(effort.children));
        for (start, (scored, steps)) in starts.iter_mut().zip(parts) {
            start.follow(scored, steps);
        }
    }
    let mut found: Vec<ScoredNumbers> = starts.into_iter().map(|start| start.best).collect();
    found.sort_by(|a, b| b.worth.total_cmp(&a.worth));
    found
}

fn normal(count: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
    (0..count).map(|_| StandardNormal.sample(&mut *random)).collect()
}

/// A start that is followed.
struct FollowedStart {
    mean: Vec<f64>,
    /// Variance of each number, and the step that all have in common.
    variances: Vec<f64>,
    step: f64,
    /// Paths of the evolution.
    of_step: Vec<f64>,
    of_variance: Vec<f64>,
    weights: Vec<f64>,
    generation: i32,
    best: ScoredNumbers,
}

impl FollowedStart {
    fn new(best: ScoredNumbers, children: usize) -> Self {
        let n = best.numbers.len();
        let parents = children / 2;
        let raw: Vec<f64> =
            (1..=parents).map(|i| ((parents as f64 + 0.5) / i as f64).ln()).collect();
        let sum: f64 = raw.iter().sum();
        Self {
            mean: best.numbers.clone(),
            variances: vec![1.0; n],
            step: STEP,
            of_step: vec![0.0; n],
            of_variance: vec![0.0; n],
            weights: raw.into_iter().map(|w| w / sum).collect(),
            generation: 0,
            best,
        }
    }

    fn child(&self, z: &[f64]) -> Vec<f64> {
        let parts = self.mean.iter().zip(&self.variances).zip(z);
        parts.map(|((mean, variance), z)| mean + self.step * variance.sqrt() * z).collect()
    }

    fn follow(&mut self, scored: &[ScoredNumbers], steps: &[Vec<f64>]) {
        let mut order: Vec<usize> = (0..scored.len()).collect();
        order.sort_by(|a, b| scored[*b].worth.total_cmp(&scored[*a].worth));
        if scored[order[0]].worth > self.best.worth {
            self.best = scored[order[0]].clone();
        }
        order.truncate(self.weights.len());
        let n = self.mean.len() as f64;
        let mass = 1.0 / self.weights.iter().map(|w| w * w).sum::<f64>();
        let c_step = (mass + 2.0) / (n + mass + 5.0);
        let damping = 1.0 + c_step + 2.0 * (((mass - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0);
        let c_path = (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n);
        // Rates of a diagonal are (n + 2)/3 times those of a full matrix: Ros and Hansen, section 3.
        let faster = (n + 2.0) / 3.0;
        let c_one = (faster * 2.0 / ((n + 1.3).powi(2) + mass)).min(0.5);
        let c_many = faster * 2.0 * (mass - 2.0 + 1.0 / mass) / ((n + 2.0).powi(2) + mass);
        let c_many = c_many.clamp(0.0, 1.0 - c_one);
        self.generation += 1;
        let moved: Vec<f64> = (0..self.mean.len())
            .map(|k| order.iter().zip(&self.weights).map(|(i, w)| w * steps[*i][k]).sum())
            .collect();
        let keep = (c_step * (2.0 - c_step) * mass).sqrt();
        for (path, z) in self.of_step.iter_mut().zip(&moved) {
            *path = (1.0 - c_step) * *path + keep * z;
        }
        let length = self.of_step.iter().map(|p| p * p).sum::<f64>().sqrt();
        let expected = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        let settled = (1.0 - (1.0 - c_step).powi(2 * self.generation)).sqrt();
        let stall = if length / settled < (1.4 + 2.0 / (n + 1.0)) * expected { 1.0 } else { 0.0 };
        let keep = stall * (c_path * (2.0 - c_path) * mass).sqrt();
        for k in 0..self.mean.len() {
            let root = self.variances[k].sqrt();
            self.mean[k] += self.step * root * moved[k];
            self.of_variance[k] = (1.0 - c_path) * self.of_variance[k] + keep * root * moved[k];
            let many: f64 =
                order.iter().zip(&self.weights).map(|(i, w)| w * steps[*i][k].powi(2)).sum();
            let one = self.of_variance[k].powi(2);
            self.variances[k] *= 1.0 - c_one - c_many + c_many * many;
            self.variances[k] += c_one * one;
        }
        self.step *= (c_step / damping * (length / expected - 1.0)).exp();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EFFORT: SearchEffort =
        SearchEffort { random: 24, starts: 2, children: 10, generations: 150 };

    fn ellipsoid(x: &[f64]) -> Option<f64> {
        // Half of the space cannot be.
        (x[0] < 2.0).then(|| {
            let parts = x.iter().enumerate();
            -parts.map(|(i, x)| 30f64.powf(i as f64 / 9.0) * (x - 0.5).powi(2)).sum::<f64>()
        })
    }

    #[test]
    fn it_finds_the_top_of_a_stretched_hill_beside_a_wall() {
        let found = best(10, 3, EFFORT, &ellipsoid, &|_, _| {});
        assert!(found[0].worth > -1e-4, "{:?}", found[0]);
        assert_eq!(found.len(), EFFORT.starts);
    }

    #[test]
    fn threads_do_not_matter() {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                best(10, 3, SearchEffort { generations: 5, ..EFFORT }, &ellipsoid, &|_, _| {})
            })
        };
        let [one, three] = [on(1), on(3)];
        assert_eq!(one[0].numbers, three[0].numbers);
    }

    #[test]
    fn where_nothing_can_be_nothing_is_found() {
        assert!(best(4, 1, EFFORT, &|_| None, &|_, _| {}).is_empty());
    }
}
