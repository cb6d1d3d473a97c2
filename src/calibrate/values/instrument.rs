//! Values without the pull of what rattles.
//!
//! Where joints rattle, what a look multiplies a value by is itself full of rattle: where a journal leans
//! is read off forces that fly about. Least squares then make such a value small, as they do with any
//! regressor that carries errors ("attenuation"; Fuller, *Measurement Error Models*, 1987, §1.1): a worn
//! clearance of 0.27 mm settles at 0.2 mm. Replicas of the model rattle otherwise than the data, so the mean of
//! their derivatives, `J̄`, knows nothing of the data's rattle: `J̄ᵀ r(θ) = 0` (instrumental variables, §1.4
//! there) has the right values as its answer.

use super::least_squares::{Free, free, jacobian, values, with_values};
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Steps towards the answer, at most: residuals are nearly linear in most values.
const STEPS: usize = 3;

/// Standard deviations that are no step.
const SETTLED: f64 = 0.05;

/// Factor by which the sum of squares may grow in a step: more is no rattle but a wrong way.
const GROWTH: f64 = 1.5;

/// Ridge, relative to the diagonal: values that the data cannot tell apart stay where they are.
const RIDGE: f64 = 1e-6;

/// Residuals of a model that rattles, of the data and of replicas of the model, in units of noise.
pub trait Replicated: Sync {
    /// How many replicas there are.
    fn replicas(&self) -> usize;

    /// What is left of the data with these effects; none where there is no such machine.
    fn white(&self, effects: &[Setting]) -> Option<DVector<f64>>;

    /// The same of a replica of the model in place of the data.
    fn white_of(&self, effects: &[Setting], replica: usize) -> Option<DVector<f64>>;
}

/// Values that rattle does not pull.
#[derive(Clone, Debug)]
pub struct Unpulled {
    /// The effects with them.
    pub effects: Vec<Setting>,
    /// What is left with these.
    pub white: DVector<f64>,
    /// The derivatives from which their intervals follow, if there are any.
    pub jacobian: Option<DMatrix<f64>>,
}

/// Values that rattle does not pull, from those of least squares and what they leave on.
pub fn unpulled(
    target: &impl Replicated,
    effects: &[Setting],
    white: DVector<f64>,
    jacobian: Option<DMatrix<f64>>,
) -> Unpulled {
    let free = free(effects);
    let mut best = Unpulled { effects: effects.to_vec(), white, jacobian };
    for _ in 0..STEPS {
        let Some(ExpectedDerivatives { jacobian, shared }) = expected(target, &best.effects, &free)
        else {
            break;
        };
        let step = step(&jacobian, &(jacobian.transpose() * &best.white + shared));
        let values = values(&best.effects);
        let bounded = values.iter().zip(step.iter()).zip(&free);
        let moved: Vec<f64> = bounded
            .map(|((value, step), free)| (value + step).clamp(free.bounds[0], free.bounds[1]))
            .collect();
        let sigmas = (&jacobian * step).norm();
        best.jacobian = Some(jacobian);
        let effects = with_values(&best.effects, &moved);
        let most = GROWTH * best.white.norm_squared();
        let there = target.white(&effects).filter(|white| white.norm_squared() < most);
        let Some(white) = there else { break };
        best = Unpulled { effects, white, ..best };
        if sigmas < SETTLED {
            break;
        }
    }
    best
}

/// What the residual would be with effects `to` in place of `from`, by what replicas say of the change:
/// the data's own rattle has no part in it. None where such a machine cannot be.
pub fn changed(target: &impl Replicated, from: &[Setting], to: &[Setting]) -> Option<DVector<f64>> {
    let replicas = target.replicas();
    let of = |replica| Some(target.white_of(to, replica)? - target.white_of(from, replica)?);
    let change = (0..replicas).map(of).sum::<Option<DVector<f64>>>()?;
    Some(target.white(from)? + change / replicas as f64)
}

/// What replicas say of a model's derivatives.
struct ExpectedDerivatives {
    /// Mean of the replicas' derivatives of the residual by each value.
    jacobian: DMatrix<f64>,
    /// The bias in `r` is the mean of the same replicas, so `J̄ᵀ r` has a share of the covariance that
    /// pulls least squares, of the other sign: this makes good for it, as if each replica's derivatives
    /// were held against the bias of the others.
    shared: DVector<f64>,
}

fn expected(
    target: &impl Replicated,
    effects: &[Setting],
    free: &[Free],
) -> Option<ExpectedDerivatives> {
    let values = values(effects);
    let count = target.replicas();
    let of = |replica: usize| {
        let look = |values: &[f64]| target.white_of(&with_values(effects, values), replica);
        let own = look(&values)?;
        Some((jacobian(&look, free, &values, &own)?, own))
    };
    let all = (0..count).into_par_iter().map(of).collect::<Option<Vec<_>>>()?;
    let share = 1.0 / count as f64;
    let (rows, columns) = all.first()?.0.shape();
    let mut jacobian = DMatrix::zeros(rows, columns);
    let mut mean = DVector::zeros(rows);
    for (own, white) in &all {
        jacobian += own * share;
        mean += white * share;
    }
    let together = all.iter().map(|(own, white)| own.transpose() * (white - &mean));
    let shared = together.sum::<DVector<f64>>() * (share / (count as f64 - 1.0));
    Some(ExpectedDerivatives { jacobian, shared })
}

/// The step of Gauss and Newton for this gradient.
fn step(jacobian: &DMatrix<f64>, gradient: &DVector<f64>) -> DVector<f64> {
    let mut normal = jacobian.transpose() * jacobian;
    for i in 0..normal.nrows() {
        normal[(i, i)] *= 1.0 + RIDGE;
    }
    let solved = normal.cholesky().map(|factor| -factor.solve(gradient));
    solved.unwrap_or_else(|| DVector::zeros(jacobian.ncols()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::named;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Rows of a residual, and replicas.
    const ROWS: usize = 4000;
    const REPLICAS: usize = 6;

    /// What a recording shows is a value times what a model multiplies it by, which a look sees with half as much rattle
    /// of the recording's own as it is large itself; likewise of replicas at half that value.
    struct Rattling {
        data: DVector<f64>,
        seen: DVector<f64>,
        half: f64,
        replicas: Vec<DVector<f64>>,
        shown: DVector<f64>,
    }

    impl Rattling {
        fn new(value: f64) -> Self {
            let mut random = ChaCha8Rng::seed_from_u64(1);
            let mut normal = || DVector::from_fn(ROWS, |_, _| StandardNormal.sample(&mut random));
            let right: DVector<f64> = normal();
            let mut rattling = || -> DVector<f64> { &right + normal() * 0.5 };
            let (seen, replicas) = (rattling(), (0..REPLICAS).map(|_| rattling()).collect());
            let half = 0.5 * value;
            Self { data: &right * value, seen, half, replicas, shown: &right * half }
        }

        fn bias(&self) -> DVector<f64> {
            let own = self.replicas.iter().map(|seen| &self.shown - seen * self.half);
            own.sum::<DVector<f64>>() / REPLICAS as f64
        }
    }

    impl Replicated for Rattling {
        fn replicas(&self) -> usize {
            REPLICAS
        }

        fn white(&self, effects: &[Setting]) -> Option<DVector<f64>> {
            Some(&self.data - &self.seen * values(effects)[0] - self.bias())
        }

        fn white_of(&self, effects: &[Setting], replica: usize) -> Option<DVector<f64>> {
            Some(&self.shown - &self.replicas[replica] * values(effects)[0] - self.bias())
        }
    }

    /// Least squares are pulled to 1/(1 + ¼) of the value by half as much rattle as there is of what it is multiplied by.
    #[test]
    fn rattle_does_not_pull_values() {
        let target = Rattling::new(0.3);
        let least = target.seen.dot(&(&target.data - target.bias())) / target.seen.norm_squared();
        assert!((0.22..0.26).contains(&least), "the test rests on it: {least}");
        let friction =
            |mu| vec![Setting::new(named("journal-friction").unwrap(), None, &[("mu", mu)])];
        let start = friction(least);
        let found = unpulled(&target, &start, target.white(&start).unwrap(), None);
        let mu = values(&found.effects)[0];
        assert!((mu - 0.3).abs() < 0.01, "{mu}");
        assert_eq!(found.white, target.white(&found.effects).unwrap());
        // What replicas say of another value knows nothing of the recording's rattle.
        let [to, from] = [0.1, 0.3].map(friction);
        let there = changed(&target, &from, &to).unwrap() - target.white(&from).unwrap();
        let mean = target.replicas.iter().sum::<DVector<f64>>() / REPLICAS as f64;
        assert!((there - mean * 0.2).norm() < 1e-9);
    }
}
