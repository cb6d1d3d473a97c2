//! How synthetic recordings begin: at rest, as calibrations take it, and up to full speed without a jump.

/// Time in s for which commands rest.
const REST: f64 = 0.05;

/// Time in s in which they come to full speed.
const RAMP: f64 = 0.25;

/// Time in s at full speed that has passed at time `t` (s): the integral of a smooth rise of the speed,
/// `3x² − 2x³` with x = (t − rest)/ramp.
pub fn passed(t: f64) -> f64 {
    let s = (t - REST).max(0.0);
    let x = (s / RAMP).min(1.0);
    RAMP * (x * x * x - 0.5 * x.powi(4)) + (s - RAMP).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_rest_then_run_at_full_speed() {
        assert_eq!((passed(0.0), passed(REST)), (0.0, 0.0));
        let rate = |t: f64| (passed(t + 1e-6) - passed(t - 1e-6)) / 2e-6;
        assert!(rate(REST) < 1e-6 && (rate(REST + RAMP) - 1.0).abs() < 1e-6);
        assert!((rate(REST + 0.5 * RAMP) - 0.5).abs() < 1e-6);
    }
}
