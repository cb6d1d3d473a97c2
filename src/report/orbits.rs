//! Where the journals went inside their bearing rings: one square per joint.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::axis::drawable;
use super::canvas::{
    Area, DrawError, PX, WIDTH, empty_frame, font, heading, line, part, picture, shortened, write,
};
use super::colour::{FAINT_INK, FRAME, GRID, PALETTE};
use super::quantity::length;
use super::{Orbit, ReportError};

const PER_ROW: i32 = 3;
const CELL_WIDTH: i32 = WIDTH / PER_ROW;
const MARGIN: i32 = 12 * PX;
const SQUARE: i32 = CELL_WIDTH - 2 * MARGIN;
const TITLE: i32 = 34 * PX;
const CAPTION: i32 = 34 * PX;
const CELL_HEIGHT: i32 = TITLE + SQUARE + CAPTION;
/// Radius of the clearance circle: it leaves room for a journal that is pressed into its ring.
const RING: i32 = SQUARE * 43 / 100;

/// Draws the orbits in a grid of squares, three to a row, each scaled to its own clearance circle.
/// Whatever lies outside its square is drawn at the square's edge. Returns the SVG.
///
/// ```
/// use freeplay::report::{Orbit, orbits_svg};
///
/// let points = vec![[0.0, -5e-4], [2e-4, -4.5e-4], [5e-4, 0.0]];
/// let svg = orbits_svg(&[Orbit { joint: "A1".to_owned(), clearance_m: 5e-4, points }])?;
/// assert!(svg.contains("A1"));
/// # Ok::<(), freeplay::report::ReportError>(())
/// ```
///
/// # Errors
/// If the drawing library refuses; no data lead to an error.
pub fn orbits_svg(orbits: &[Orbit]) -> Result<String, ReportError> {
    if orbits.is_empty() {
        return Ok(picture(TITLE, |root| empty_frame(root, "no data"))?);
    }
    let rows = (orbits.len() as i32 - 1) / PER_ROW + 1;
    let svg = picture(rows * CELL_HEIGHT, |root| {
        for (i, orbit) in (0..).zip(orbits) {
            let corner = (i % PER_ROW * CELL_WIDTH, i / PER_ROW * CELL_HEIGHT);
            draw_cell(&part(root, corner, (CELL_WIDTH, CELL_HEIGHT)), orbit)?;
        }
        Ok(())
    })?;
    Ok(svg)
}

fn draw_cell(area: &Area, orbit: &Orbit) -> Result<(), DrawError> {
    let joint = shortened(&orbit.joint, 20);
    write(area, &joint, &heading(14), HPos::Left, (MARGIN, TITLE / 2))?;
    let square = part(area, (MARGIN, TITLE), (SQUARE, SQUARE));
    if !(drawable(orbit.clearance_m) && orbit.clearance_m > 0.0) {
        return empty_frame(&square, "no clearance");
    }
    let points = corners(orbit);
    let Some(last) = points.last().copied() else {
        return empty_frame(&square, "no data");
    };

    let middle = SQUARE / 2;
    for cross in [
        vec![(0, middle), (SQUARE, middle)],
        vec![(middle, 0), (middle, SQUARE)],
        vec![(0, 0), (SQUARE, 0), (SQUARE, SQUARE), (0, SQUARE), (0, 0)],
    ] {
        square.draw(&PathElement::new(cross, line(&GRID, 8)))?;
    }
    square.draw(&Circle::new((middle, middle), RING, line(&FRAME, 15)))?;
    square.draw(&PathElement::new(points, line(&PALETTE[0], 9)))?;
    square.draw(&Circle::new(last, 3 * PX, PALETTE[1].filled()))?;

    let caption = format!("radial clearance {}", length(orbit.clearance_m));
    let below = (CELL_WIDTH / 2, TITLE + SQUARE + CAPTION / 2);
    write(area, &caption, &font(12, FAINT_INK), HPos::Center, below)
}

/// The orbit in canvas units of its square, y downwards.
fn corners(orbit: &Orbit) -> Vec<(i32, i32)> {
    let place = |value: f64| {
        let offset = f64::from(RING) * value / orbit.clearance_m;
        (f64::from(SQUARE / 2) + offset).clamp(0.0, f64::from(SQUARE)).round() as i32
    };
    let points = orbit.points.iter();
    let mut corners: Vec<_> = points
        .filter(|p| drawable(p[0]) && drawable(p[1]))
        .map(|p| (place(p[0]), place(-p[1])))
        .collect();
    corners.dedup();
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit(clearance_m: f64, points: Vec<[f64; 2]>) -> Orbit {
        Orbit { joint: "crank & rod".to_owned(), clearance_m, points }
    }

    #[test]
    fn a_journal_at_the_clearance_is_on_the_circle() {
        let c = 0.25e-3;
        let corners = corners(&orbit(c, vec![[c, 0.0], [0.0, c]]));
        let middle = SQUARE / 2;
        assert_eq!(corners, [(middle + RING, middle), (middle, middle - RING)]);
    }

    #[test]
    fn a_journal_far_out_stays_in_its_square() {
        let corners = corners(&orbit(1e-4, vec![[1.0, -1e300], [7.0, -1.0]]));
        assert_eq!(corners, [(SQUARE, SQUARE)]);
    }

    #[test]
    fn odd_orbits_still_give_a_picture() {
        let nan = f64::NAN;
        let orbits = [
            orbit(0.0, vec![[0.0, 0.0]]),
            orbit(nan, vec![[0.0, 0.0]]),
            orbit(1e-3, vec![]),
            orbit(1e-3, vec![[nan, 0.0]]),
            orbit(1e-3, vec![[0.0, 0.0]]),
        ];
        let svg = orbits_svg(&orbits).unwrap();
        assert_eq!(svg.matches("no clearance").count(), 2);
        assert_eq!(svg.matches("no data").count(), 2);
        assert!(svg.contains("crank &amp; rod") && !svg.contains("NaN"));
        assert!(orbits_svg(&[]).unwrap().contains("no data"));
    }
}
