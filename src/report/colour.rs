//! One colour for one thing, in all pictures: by the name of its curve.

use plotters::style::RGBColor;

pub(super) const INK: RGBColor = RGBColor(0x22, 0x26, 0x2b);
pub(super) const FAINT_INK: RGBColor = RGBColor(0x5f, 0x66, 0x6e);
pub(super) const GRID: RGBColor = RGBColor(0xe4, 0xe7, 0xea);
pub(super) const FRAME: RGBColor = RGBColor(0x9a, 0xa1, 0xa9);
/// Areas between curves: faint enough for the grid and every line to show on it.
pub(super) const BAND: RGBColor = RGBColor(0xd8, 0xdd, 0xe3);

/// What the ideal machine does, and other references. Curves of this colour and of the next are dashed by the style
/// sheet in the picture, because the backend knows no dashed lines.
pub(super) const REFERENCE: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// What a maker declares.
const DECLARED: RGBColor = RGBColor(0x77, 0x7e, 0x86);

/// The colours of Okabe and Ito, which colour-blind readers tell apart, without the yellow that
/// vanishes on white.
pub(super) const PALETTE: [RGBColor; 6] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
];

/// Names of curves, or how they begin, with their colour: the contact law blue, the physics engine's contacts orange,
/// what was measured black, what is declared grey, what is calibrated green.
const ROLES: [(&str, RGBColor); 12] = [
    ("hertz-step", PALETTE[0]),
    ("native", PALETTE[1]),
    ("measured", INK),
    ("declared", DECLARED),
    ("as declared", DECLARED),
    ("without effects", DECLARED),
    ("before", DECLARED),
    ("calibrated", PALETTE[2]),
    ("predicted", PALETTE[2]),
    ("as it is", PALETTE[2]),
    ("after", PALETTE[2]),
    ("ideal", REFERENCE),
];

/// The colour of what has one.
pub(super) fn of(name: &str) -> Option<RGBColor> {
    let is = |role: &str| {
        let rest = name.strip_prefix(role);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', ',']))
    };
    ROLES.iter().find(|(role, _)| is(role)).map(|(_, colour)| *colour)
}

/// A colour as pages write it.
pub(super) fn hex(RGBColor(r, g, b): RGBColor) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// What pictures look like: dashed references, and light on dark where readers ask for that.
pub(super) fn style_sheet() -> String {
    let [reference, declared] = [REFERENCE, DECLARED].map(hex);
    let mut rules = format!(
        ".picture polyline[stroke=\"{reference}\"],.picture polyline[stroke=\"{declared}\"]\
         {{stroke-dasharray:60 40;stroke-linecap:butt}}"
    );
    let dark = [
        (RGBColor(0xff, 0xff, 0xff), "#16191d"),
        (INK, "#e4e7ea"),
        (REFERENCE, "#cfd4d9"),
        (FAINT_INK, "#a2a9b1"),
        (GRID, "#2b3138"),
        (FRAME, "#5d656e"),
        (BAND, "#333a42"),
        (DECLARED, "#9aa1a9"),
        (PALETTE[0], "#4aa3df"),
        (PALETTE[1], "#f0803c"),
        (PALETTE[2], "#2fbf93"),
    ];
    rules += "@media (prefers-color-scheme:dark){";
    for (light, dark) in dark {
        let light = hex(light);
        rules += &format!(
            ".picture [fill=\"{light}\"]{{fill:{dark}}}.picture [stroke=\"{light}\"]{{stroke:{dark}}}"
        );
    }
    rules + "}"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_thing_has_one_colour() {
        assert_eq!(of("hertz-step, step 1e-5 s"), of("hertz-step"));
        assert_eq!(of("calibrated"), of("predicted"));
        assert_ne!(of("measured"), of("declared"));
        assert_eq!(of("measurement"), None);
    }
}
