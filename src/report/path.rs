//! The picture of paths in the plane, with the same scale in both directions.

use std::ops::Range;

use super::axis::{constant, least_width, padded, with_room};
use super::canvas::{PX, described};
use super::chart::{BELOW, Chart, GAP, PANEL_PLOT_HEIGHT, PLOT_WIDTH, header, ranges};
use super::readout::attribute;
use super::{Curve, Label, ReportError};

/// Smallest and largest height of the plot, in canvas units.
const PLOT_HEIGHT: Range<f64> = 160.0 * PX as f64..440.0 * PX as f64;
/// Smallest distance between ticks, in canvas units. It is the same on both axes, and so are the ticks.
const TICKS: f64 = 70.0 * PX as f64;

/// Draws curves in the plane, x and y in metres, with the same scale on both axes: a circle looks
/// round. Returns the SVG.
///
/// ```
/// use freeplay::report::{Curve, Style, path_svg};
///
/// let curve = |name: &str, style, points: &[(f64, f64)]| Curve { name: name.to_owned(), points: points.to_vec(), style };
/// let curves = [
///     curve("ideal", Style::Reference, &[(0.0, 0.0), (0.1, 0.1)]),
///     curve("simulated", Style::Solid, &[(0.0, 0.001), (0.1, 0.099)]),
/// ];
/// assert!(path_svg("Path", &curves)?.contains("simulated"));
/// # Ok::<(), freeplay::report::ReportError>(())
/// ```
///
/// # Errors
/// If the drawing library refuses; no data lead to an error.
pub fn path_svg(title: &str, curves: &[Curve]) -> Result<String, ReportError> {
    let (plot_height, ranges) = match ranges(curves) {
        Some(mut ranges) => {
            if ranges.iter().all(constant) {
                ranges = ranges.map(with_room);
            }
            let [x, y] = ranges.map(|range| padded(range, 0.05));
            let (height, ranges) = equal_scales(x, y);
            (height, Some(ranges))
        }
        None => (PANEL_PLOT_HEIGHT, None),
    };
    let labels = [&Label::from("x (m)"), &Label::from("y (m)")];
    let chart = Chart { title, labels, curves, plot_height, ticks: [TICKS; 2], ranges };
    let plots = attribute(chart.readout(0));
    let height = header(curves) + plot_height + BELOW + GAP;
    Ok(described(height, &plots, |root| chart.draw(root))?)
}

/// Widens the range that has room to spare, so that one metre is as long on both axes.
/// One of them may be empty. Returns the height of the plot (canvas units) and the ranges.
fn equal_scales(x: Range<f64>, y: Range<f64>) -> (i32, [Range<f64>; 2]) {
    let width = f64::from(PLOT_WIDTH);
    let size = |range: &Range<f64>| (range.end - range.start).max(least_width(range));
    let (x_size, y_size) = (size(&x), size(&y));
    let height = (width / x_size * y_size).clamp(PLOT_HEIGHT.start, PLOT_HEIGHT.end).round();
    let metre = (width / x_size).min(height / y_size);
    let widened = |range: Range<f64>, pixels: f64| {
        let middle = 0.5 * (range.start + range.end);
        let half = 0.5 * pixels / metre;
        middle - half..middle + half
    };
    (height as i32, [widened(x, width), widened(y, height)])
}

#[cfg(test)]
mod tests {
    use super::super::Style;
    use super::*;

    fn svg_of(points: Vec<(f64, f64)>) -> String {
        let curve = Curve { name: "path".to_owned(), points, style: Style::Solid };
        path_svg("Path", &[curve]).unwrap()
    }

    /// Width and height of the path as it is drawn, canvas units.
    fn drawn_size(points: Vec<(f64, f64)>) -> (i32, i32) {
        let svg = svg_of(points);
        let line = svg.lines().find(|l| l.contains("#0072B2") && l.contains(" points=")).unwrap();
        let points = line.split("points=\"").nth(1).unwrap();
        let points = points.split('"').next().unwrap().split_whitespace();
        let (x, y): (Vec<i32>, Vec<i32>) = points
            .map(|p| p.split_once(',').unwrap())
            .map(|(x, y)| (x.parse::<i32>().unwrap(), y.parse::<i32>().unwrap()))
            .unzip();
        let size = |v: &[i32]| v.iter().max().unwrap() - v.iter().min().unwrap();
        (size(&x), size(&y))
    }

    /// Height of the highest plot, canvas units.
    fn most_high() -> i32 {
        PLOT_HEIGHT.end as i32
    }

    #[test]
    fn a_circle_looks_round() {
        for centre in [0.0, 3.0] {
            let circle = (0..=360)
                .map(|deg| f64::from(deg).to_radians())
                .map(|a| (centre + 0.05 * a.cos(), 0.05 * a.sin()));
            let (x, y) = drawn_size(circle.collect());
            assert!(x > 65 * most_high() / 100 && (x - y).abs() <= 10, "{x} by {y}");
        }
    }

    #[test]
    fn a_straight_path_fills_the_picture() {
        for offset in [0.0, 0.3, -7.0] {
            let (x, y) = drawn_size(vec![(0.1, offset), (0.3, offset)]);
            assert!(x > 87 * PLOT_WIDTH / 100 && y == 0, "{x} by {y}");
            let (x, y) = drawn_size(vec![(offset, 0.1), (offset, 0.3)]);
            assert!(x == 0 && y > 80 * most_high() / 100, "{x} by {y}");
        }
    }

    #[test]
    fn extreme_paths_still_give_a_picture() {
        let values = [0.0, 5e-324, 1e-200, 1.0, 1.0 + 1e-9, 1e9, 1e200, -1e200];
        for x in values {
            for y in values {
                for points in [
                    vec![(x, y), (0.0, 1.0)],
                    vec![(x, y), (x + 1.0, y)],
                    vec![(1e200, y), (1e200, x), (1e200, 1.5)],
                ] {
                    let svg = svg_of(points);
                    assert!(!svg.contains("NaN") && !svg.contains("inf"));
                    assert!(svg.contains("x (m)"));
                }
            }
        }
    }
}
