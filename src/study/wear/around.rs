//! What journals rub round their rings: as a table and as a picture.

use crate::engine::WEAR_DIRECTIONS;
use crate::mechanism::{Bearing, Mechanism};
use crate::report::{Curve, Panel, Picture, ReportError, Style, panels_svg};
use std::f64::consts::TAU;

/// File of the table.
pub(in crate::study) const WEAR_FILE: &str = "wear.csv";

/// The joints whose rings wear: those under a contact law.
pub(in crate::study) fn wearing(mechanism: &Mechanism) -> Vec<usize> {
    let joints = mechanism.revolutes.iter().enumerate();
    let by_law = joints
        .filter(|(_, joint)| matches!(joint.bearing, Bearing::Clearance(_)) && !joint.is_corner());
    by_law.map(|(i, _)| i).collect()
}

/// Angle in rad of each direction in which rubbing is counted.
pub(super) fn angles() -> impl Iterator<Item = f64> {
    (0..WEAR_DIRECTIONS).map(|i| TAU * i as f64 / WEAR_DIRECTIONS as f64)
}

/// A table of numbers: heads, and columns of one length.
pub(super) fn table(heads: &[String], columns: &[Vec<f64>]) -> String {
    let mut table = csv::Writer::from_writer(Vec::new());
    // Writing to memory cannot fail, here and below; rows are as long as the header.
    let _ = table.write_record(heads);
    for row in 0..columns.first().map_or(0, Vec::len) {
        let _ = table.write_record(columns.iter().map(|column| format!("{:e}", column[row])));
    }
    String::from_utf8(table.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// `angle` (rad, of the ring's surface in its body's axes), and for each joint J under a law `wear_J`: normal force
/// times sliding distance in J (N m) over that degree.
pub(in crate::study) fn wear_csv(mechanism: &Mechanism, rubbed: &[Vec<f64>]) -> String {
    let joints = wearing(mechanism);
    let name = |&joint: &usize| format!("wear_{}", mechanism.revolutes[joint].name);
    let heads: Vec<String> =
        ["angle".to_owned()].into_iter().chain(joints.iter().map(name)).collect();
    let columns: Vec<Vec<f64>> =
        [angles().collect()].into_iter().chain(joints.iter().map(|&j| rubbed[j].clone())).collect();
    table(&heads, &columns)
}

/// One curve round each ring. `title` heads a joint's panel, by its name.
pub(super) fn rings(
    joints: &[(String, Vec<Curve>)],
    y_label: &str,
    file: &str,
    [title, caption]: [&str; 2],
) -> Result<Picture, ReportError> {
    let panel = |(name, curves): &(String, Vec<Curve>)| Panel {
        title: format!("Joint {name}"),
        x_label: "direction in the ring's body (deg)".into(),
        y_label: y_label.into(),
        curves: curves.clone(),
    };
    let panels: Vec<Panel> = joints.iter().map(panel).collect();
    Ok(Picture {
        file: file.to_owned(),
        title: title.to_owned(),
        caption: caption.to_owned(),
        svg: panels_svg(&panels)?,
    })
}

/// A curve round a ring.
pub(super) fn round(name: &str, values: &[f64]) -> Curve {
    let degrees = angles().map(f64::to_degrees);
    Curve {
        name: name.to_owned(),
        points: degrees.zip(values.iter().copied()).collect(),
        style: Style::Solid,
    }
}

/// Where journals rub, joint by joint.
pub(in crate::study) fn wear_picture(
    mechanism: &Mechanism,
    rubbed: &[Vec<f64>],
) -> Result<Picture, ReportError> {
    let joint = |i: usize| {
        let name = mechanism.revolutes[i].name.clone();
        let curve = round(&name, &rubbed[i]);
        (name, vec![curve])
    };
    let joints: Vec<_> = wearing(mechanism).into_iter().map(joint).collect();
    rings(
        &joints,
        "force times sliding (J per degree)",
        "wear.svg",
        [
            "Where the rings wear",
            "Normal force times sliding distance by the direction in which the surface faces, seen from the ring's \
             body. Wear is in proportion to it (Archard's law); `freeplay wear` grows the rings by it.",
        ],
    )
}
