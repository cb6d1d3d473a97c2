//! The explicit Runge–Kutta pair of orders 5(4) by Tsitouras, first same as last, for `q̈ = a(t, q, q̇)`.
//!
//! Ch. Tsitouras, *Runge–Kutta pairs of order 5(4) satisfying only the first column simplifying assumption*,
//! Computers & Mathematics with Applications 62 (2011) 770–775. Put into one another, the stages' velocities
//! leave accelerations only to be kept:
//!
//! `v_i = v + h Σ_j A_ij a_j`, `q_i − q = h c_i v + h² Σ_j (A²)_ij a_j`.

/// Stages, the first one the last of the step before.
pub const STAGES: usize = 7;

/// The coefficients as published; the last row is also the weights of order 5.
const A: [[f64; STAGES]; STAGES] = [
    [0.0; STAGES],
    [0.161, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-0.008_480_655_492_356_989, 0.335_480_655_492_357, 0.0, 0.0, 0.0, 0.0, 0.0],
    [2.897_153_057_105_493_5, -6.359_448_489_975_075, 4.362_295_432_869_581_5, 0.0, 0.0, 0.0, 0.0],
    [
        5.325_864_828_439_257,
        -11.748_883_564_062_828,
        7.495_539_342_889_836,
        -0.092_495_066_361_755_25,
        0.0,
        0.0,
        0.0,
    ],
    [
        5.861_455_442_946_42,
        -12.920_969_317_847_11,
        8.159_367_898_576_159,
        -0.071_584_973_281_401,
        -0.028_269_050_394_068_383,
        0.0,
        0.0,
    ],
    [
        0.096_460_766_818_065_23,
        0.01,
        0.479_889_650_414_499_6,
        1.379_008_574_103_742,
        -3.290_069_515_436_081,
        2.324_710_524_099_774,
        0.0,
    ],
];

/// Weights of order 5 less those of order 4.
const ERROR: [f64; STAGES] = [
    -0.001_780_011_052_225_777,
    -0.000_816_434_459_656_746_9,
    0.007_880_878_010_261_995,
    -0.144_711_007_173_262_9,
    0.582_357_165_452_555_2,
    -0.458_082_105_929_186_97,
    1.0 / 66.0,
];

/// Where in the step each stage is, as a share of it: `c_i = Σ_j A_ij`.
pub const C: [f64; STAGES] = {
    let mut c = [0.0; STAGES];
    let mut k = 0;
    while k < STAGES * STAGES {
        c[k / STAGES] += A[k / STAGES][k % STAGES];
        k += 1;
    }
    // Without the last row's rounding.
    c[STAGES - 1] = 1.0;
    c
};

/// Weights of order 5 of each stage.
pub const WEIGHTS: [f64; STAGES] = A[STAGES - 1];

const A_SQUARED: [[f64; STAGES]; STAGES] = {
    let mut square = [[0.0; STAGES]; STAGES];
    let mut k = 0;
    while k < STAGES * STAGES * STAGES {
        let (i, j, l) = (k / STAGES / STAGES, k / STAGES % STAGES, k % STAGES);
        square[i][j] += A[i][l] * A[l][j];
        k += 1;
    }
    square
};

/// Numbers that a processor adds at once; which coordinates they belong to does not matter here.
pub type Lanes = [f64; 4];

/// Accelerations of some coordinates (m/s² or rad/s²) at each stage.
pub type Accelerations = [Lanes; STAGES];

/// Puts `way` to how far some coordinates have come at stage `I` of a step of `h` s, and `rate` to their rates there,
/// from their rates at the step's start and their accelerations at the stages before.
// Inlined, it is taken for a loop over rows of lanes, not over the lanes of a row.
#[inline(never)]
pub fn stage<const I: usize>(
    h: f64,
    start: &Lanes,
    a: &Accelerations,
    way: &mut Lanes,
    rate: &mut Lanes,
) {
    let (mut once, mut twice) = ([0.0; 4], [0.0; 4]);
    // The bound is a constant: unrolled, and nothing is left of coefficients that are zero.
    for j in 0..I {
        for (once, a) in once.iter_mut().zip(&a[j]) {
            *once += a * A[I][j];
        }
        if A_SQUARED[I][j] != 0.0 {
            for (twice, a) in twice.iter_mut().zip(&a[j]) {
                *twice += a * A_SQUARED[I][j];
            }
        }
    }
    let (along, square) = (C[I] * h, h * h);
    *way = std::array::from_fn(|lane| start[lane] * along + twice[lane] * square);
    *rate = std::array::from_fn(|lane| start[lane] + once[lane] * h);
}

/// Estimated errors of the rates of some coordinates at the end of a step of `h` s.
#[inline(always)]
pub fn error(h: f64, a: &Accelerations) -> Lanes {
    let mut sum = [0.0; 4];
    for (a, weight) in a.iter().zip(ERROR) {
        for (sum, a) in sum.iter_mut().zip(a) {
            *sum += a * weight;
        }
    }
    sum.map(|sum| sum * h)
}

#[cfg(test)]
mod tests {
    use super::super::super::between::coordinate;
    use super::*;

    /// One step of `q̈ = a(t, q)` from q = 1 and q̇ = 0.3: place and rate at its end, and the estimate of its error.
    fn step(h: f64, a: impl Fn(f64, f64) -> f64) -> [f64; 3] {
        let start = [1.0, 0.3];
        let mut k = [[0.0; 4]; STAGES];
        k[0][0] = a(0.0, start[0]);
        macro_rules! at {
            ($i:literal) => {{
                let (mut way, mut rate) = ([0.0; 4], [0.0; 4]);
                stage::<$i>(h, &[start[1], 0.0, 0.0, 0.0], &k, &mut way, &mut rate);
                k[$i][0] = a(C[$i] * h, start[0] + way[0]);
                [start[0] + way[0], rate[0]]
            }};
        }
        at!(1);
        at!(2);
        at!(3);
        at!(4);
        at!(5);
        let [place, rate] = at!(6);
        [place, rate, error(h, &k)[0]]
    }

    /// On the oscillator `q̈ = −q`, whose solution is known: a step's error falls with h⁶, its estimate
    /// with h⁵, and the quintic between its ends is as good as they are.
    #[test]
    fn a_step_has_the_orders_it_claims() {
        let exact = |t: f64| [t.cos() + 0.3 * t.sin(), -t.sin() + 0.3 * t.cos()];
        let [coarse, fine] = [0.4, 0.2].map(|h| {
            let [q, v, estimate] = step(h, |_, q| -q);
            let error = (q - exact(h)[0]).abs().max((v - exact(h)[1]).abs());
            let (way, rate) = coordinate(h, 0.4, [0.3, v], [-1.0, -q], q - 1.0);
            let [place, speed] = exact(0.4 * h);
            let inside = (1.0 + way - place).abs().max((rate - speed).abs());
            [error, estimate.abs(), inside]
        });
        let order = |k: usize| (coarse[k] / fine[k]).log2();
        assert!(order(0) > 5.5, "step: {}", order(0));
        assert!((order(1) - 5.0).abs() < 0.5, "estimate: {}", order(1));
        assert!(order(2) > 4.5, "between: {}", order(2));
        assert!(coarse[0] < coarse[1], "the estimate is that of the lower order");
    }
}
