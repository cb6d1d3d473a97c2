//! Sine and cosine of several angles at once, in vector registers and without a call.

use std::f64::consts::FRAC_2_PI;

/// π/2 in three parts (Cody and Waite): the first two carry 33 bits each, so `n` times either is exact.
const HALF_PI: [f64; 3] =
    [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];
/// Adding and taking away 1.5·2⁵² rounds to the nearest whole number, which then is in the low bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// `(sin, cos)` within 2e-16 for |angle| < 1e5: reduced to [−π/4, π/4], then the polynomials
/// of fdlibm's `__kernel_sin` and `__kernel_cos`.
#[inline(always)]
pub fn sin_cos<const N: usize>(angles: &[f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        let shifted = angles[i] * FRAC_2_PI + ROUND;
        let turns = shifted - ROUND;
        let quadrant = shifted.to_bits();
        let r = angles[i] - turns * HALF_PI[0] - turns * HALF_PI[1] - turns * HALF_PI[2];
        let z = r * r;
        let sine = r + r * z * polynomial(z, &SINE);
        let cosine = 1.0 - (0.5 * z - z * z * polynomial(z, &COSINE));
        // odd quadrants swap the two; bit 1 flips the sine's sign, bit 1 of (quadrant + 1) the cosine's
        let swap = 0u64.wrapping_sub(quadrant & 1);
        let (s, c) = (sine.to_bits(), cosine.to_bits());
        let difference = (s ^ c) & swap;
        sines[i] = f64::from_bits(s ^ difference ^ ((quadrant & 2) << 62));
        cosines[i] = f64::from_bits(c ^ difference ^ ((quadrant.wrapping_add(1) & 2) << 62));
    }
    (sines, cosines)
}

/// fdlibm `k_sin.c`, S1 to S6.
const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_007e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];

/// fdlibm `k_cos.c`, C1 to C6.
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

#[inline(always)]
fn polynomial(z: f64, c: &[f64; 6]) -> f64 {
    let z2 = z * z;
    (c[0] + z * c[1]) + z2 * ((c[2] + z * c[3]) + z2 * (c[4] + z * c[5]))
}
