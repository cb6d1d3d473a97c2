//! STEP, the smooth rise with which ADAMS fades a damper in.

/// `STEP(δ, 0, 0, d_max, C_max)`: cubic from 0 at δ = 0 to `c_max` at δ = `d_max` (paper eq. 6).
///
/// The unit of the result is that of `c_max`.
///
/// ```
/// use freeplay::contact::step;
///
/// let rise = [0.0, 0.5e-5, 1e-5, 2e-5].map(|depth| step(depth, 1e-5, 500.0));
/// assert!(rise.iter().zip([0.0, 250.0, 500.0, 500.0]).all(|(a, b)| (a - b).abs() < 1e-9));
/// ```
pub fn step(penetration: f64, d_max: f64, c_max: f64) -> f64 {
    let s = (penetration / d_max).clamp(0.0, 1.0);
    c_max * s * s * (3.0 - 2.0 * s)
}

#[cfg(test)]
mod tests {
    use super::step;

    #[test]
    fn step_is_the_cubic_of_the_paper() {
        assert_eq!(step(-1e-6, 1e-5, 500.0), 0.0);
        assert_eq!(step(0.5e-5, 1e-5, 500.0), 250.0);
        assert_eq!(step(1e-5, 1e-5, 500.0), 500.0);
        assert_eq!(step(1.0, 1e-5, 500.0), 500.0);
    }
}
