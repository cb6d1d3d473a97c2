//! One axis of a chart: its range, its ticks and how they read.

use std::ops::Range;

use super::label::Label;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

/// The largest value that is drawn. Far above any quantity of interest, and small enough that no
/// difference of two values overflows.
const LARGEST: f64 = 1e200;

/// A signal whose spread is smaller than this fraction of its size counts as constant: what is left
/// is rounding noise, and ticks in it would need too many digits to read.
const SPREAD: f64 = 1e-6;

/// An axis with round tick values.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    range: Range<f64>,
    /// Distance between ticks: 1, 2 or 5 times a power of ten.
    step: f64,
    /// What a logarithmic axis shows; its range is one of decimal logarithms.
    logarithmic: Option<Label>,
}

/// Decades below which a logarithmic axis has ticks at 2 and 5, too.
const FEW_DECADES: f64 = 2.5;

impl Axis {
    /// An axis over `range` with at most about `ticks` ticks. The range must not be
    /// [`constant`].
    pub(super) fn of(label: &Label, range: Range<f64>, ticks: f64) -> Self {
        let axis = Self::new(range, ticks);
        if label.counted {
            return Axis { step: axis.step.max(1.0), ..axis };
        }
        if !label.logarithmic {
            return axis;
        }
        Axis { step: axis.step.ceil(), logarithmic: Some(label.clone()), ..axis }
    }

    /// The same of a quantity itself.
    fn new(range: Range<f64>, ticks: f64) -> Self {
        let rough = (range.end - range.start) / ticks;
        let decade = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0]
            .map(|m| m * decade)
            .into_iter()
            .find(|step| *step >= rough)
            .unwrap_or(10.0 * decade);
        Axis { range, step, logarithmic: None }
    }
}

/// The range that holds all `values`, empty for a constant.
/// `None` if there is no value that can be drawn.
pub(super) fn range_of(values: impl Iterator<Item = f64>) -> Option<Range<f64>> {
    let (min, max) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), v| (min.min(v), max.max(v)));
    (min <= max).then_some(min..max)
}

/// The smallest width of an axis around `range` that its ticks can show.
pub(super) fn least_width(range: &Range<f64>) -> f64 {
    SPREAD * range.start.abs().max(range.end.abs())
}

/// Whether `range` is too narrow for an axis.
pub(super) fn constant(range: &Range<f64>) -> bool {
    range.end - range.start <= least_width(range).max(SPREAD / LARGEST)
}

/// `range` with some room around it if it belongs to a constant.
pub(super) fn with_room(range: Range<f64>) -> Range<f64> {
    let size = range.start.abs().max(range.end.abs());
    let room = match constant(&range) {
        true if size < 1.0 / LARGEST => 1.0,
        true => 0.1 * size,
        false => 0.0,
    };
    range.start - room..range.end + room
}

/// `range` with a margin of the given fraction of its width at both ends.
pub(super) fn padded(range: Range<f64>, fraction: f64) -> Range<f64> {
    let margin = fraction * (range.end - range.start);
    range.start - margin..range.end + margin
}

/// Whether a coordinate can be drawn: a number, and not absurdly large.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() <= LARGEST
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let fraction = (value - self.range.start) / (self.range.end - self.range.start);
        // Inside the plot also by rounding: the library leaves out ticks that are not.
        let fraction = fraction.clamp(0.0, 1.0);
        (f64::from(limit.0) + fraction * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        let width = self.range.end - self.range.start;
        if self.logarithmic.is_some() && width < FEW_DECADES {
            let decades = (self.range.start.floor() as i32)..=(self.range.end.ceil() as i32);
            let round = decades.flat_map(|n| [1.0f64, 2.0, 5.0].map(|m| f64::from(n) + m.log10()));
            return round.filter(|tick| self.range.contains(tick)).collect();
        }
        // A tick that is missed by a hair belongs to the axis: a run of 4 s ends one step before.
        let hair = 2e-3;
        let first = (self.range.start / self.step - hair).ceil();
        let count = ((self.range.end / self.step + hair).floor() - first).max(0.0) as usize;
        (0..=count).map(|i| (first + i as f64) * self.step).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

impl ValueFormatter<f64> for Axis {
    /// As many decimals as the step needs; very large and very small values in engineering notation,
    /// with an exponent that is the same for the whole axis.
    fn format_ext(&self, value: &f64) -> String {
        if let Some(label) = &self.logarithmic {
            return label.in_words(10f64.powf(*value));
        }
        let size = self.range.start.abs().max(self.range.end.abs());
        let engineering = 3 * (size.log10() / 3.0).floor() as i32;
        let exponent = match engineering {
            _ if (1e-3..1e5).contains(&size) => 0,
            -9..=9 => engineering,
            // Three digits, or decimals, before such an exponent leave no room.
            _ => (self.step.log10() + 1e-9).floor() as i32,
        };
        let unit = 10f64.powi(exponent);
        let decimals = (-(self.step / unit).log10() - 1e-9).ceil().max(0.0) as usize;
        let text = format!("{:.decimals$}", value / unit);
        let zero = text.chars().all(|c| "-0.".contains(c));
        match exponent {
            _ if zero => "0".to_owned(),
            0 => text.replace('-', "−"),
            _ => format!("{text}e{exponent}").replace('-', "−"),
        }
    }
}

#[cfg(test)]
mod tests {
    use plotters::coord::ranged1d::BoldPoints;

    use super::*;

    fn labels(range: Range<f64>, ticks: f64) -> Vec<String> {
        let axis = Axis::new(range, ticks);
        let points = axis.key_points(BoldPoints(0));
        points.iter().map(|p| axis.format_ext(p)).collect()
    }

    #[test]
    fn ticks_are_round_and_short() {
        assert_eq!(labels(0.0..0.5, 5.0), ["0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(labels(-42.0..42.0, 5.0), ["−40", "−20", "0", "20", "40"]);
        assert_eq!(labels(0.0..0.9999, 2.0), ["0", "0.5", "1.0"]);
        assert_eq!(labels(0.95..1.05, 4.0), ["0.95", "1.00", "1.05"]);
    }

    #[test]
    fn far_from_one_ticks_use_engineering_notation() {
        assert_eq!(labels(-1e-5..1e-5, 2.0), ["−10e−6", "0", "10e−6"]);
        assert_eq!(labels(0.0..2.5e6, 3.0), ["0", "1e6", "2e6"]);
        assert_eq!(labels(-2e-10..2e-10, 4.0), ["−2e−10", "−1e−10", "0", "1e−10", "2e−10"]);
    }

    #[test]
    fn logarithms_have_ticks_in_units() {
        let label = Label::log("clearance (m)");
        let of = |range: Range<f64>| {
            let axis = Axis::of(&label, range, 5.0);
            axis.key_points(BoldPoints(0)).iter().map(|p| axis.format_ext(p)).collect::<Vec<_>>()
        };
        assert_eq!(of(-8.0..-3.0), ["10 nm", "100 nm", "1 µm", "10 µm", "100 µm", "1 mm"]);
        assert_eq!(of(-4.1..-3.2), ["100 µm", "200 µm", "500 µm"]);
    }

    #[test]
    fn what_is_counted_has_ticks_at_whole_numbers() {
        let axis = Axis::of(&Label::counted("law"), 0.98..3.02, 5.0);
        let ticks: Vec<String> =
            axis.key_points(BoldPoints(0)).iter().map(|p| axis.format_ext(p)).collect();
        assert_eq!(ticks, ["1", "2", "3"]);
    }

    #[test]
    fn every_range_has_width_and_few_ticks() {
        for values in [
            vec![0.0],
            vec![3.0, 3.0],
            vec![1e9, 1e9 + 1e-3],
            vec![-1e200, 1e200],
            vec![5e-324, 1e-300],
            vec![1e-190],
        ] {
            let range = with_room(range_of(values.iter().copied()).unwrap());
            assert!(range.start < range.end, "{values:?}");
            let ticks = labels(range, 5.0);
            assert!((1..=7).contains(&ticks.len()), "{values:?}: {ticks:?}");
            assert!(ticks.iter().all(|t| t.len() < 14), "{values:?}: {ticks:?}");
        }
        assert_eq!(range_of(std::iter::empty()), None);
    }
}
