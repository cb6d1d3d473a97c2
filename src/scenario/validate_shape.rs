//! Masses and shapes that no body can have.

use super::validate_described::Checks;
use super::validate_names::suggest;
use super::{Body, Shape};

impl Checks<'_> {
    /// A body's mass and inertia, or its shape.
    pub(super) fn mass(&mut self, path: &str, body: &Body) {
        let given = [("mass", body.mass, "kg"), ("inertia", body.inertia, "kg m²")];
        for (key, value, unit) in given {
            let path = format!("{path}.{key}");
            match (value, &body.shape) {
                (Some(_), Some(_)) => {
                    let message = "stands beside `shape`".to_owned();
                    self.complain(&path, message, "keep one: a shape has a mass and an inertia");
                }
                (None, None) => {
                    let message = format!("is missing for the body \"{}\"", body.name);
                    self.complain(&path, message, &format!("write {key} = … ({unit}), or a shape"));
                }
                (Some(value), None) if value <= 0.0 => {
                    let message = format!("is {value} for the body \"{}\"", body.name);
                    let help = format!(
                        "expected above 0 {unit}: a body that moves has both, however small"
                    );
                    self.complain(&path, message, &help);
                }
                _ => {}
            }
        }
        let Some(shape) = &body.shape else { return };
        let (points, sizes): (Vec<&String>, &[(&str, f64, &str)]) = match shape {
            Shape::Bar { from, to, diameter, density } => {
                (vec![from, to], &[("diameter", *diameter, "m"), ("density", *density, "kg/m³")])
            }
            Shape::Disc { center, radius, thickness, density } => (
                vec![center],
                &[
                    ("radius", *radius, "m"),
                    ("thickness", *thickness, "m"),
                    ("density", *density, "kg/m³"),
                ],
            ),
            Shape::Polygon { corners, thickness, density } => (
                corners.iter().collect(),
                &[("thickness", *thickness, "m"), ("density", *density, "kg/m³")],
            ),
        };
        for (key, value, unit) in sizes {
            if *value <= 0.0 {
                let help = format!("expected above 0 {unit}");
                self.complain(&format!("{path}.shape.{key}"), format!("is {value}"), &help);
            }
        }
        let known = points.iter().all(|point| body.points.contains_key(*point));
        for point in points {
            if !body.points.contains_key(point) {
                let message = format!("the body \"{}\" has no point \"{point}\"", body.name);
                let known: Vec<&str> = body.points.keys().map(String::as_str).collect();
                self.complain(&format!("{path}.shape"), message, &suggest(point, &known));
            }
        }
        // What a point nobody has would enclose says nothing more.
        if !known {
            return;
        }
        let place = |name: &String| body.points.get(name).copied().unwrap_or_default();
        let flat = match shape {
            Shape::Bar { from, to, .. } => place(from) == place(to),
            Shape::Disc { .. } => false,
            Shape::Polygon { corners, .. } => {
                let next = corners.iter().cycle().skip(1);
                let double: f64 = corners
                    .iter()
                    .zip(next)
                    .map(|(a, b)| (place(a), place(b)))
                    .map(|([ax, ay], [bx, by])| ax * by - ay * bx)
                    .sum();
                double == 0.0
            }
        };
        if flat {
            let message = format!("of the body \"{}\" has no extent, and so no mass", body.name);
            let help = "a bar between two places, or a polygon with an area";
            self.complain(&format!("{path}.shape"), message, help);
        }
        if let Shape::Polygon { corners, .. } = shape {
            let path = format!("{path}.shape.corners");
            if corners.len() < 3 {
                let message = format!("has {} corners", corners.len());
                self.complain(&path, message, "expected 3 or more");
            } else if let Some([a, b]) = crossing(&corners.iter().map(place).collect::<Vec<_>>()) {
                let name = |i: usize| &corners[i % corners.len()];
                let message = format!(
                    "crosses itself: {}-{} and {}-{}",
                    name(a),
                    name(a + 1),
                    name(b),
                    name(b + 1)
                );
                self.complain(&path, message, "name the corners in their order around the plate");
            }
        }
    }
}

/// The first two sides of a polygon that cross, each by the corner where it begins.
fn crossing(corners: &[[f64; 2]]) -> Option<[usize; 2]> {
    let n = corners.len();
    let side = |i: usize| [corners[i], corners[(i + 1) % n]];
    // On which side of the line through `a` and `b` a point is.
    let turn = |[a, b]: [[f64; 2]; 2], p: [f64; 2]| {
        ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])).signum()
    };
    let parts = |line, [a, b]: [[f64; 2]; 2]| turn(line, a) * turn(line, b) < 0.0;
    let crosses = |a: usize, b: usize| parts(side(a), side(b)) && parts(side(b), side(a));
    // Sides that share a corner do not cross.
    let pairs = (0..n).flat_map(|a| (a + 2..n).map(move |b| [a, b]));
    pairs.into_iter().find(|&[a, b]| (a, b) != (0, n - 1) && crosses(a, b))
}
