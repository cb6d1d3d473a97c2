//! Pictures and one HTML page from plain data.
//!
//! Nothing here knows what a mechanism is: the caller names the curves, writes units into the labels
//! and chooses what to show. All pictures are SVG texts with one shared look; values that are not
//! finite numbers are left out of them and break lines, and data that leave nothing to draw give a picture that says
//! "no data".

mod animation;
mod axis;
mod canvas;
mod chart;
mod colour;
mod label;
mod orbits;
mod page;
mod path;
mod player;
mod quantity;
mod readout;
mod scene;

pub use animation::animation_svg;
pub use chart::panels_svg;
pub use label::Label;
pub use orbits::orbits_svg;
pub use page::{PagePart, PageTable, document, page};
pub use path::path_svg;
pub use player::player_html;
pub use quantity::{known_to, length, number};
pub use scene::{Outline, Scene, SceneBody, SceneChart, SceneCurve, SceneJoint};

/// How a curve is drawn.
///
/// [`panels_svg`] has an example.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// A coloured line; each solid curve of a panel has its own colour.
    Solid,
    /// A dot for each point, each such curve of a panel in its own colour.
    Dots,
    /// The area inside the points, faint and below all lines: between what and what curves lie.
    Band,
    /// A thin dark dashed line on top of the others: what the ideal machine does.
    Reference,
}

/// A line in a chart.
///
/// [`panels_svg`] has an example.
#[derive(Debug, Clone)]
pub struct Curve {
    /// What the legend calls it.
    pub name: String,
    /// (x, y) in the units of the chart's axes, in drawing order.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub style: Style,
}

/// One chart in a stack of charts.
///
/// [`panels_svg`] has an example.
#[derive(Debug, Clone)]
pub struct Panel {
    /// Heading above the chart.
    pub title: String,
    /// Quantity and unit of the horizontal axis, e.g. `time (s)`.
    pub x_label: Label,
    /// Quantity and unit of the vertical axis, e.g. `force (N)`.
    pub y_label: Label,
    /// The lines, in the order of the legend.
    pub curves: Vec<Curve>,
}

/// Where a journal went inside its bearing.
///
/// [`orbits_svg`] has an example.
#[derive(Debug, Clone)]
pub struct Orbit {
    /// Name of the joint.
    pub joint: String,
    /// Radial clearance in metres: how far the journal's centre can go before it touches the ring.
    pub clearance_m: f64,
    /// Journal centre relative to the bearing centre, [x, y] in metres, in order of time.
    pub points: Vec<[f64; 2]>,
}

/// A finished picture for the page.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Name of the file it is also stored in, e.g. `path.svg`.
    pub file: String,
    /// Heading on the page and in its table of contents.
    pub title: String,
    /// What the reader sees in it.
    pub caption: String,
    /// The picture itself, as made by [`panels_svg`], [`path_svg`] or [`orbits_svg`]; it goes into the
    /// page as it is.
    pub svg: String,
}

/// A line in the page's table of results.
///
/// [`page`](page()) has an example.
#[derive(Debug, Clone)]
pub struct Fact {
    /// What was measured.
    pub label: String,
    /// The value with its unit.
    pub value: String,
    /// A remark, or nothing.
    pub note: String,
}

/// A picture could not be drawn: the drawing library refused. No data lead here.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw the picture")]
pub struct ReportError {
    #[from]
    source: canvas::DrawError,
}
