//! Student's t.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// The value below which a share of Student's t with so many degrees of freedom lies; infinite where there are none.
pub fn t(share: f64, degrees: f64) -> f64 {
    let distribution = StudentsT::new(0.0, 1.0, degrees);
    distribution.map_or(f64::INFINITY, |distribution| distribution.inverse_cdf(share))
}

/// So many standard deviations on either side of a normal variable's mean hold it 95 times in 100.
pub const NORMAL95: f64 = 1.96;

/// Half width of a 95 % interval in standard errors.
///
/// ```
/// use freeplay::measure::student::{t, t95};
///
/// assert!((t95(9) - 2.262).abs() < 1e-3, "ten values");
/// assert!((t(0.975, 9.0) - t95(9)).abs() < 1e-9, "2.5 % on either side");
/// ```
pub fn t95(degrees: usize) -> f64 {
    t(0.975, degrees as f64)
}

#[cfg(test)]
mod tests {
    use super::t;

    /// Abramowitz & Stegun, table 26.10.
    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (share, degrees, expected) in [
            (0.975, 1.0, 12.706),
            (0.975, 5.0, 2.571),
            (0.975, 30.0, 2.042),
            (0.975, 120.0, 1.980),
            (0.995, 5.0, 4.032),
            (0.9975, 11.0, 3.497),
        ] {
            let found = t(share, degrees);
            assert!((found - expected).abs() < 6e-4, "{share} {degrees}: {found}");
        }
        assert_eq!(t(0.975, 0.0), f64::INFINITY);
    }
}
