//! Mass, inertia and centre of mass of homogeneous shapes.

use crate::scenario::{Body, Shape};
use nalgebra::Vector2;
use std::f64::consts::PI;

/// Mass of a body in kg, inertia about its centre of mass in kg·m², and that centre in its own axes in m.
pub(super) fn mass(body: &Body) -> (f64, f64, Vector2<f64>) {
    let given: Vector2<f64> = body.center_of_mass.unwrap_or_default().into();
    let Some(shape) = &body.shape else {
        return (body.mass.unwrap_or_default(), body.inertia.unwrap_or_default(), given);
    };
    let point =
        |name: &String| body.points.get(name).copied().map(Vector2::from).unwrap_or_default();
    match shape {
        // m L²/12 + m r²/4, as every bar of this program.
        Shape::Bar { from, to, diameter, density } => {
            let (from, to) = (point(from), point(to));
            let (length, radius) = ((to - from).norm(), 0.5 * diameter);
            let mass = density * PI * radius * radius * length;
            let inertia = mass * (length * length / 12.0 + radius * radius / 4.0);
            (mass, inertia, (from + to) / 2.0)
        }
        Shape::Disc { center, radius, thickness, density } => {
            let mass = density * PI * radius * radius * thickness;
            (mass, 0.5 * mass * radius * radius, point(center))
        }
        Shape::Polygon { corners, thickness, density } => {
            let corners: Vec<Vector2<f64>> = corners.iter().map(point).collect();
            polygon(&corners, density * thickness)
        }
    }
}

/// A flat polygon of `surface` kg/m², from triangles between the origin and its edges: area `½ a × b`, centre
/// `(a + b)/3`, second moment about the origin `(a·a + a·b + b·b)/6` of the area.
fn polygon(corners: &[Vector2<f64>], surface: f64) -> (f64, f64, Vector2<f64>) {
    let (mut area, mut first, mut second) = (0.0, Vector2::zeros(), 0.0);
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let triangle = 0.5 * a.perp(b);
        area += triangle;
        first += (a + b) * (triangle / 3.0);
        second += triangle * (a.dot(a) + a.dot(b) + b.dot(b)) / 6.0;
    }
    if area == 0.0 {
        return (0.0, 0.0, Vector2::zeros());
    }
    let centre = first / area;
    let (mass, about_origin) = (surface * area.abs(), surface * second.abs());
    (mass, about_origin - mass * centre.norm_squared(), centre)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_off_the_origin() {
        let corner = |x: f64, y: f64| Vector2::new(x, y);
        let corners = [corner(1.0, 2.0), corner(1.3, 2.0), corner(1.3, 2.4), corner(1.0, 2.4)];
        let (mass, inertia, centre) = polygon(&corners, 5.0);
        assert!((mass - 0.6).abs() < 1e-12);
        assert!((centre - Vector2::new(1.15, 2.2)).norm() < 1e-12);
        assert!((inertia - 0.6 * (0.09 + 0.16) / 12.0).abs() < 1e-12);
        let reversed: Vec<_> = corners.into_iter().rev().collect();
        assert!((polygon(&reversed, 5.0).1 - inertia).abs() < 1e-12);
    }
}
