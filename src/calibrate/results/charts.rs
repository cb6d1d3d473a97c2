//! Curves over time.

use crate::report::{Curve, Panel};

/// Points of a curve and of a cloud of dots: about one per pixel, and as many as can be told apart.
pub(in crate::calibrate) const POINTS: usize = 800;

/// A chart over time.
pub(in crate::calibrate) fn panel(
    title: String,
    y_label: &str,
    curves: impl Iterator<Item = Curve>,
) -> Panel {
    Panel { title, x_label: "time (s)".into(), y_label: y_label.into(), curves: curves.collect() }
}

/// About so many of the points, evenly: fewer than twice as many.
pub(in crate::calibrate) fn thinned(points: &[(f64, f64)], count: usize) -> Vec<(f64, f64)> {
    points.iter().copied().step_by((points.len() / count).max(1)).collect()
}
