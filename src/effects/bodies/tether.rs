//! A cable or hose that pulls at a body.

use crate::effects::kind::defaults;
use crate::effects::{FittedBy, FittedNumber, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Axes, Load, Mark, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Farthest anchor in m along an axis, and longest cable: what hangs in a hall.
const FAR: f64 = 15.0;

/// Stiffest cable in N/m: a steel rope of 5 mm and some metres, which ten kilonewtons stretch by a decimetre.
const STIFFEST: f64 = 1e5;

const fn anchor(name: &'static str, about: &'static str) -> Parameter {
    Parameter { name, unit: "m", about, bounds: [-FAR, FAR], step: 1e-3, default: Some(0.0) }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "tether",
    summary: "a spring that only pulls, from a fixed anchor to the centre of mass of a body (the platform, where none \
              is named): a cable, a hose",
    equation: "k max(0, |a - C| - rest length) towards the anchor a, C the centre of mass as declared",
    source: "Hooke",
    trace: "actuator forces: a pull that grows with the distance from one point",
    targets: Targets::Body,
    parameters: &[
        Parameter::size("stiffness_N_m", "N/m", "stiffness k", STIFFEST, 0.2),
        anchor("anchor_x_m", "anchor along x"),
        anchor("anchor_y_m", "anchor along y"),
        Parameter::size("rest_length_m", "m", "length at which it does not pull yet", FAR, 1e-3),
    ],
    variants: &[&["stiffness_N_m", "anchor_x_m", "anchor_y_m", "rest_length_m"]],
    neutral: defaults,
    starts,
    scan: None,
    fitted_by: Some(FittedBy { numbers, values }),
    apply,
};

/// Anchors around the machine, near and far by its own size, taut and slack for a part of the motion.
fn starts(mechanism: &Mechanism, _: &Setting) -> Vec<Vec<f64>> {
    let bodies = &mechanism.bodies;
    let middle = bodies.iter().map(|body| body.start.position).sum::<Vector2<f64>>();
    let (middle, size) = (middle / bodies.len().max(1) as f64, mechanism.size());
    let ring = |share: f64| (0..8).map(move |k| (share * size, TAU * f64::from(k) / 8.0));
    let around = [0.25, 0.5, 1.25].into_iter().flat_map(ring);
    let slack = |(r, angle): (f64, f64)| {
        let anchor = middle + Vector2::new(angle.cos(), angle.sin()) * r;
        [0.5, 0.9, 1.0].map(|slack| vec![20.0, anchor.x, anchor.y, slack * r])
    };
    around.flat_map(slack).collect()
}

/// What pulls at a point that hardly moves: with how much force T (less than nothing where it is slack), in which direction θ,
/// by how much more for each metre along that, k, and the length at which it begins to, L. The anchor is d = L + T/k away, and of
/// a small motion δ the force is T u − k (u·δ) u − T/d (1 − u uᵀ) δ, u towards the anchor: the first three show by themselves,
/// where another anchor makes up for another stiffness almost entirely, and the last, which hardly shows, is as long as makes sense.
fn numbers(mechanism: &Mechanism, setting: &Setting) -> Option<Vec<FittedNumber>> {
    let values: Vec<f64> = setting.values().map(|(_, value)| value).collect();
    let &[stiffness, x, y, rest_length] = values.as_slice() else { return None };
    let pull = Vector2::new(x, y) - middle(mechanism, setting)?;
    let length = pull.norm();
    let reach = REACH * mechanism.size();
    let wide = [-f64::MAX, f64::MAX];
    let number = |start: f64, size: f64, bounds| FittedNumber { start, step: SHARE * size, bounds };
    (stiffness > 0.0 && length > 0.0).then(|| {
        vec![
            number(stiffness * (length - rest_length), stiffness * length, wide),
            number(pull.y.atan2(pull.x), 1.0, wide),
            number(stiffness, stiffness, [0.0, STIFFEST]),
            number(rest_length, length, [0.0, reach]),
        ]
    })
}

/// Farthest anchor that a fit comes to, in sizes of the machine: farther ones pull alike.
const REACH: f64 = 1.5;

/// Change of the numbers that a tether is fitted by, as a share of their sizes, by which derivatives are taken: what bends is
/// hardly bent over it.
const SHARE: f64 = 0.01;

/// The values of a tether that such numbers stand for: one with its anchor too far away is as long as it may be.
fn values(mechanism: &Mechanism, setting: &Setting, numbers: &[f64]) -> Vec<f64> {
    let (&[force, angle, stiffness, rest_length], Some(middle)) =
        (numbers, middle(mechanism, setting))
    else {
        return setting.values().map(|(_, value)| value).collect();
    };
    let reach = (REACH * mechanism.size()).min(FAR);
    let stiffness = stiffness.max(force / reach).clamp(f64::MIN_POSITIVE, STIFFEST);
    let stretched = (force / stiffness).min(reach);
    let length = (rest_length + stretched).clamp(0.0, reach);
    let anchor = middle + Vector2::new(angle.cos(), angle.sin()) * length;
    let rest_length = if stretched > 0.0 { length - stretched } else { rest_length };
    vec![stiffness, anchor.x.clamp(-FAR, FAR), anchor.y.clamp(-FAR, FAR), rest_length]
}

/// Where the body that it pulls at begins, in m.
fn middle(mechanism: &Mechanism, setting: &Setting) -> Option<Vector2<f64>> {
    let (body, Axes { centre, .. }) = setting.body(mechanism).ok()?;
    let start = &mechanism.bodies[body].start;
    let from = mechanism.bodies[body].reference + centre.point;
    Some(start.position + start.rotation * from)
}

#[derive(Debug)]
struct Tether {
    centre: Mark,
    stiffness: f64,
    anchor: Vector2<f64>,
    rest_length: f64,
}

impl Load for Tether {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let pull = self.anchor - at.point(self.centre).position;
        let length = pull.norm();
        if length > self.rest_length {
            let force = pull * (self.stiffness * (length - self.rest_length) / length);
            at.push_point(self.centre, force, 0.0, wrenches);
        }
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let anchor = Vector2::new(setting.number("anchor_x_m"), setting.number("anchor_y_m"));
    let (_, Axes { centre, .. }) = setting.body(mechanism)?;
    mechanism.loads.push(Arc::new(Tether {
        centre,
        stiffness: setting.number("stiffness_N_m"),
        anchor,
        rest_length: setting.number("rest_length_m"),
    }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{KIND, REACH, numbers, values};
    use crate::effects::rigs::{SLIDER_CRANK, closed};
    use crate::effects::{Parameter, Setting, Target};
    use nalgebra::Vector2;

    fn tether(values: [f64; 4]) -> Setting {
        let names = ["stiffness_N_m", "anchor_x_m", "anchor_y_m", "rest_length_m"];
        let given: Vec<_> = names.into_iter().zip(values).collect();
        Setting::on(&KIND, Target::Body("piston".to_owned()), &given)
    }

    /// The force on a piston that moves by a little, by Hooke's law and by the numbers that a fit chooses; taut and slack ones
    /// come back as the values that they were.
    #[test]
    fn a_tether_is_its_force_its_slope_and_its_direction() {
        let rig = closed(SLIDER_CRANK);
        let machine = &rig.mechanism;
        let start = machine.bodies[2].start.position;
        for own in [[20.0, 0.3, 0.1, 0.05], [5.0, 0.1, -0.12, 0.18]] {
            let setting = tether(own);
            let told: Vec<f64> =
                numbers(machine, &setting).unwrap().iter().map(|of| of.start).collect();
            let back = values(machine, &setting, &told);
            assert!(back.iter().zip(own).all(|(a, b)| (a - b).abs() < 1e-12), "{back:?}");
            let [stiffness, x, y, rest_length] = own;
            let pull = |at: Vector2<f64>| {
                let to = Vector2::new(x, y) - at;
                to.normalize() * (stiffness * (to.norm() - rest_length))
            };
            let by = Vector2::new(2e-5, -1e-5);
            let along = Vector2::new(told[1].cos(), told[1].sin());
            let across = by - along * along.dot(&by);
            let expected = pull(start + by) - along * told[0];
            let away = told[3] + told[0] / told[2];
            let seen = -along * (told[2] * along.dot(&by)) - across * (told[0] / away);
            assert!((expected - seen).norm() < 1e-3 * seen.norm(), "{expected} {seen}");
        }
    }

    /// Whatever numbers a step leads to within their bounds, they stand for a tether that can be.
    #[test]
    fn a_step_too_far_is_still_a_tether() {
        let rig = closed(SLIDER_CRANK);
        let machine = &rig.mechanism;
        let setting = tether([20.0, 0.3, 0.1, 0.05]);
        let longest = numbers(machine, &setting).unwrap()[3].bounds[1];
        assert!((longest - REACH * machine.size()).abs() < 1e-12);
        for tried in [
            [1.0, 0.3, 0.0, 0.0],
            [0.0, 0.3, 0.0, 0.0],
            [-1e9, 9.0, 1e-9, longest],
            [3e9, 0.0, 1.0, longest],
        ] {
            let found = values(machine, &setting, &tried);
            let mut ends = KIND.parameters.iter().zip(&found);
            let inside = |(p, v): (&Parameter, &f64)| (p.bounds[0]..=p.bounds[1]).contains(v);
            assert!(ends.all(inside), "{tried:?}: {found:?}");
        }
    }
}
