//! What an effect without a name does: its force over the plane, or over what it depends on.

use crate::effects::{Central, Efforts, Over, Setting};
use crate::report::{Curve, Panel, Picture, ReportError, Style, number, panels_svg, path_svg};

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
        let (svg, over) = match (effect.efforts(), effect.central()) {
            (Some(table), _) if table.depends_on == Over::OutputPosition => {
                (plane(table)?, "the plane")
            }
            (Some(table), _) => (panels_svg(&of_table(table))?, table.depends_on.words()),
            (_, Some(table)) => (panels_svg(&[of_distance(table)])?, "the distance"),
            _ => continue,
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

/// Evenly from −1 to 1.
fn from_end_to_end(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| 2.0 * k as f64 / (count - 1) as f64 - 1.0)
}

/// Arrows over the plane, each from its place along the force on the output there.
fn plane(table: &Efforts) -> Result<String, ReportError> {
    let [x, y, phi] = [0, 1, 2].map(|k| table.middle[k]);
    let still = [0.0; 3];
    let places = from_end_to_end(ARROWS).flat_map(|u| {
        from_end_to_end(ARROWS).map(move |v| [x + u * table.reach[0], y + v * table.reach[1], phi])
    });
    let force = |place: &[f64], k: usize| table.effort(k, place, &still);
    let arrows: Vec<[f64; 4]> =
        places.map(|place| [place[0], place[1], force(&place, 0), force(&place, 1)]).collect();
    let strongest = arrows.iter().map(|[_, _, fx, fy]| fx.hypot(*fy)).fold(0.0, f64::max);
    let apart = 2.0 * table.reach[0].min(table.reach[1]) / (ARROWS - 1) as f64;
    let scale = if strongest > 0.0 { LONGEST * apart / strongest } else { 0.0 };
    // Up to the tip, and the barbs.
    let drawn = arrows.iter().flat_map(|[x, y, fx, fy]| {
        let (dx, dy) = (scale * fx, scale * fy);
        let tip = (x + dx, y + dy);
        let barb =
            |side: f64| (tip.0 - 0.3 * dx - side * 0.2 * dy, tip.1 - 0.3 * dy + side * 0.2 * dx);
        [(*x, *y), tip, barb(1.0), barb(-1.0), tip, (f64::NAN, f64::NAN)]
    });
    let strongest = number(strongest);
    let name = format!("force, at most {strongest} N");
    let arrows = [Curve { name, points: drawn.collect(), style: Style::Solid }];
    path_svg(&format!("Force on the output, at most {strongest} N"), &arrows)
}

/// The force towards a fixed place over the distance from there.
fn of_distance(table: &Central) -> Panel {
    let [near, far] = table.reach;
    let distances = from_end_to_end(POINTS).map(|u| near + 0.5 * (u + 1.0) * (far - near));
    let [x, y] = table.place.map(number);
    let points = distances.map(|distance| (distance, table.force(distance))).collect();
    let name = table.point.as_deref().unwrap_or("the output").to_owned();
    Panel {
        title: format!("Force on {name} towards ({x}, {y}) m"),
        x_label: "distance (m)".into(),
        y_label: "force (N)".into(),
        curves: vec![Curve { name, points, style: Style::Solid }],
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
        for depends_on in Over::ALL {
            let joints = match depends_on.acts_on_output() {
                true => Vec::new(),
                false => ["A", "B", "C"].map(str::to_owned).to_vec(),
            };
            let ranges = [[0.0, 0.05, 0.1], [0.1, 0.04, 0.1], [0.5, 0.2, 1.0]];
            let mut table = Efforts::empty(depends_on, joints, &ranges);
            let features = table.features(0, &table.middle, &[0.0; 3]).len();
            table.coefficients = vec![vec![0.5; features]; 3];
            let drawn = pictures([&Setting::unnamed_efforts(table)]).expect("a picture");
            assert_eq!(drawn.len(), 1, "{depends_on:?}");
            assert!(drawn[0].svg.contains("<polyline") && !drawn[0].svg.contains("no data"));
        }
        let mut central = Central::empty(None, [0.1, 0.2], [0.01, 0.1], 4);
        central.coefficients = vec![0.5; 4];
        let kind = named("payload").expect("an effect");
        let effects = [Setting::new(kind, None, &[]), Setting::unnamed_central(central)];
        let drawn = pictures(&effects).expect("a picture");
        assert_eq!(drawn.len(), 1, "a payload has a name");
        assert!(drawn[0].svg.contains("<polyline") && drawn[0].svg.contains("(0.1, 0.2)"));
    }
}
