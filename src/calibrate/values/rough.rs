//! Least squares of what is rough: no two simulations are off by the same, so that what is left jumps a little from any
//! values to the next.

use super::least_squares::{Best, FitEffort, Free, ResidualAt, jacobian, least_squares};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// A step of Gauss and Newton.
const ONE_STEP: FitEffort = FitEffort { steps: 1, enough: 0.0, secant: false };

/// Steps, at most: jumps of a tenth of a unit lengthen the steps of derivatives tenfold each time, from what a thousandth of a
/// unit changes.
const STEPS: usize = 5;

/// Factor by which a step of a derivative gets longer that is worth another.
const LONGER: f64 = 1.5;

/// Share of the change over which a derivative is taken that a jump is at most: a value is then known to an eighth less than it seems.
const JUMP: f64 = 0.5;

/// Change of a value in units of what changes a residual by one of noise, by which jumps are asked for.
const HAIR: f64 = 1e-3;

/// Least squares from values on at which a fit ended, by derivatives over changes of each value that change the residual by about
/// a unit of noise, or by as much more as [jumps](JUMP) ask for: a jump over a shorter change is taken for a large derivative, by
/// which a value seems known to a fraction of what it is. None where there is no model.
pub fn closest(look: ResidualAt, mut free: Vec<Free>, mut values: Vec<f64>) -> Option<Best> {
    let (mut best, mut known) = (None, None);
    for _ in 0..STEPS {
        let there = least_squares(look, &free, values, ONE_STEP, None)?;
        let mut longer = false;
        if let Some(own) = &there.jacobian {
            let slope = own.column(0).norm();
            let jump = *known.get_or_insert_with(|| jump(look, &free, &there, slope));
            longer = lengthen(&mut free, own, jump);
        }
        values = there.values.clone();
        best = Some(there);
        if !longer {
            break;
        }
    }
    best
}

/// By how much a residual changes that a thousandth of a unit of the first value away, which has this slope there, should hardly
/// change.
fn jump(look: ResidualAt, free: &[Free], there: &Best, slope: f64) -> f64 {
    let mut beside = there.values.clone();
    let hair = HAIR * unit(&free[0], slope, 1.0);
    beside[0] += if beside[0] + hair > free[0].bounds[1] { -hair } else { hair };
    look(&beside).map_or(0.0, |seen| (seen - &there.residual).norm())
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
            free.step = unit(free, column.norm(), 1.0);
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

/// How often the step of a derivative is sought that changes a residual by what it is to change: from a unit of a value, which may
/// be a ten thousandth of that or more than a machine can take, to within a factor of two.
const SOUGHT: usize = 6;

/// Factors by which such a step is shortened where there is no such machine, and lengthened, at least and at most: what jumps do not
/// tell of the right one.
const NO_MACHINE: f64 = 0.05;
/// See [`NO_MACHINE`].
const FURTHER: [f64; 2] = [3.0, 16.0];

/// The derivative of the residual by value `i`, by a difference over as much of it as changes the residual by about `change` units of
/// noise beside what a hair makes of it, which is `rough` at most, away from the nearest bound and no further than the other. None
/// where there is no model beside it.
pub fn derivative_over(
    look: ResidualAt,
    Free { step, bounds: [low, high] }: Free,
    (values, i): (&[f64], usize),
    residual: &DVector<f64>,
    [change, rough]: [f64; 2],
) -> Option<DVector<f64>> {
    let up = values[i] + step <= high;
    let (sign, room) = if up { (1.0, high - values[i]) } else { (-1.0, values[i] - low) };
    let mut step = step.min(room);
    let mut known = None;
    for _ in 0..SOUGHT {
        let mut beside = values.to_vec();
        beside[i] += sign * step;
        let Some(seen) = look(&beside).map(|there| there - residual) else {
            if known.is_some() {
                break;
            }
            step *= NO_MACHINE;
            continue;
        };
        let told = (seen.norm_squared() - rough.powi(2)).max(0.0).sqrt();
        known = Some(seen / (sign * step));
        let [least, most] = FURTHER;
        match change / told {
            ratio if ratio < 0.5 => step *= ratio,
            ratio if ratio > 1.5 && step < room => {
                step = (step * ratio.clamp(least, most)).min(room);
            }
            _ => break,
        }
    }
    known
}

/// Lengthens the steps of values by which a residual in units of noise changes by less than a unit, or than a [jump](JUMP) asks
/// for, and says whether it lengthened one by [much](LONGER).
fn lengthen(free: &mut [Free], jacobian: &DMatrix<f64>, jump: f64) -> bool {
    let change = jump / JUMP;
    let mut longer = false;
    for (free, column) in free.iter_mut().zip(jacobian.column_iter()) {
        let jumps = jump / free.step;
        let told = column.norm_squared() - jumps.powi(2);
        let unit = match change > 1.0 {
            false => unit(free, column.norm(), 1.0),
            // What is hardly more than a jump says nothing.
            true if told < 0.5 * jumps.powi(2) => unit(free, (FURTHER[0] * free.step).recip(), 1.0),
            true => unit(free, told.sqrt(), change),
        };
        longer |= unit > LONGER * free.step;
        free.step = free.step.max(unit);
    }
    longer
}

/// Change of a value that changes a residual by so many units of noise, by the size of its derivative: from one bound it leads no
/// further than half way to the other.
fn unit(Free { bounds, .. }: &Free, slope: f64, change: f64) -> f64 {
    (change / slope).min(0.5 * (bounds[1] - bounds[0]))
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

    /// Hundred rows that jump by 0.3 each, anew at any value, and change by one as the value does; and hundred that nothing changes.
    fn jumping(v: &[f64]) -> Option<DVector<f64>> {
        let mut random = ChaCha8Rng::seed_from_u64(v[0].to_bits());
        let mut rough = || -> f64 { StandardNormal.sample(&mut random) };
        let mut row = |k: usize| if k < 100 { (v[0] - 1.0) + 0.3 * rough() } else { 1.0 };
        Some(DVector::from_fn(200, |k, _| row(k)))
    }

    /// Jumps that are larger than a unit of noise are told from what a value changes, too.
    #[test]
    fn derivatives_are_taken_over_more_than_jumps() {
        let free = vec![Free { step: 0.03, bounds: [-10.0, 10.0] }];
        let best = closest(&jumping, free, vec![1.1]).unwrap();
        let known = inverse_normal(best.jacobian.as_ref().unwrap()).unwrap()[(0, 0)].sqrt();
        assert!((known - 0.1).abs() < 0.03, "{known}");
    }

    /// A derivative over as much of a value as changes hundred rows by ten units beside jumps of four, and over as much as there is.
    #[test]
    fn a_derivative_is_sought_beyond_jumps() {
        let slope = |bounds: [f64; 2], now: f64, asked: [f64; 2]| {
            let left = jumping(&[now]).unwrap();
            let free = Free { step: 1e-4, bounds };
            let slope = derivative_over(&jumping, free, (&[now], 0), &left, asked).unwrap();
            slope.rows(0, 100).mean()
        };
        let wide = [-10.0, 10.0];
        assert!((slope(wide, 0.0, [0.1, 0.0]) - 1.0).abs() > 1.0, "the test rests on it");
        assert!((slope(wide, 0.0, [10.0, 5.0]) - 1.0).abs() < 0.1);
        assert!((slope(wide, 10.0, [10.0, 5.0]) - 1.0).abs() < 0.1, "away from a bound");
        assert!((slope([0.0, 0.5], 0.0, [100.0, 5.0]) - 1.0).abs() < 0.2, "and up to one");
    }
}
