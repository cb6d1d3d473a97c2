//! Student's t.

/// 97.5 % quantiles of Student's t for 1 to 30 degrees of freedom: half of these lie above a 95 %
/// interval, half below.
const T: [f64; 30] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
    2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056,
    2.052, 2.048, 2.045, 2.042,
];

/// Half width of a 95 % interval in standard errors. Above 30 degrees of freedom ν, the normal
/// distribution's 1.960 with its corrections of first and second order in 1/ν (Abramowitz & Stegun
/// 26.7.5): exact to 0.001.
pub fn t95(degrees: usize) -> f64 {
    match degrees {
        0 => f64::INFINITY,
        1..=30 => T[degrees - 1],
        more => {
            let inverse = 1.0 / more as f64;
            1.95996 + (2.3722 + 2.8225 * inverse) * inverse
        }
    }
}
