//! The elements of a picture that moves: curves, attributes and transforms that take a value at each
//! frame.

use crate::measure::frames::FilmFrame;
use crate::report::scene::{Outline, Scene};
use std::f64::consts::TAU;
use std::fmt::Write;

/// Frames of a scene to be played.
pub(super) struct SceneFilm<'a> {
    pub scene: &'a Scene,
    pub frames: &'a [&'a FilmFrame],
    /// Length on the viewer's clock.
    pub seconds: f64,
}

impl SceneFilm<'_> {
    /// A curve that appears as time goes by.
    pub fn revealed(&self, svg: &mut String, class: &str, points: &[[f64; 2]]) -> std::fmt::Result {
        let mut lengths = vec![0.0];
        for pair in points.windows(2) {
            let step = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
            lengths.push(lengths[lengths.len() - 1] + step);
        }
        let whole = lengths[lengths.len() - 1].max(1e-9);
        let offsets: Vec<String> = lengths.iter().map(|l| short(whole - l, 1)).collect();
        let corners: Vec<String> = points.iter().map(|p| pair(*p, 1)).collect();
        write!(
            svg,
            "<polyline class=\"{class}\" stroke-dasharray=\"{whole:.1}\" points=\"{}\">",
            corners.join(" ")
        )?;
        svg.push_str(&self.animate("stroke-dashoffset", "linear", &offsets));
        writeln!(svg, "</polyline>")
    }

    /// An attribute that takes a value at each frame.
    pub fn animate(&self, name: &str, mode: &str, values: &[String]) -> String {
        self.element("animate", &format!("attributeName=\"{name}\""), mode, values)
    }

    /// A transform that takes a value at each frame, straight from one to the next.
    pub fn turned(
        &self,
        kind: &str,
        additive: &str,
        value: impl Fn(&FilmFrame) -> String,
    ) -> String {
        let values: Vec<String> = self.frames.iter().map(|f| value(f)).collect();
        self.transform(kind, additive, "linear", &values)
    }

    /// A transform that takes these values, frame by frame.
    pub fn transform(&self, kind: &str, additive: &str, mode: &str, values: &[String]) -> String {
        let what = format!("attributeName=\"transform\" type=\"{kind}\" additive=\"{additive}\"");
        self.element("animateTransform", &what, mode, values)
    }

    fn element(&self, tag: &str, what: &str, mode: &str, values: &[String]) -> String {
        // A thing at rest needs no list.
        let rest = values.iter().all(|value| *value == values[0]);
        let values = if rest { values[0].clone() } else { values.join(";") };
        format!(
            "<{tag} {what} calcMode=\"{mode}\" dur=\"{}s\" repeatCount=\"indefinite\" \
             values=\"{values}\"/>",
            short(self.seconds, 3)
        )
    }
}

/// An outline, in so many pixels a metre, at a place in pixels.
pub(super) fn outline(svg: &mut String, outline: &Outline, scale: f64, [x, y]: [f64; 2]) {
    let corners: Vec<String> =
        outline.points.iter().map(|p| pair([x + scale * p[0], y - scale * p[1]], 1)).collect();
    let corners = corners.join(" ");
    let width = (scale * outline.width_m).max(1.5);
    // Writing to a string cannot fail.
    let _ = if outline.closed {
        write!(svg, "<polygon class=\"l p\" stroke-width=\"{width:.1}\" points=\"{corners}\"/>")
    } else {
        write!(
            svg,
            "<polyline class=\"l\" stroke-width=\"{width:.1}\" points=\"{corners}\"/>\
             <polyline class=\"l k\" stroke-width=\"{:.1}\" points=\"{corners}\"/>",
            width - 2.0
        )
    };
}

/// Angles without jumps of a whole turn.
pub(super) fn unwrapped(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut before = 0.0;
    let next = |angle: f64| {
        before = angle + TAU * ((before - angle) / TAU).round();
        before
    };
    angles.map(next).collect()
}

/// Two numbers side by side.
pub(super) fn pair([x, y]: [f64; 2], digits: usize) -> String {
    format!("{} {}", short(x, digits), short(y, digits))
}

/// A number with at most so many decimals.
pub(super) fn short(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_go_on_beyond_half_a_turn() {
        let angles = unwrapped([3.0, -3.0, 3.0].into_iter());
        assert_eq!(angles, [3.0, TAU - 3.0, 3.0]);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([short(-0.001, 1), short(10.0, 0), short(1.5, 3)], ["0", "10", "1.5"]);
    }
}
