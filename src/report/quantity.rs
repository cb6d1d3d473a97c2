//! Numbers for people: three digits, and for lengths the unit that suits them.

/// A length of `metres` with three digits, in the unit that suits it.
pub fn length(metres: f64) -> String {
    let (value, unit) = match metres.abs() {
        m if m < 0.9995e-6 => (metres * 1e9, "nm"),
        m if m < 0.9995e-3 => (metres * 1e6, "µm"),
        m if m < 0.9995 => (metres * 1e3, "mm"),
        _ => (metres, "m"),
    };
    format!("{} {unit}", number(value))
}

/// A number with three significant digits; very small and very large ones with a power of ten, what
/// is no number as a dash.
///
/// ```
/// use freeplay::report::{known_to, length, number};
///
/// assert_eq!(number(12.3456), "12.3");
/// assert_eq!(length(0.00012), "120 µm");
/// assert_eq!(known_to(12.3456, 0.021), "12.346");
/// ```
pub fn number(value: f64) -> String {
    significant(value, 3)
}

/// A value with as many digits as its standard deviation is worth: two of the latter's, at least three.
pub fn known_to(value: f64, std: f64) -> String {
    let ratio = (value / std).abs();
    if std > 0.0 && ratio.is_normal() {
        let more = value.abs().log10().floor() - std.log10().floor();
        return significant(value, (more + 2.0).clamp(3.0, 12.0) as usize);
    }
    number(value)
}

fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let size = value.abs();
    if !(0.999_5e-3..0.999_5e6).contains(&size) {
        let decimals = digits - 1;
        let text = format!("{value:.decimals$e}");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{power}", trimmed(digits));
    }
    let decimals = (digits as f64 - 1.0 - size.log10().floor()).max(0.0) as usize;
    trimmed(&format!("{value:.decimals$}")).to_owned()
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_the_digits_that_are_known() {
        assert_eq!(known_to(-9.80022, 0.0015), "-9.8002");
        assert_eq!(known_to(4.001_78e-4, 4.1e-7), "4.0018e-4");
        assert_eq!(known_to(1.2345, 0.4), "1.23");
        assert_eq!(known_to(0.0, 0.1), "0");
        assert_eq!(known_to(1.2345, f64::NAN), "1.23");
        assert_eq!(known_to(2.0, 0.0), "2");
    }

    #[test]
    fn lengths_choose_their_unit() {
        assert_eq!(length(0.5e-3), "500 µm");
        assert_eq!(length(12.34e-6), "12.3 µm");
        assert_eq!(length(1e-3), "1 mm");
        assert_eq!(length(1.25e-3), "1.25 mm");
        assert_eq!(length(20e-9), "20 nm");
        assert_eq!(length(0.66), "660 mm");
        assert_eq!(length(0.0), "0 nm");
    }

    #[test]
    fn numbers_have_three_digits() {
        for (value, text) in [
            (38.2345, "38.2"),
            (0.012345, "0.0123"),
            (1234.5, "1234"),
            (100_000.0, "100000"),
            (3.7328e9, "3.73e9"),
            (1e-5, "1e-5"),
            (-2.0, "-2"),
            (f64::NAN, "–"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
