//! Least squares of what is rough: no two simulations are off by the same, so that what is left jumps a little from any
//! values to the next.

use super::least_squares::{Best, FitEffort, Free, ResidualAt, least_squares};
use nalgebra::DMatrix;

/// A step of Gauss and Newton.
const ONE_STEP: FitEffort = FitEffort { steps: 1, enough: 0.0, secant: false };

/// Steps, at most: jumps of a tenth of a unit lengthen the steps of derivatives tenfold each time, from what a thousandth of a
/// unit changes.
const STEPS: usize = 5;

/// Factor by which a step of a derivative gets longer that is worth another.
const LONGER: f64 = 1.5;

/// Least squares from values on at which a fit ended, by derivatives over changes of each value that change the residual by about
/// a unit of noise: a jump over a shorter change is taken for a large derivative, by which a value seems known to a fraction of what
/// it is. None where there is no model.
pub fn closest(look: ResidualAt, mut free: Vec<Free>, mut values: Vec<f64>) -> Option<Best> {
    let mut best = None;
    for _ in 0..STEPS {
        let there = least_squares(look, &free, values, ONE_STEP, None)?;
        let longer = there.jacobian.as_ref().is_some_and(|own| lengthen(&mut free, own));
        values = there.values.clone();
        best = Some(there);
        if !longer {
            break;
        }
    }
    best
}

/// Lengthens the steps of values by which a residual in units of noise changes by less than a unit, and says whether it
/// lengthened one by [much](LONGER).
fn lengthen(free: &mut [Free], jacobian: &DMatrix<f64>) -> bool {
    let mut longer = false;
    for (Free { step, bounds }, column) in free.iter_mut().zip(jacobian.column_iter()) {
        // From one bound it leads no further than half way to the other.
        let unit = column.norm().recip().min(0.5 * (bounds[1] - bounds[0]));
        longer |= unit > LONGER * *step;
        *step = step.max(unit);
    }
    longer
}

#[cfg(test)]
mod tests {
    use super::super::normal::inverse_normal;
    use super::*;
    use nalgebra::DVector;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Hundred rows that are off by a hundredth of a unit each, anew at any value, and that know a value to 0.1: by changes
    /// of a thousandth of that it seems known to a hundredth.
    #[test]
    fn roughness_is_not_taken_for_knowledge() {
        let look = |v: &[f64]| {
            let mut random = ChaCha8Rng::seed_from_u64(v[0].to_bits());
            let mut rough = || -> f64 { StandardNormal.sample(&mut random) };
            Some(DVector::from_fn(100, |_, _| (v[0] - 1.0) + 0.01 * rough()))
        };
        let free = vec![Free { step: 1e-4, bounds: [-10.0, 10.0] }];
        let known = |best: &Best| inverse_normal(best.jacobian.as_ref().unwrap()).unwrap()[(0, 0)];
        let short = least_squares(&look, &free, vec![1.1], ONE_STEP, None).unwrap();
        assert!(known(&short).sqrt() < 1e-3, "the test rests on it: {}", known(&short).sqrt());
        let best = closest(&look, free, vec![1.1]).unwrap();
        assert!((known(&best).sqrt() - 0.1).abs() < 0.01, "{}", known(&best).sqrt());
        assert!((best.values[0] - 1.0).abs() < 0.01, "{:?}", best.values);
    }
}
