//! Masses and shapes that no body can have.

use super::described::DescribedChecks;
use super::names::suggest;
use crate::scenario::{Body, Shape};

impl DescribedChecks<'_> {
    /// A body's mass and inertia, or its shape.
    pub(super) fn mass(&mut self, path: &str, body: &Body) {
        self.given_mass(path, body);
        let Some(shape) = &body.shape else { return };
        self.sizes(path, shape);
        // What a point nobody has would enclose says nothing more.
        if !self.points_of_shape(path, body, shape) {
            return;
        }
        if is_flat(body, shape) {
            let message = format!("of the body \"{}\" has no extent, and so no mass", body.name);
            let help = "a bar between two places, or a polygon with an area";
            self.complain(&format!("{path}.shape"), message, help);
        }
        if let Shape::Polygon { corners, .. } = shape {
            self.corners(path, body, corners);
        }
    }

    /// Mass and inertia that stand there, or should.
    fn given_mass(&mut self, path: &str, body: &Body) {
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
    }

    /// Sizes and densities of a shape.
    fn sizes(&mut self, path: &str, shape: &Shape) {
        let sizes: &[(&str, f64, &str)] = match shape {
            Shape::Bar { diameter, density, .. } => {
                &[("diameter", *diameter, "m"), ("density", *density, "kg/m³")]
            }
            Shape::Disc { radius, thickness, density, .. } => &[
                ("radius", *radius, "m"),
                ("thickness", *thickness, "m"),
                ("density", *density, "kg/m³"),
            ],
            Shape::Polygon { thickness, density, .. } => {
                &[("thickness", *thickness, "m"), ("density", *density, "kg/m³")]
            }
        };
        for (key, value, unit) in sizes {
            if *value <= 0.0 {
                let help = format!("expected above 0 {unit}");
                self.complain(&format!("{path}.shape.{key}"), format!("is {value}"), &help);
            }
        }
    }

    /// Whether the body has all points of its shape.
    fn points_of_shape(&mut self, path: &str, body: &Body, shape: &Shape) -> bool {
        let points: Vec<&String> = match shape {
            Shape::Bar { from, to, .. } => vec![from, to],
            Shape::Disc { center, .. } => vec![center],
            Shape::Polygon { corners, .. } => corners.iter().collect(),
        };
        let mut known = true;
        for point in points {
            if !body.points.contains_key(point) {
                known = false;
                let message = format!("the body \"{}\" has no point \"{point}\"", body.name);
                let known: Vec<&str> = body.points.keys().map(String::as_str).collect();
                self.complain(&format!("{path}.shape"), message, &suggest(point, &known));
            }
        }
        known
    }

    /// A polygon's number of corners, and their order.
    fn corners(&mut self, path: &str, body: &Body, corners: &[String]) {
        let path = format!("{path}.shape.corners");
        let places: Vec<[f64; 2]> = corners.iter().map(|name| place(body, name)).collect();
        if corners.len() < 3 {
            let message = format!("has {} corners", corners.len());
            self.complain(&path, message, "expected 3 or more");
        } else if let Some([a, b]) = crossing(&places) {
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

/// Where a point of a body is, in its own axes, m.
fn place(body: &Body, name: &str) -> [f64; 2] {
    body.points.get(name).copied().unwrap_or_default()
}

/// Whether a shape has no extent.
fn is_flat(body: &Body, shape: &Shape) -> bool {
    match shape {
        Shape::Bar { from, to, .. } => place(body, from) == place(body, to),
        Shape::Disc { .. } => false,
        Shape::Polygon { corners, .. } => {
            let next = corners.iter().cycle().skip(1);
            let double: f64 = corners
                .iter()
                .zip(next)
                .map(|(a, b)| (place(body, a), place(body, b)))
                .map(|([ax, ay], [bx, by])| ax * by - ay * bx)
                .sum();
            double == 0.0
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
