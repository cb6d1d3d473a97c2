//! The shared look of all pictures, and the surface they are drawn on.

use super::colour::{FAINT_INK, GRID, INK, style_sheet};
use crate::measure::shown::shown;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Canvas units per pixel. The SVG backend writes whole numbers; on a canvas ten times as large they
/// are tenths of a pixel.
pub(super) const PX: i32 = 10;
/// Width of every picture in canvas units: at which letters can be read on a phone, two thirds as large there, and on a
/// page.
pub(super) const WIDTH: i32 = 560 * PX;

pub(super) type Backend<'a> = SVGBackend<'a>;
pub(super) type Area<'a> = DrawingArea<Backend<'a>, Shift>;
pub(super) type DrawError = DrawingAreaErrorKind<std::io::Error>;

/// Draws a picture of the shared width and the given height (canvas units) and returns its SVG.
pub(super) fn picture(
    height: i32,
    draw: impl FnOnce(&Area) -> Result<(), DrawError>,
) -> Result<String, DrawError> {
    described(height, "", draw)
}

/// The same with what a page reads of it: JSON about its plots ([`super::readout`]).
pub(super) fn described(
    height: i32,
    plots: &str,
    draw: impl FnOnce(&Area) -> Result<(), DrawError>,
) -> Result<String, DrawError> {
    let mut svg = String::new();
    {
        let root =
            SVGBackend::with_string(&mut svg, (WIDTH as u32, height as u32)).into_drawing_area();
        draw(&root)?;
        root.present()?;
    }
    // The backend's own first tag would show the picture ten times too large.
    let content = svg.split_once('\n').map_or("", |(_, content)| content);
    let (width_px, height_px) = (WIDTH / PX, height / PX);
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"picture\" \
         width=\"{width_px}\" height=\"{height_px}\" viewBox=\"0 0 {WIDTH} {height}\" \
         stroke-linejoin=\"round\" stroke-linecap=\"round\"{plots}>\n<style>{}</style>\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n{}",
        style_sheet(),
        shown(content)
    ))
}

/// A part of an area: offset and size in canvas units.
pub(super) fn part<'a>(area: &Area<'a>, at: (i32, i32), size: (i32, i32)) -> Area<'a> {
    area.clone().shrink(at, size)
}

/// A line of the given width in tenths of a pixel.
pub(super) fn line(color: &impl Color, width: u32) -> ShapeStyle {
    color.stroke_width(width)
}

/// A font of the given size in pixels.
pub(super) fn font(size: i32, color: RGBColor) -> TextStyle<'static> {
    // The backend divides font sizes by 1.24.
    ("sans-serif", f64::from(size * PX) * 1.24).into_font().color(&color)
}

/// A bold font for headings, of the given size in pixels.
pub(super) fn heading(size: i32) -> TextStyle<'static> {
    ("sans-serif", f64::from(size * PX) * 1.24, FontStyle::Bold).into_font().color(&INK)
}

/// Writes text whose anchor, given by `side`, is at the middle of the line's height.
pub(super) fn write(
    area: &Area,
    text: &str,
    style: &TextStyle,
    side: HPos,
    at: (i32, i32),
) -> Result<(), DrawError> {
    area.draw_text(text, &style.pos(Pos::new(side, VPos::Center)), at)
}

/// `text`, cut to at most `length` characters.
pub(super) fn shortened(text: &str, length: usize) -> String {
    if text.chars().count() <= length {
        return text.to_owned();
    }
    let start: String = text.chars().take(length.saturating_sub(1)).collect();
    start + "…"
}

/// An empty frame around the area that says why.
pub(super) fn empty_frame(area: &Area, reason: &str) -> Result<(), DrawError> {
    let (width, height) = area.dim_in_pixel();
    let (right, bottom) = (width as i32, height as i32);
    let frame = vec![(0, 0), (right, 0), (right, bottom), (0, bottom), (0, 0)];
    area.draw(&PathElement::new(frame, line(&GRID, 10)))?;
    let middle = (right / 2, bottom / 2);
    write(area, reason, &font(13, FAINT_INK), HPos::Center, middle)
}
