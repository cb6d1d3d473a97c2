//! What an effect without a name does: its force over the plane, or over what it depends on.

use crate::effects::{DependsOn, Efforts, Map, MapMotion, Over, Setting};
use crate::mechanism::Command;
use crate::report::{Curve, Panel, Picture, ReportError, Style, panels_svg, path_svg};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Points of a curve.
const POINTS: usize = 121;

/// Arrows along each side of the plane.
const ARROWS: usize = 9;

/// Length of the longest arrow as a share of the distance of two.
const LONGEST: f64 = 0.9;

/// Forces on the output.
const PARTS: [&str; 3] = ["Force along x", "Force along y", "Torque"];

/// The pictures of those effects of a model that have no name and are tables.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn pictures<'a>(
    effects: impl IntoIterator<Item = &'a Setting>,
) -> Result<Vec<Picture>, ReportError> {
    let mut pictures = Vec::new();
    for effect in effects {
        let (svg, over) = match (effect.map(), effect.efforts()) {
            (Some(map), _) if map.depends_on == DependsOn::Position => {
                (plane(map)?, "the plane".to_owned())
            }
            (Some(map), _) => (panels_svg(&of_map(map))?, map.depends_on.words().to_owned()),
            (None, Some(table)) => {
                (panels_svg(&of_table(table))?, table.depends_on.words().to_owned())
            }
            (None, None) => continue,
        };
        let file = match pictures.len() {
            0 => "unnamed.svg".to_owned(),
            n => format!("unnamed-{}.svg", n + 1),
        };
        pictures.push(Picture {
            file,
            title: format!("What has no name, over {over}"),
            caption: "The forces that the fitted table stands for, over what it depends on, as far as the recording went: \
                      their shape may say what they come from."
                .to_owned(),
            svg,
        });
    }
    Ok(pictures)
}

/// The force of each component of a map.
fn forces(map: &Map, motion: MapMotion, commands: &[Command]) -> Vec<f64> {
    let features = map.features(motion, commands);
    let of = |list: &Vec<f64>| features.iter().zip(list).map(|(f, c)| f * c).sum();
    map.coefficients.iter().map(of).collect()
}

/// Evenly from −1 to 1.
fn from_end_to_end(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| 2.0 * k as f64 / (count - 1) as f64 - 1.0)
}

/// Arrows over the plane, each from its place along the force on the output there.
fn plane(map: &Map) -> Result<String, ReportError> {
    let [x, y, phi] = map.middle;
    let places = from_end_to_end(ARROWS)
        .flat_map(|u| from_end_to_end(ARROWS).map(move |v| (u * map.reach[0], v * map.reach[1])));
    let arrows: Vec<[f64; 4]> = places
        .map(|(u, v)| {
            let pose = Vector3::new(x + u, y + v, phi);
            let force = forces(map, MapMotion { pose, ..MapMotion::default() }, &[]);
            [pose.x, pose.y, force[0], force[1]]
        })
        .collect();
    let strongest = arrows.iter().map(|[_, _, fx, fy]| fx.hypot(*fy)).fold(0.0, f64::max);
    let apart = 2.0 * map.reach[0].min(map.reach[1]) / (ARROWS - 1) as f64;
    let scale = if strongest > 0.0 { LONGEST * apart / strongest } else { 0.0 };
    // Up to the tip, and the barbs.
    let drawn = arrows.iter().flat_map(|[x, y, fx, fy]| {
        let (dx, dy) = (scale * fx, scale * fy);
        let tip = (x + dx, y + dy);
        let barb =
            |side: f64| (tip.0 - 0.3 * dx - side * 0.2 * dy, tip.1 - 0.3 * dy + side * 0.2 * dx);
        [(*x, *y), tip, barb(1.0), barb(-1.0), tip, (f64::NAN, f64::NAN)]
    });
    let strongest = crate::report::number(strongest);
    let name = format!("force, at most {strongest} N");
    let arrows = [Curve { name, points: drawn.collect(), style: Style::Solid }];
    path_svg(&format!("Force on the output, at most {strongest} N"), &arrows)
}

/// Force over speed, length or acceleration; what a motion of the map's reach once a second has.
fn of_map(map: &Map) -> Vec<Panel> {
    (0..map.coefficients.len())
        .map(|i| {
            let at = |share: f64| {
                let (x, motion, commands) = moving(map, i, share);
                (x, forces(map, motion, &commands)[i])
            };
            let points = from_end_to_end(POINTS).map(at).collect();
            let (title, x_label, torque) = heading(map.depends_on, i);
            Panel {
                curves: vec![Curve { name: title.clone(), points, style: Style::Solid }],
                title,
                x_label: x_label.into(),
                y_label: if torque { "torque (N m)" } else { "force (N)" }.into(),
            }
        })
        .collect()
}

/// Title of the panel of a force, label of what it is over, and whether it is a torque.
fn heading(depends_on: DependsOn, i: usize) -> (String, &'static str, bool) {
    const PARTS: [&str; 3] = ["along x", "along y", "torque"];
    let actuator = || format!("Actuator {}", i + 1);
    match depends_on {
        DependsOn::ActuatorLength => (actuator(), "length (m)", false),
        DependsOn::ActuatorVelocity => (actuator(), "speed (m/s)", false),
        DependsOn::Acceleration => (actuator(), "acceleration (m/s²)", false),
        DependsOn::Velocity | DependsOn::Position => {
            let label = if i == 2 { "angular velocity (rad/s)" } else { "velocity (m/s)" };
            (PARTS[i.min(2)].to_owned(), label, i == 2)
        }
    }
}

/// What a force is over at a share of its reach, and the motion and commands there.
fn moving(map: &Map, i: usize, share: f64) -> (f64, MapMotion, Vec<Command>) {
    let pose = Vector3::from(map.middle);
    let [middle, reach] = map.lengths;
    match map.depends_on {
        DependsOn::ActuatorLength => {
            let length = middle + share * reach;
            (
                length,
                MapMotion { pose, actuator: [length, 0.0], ..MapMotion::default() },
                Vec::new(),
            )
        }
        DependsOn::ActuatorVelocity => {
            let speed = share * TAU * reach;
            (
                speed,
                MapMotion { pose, actuator: [middle, speed], ..MapMotion::default() },
                Vec::new(),
            )
        }
        DependsOn::Acceleration => {
            let acceleration = share * TAU * TAU * reach;
            let mut commands = vec![Command::default(); map.coefficients.len()];
            commands[i].acceleration = acceleration;
            (acceleration, MapMotion { pose, ..MapMotion::default() }, commands)
        }
        DependsOn::Velocity | DependsOn::Position => {
            let mut rate = Vector3::zeros();
            rate[i] = share * TAU * map.reach[i];
            (rate[i], MapMotion { pose, rate, ..MapMotion::default() }, Vec::new())
        }
    }
}

/// The effort at each joint, or the force along each coordinate of the output, over what it depends on, the other coordinates
/// in the middle of their ways.
fn of_table(table: &Efforts) -> Vec<Panel> {
    let still = vec![0.0; table.coordinates()];
    let of_rate = matches!(table.depends_on, Over::JointRate | Over::OutputVelocity);
    let panel = |own: usize| {
        let at = |share: f64| {
            let (mut positions, mut rates) = (table.middle.clone(), still.clone());
            if of_rate {
                rates[own] = share * table.rates[own];
                return (rates[own], table.effort(own, &positions, &rates));
            }
            positions[own] += share * table.reach[own];
            (positions[own], table.effort(own, &positions, &rates))
        };
        let over = if of_rate { "rate" } else { "coordinate" };
        let [title, name] = match table.joints.get(own) {
            Some(joint) => [format!("Joint {joint}"), joint.clone()],
            None => [PARTS[own], ["x", "y", "angle"][own]].map(str::to_owned),
        };
        Panel {
            title,
            x_label: format!("{over} of {name} (SI units)").into(),
            y_label: "effort (N or N m)".into(),
            curves: vec![Curve {
                name,
                points: from_end_to_end(POINTS).map(at).collect(),
                style: Style::Solid,
            }],
        }
    };
    (0..table.coordinates()).map(panel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::named;

    #[test]
    fn every_dependence_has_a_picture() {
        for depends_on in DependsOn::ALL {
            let mut map = Map {
                depends_on,
                middle: [0.0, 0.1, 0.5],
                reach: [0.05, 0.04, 0.2],
                lengths: [0.3, 0.05],
                coefficients: Vec::new(),
            };
            let commands = vec![Command::default(); 3];
            let features = map.features(MapMotion::default(), &commands).len();
            map.coefficients = vec![vec![0.5; features]; map.components(3)];
            let drawn = pictures([&Setting::unnamed(map)]).expect("a picture");
            assert_eq!(drawn.len(), 1, "{depends_on:?}");
            assert!(drawn[0].svg.contains("<polyline") && !drawn[0].svg.contains("no data"));
        }
        let kind = named("payload").expect("an effect");
        assert!(pictures([&Setting::new(kind, None, &[])]).expect("none").is_empty());
    }
}
