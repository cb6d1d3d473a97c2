//! What counts of a trial's values, and shares with what chance leaves open.

use super::HiddenValue;
use crate::measure::student::NORMAL95;

/// The largest relative error of a value that counts as near.
const NEAR: f64 = 0.1;

/// Whether a value is a phase, which near another one says nothing of its effect's size.
pub(in crate::calibrate) fn is_phase(value: &HiddenValue) -> bool {
    value.name.ends_with("phase_rad")
}

/// Whether a value was found within 10 %.
pub(in crate::calibrate) fn near(value: &HiddenValue) -> bool {
    (value.value - value.truth).abs() < NEAR * value.truth.abs()
}

/// Whether the true value lies in the 95 % interval of the one that was found.
pub(in crate::calibrate) fn covered(value: &HiddenValue) -> bool {
    value.std.is_some_and(|std| (value.value - value.truth).abs() < NORMAL95 * std)
}

/// `9 of 10 (90 %, 60–98)`.
pub(in crate::calibrate) fn share(of: &[bool]) -> String {
    let right = of.iter().filter(|right| **right).count();
    let Some([low, high]) = wilson(right, of.len()) else { return "–".to_owned() };
    // No minus before a zero.
    let percent = |share: f64| (100.0 * share).round() + 0.0;
    let share = percent(right as f64 / of.len() as f64);
    format!("{right} of {} ({share} %, {}–{})", of.len(), percent(low), percent(high))
}

/// The 95 % interval of a share of `of` independent trials of which `right` were right (Wilson, J. Am.
/// Stat. Assoc. 22 (1927) 209–212); none without trials.
fn wilson(right: usize, of: usize) -> Option<[f64; 2]> {
    if of == 0 {
        return None;
    }
    let n = of as f64;
    let share = right as f64 / n;
    let middle = (share + NORMAL95 * NORMAL95 / (2.0 * n)) / (1.0 + NORMAL95 * NORMAL95 / n);
    let half = NORMAL95 / (1.0 + NORMAL95 * NORMAL95 / n)
        * (share * (1.0 - share) / n + NORMAL95 * NORMAL95 / (4.0 * n * n)).sqrt();
    Some([middle - half, middle + half])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Newcombe, Statistics in Medicine 17 (1998) 857–872, table I: 81 of 263, 15 of 148, 0 of 20.
    #[test]
    fn intervals_are_published_ones() {
        for (right, of, expected) in
            [(81, 263, [0.2553, 0.3662]), (15, 148, [0.0624, 0.1605]), (0, 20, [0.0, 0.1611])]
        {
            let interval = wilson(right, of).unwrap();
            for (found, expected) in interval.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-4, "{right} of {of}: {interval:?}");
            }
        }
        assert_eq!(wilson(0, 0), None);
    }
}
