//! One step of the explicit Runge–Kutta pair of orders 5(4) by Tsitouras, first same as last.
//!
//! Ch. Tsitouras, *Runge–Kutta pairs of order 5(4) satisfying only the first column simplifying
//! assumption*, Computers & Mathematics with Applications 62 (2011) 770–775.
//!
//! The system is `q̈ = a(t, q, q̇)`, so the stages' velocities can be eliminated from their positions:
//!
//!     v_i = v + h Σ_j A_ij a_j,    q_i = q + h c_i v + h² Σ_j (A²)_ij a_j
//!
//! which is the same method on the first-order system, with accelerations only to be kept.

use super::system::System;

const STAGES: usize = 7;

/// The paper's coefficients; the last row is the weights of order 5.
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

/// `c_i = Σ_j A_ij`.
const C: [f64; STAGES] = {
    let mut c = [0.0; STAGES];
    let mut k = 0;
    while k < STAGES * STAGES {
        c[k / STAGES] += A[k / STAGES][k % STAGES];
        k += 1;
    }
    c
};

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

/// A point of the motion, with its accelerations.
#[derive(Clone)]
pub struct State<const N: usize> {
    pub t: f64,
    pub q: [f64; N],
    pub v: [f64; N],
    pub a: [f64; N],
}

impl<const N: usize> State<N> {
    #[inline(always)]
    pub fn new<S: System<N>>(system: &S, t: f64, q: [f64; N], v: [f64; N]) -> (Self, S::Pose) {
        let (a, pose) = system.evaluate(t, &q, &v);
        (Self { t, q, v, a }, pose)
    }
}

/// Where a step ended, and the estimated error of its velocities.
pub struct Trial<const N: usize, S: System<N>> {
    pub end: State<N>,
    pub pose: S::Pose,
    pub velocity_error: [f64; N],
}

/// Evaluations of the right-hand side per step: the first is the last of the step before.
pub const EVALUATIONS: u64 = STAGES as u64 - 1;

#[inline(always)]
pub fn step<const N: usize, S: System<N>>(system: &S, from: &State<N>, h: f64) -> Trial<N, S> {
    let mut a = [[0.0; N]; STAGES];
    a[0] = from.a;
    // no loop: with the stage a literal, the compiler drops the zero coefficients
    a[1] = stage(system, from, &a, 1, h);
    a[2] = stage(system, from, &a, 2, h);
    a[3] = stage(system, from, &a, 3, h);
    a[4] = stage(system, from, &a, 4, h);
    a[5] = stage(system, from, &a, 5, h);
    let (q, v) = combine(from, &a, 6, h);
    let (end, pose) = State::new(system, from.t + h, q, v);
    a[6] = end.a;
    let velocity_error = std::array::from_fn(|n| h * weighted(&ERROR, &a, STAGES, n));
    Trial { end, pose, velocity_error }
}

/// The accelerations of stage `i`.
#[inline(always)]
fn stage<const N: usize, S: System<N>>(
    system: &S,
    from: &State<N>,
    a: &[[f64; N]; STAGES],
    i: usize,
    h: f64,
) -> [f64; N] {
    let (q, v) = combine(from, a, i, h);
    accelerations(system, from.t + C[i] * h, &q, &v)
}

/// The right-hand side, once in the program: five copies would not stay in the instruction cache.
#[inline(never)]
fn accelerations<const N: usize, S: System<N>>(
    system: &S,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> [f64; N] {
    system.evaluate(t, q, v).0
}

/// Coordinates and rates of stage `i`, from the accelerations of those before.
#[inline(always)]
fn combine<const N: usize>(
    from: &State<N>,
    a: &[[f64; N]; STAGES],
    i: usize,
    h: f64,
) -> ([f64; N], [f64; N]) {
    let (mut q, mut v) = ([0.0; N], [0.0; N]);
    for n in 0..N {
        v[n] = from.v[n] + h * weighted(&A[i], a, i, n);
        q[n] = from.q[n] + h * (C[i] * from.v[n] + h * weighted(&A_SQUARED[i], a, i, n));
    }
    (q, v)
}

/// `Σ_{j<end} w_j a_j[n]`; the weights are constants, and no code is left of those that are zero.
#[inline(always)]
fn weighted<const N: usize>(
    w: &[f64; STAGES],
    a: &[[f64; N]; STAGES],
    end: usize,
    n: usize,
) -> f64 {
    let mut sum = 0.0;
    for j in 0..end {
        if w[j] != 0.0 {
            sum += w[j] * a[j][n];
        }
    }
    sum
}

/// Coordinates and rates within a step: the quintic through q, v and a of both its ends. It errs by
/// h⁶ in q, less than the step itself.
pub fn interpolate<const N: usize>(from: &State<N>, to: &State<N>, t: f64) -> ([f64; N], [f64; N]) {
    let h = to.t - from.t;
    let s = (t - from.t) / h;
    let (mut q, mut v) = ([0.0; N], [0.0; N]);
    for n in 0..N {
        let (hv, hha) = (h * from.v[n], h * h * from.a[n]);
        // what the parabola from the start misses at the end: position, slope, curvature
        let d = to.q[n] - from.q[n] - hv - 0.5 * hha;
        let e = h * to.v[n] - hv - hha;
        let g = h * h * to.a[n] - hha;
        let (c3, c4, c5) =
            (10.0 * d - 4.0 * e + 0.5 * g, -15.0 * d + 7.0 * e - g, 6.0 * d - 3.0 * e + 0.5 * g);
        q[n] = from.q[n] + s * (hv + s * (0.5 * hha + s * (c3 + s * (c4 + s * c5))));
        v[n] = (hv + s * (hha + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / h;
    }
    (q, v)
}
