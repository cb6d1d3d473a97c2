//! The bodies of a description as those that move: bodies that fixed joints hold together are one.

use super::shape;
use crate::mechanism::{Attachment, Body, BodyState};
use crate::scenario::{self, Described, GROUND, Joint};
use nalgebra::{UnitComplex, Vector2, Vector3};
use std::collections::BTreeMap;

/// Where a described body is in what moves.
#[derive(Clone, Copy, Debug)]
pub(in crate::model) struct Part {
    /// The moving body, or the ground.
    pub body: Option<usize>,
    /// Origin of the described axes, from the moving body's centre of mass in its own axes (ground: world),
    /// in m.
    pub origin: Vector2<f64>,
    /// Their angle in those axes, in rad.
    pub angle: f64,
}

/// What moves, and where each described body is in it.
#[derive(Clone, Debug)]
pub(in crate::model) struct Parts {
    pub bodies: Vec<Body>,
    /// By name; the ground included.
    pub named: BTreeMap<String, Part>,
    points: BTreeMap<String, BTreeMap<String, [f64; 2]>>,
}

/// A described body in the axes of the first one that it is fixed to.
#[derive(Clone, Copy)]
struct Placed {
    root: Option<usize>,
    origin: Vector2<f64>,
    angle: f64,
}

impl Parts {
    /// The bodies of a description, at their guessed starts.
    pub fn of(described: &Described) -> Self {
        let placed = placed(described);
        let mut bodies = Vec::new();
        let mut named = BTreeMap::new();
        let ground = Part { body: None, origin: Vector2::zeros(), angle: 0.0 };
        named.insert(GROUND.to_owned(), ground);
        for (i, root) in described.bodies.iter().enumerate() {
            let members: Vec<usize> =
                (0..placed.len()).filter(|&k| placed[k].root == Some(i)).collect();
            if placed[i].root != Some(i) {
                continue;
            }
            let (mass, inertia, centre) = together(described, &placed, &members);
            for &k in &members {
                let Placed { origin, angle, .. } = placed[k];
                let part = Part { body: Some(bodies.len()), origin: origin - centre, angle };
                named.insert(described.bodies[k].name.clone(), part);
            }
            bodies.push(body(root, mass, inertia, centre));
        }
        for (body, placed) in described.bodies.iter().zip(&placed) {
            if placed.root.is_none() {
                let Placed { origin, angle, .. } = *placed;
                named.insert(body.name.clone(), Part { body: None, origin, angle });
            }
        }
        let mut points: BTreeMap<_, _> =
            described.bodies.iter().map(|b| (b.name.clone(), b.points.clone())).collect();
        points.insert(GROUND.to_owned(), described.ground.points.clone());
        Self { bodies, named, points }
    }

    /// The part of that name; the ground's where there is none, which validation has refused.
    pub fn part(&self, name: &str) -> Part {
        self.named.get(name).copied().unwrap_or(Part {
            body: None,
            origin: Vector2::zeros(),
            angle: 0.0,
        })
    }

    /// The point `body.point`, and the angle (rad) of the described axes in those of the moving body.
    pub fn point(&self, name: &str) -> (Attachment, f64) {
        let (body, point) = name.split_once('.').unwrap_or((name, ""));
        let part = self.part(body);
        let local = self.points.get(body).and_then(|points| points.get(point));
        let local: Vector2<f64> = local.copied().unwrap_or_default().into();
        (Attachment { body: part.body, point: part.place(local) }, part.angle)
    }
}

impl Part {
    /// A point of the described axes (m) in those of the moving body, from its centre of mass.
    pub fn place(&self, local: Vector2<f64>) -> Vector2<f64> {
        self.origin + turned(self.angle, local)
    }
}

/// A vector turned by `angle` rad; exactly itself where that is none.
fn turned(angle: f64, v: Vector2<f64>) -> Vector2<f64> {
    if angle == 0.0 { v } else { UnitComplex::new(angle) * v }
}

/// Each body in the axes of the first one, or the ground, that fixed joints hold it to.
fn placed(described: &Described) -> Vec<Placed> {
    let index = |name: &str| described.bodies.iter().position(|body| body.name == name);
    let mut placed: Vec<Option<Placed>> = vec![None; described.bodies.len()];
    // From the ground on, then from each body in turn that is not placed yet.
    for root in std::iter::once(None).chain((0..described.bodies.len()).map(Some)) {
        if let Some(i) = root {
            if placed[i].is_some() {
                continue;
            }
            placed[i] = Some(Placed { root, origin: Vector2::zeros(), angle: 0.0 });
        }
        loop {
            let before = placed.clone();
            for joint in &described.joints {
                let Joint::Fixed(fixed) = joint else { continue };
                let ends = [(&fixed.base, &fixed.part, 1.0), (&fixed.part, &fixed.base, -1.0)];
                for (known, other, sign) in ends {
                    let Some((from, from_point)) = located(described, known) else { continue };
                    let Some((to, to_point)) = located(described, other) else { continue };
                    let here = match index(from) {
                        Some(i) => placed[i].filter(|p| p.root == root),
                        None => root.is_none().then_some(Placed {
                            root: None,
                            origin: Vector2::zeros(),
                            angle: 0.0,
                        }),
                    };
                    let (Some(here), Some(to)) = (here, index(to)) else { continue };
                    if placed[to].is_none() {
                        let angle = here.angle + sign * fixed.angle;
                        let meeting = here.origin + turned(here.angle, from_point);
                        let origin = meeting - turned(angle, to_point);
                        placed[to] = Some(Placed { root, origin, angle });
                    }
                }
            }
            if before.iter().map(Option::is_some).eq(placed.iter().map(Option::is_some)) {
                break;
            }
        }
    }
    let alone = |i: usize| Placed { root: Some(i), origin: Vector2::zeros(), angle: 0.0 };
    placed.into_iter().enumerate().map(|(i, p)| p.unwrap_or(alone(i))).collect()
}

/// The body of `body.point`, and the point in its own axes.
fn located<'a>(described: &Described, name: &'a str) -> Option<(&'a str, Vector2<f64>)> {
    let (body, point) = name.split_once('.')?;
    let points = if body == GROUND {
        &described.ground.points
    } else {
        &described.bodies.iter().find(|b| b.name == body)?.points
    };
    Some((body, (*points.get(point)?).into()))
}

/// Mass, inertia about the common centre of mass, and that centre in the first one's axes: parallel axis
/// theorem.
fn together(
    described: &Described,
    placed: &[Placed],
    members: &[usize],
) -> (f64, f64, Vector2<f64>) {
    if let [only] = members {
        return shape::mass(&described.bodies[*only]);
    }
    let each: Vec<(f64, f64, Vector2<f64>)> = members
        .iter()
        .map(|&k| {
            let (mass, inertia, centre) = shape::mass(&described.bodies[k]);
            (mass, inertia, placed[k].origin + turned(placed[k].angle, centre))
        })
        .collect();
    let mass: f64 = each.iter().map(|(mass, ..)| mass).sum();
    let centre = each.iter().map(|(m, _, c)| c * *m).sum::<Vector2<f64>>() / mass;
    let inertia = each.iter().map(|(m, i, c)| i + m * (c - centre).norm_squared()).sum();
    (mass, inertia, centre)
}

/// The moving body of `root`'s axes.
fn body(root: &scenario::Body, mass: f64, inertia: f64, centre: Vector2<f64>) -> Body {
    let [x, y, angle] = root.start;
    let [vx, vy, spin] = root.velocity;
    let rotation = UnitComplex::new(angle);
    let arm = rotation * centre;
    let start = BodyState {
        position: Vector2::new(x, y) + arm,
        rotation,
        twist: Vector3::new(vx - spin * arm.y, vy + spin * arm.x, spin),
    };
    Body { angle, reference: -centre, ..Body::new(&root.name, mass, inertia, start) }
}
