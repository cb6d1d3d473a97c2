//! A tracker whose frame is not the world's.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Mechanism, TrackerFrame};
use nalgebra::Vector2;

/// More than half a metre or half a radian would be seen.
const fn place(
    name: &'static str,
    unit: &'static str,
    about: &'static str,
    step: f64,
) -> Parameter {
    Parameter { name, unit, about, bounds: [-0.5, 0.5], step, default: Some(0.0) }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "tracker-frame",
    summary: "a tracker whose frame is beside, turned against or scaled to the world's: all sensors of x, y and \
              angle together",
    equation: "shows the point p at (dx, dy) + scale R(rotation) p, and angles with the rotation added",
    source: "a similarity of the plane",
    trace: "x, y and angle: with the place alone; no drive and no joint has it",
    targets: Targets::Tracker,
    parameters: &[
        place("dx_m", "m", "what it shows for the world's origin, along x", 1e-5),
        place("dy_m", "m", "what it shows for the world's origin, along y", 1e-5),
        place("rotation_rad", "rad", "by how much it shows the world turned", 1e-4),
        Parameter {
            name: "scale",
            unit: "",
            about: "what it multiplies lengths by",
            bounds: [0.5, 2.0],
            step: 1e-4,
            default: Some(1.0),
        },
    ],
    variants: &[
        &["dx_m", "dy_m"],
        &["scale"],
        &["dx_m", "dy_m", "rotation_rad"],
        &["dx_m", "dy_m", "rotation_rad", "scale"],
    ],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let frame = TrackerFrame {
        shift: Vector2::new(setting.number("dx_m"), setting.number("dy_m")),
        rotation: setting.number("rotation_rad"),
        scale: setting.number("scale"),
    };
    let mut found = false;
    for sensor in mechanism.sensors.iter_mut().filter(|sensor| sensor.tracks()) {
        sensor.frames.push(frame);
        found = true;
    }
    if found {
        return Ok(());
    }
    Err(Wrong {
        key: "kind".to_owned(),
        message: "\"tracker-frame\" needs a tracker".to_owned(),
        help: "this machine has no [[sensor]] of quantity x, y or angle".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{SLIDER_CRANK, closed};

    #[test]
    fn the_tracker_shows_a_similar_world() {
        let keys = "dx_m = 0.01\ndy_m = -0.02\nrotation_rad = 0.1\nscale = 1.05\n";
        let effect = format!("[[effect]]\nkind = \"tracker-frame\"\n{keys}");
        let [plain, off] = ["", &effect].map(|effect| closed(&format!("{SLIDER_CRANK}{effect}")));
        let [x, y, angle] = ["x_A", "y_A", "phi_rod"].map(|column| plain.shows(column));
        let (sin, cos) = 0.1f64.sin_cos();
        assert!((off.shows("x_A") - (0.01 + 1.05 * (cos * x - sin * y))).abs() < 1e-12);
        assert!((off.shows("y_A") - (-0.02 + 1.05 * (sin * x + cos * y))).abs() < 1e-12);
        assert!((off.shows("phi_rod") - (angle + 0.1)).abs() < 1e-12);
        assert_eq!(off.shows("q_O"), plain.shows("q_O"));
    }
}
