//! Charts with axes, and the picture of several of them below each other.

use std::ops::Range;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::axis::{Axis, drawable, padded, range_of, with_room};
use super::canvas::{
    Area, DrawError, PX, WIDTH, described, empty_frame, font, heading, line, part, shortened, write,
};
use super::colour::{self, BAND, FAINT_INK, FRAME, GRID, INK, PALETTE, REFERENCE};
use super::readout::{Plot, attribute};
use super::{Curve, Label, Panel, ReportError, Style};

/// Widths and heights around the plot, in canvas units.
const EDGE: i32 = 8 * PX;
const LEFT: i32 = 88 * PX;
const RIGHT: i32 = 20 * PX;
const TITLE: i32 = 34 * PX;
const LEGEND_ROW: i32 = 18 * PX;

/// Radius of a dot in the plot and in the legend: many lie side by side in the plot.
const DOT: i32 = 5 * PX / 2;
const LEGEND_DOT: i32 = 3 * PX;
pub(super) const BELOW: i32 = 46 * PX;
pub(super) const GAP: i32 = 10 * PX;

pub(super) const PLOT_WIDTH: i32 = WIDTH - LEFT - RIGHT;
pub(super) const PANEL_PLOT_HEIGHT: i32 = 180 * PX;

/// Smallest distance between ticks, [x, y] in canvas units.
const PANEL_TICKS: [f64; 2] = [90.0 * PX as f64, 36.0 * PX as f64];

/// Draws the panels below each other, each with its own axes, and a legend where a panel has more
/// than one curve. Returns the SVG.
///
/// ```
/// use freeplay::report::{Curve, Panel, Style, panels_svg};
///
/// let points = (0..100).map(|i| (f64::from(i) / 100.0, (f64::from(i) / 10.0).sin())).collect();
/// let curve = Curve { name: "drive 1".to_owned(), points, style: Style::Solid };
/// let panel = Panel {
///     title: "Forces".to_owned(),
///     x_label: "time (s)".into(),
///     y_label: "force (N)".into(),
///     curves: vec![curve],
/// };
/// let svg = panels_svg(&[panel])?;
/// assert!(svg.contains("<svg") && svg.contains("Forces"));
/// # Ok::<(), freeplay::report::ReportError>(())
/// ```
///
/// # Errors
/// If the drawing library refuses; no data lead to an error.
pub fn panels_svg(panels: &[Panel]) -> Result<String, ReportError> {
    let height = |panel: &Panel| header(&panel.curves) + PANEL_PLOT_HEIGHT + BELOW + GAP;
    let total = panels.iter().map(height).sum::<i32>().max(TITLE);
    let mut top = 0;
    let charts: Vec<(i32, Chart)> = panels
        .iter()
        .map(|panel| {
            let place = top;
            top += height(panel);
            (place, chart_of(panel))
        })
        .collect();
    let plots = attribute(charts.iter().filter_map(|(top, chart)| chart.readout(*top)));
    let svg = described(total, &plots, |root| {
        for ((top, chart), panel) in charts.iter().zip(panels) {
            chart.draw(&part(root, (0, *top), (WIDTH, height(panel))))?;
        }
        Ok(())
    })?;
    Ok(svg)
}

fn chart_of(panel: &Panel) -> Chart<'_> {
    Chart {
        title: &panel.title,
        labels: [&panel.x_label, &panel.y_label],
        curves: &panel.curves,
        plot_height: PANEL_PLOT_HEIGHT,
        ticks: PANEL_TICKS,
        ranges: ranges(&panel.curves)
            .map(|range| range.map(with_room))
            .map(|[x, y]| [padded(x, side_margin(&panel.curves)), padded(y, 0.06)]),
    }
}

/// Dots at the ends of the axis must not be cut in half; lines may touch its ends.
fn side_margin(curves: &[Curve]) -> f64 {
    if curves.iter().any(|curve| curve.style == Style::Dots) { 0.02 } else { 0.0 }
}

/// The ranges of x and y over all curves, or `None` if there is nothing to draw.
pub(super) fn ranges(curves: &[Curve]) -> Option<[Range<f64>; 2]> {
    let points = || curves.iter().flat_map(drawable_points);
    let x = range_of(points().map(|p| p.0))?;
    let y = range_of(points().map(|p| p.1))?;
    Some([x, y])
}

fn drawable_points(curve: &Curve) -> impl Iterator<Item = (f64, f64)> {
    let points = curve.points.iter().copied();
    points.filter(|p| drawable(p.0) && drawable(p.1))
}

/// The stretches of a curve between points that cannot be drawn, which break a line.
fn unbroken(curve: &Curve) -> impl Iterator<Item = &[(f64, f64)]> {
    let parts = curve.points.split(|p| !(drawable(p.0) && drawable(p.1)));
    parts.filter(|part| !part.is_empty())
}

/// Height of title and legend.
pub(super) fn header(curves: &[Curve]) -> i32 {
    let rows = legend(curves).last().map_or(0, |entry| entry.1 + 1);
    TITLE + rows * LEGEND_ROW
}

/// Where each curve's legend entry goes: (x in canvas units, row). A single curve needs none.
fn legend(curves: &[Curve]) -> Vec<(i32, i32)> {
    if curves.len() < 2 {
        return Vec::new();
    }
    let (mut x, mut row) = (LEFT, 0);
    let place = |curve: &Curve| {
        // There is no font to measure with: 6.6 px is a little more than most letters of 12 px need.
        let letters = shortened(&curve.name, 56).chars().count() as i32;
        let width = 52 * PX + letters * 66 * PX / 10;
        if x > LEFT && x + width > WIDTH {
            (x, row) = (LEFT, row + 1);
        }
        let entry = (x, row);
        x += width;
        entry
    };
    curves.iter().map(place).collect()
}

/// The colour and width of each curve.
fn line_styles(curves: &[Curve]) -> Vec<ShapeStyle> {
    // What has no colour of its own takes the next that nothing else here has.
    let taken: Vec<_> = curves.iter().filter_map(|curve| colour::of(&curve.name)).collect();
    let mut free = PALETTE.iter().filter(|free| !taken.contains(free)).cycle();
    let style = |curve: &Curve| match (curve.style, colour::of(&curve.name)) {
        (Style::Band, _) => line(&BAND, 12),
        (Style::Solid | Style::Dots, Some(own)) => line(&own, 12),
        (Style::Solid | Style::Dots, None) => line(free.next().unwrap_or(&INK), 12),
        // A reference in the colour of something that is not dashed would be taken for it.
        (Style::Reference, Some(own)) if !PALETTE.contains(&own) && own != INK => line(&own, 10),
        (Style::Reference, _) => line(&REFERENCE, 10),
    };
    curves.iter().map(style).collect()
}

/// One set of axes with its heading.
pub(super) struct Chart<'a> {
    pub(super) title: &'a str,
    /// Quantity and unit of x and y.
    pub(super) labels: [&'a Label; 2],
    pub(super) curves: &'a [Curve],
    /// Height of the plot without heading and labels, in canvas units.
    pub(super) plot_height: i32,
    /// Smallest distance between ticks, [x, y] in canvas units.
    pub(super) ticks: [f64; 2],
    /// Of x and y; `None` if there is nothing to draw.
    pub(super) ranges: Option<[Range<f64>; 2]>,
}

impl Chart<'_> {
    /// Draws heading, legend and plot from the top of the area.
    pub(super) fn draw(&self, area: &Area) -> Result<(), DrawError> {
        let styles = line_styles(self.curves);
        let title = shortened(self.title, 60);
        write(area, &title, &heading(13), HPos::Left, (LEFT, TITLE / 2))?;
        for ((curve, style), (x, row)) in self.curves.iter().zip(&styles).zip(legend(self.curves)) {
            let y = TITLE + row * LEGEND_ROW + LEGEND_ROW / 3;
            if curve.style == Style::Dots {
                area.draw(&Circle::new((x + 13 * PX, y), LEGEND_DOT, style.color.filled()))?;
            } else if curve.style == Style::Band {
                let (upper, lower) = ((x, y - LEGEND_DOT * 2), (x + 26 * PX, y + LEGEND_DOT * 2));
                area.draw(&Rectangle::new([upper, lower], style.color.filled()))?;
            } else {
                let swatch = vec![(x, y), (x + 26 * PX, y)];
                area.draw(&PathElement::new(swatch, style.stroke_width(20)))?;
            }
            let name = shortened(&curve.name, 56);
            write(area, &name, &font(12, INK), HPos::Left, (x + 32 * PX, y))?;
        }
        let top = header(self.curves);
        match &self.ranges {
            Some(ranges) => {
                let plot =
                    part(area, (EDGE, top), (WIDTH - EDGE - RIGHT, self.plot_height + BELOW));
                self.draw_plot(&plot, ranges, &styles)
            }
            None => {
                let plot = part(area, (LEFT, top), (PLOT_WIDTH, self.plot_height));
                empty_frame(&plot, "no data")
            }
        }
    }

    /// What a page reads of the chart, `top` canvas units below the top of its picture; nothing of an empty one.
    pub(super) fn readout(&self, top: i32) -> Option<Plot<'_>> {
        let [x, y] = self.ranges.clone()?;
        let styles = line_styles(self.curves);
        let named = self.curves.iter().zip(styles).filter(|(curve, _)| curve.style != Style::Band);
        let hex = |style: ShapeStyle| {
            let (r, g, b) = style.color.rgb();
            colour::hex(RGBColor(r, g, b))
        };
        Some(Plot {
            area: [LEFT, top + header(self.curves), PLOT_WIDTH, self.plot_height],
            ranges: [[x.start, x.end], [y.start, y.end]],
            labels: self.labels,
            curves: named.map(|(curve, style)| (curve.name.as_str(), hex(style))).collect(),
        })
    }

    fn draw_plot(
        &self,
        area: &Area,
        [x, y]: &[Range<f64>; 2],
        styles: &[ShapeStyle],
    ) -> Result<(), DrawError> {
        let [x_label, y_label] = self.labels;
        let x_axis = Axis::of(x_label, x.clone(), f64::from(PLOT_WIDTH) / self.ticks[0]);
        let y_axis = Axis::of(y_label, y.clone(), f64::from(self.plot_height) / self.ticks[1]);
        let mut chart = ChartBuilder::on(area)
            .x_label_area_size(BELOW)
            .y_label_area_size(LEFT - EDGE)
            .build_cartesian_2d(x_axis, y_axis)?;
        chart
            .configure_mesh()
            .bold_line_style(line(&GRID, 8))
            .light_line_style(TRANSPARENT)
            .axis_style(line(&FRAME, 10))
            .set_all_tick_mark_size(4 * PX)
            .label_style(font(12, FAINT_INK))
            .axis_desc_style(font(12, INK))
            .x_desc(shortened(x_label.beside(), 70))
            .y_desc(shortened(y_label.beside(), 30))
            .draw()?;
        let zero_lines =
            [(y, vec![(x.start, 0.0), (x.end, 0.0)]), (x, vec![(0.0, y.start), (0.0, y.end)])];
        for (range, zero_line) in zero_lines {
            let logarithmic = if range == y { y_label } else { x_label }.logarithmic;
            if range.start < 0.0 && range.end > 0.0 && !logarithmic {
                chart.draw_series([PathElement::new(zero_line, line(&FRAME, 8))])?;
            }
        }
        // References last: they stay visible on a busy signal.
        for wanted in [Style::Band, Style::Dots, Style::Solid, Style::Reference] {
            for (curve, style) in self.curves.iter().zip(styles) {
                if curve.style != wanted {
                    continue;
                }
                match wanted {
                    Style::Band => {
                        let points: Vec<_> = drawable_points(curve).collect();
                        chart.draw_series([Polygon::new(points, style.color.filled())])?;
                    }
                    Style::Dots => {
                        let dot = style.color.mix(0.6).filled();
                        let points = drawable_points(curve);
                        chart.draw_series(points.map(|p| Circle::new(p, DOT, dot)))?;
                    }
                    Style::Solid | Style::Reference => {
                        for part in unbroken(curve) {
                            if part.iter().all(|p| *p == part[0]) {
                                // A line of no length would be invisible.
                                let dot = style.color.filled();
                                chart.draw_series([Circle::new(part[0], 3 * PX, dot)])?;
                            } else {
                                chart.draw_series(LineSeries::new(part.iter().copied(), *style))?;
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::path_svg;
    use super::*;

    fn curve(name: &str, points: Vec<(f64, f64)>) -> Curve {
        Curve { name: name.to_owned(), points, style: Style::Solid }
    }

    fn panel(curves: Vec<Curve>) -> Panel {
        Panel {
            title: "Force".to_owned(),
            x_label: "time (s)".into(),
            y_label: "force (N)".into(),
            curves,
        }
    }

    #[test]
    fn dots_are_dots() {
        let points = (0..50).map(|i| (f64::from(i), f64::from(i % 7))).collect();
        let dots = Curve { style: Style::Dots, ..curve("runs", points) };
        let svg = panels_svg(&[panel(vec![dots, curve("b", vec![])])]).unwrap();
        // And one in the legend.
        assert_eq!(svg.matches("<circle").count(), 51);
    }

    #[test]
    fn odd_data_still_give_a_picture() {
        let nan = f64::NAN;
        let odd = [
            vec![],
            vec![(nan, 1.0), (0.0, f64::INFINITY)],
            vec![(0.0, 5.0), (1.0, 5.0)],
            vec![(2.0, 3.0)],
            vec![(0.0, 1.0), (nan, 2.0), (1.0, 3.0)],
            vec![(f64::MIN, f64::MAX), (0.0, 0.0)],
        ];
        for points in odd {
            let curves = vec![curve("a", points.clone()), curve("b", vec![])];
            for svg in
                [panels_svg(&[panel(curves.clone())]).unwrap(), path_svg("Path", &curves).unwrap()]
            {
                assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
                assert!(!svg.contains("NaN") && !svg.contains("inf"));
                let drawable = points.iter().any(|p| drawable(p.0) && drawable(p.1));
                assert_eq!(svg.contains("no data"), !drawable, "{points:?}");
            }
        }
        assert!(panels_svg(&[]).unwrap().starts_with("<svg"));
        assert!(panels_svg(&[panel(vec![])]).unwrap().contains("no data"));
    }

    #[test]
    fn only_more_than_one_curve_needs_a_legend() {
        let one = curve("alone", vec![(0.0, 0.0), (1.0, 1.0)]);
        let svg = panels_svg(&[panel(vec![one.clone()])]).unwrap();
        // Behind the first tag, which tells pages the names of all.
        assert!(!svg.split_once('>').unwrap().1.contains("alone"));
        let many = (0..12).map(|i| curve(&format!("<curve {i}>"), one.points.clone()));
        let svg = panels_svg(&[panel(many.collect())]).unwrap();
        assert!(svg.contains("&lt;curve 11&gt;"));
    }

    #[test]
    fn a_reference_is_drawn_last_in_the_colour_that_the_style_sheet_dashes() {
        let mut ideal = curve("ideal", vec![(0.0, 0.0), (1.0, 1.0)]);
        ideal.style = Style::Reference;
        let real = curve("real", vec![(0.0, 0.0), (1.0, 2.0)]);
        let svg = panels_svg(&[panel(vec![ideal, real])]).unwrap();
        assert!(svg.contains("polyline[stroke=\"#222222\"]"));
        assert!(svg.rfind("stroke=\"#222222\"") > svg.rfind("stroke=\"#0072B2\""));
    }

    #[test]
    fn a_band_is_an_area_below_the_lines() {
        let area = vec![(0.0, 0.0), (1.0, 1.0), (1.0, 2.0), (0.0, 3.0)];
        let band = Curve { style: Style::Band, ..curve("all", area) };
        let svg = panels_svg(&[panel(vec![curve("one", vec![(0.0, 1.0), (1.0, 1.5)]), band])]);
        let svg = svg.unwrap();
        let polygon = svg.find("<polygon").unwrap();
        assert!(svg.rfind("<polyline").unwrap() > polygon);
    }

    #[test]
    fn long_signals_stay_small() {
        let wave = |phase: f64| {
            (0..2000).map(|i| f64::from(i) * 1e-3).map(|t| (t, (40.0 * t + phase).sin())).collect()
        };
        let curves = vec![curve("a", wave(0.0)), curve("b", wave(1.0)), curve("c", wave(2.0))];
        let svg = panels_svg(&[panel(curves.clone()), panel(curves.clone()), panel(curves)]);
        assert!(svg.unwrap().len() < 400_000);
    }
}
