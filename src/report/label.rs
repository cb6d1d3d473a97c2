//! What an axis shows.

use super::quantity::number;

/// Quantity and unit of an axis, e.g. `force (N)`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// In words, the unit in parentheses at the end.
    pub text: String,
    /// Whether points hold decimal logarithms of the quantity; ticks then say the quantity itself.
    pub logarithmic: bool,
    /// Whether points count things: there is nothing between whole numbers.
    pub counted: bool,
}

impl From<&str> for Label {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

impl From<String> for Label {
    fn from(text: String) -> Self {
        Self { text, logarithmic: false, counted: false }
    }
}

/// Units that take prefixes.
const PREFIXED: [&str; 6] = ["m", "s", "N", "W", "J", "Hz"];

/// Prefixes with their powers of ten.
const PREFIXES: [(i32, &str); 7] =
    [(-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M")];

impl Label {
    /// Of points that hold decimal logarithms of a quantity.
    pub fn log(text: impl Into<String>) -> Self {
        Self::log_if(text, true)
    }

    /// The same, where points hold logarithms only sometimes.
    pub fn log_if(text: impl Into<String>, logarithmic: bool) -> Self {
        Self { text: text.into(), logarithmic, counted: false }
    }

    /// Of things that are counted from 1.
    pub fn counted(text: impl Into<String>) -> Self {
        Self { text: text.into(), logarithmic: false, counted: true }
    }

    /// The unit, if one stands there.
    fn unit(&self) -> Option<&str> {
        let (_, unit) = self.text.strip_suffix(')')?.rsplit_once('(')?;
        Some(unit)
    }

    /// A value of a logarithmic axis in words: `10 nm`, `2 kN`; without a unit that takes prefixes the number alone.
    pub(super) fn in_words(&self, value: f64) -> String {
        let Some(unit) = self.unit().filter(|unit| PREFIXED.contains(unit)) else {
            return number(value);
        };
        // 999.6 of a unit reads 1000, of the one below.
        let size = (value.abs() * (1.0 + 1e-9)).log10();
        let fits = PREFIXES.iter().rev().find(|(power, _)| size >= f64::from(*power));
        let (power, prefix) = fits.unwrap_or(&PREFIXES[0]);
        format!("{} {prefix}{unit}", number(value / 10f64.powi(*power)))
    }

    /// What stands beside the axis: without the unit where the ticks say it.
    pub(super) fn beside(&self) -> &str {
        let said = self.unit().filter(|unit| self.logarithmic && PREFIXED.contains(unit));
        match said.and_then(|unit| self.text.strip_suffix(&format!("({unit})"))) {
            Some(bare) => bare.trim_end(),
            None => &self.text,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_of_logarithms_say_the_quantity() {
        let clearance = Label::log("clearance (m)");
        assert_eq!(clearance.beside(), "clearance");
        for (value, words) in [(1e-8, "10 nm"), (1e-3, "1 mm"), (2e-6, "2 µm"), (1.0, "1 m")] {
            assert_eq!(clearance.in_words(value), words);
        }
        assert_eq!(Label::log("force (N)").in_words(5e3), "5 kN");
        let share = Label::log("acceleration (m/s²)");
        assert_eq!(
            (share.beside(), share.in_words(0.1)),
            ("acceleration (m/s²)", "0.1".to_owned())
        );
        assert_eq!(Label::from("time (s)").beside(), "time (s)");
    }
}
