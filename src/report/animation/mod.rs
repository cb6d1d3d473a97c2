//! A picture that moves by itself: an SVG that plays frames in slow motion, over and over, wherever a
//! picture can stand. The mechanism in the middle, its joints magnified on both sides.

mod elements;

use super::page::escaped;
use super::quantity::number;
use super::scene::Scene;
use crate::measure::frames::{FilmFrame, Frames};
use elements::{SceneFilm, outline, pair, short, unwrapped};
use std::fmt::Write;

/// Seconds on the viewer's clock for each second shown.
const SLOWNESS: f64 = 100.0;
/// Seconds on the viewer's clock in which the mark of a hit fades to a third.
const FADE: f64 = 0.35;

/// Pixels.
const WIDTH: f64 = 900.0;
const COLUMN: f64 = 190.0;
const CELL: f64 = 176.0;
const FOOT: f64 = 44.0;
/// Radius in pixels of a magnified ring, of the journal inside it, and what is left: the clearance.
const RING: f64 = 72.0;
const JOURNAL: f64 = 24.0;
const PLAY: f64 = RING - JOURNAL;

const STYLE: &str = "text{font:600 15px system-ui,sans-serif;fill:#22262b}.s{font-weight:400;font-size:13px;fill:#5f666e}\
    .l{fill:none;stroke:#6d7781;stroke-linecap:round;stroke-linejoin:round}.k{stroke:#c3ccd5}\
    .p{fill:#c3ccd5}.g{opacity:.25}.t{fill:none;stroke:#0072b2;stroke-width:2}\
    .o{fill:none;stroke:#0072b2;stroke-width:1;opacity:.7}.a{fill:#d01c1c;stroke:#d01c1c}\
    .h{stroke:#9aa1a9;stroke-dasharray:3 3}.r{fill:#f4f6f8;stroke:#6d7781;stroke-width:3}\
    .j{fill:#c3ccd5;stroke:#6d7781}.b{fill:#fff;stroke:#22262b;stroke-width:2}";

/// Draws the frames as an SVG that plays them, 100 times slower than they were.
///
/// ```
/// use freeplay::measure::frames::{FilmFrame, Frames};
/// use freeplay::report::{Outline, Scene, SceneBody, animation_svg};
///
/// let bar = Outline { points: vec![[-0.1, 0.0], [0.1, 0.0]], closed: false, width_m: 0.01 };
/// let scene = Scene {
///     title: "A bar that turns".to_owned(),
///     ground: Vec::new(),
///     bodies: vec![SceneBody { name: "bar".to_owned(), outlines: vec![bar] }],
///     joints: Vec::new(),
///     tracked: 0,
///     tracked_point: [0.1, 0.0],
///     charts: Vec::new(),
/// };
/// let mut frames = Frames::new(100);
/// for i in 0..50 {
///     // The body's x, y and angle, then how far the tracked point is from where it should be.
///     frames.push(FilmFrame { t: f64::from(i) / 50.0, values: vec![0.0, 0.0, i as f32 / 10.0, 0.0, 0.0], extremes: vec![] });
/// }
/// assert!(animation_svg(&scene, &frames).contains("A bar that turns"));
/// ```
pub fn animation_svg(scene: &Scene, frames: &Frames) -> String {
    let frames: Vec<&FilmFrame> = frames.all().collect();
    let joints: Vec<usize> =
        (0..scene.joints.len()).filter(|i| scene.joints[*i].clearance_m.is_some()).collect();
    let rows = joints.len().div_ceil(2).max(3) as f64;
    let bottom = rows * CELL;
    let height = bottom + FOOT;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" \
         viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" aria-label=\"{}\">\n<style>{STYLE}</style>\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" rx=\"8\" fill=\"#fff\"/>\n",
        escaped(&scene.title)
    );
    if let (Some(first), Some(last)) = (frames.first(), frames.last())
        && last.t > first.t
    {
        let film = SceneFilm { scene, frames: &frames, seconds: SLOWNESS * (last.t - first.t) };
        let view = PixelView::new(scene, &frames, bottom);
        film.draw(&mut svg, &view, &joints, bottom).expect("writing to a string cannot fail");
    }
    svg + "</svg>\n"
}

/// Metres to pixels.
struct PixelView {
    scale: f64,
    origin: [f64; 2],
}

impl PixelView {
    /// The whole mechanism, at all times, between the columns.
    fn new(scene: &Scene, frames: &[&FilmFrame], bottom: f64) -> Self {
        let mut points: Vec<[f64; 2]> =
            scene.ground.iter().flat_map(|o| &o.points).copied().collect();
        for frame in frames {
            for (i, body) in scene.bodies.iter().enumerate() {
                let outline = body.outlines.iter().flat_map(|o| &o.points);
                points.extend(outline.map(|point| world(frame, Some(i), *point)));
            }
        }
        let range = |k: usize| {
            let values = || points.iter().map(|p| p[k]).filter(|v| v.is_finite());
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
        };
        let [(left, right), (low, high)] = [range(0), range(1)];
        let room = [WIDTH - 2.0 * COLUMN - 40.0, bottom - 60.0];
        let scale = (room[0] / (right - left).max(1e-12)).min(room[1] / (high - low).max(1e-12));
        let middle = [0.5 * (left + right), 0.5 * (low + high)];
        let origin = [0.5 * WIDTH - scale * middle[0], 0.5 * bottom + 10.0 + scale * middle[1]];
        Self { scale, origin }
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + self.scale * x, self.origin[1] - self.scale * y]
    }
}

/// A point of a body, or of the ground, in the world.
fn world(frame: &FilmFrame, body: Option<usize>, [u, v]: [f64; 2]) -> [f64; 2] {
    let Some(i) = body else { return [u, v] };
    let [x, y, angle] = [0, 1, 2].map(|k| f64::from(frame.values[3 * i + k]));
    let (sin, cos) = angle.sin_cos();
    [x + cos * u - sin * v, y + sin * u + cos * v]
}

impl SceneFilm<'_> {
    fn draw(
        &self,
        svg: &mut String,
        view: &PixelView,
        joints: &[usize],
        bottom: f64,
    ) -> Result<(), std::fmt::Error> {
        let scene = self.scene;
        svg.push_str("<g class=\"g\">");
        scene.ground.iter().for_each(|o| outline(svg, o, view.scale, view.origin));
        svg.push_str("</g>\n");
        for (i, body) in scene.bodies.iter().enumerate() {
            svg.push_str("<g>");
            let place = |f: &FilmFrame| pair(view.place(world(f, Some(i), [0.0, 0.0])), 2);
            svg.push_str(&self.turned("translate", "replace", place));
            let angles = unwrapped(self.frames.iter().map(|f| f64::from(f.values[3 * i + 2])));
            let angles: Vec<String> = angles.iter().map(|a| short(-a.to_degrees(), 3)).collect();
            svg.push_str(&self.transform("rotate", "sum", "linear", &angles));
            body.outlines.iter().for_each(|o| outline(svg, o, view.scale, [0.0; 2]));
            svg.push_str("</g>\n");
        }
        let track: Vec<[f64; 2]> = (self.frames.iter())
            .map(|f| view.place(world(f, Some(scene.tracked), scene.tracked_point)))
            .collect();
        self.revealed(svg, "t", &track)?;

        // Left half and right half of the joints, each from the top down: no lines cross.
        let first = self.frames[0];
        let at = |i: usize| world(first, scene.joints[i].body, scene.joints[i].point);
        let mut order = joints.to_vec();
        order.sort_by(|a, b| at(*a)[0].total_cmp(&at(*b)[0]));
        let (left, right) = order.split_at_mut(joints.len().div_ceil(2));
        let strongest = self.frames.iter().flat_map(|f| joints.iter().map(|i| f.extremes[*i][1]));
        let strongest = f64::from(strongest.fold(f32::MIN_POSITIVE, f32::max));
        for (side, x) in [(left, 0.5 * COLUMN), (right, WIDTH - 0.5 * COLUMN)] {
            side.sort_by(|a, b| at(*b)[1].total_cmp(&at(*a)[1]));
            let cell = bottom / side.len().max(1) as f64;
            for (row, i) in side.iter().enumerate() {
                let centre = [x, cell * (row as f64 + 0.5)];
                self.joint(svg, view, *i, centre, strongest)?;
            }
        }
        for joint in &scene.joints {
            let place = |f: &FilmFrame| pair(view.place(world(f, joint.body, joint.point)), 1);
            let radius = (view.scale * joint.radius_m).max(5.0);
            write!(svg, "<circle class=\"b\" r=\"{radius:.1}\">")?;
            svg.push_str(&self.turned("translate", "replace", place));
            svg.push_str("</circle>\n");
        }
        self.foot(svg, bottom, strongest)
    }

    fn foot(&self, svg: &mut String, bottom: f64, strongest: f64) -> std::fmt::Result {
        let span = self.seconds / SLOWNESS;
        let y = bottom + 8.0;
        writeln!(
            svg,
            "<rect x=\"20\" y=\"{y}\" width=\"{0}\" height=\"4\" rx=\"2\" fill=\"#dfe3e7\"/>\
             <rect x=\"20\" y=\"{y}\" width=\"0\" height=\"4\" rx=\"2\" fill=\"#0072b2\"><animate \
             attributeName=\"width\" from=\"0\" to=\"{0}\" dur=\"{1}s\" \
             repeatCount=\"indefinite\"/></rect>\n\
             <text class=\"s\" x=\"20\" y=\"{2}\">{3} ms, slowed down {SLOWNESS} times; longest arrow: \
             {4} N (length by square root)</text>",
            WIDTH - 40.0,
            short(self.seconds, 3),
            y + 24.0,
            number(1e3 * span),
            number(strongest)
        )
    }

    /// One joint: ring, where the journal's centre went, journal, force.
    fn joint(
        &self,
        svg: &mut String,
        view: &PixelView,
        i: usize,
        [x, y]: [f64; 2],
        strongest: f64,
    ) -> std::fmt::Result {
        let joint = &self.scene.joints[i];
        let clearance = joint.clearance_m.unwrap_or(1.0);
        let column = 3 * self.scene.bodies.len() + 2 * i;
        let eccentricity = |f: &FilmFrame| {
            [f.values[column], -f.values[column + 1]].map(|e| PLAY * f64::from(e) / clearance)
        };
        let ends: Vec<[f64; 2]> =
            (self.frames.iter()).map(|f| view.place(world(f, joint.body, joint.point))).collect();
        let edge = x + RING.copysign(0.5 * WIDTH - x);
        write!(svg, "<line class=\"h\" x1=\"{edge}\" y1=\"{y}\">")?;
        for (k, name) in ["x2", "y2"].into_iter().enumerate() {
            let values: Vec<String> = ends.iter().map(|p| short(p[k], 1)).collect();
            svg.push_str(&self.animate(name, "linear", &values));
        }
        writeln!(svg, "</line>")?;
        writeln!(
            svg,
            "<g transform=\"translate({x} {y})\"><circle class=\"r\" r=\"{RING}\"/>\
             <text x=\"{}\" y=\"{}\">{}</text>",
            -RING - 14.0,
            12.0 - RING,
            escaped(&joint.name)
        )?;
        let orbit: Vec<[f64; 2]> = self.frames.iter().map(|f| eccentricity(f)).collect();
        self.revealed(svg, "o", &orbit)?;
        write!(
            svg,
            "<g><circle class=\"j\" r=\"{JOURNAL}\"/><circle r=\"2.5\" fill=\"#0072b2\"/>"
        )?;
        svg.push_str(&self.turned("translate", "replace", |f| pair(eccentricity(f), 1)));
        svg.push_str("</g>\n");

        // An arrow of length 1 from the ring inwards, turned, stretched and faded.
        let marks = self.marks(i, &orbit, strongest);
        let list = |f: &dyn Fn(&HitMark) -> String| marks.iter().map(f).collect::<Vec<_>>();
        svg.push_str("<g class=\"a\">");
        svg.push_str(&self.transform(
            "rotate",
            "replace",
            "discrete",
            &list(&|m| short(m.angle, 1)),
        ));
        svg.push_str(&self.animate("opacity", "linear", &list(&|m| short(m.left, 2))));
        write!(svg, "<g transform=\"translate({RING} 0)\"><g>")?;
        svg.push_str(&self.transform("scale", "replace", "discrete", &list(&|m| short(m.size, 2))));
        writeln!(
            svg,
            "<path stroke=\"none\" d=\"M0-2.5H-48V-9L-66 0L-48 9V2.5H0Z\"/></g></g>\
             <path fill=\"none\" stroke-width=\"5\" d=\"M{0} {1}A{RING} {RING} 0 0 0 {0}-{1}\"/></g></g>",
            short(RING * 0.35f64.cos(), 1),
            short(RING * 0.35f64.sin(), 1),
        )
    }

    /// What the latest hit has left, frame by frame: a stronger one, or a fresher one, takes its place.
    fn marks(&self, joint: usize, orbit: &[[f64; 2]], strongest: f64) -> Vec<HitMark> {
        let mut mark = HitMark::default();
        let mut before = self.frames[0].t;
        let next = |(frame, place): (&&FilmFrame, &[f64; 2])| {
            mark.left *= (-SLOWNESS * (frame.t - before) / FADE).exp();
            before = frame.t;
            let size = (f64::from(frame.extremes[joint][1]) / strongest).max(0.0).sqrt();
            if size > mark.size * mark.left {
                mark = HitMark { angle: place[1].atan2(place[0]).to_degrees(), size, left: 1.0 };
            }
            mark
        };
        self.frames.iter().zip(orbit).map(next).collect()
    }
}

/// What a hit leaves to see.
#[derive(Clone, Copy, Default)]
struct HitMark {
    /// Direction of the contact, in degrees clockwise from +x as the screen has it.
    angle: f64,
    /// Square root of its force, as a share of the strongest's.
    size: f64,
    /// What has not faded, 1 to 0.
    left: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scene::Outline;
    use crate::report::scene::SceneJoint;

    fn scene(name: &str) -> Scene {
        Scene {
            title: name.into(),
            ground: vec![Outline {
                points: vec![[0.0, 0.0], [1.0, 1.0]],
                closed: false,
                width_m: 0.1,
            }],
            bodies: vec![],
            joints: vec![SceneJoint {
                name: name.into(),
                body: None,
                point: [0.5, 0.5],
                radius_m: 0.01,
                clearance_m: Some(1e-3),
            }],
            tracked: 0,
            tracked_point: [0.0, 0.0],
            charts: vec![],
        }
    }

    #[test]
    fn nothing_to_play_is_still_a_picture_and_names_are_no_markup() {
        let svg = animation_svg(&scene("<b>"), &Frames::new(4));
        assert!(svg.starts_with("<svg") && svg.contains("&lt;b&gt;") && !svg.contains("<b>"));
        assert!(!svg.contains("animate"));
    }

    /// The journal's list of places holds its eccentricity, one clearance long: at the ring.
    #[test]
    fn a_journal_at_its_clearance_touches_the_ring() {
        let mut frames = Frames::new(4);
        let mut scene = scene("A");
        scene.bodies.push(crate::report::scene::SceneBody { name: "rod".into(), outlines: vec![] });
        for (t, e) in [(0.0, [0.0, 0.0]), (0.01, [1e-3, 0.0]), (0.02, [0.0, 1e-3])] {
            let values = vec![0.1, 0.2, 0.3, e[0], e[1], 0.0, 0.0];
            frames.push(FilmFrame { t, values, extremes: vec![[0.0, 4.0]] });
        }
        let svg = animation_svg(&scene, &frames);
        assert!(svg.contains("values=\"0 0;48 0;0 -48\""), "{svg}");
        assert!(svg.contains("dur=\"2s\"") && !svg.contains("NaN"));
    }
}
