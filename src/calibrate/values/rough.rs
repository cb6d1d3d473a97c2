//! Least squares of what is rough: no two simulations are off by the same, so that what is left jumps a little from any
//! values to the next.

use super::least_squares::{Best, FitEffort, Free, ResidualAt, jacobian, least_squares};
use nalgebra::DMatrix;
use rayon::prelude::*;

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

/// How far each value is moved both ways to look for others that leave less, in changes of the residual by a unit of noise: of a
/// drive's backlash that takes 4000 off the sum of squares, a fit ended 30 of them beside the hidden value, behind a rise (trial
/// 1160000026).
const AROUND: &[f64] = &[4.0, 8.0, 16.0, 32.0, 64.0, 128.0];

/// The values that leave the least, of those at which a fit ended and those with one of them [moved](AROUND): a fit does not pass a
/// rise. None where there is no model.
pub fn around(look: ResidualAt, mut free: Vec<Free>, values: &[f64]) -> Option<Vec<f64>> {
    let left = look(values)?;
    // Once more over a unit: what a hair changes may be a jump.
    for _ in 0..2 {
        let own = jacobian(look, &free, values, &left)?;
        for (free, column) in free.iter_mut().zip(own.column_iter()) {
            free.step = unit(free, column.norm());
        }
    }
    let moved = |(i, by): (usize, f64)| {
        let Free { step, bounds } = free[i];
        let mut moved = values.to_vec();
        moved[i] = (values[i] + by * step).clamp(bounds[0], bounds[1]);
        Some((look(&moved)?.norm_squared(), moved))
    };
    let places =
        (0..values.len()).flat_map(|i| AROUND.iter().flat_map(move |by| [(i, -by), (i, *by)]));
    let places: Vec<(usize, f64)> = places.collect();
    let beside: Vec<(f64, Vec<f64>)> = places.into_par_iter().filter_map(moved).collect();
    let own = (left.norm_squared(), values.to_vec());
    let least =
        beside.into_iter().fold(own, |least, there| if there.0 < least.0 { there } else { least });
    Some(least.1)
}

/// Lengthens the steps of values by which a residual in units of noise changes by less than a unit, and says whether it
/// lengthened one by [much](LONGER).
fn lengthen(free: &mut [Free], jacobian: &DMatrix<f64>) -> bool {
    let mut longer = false;
    for (free, column) in free.iter_mut().zip(jacobian.column_iter()) {
        let unit = unit(free, column.norm());
        longer |= unit > LONGER * free.step;
        free.step = free.step.max(unit);
    }
    longer
}

/// Change of a value that changes a residual by a unit of noise, by the size of its derivative: from one bound it leads no further
/// than half way to the other.
fn unit(Free { bounds, .. }: &Free, slope: f64) -> f64 {
    slope.recip().min(0.5 * (bounds[1] - bounds[0]))
}

#[cfg(test)]
mod tests {
    use super::super::normal::inverse_normal;
    use super::*;
    use nalgebra::DVector;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// A fit ends before what stands between it and the least that can be left.
    #[test]
    fn what_is_less_beyond_a_rise_is_found() {
        let look = |v: &[f64]| {
            let away = v[0] - 1.0;
            Some(DVector::from_vec(vec![0.5 * away, 1.5 * (2.0 * away).sin(), v[1]]))
        };
        let free = vec![Free { step: 1e-4, bounds: [-10.0, 10.0] }; 2];
        let there = closest(&look, free.clone(), vec![2.7, 0.5]).unwrap().values;
        assert!((there[0] - 2.55).abs() < 0.1, "the test rests on it: {there:?}");
        let found = around(&look, free.clone(), &there).unwrap();
        let found = closest(&look, free, found).unwrap().values;
        assert!((found[0] - 1.0).abs() < 0.05 && found[1].abs() < 1e-6, "{found:?}");
    }

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
