//! The paper's figures 4 to 9, and three before them: what is left of the numbers when the assumptions
//! move.

use super::items::Item;
use super::result::{Paper, VariantResult};
use super::variants::{LARGE, SMALL, machine};
use crate::engine;
use crate::measure::envelope::Envelope;
use crate::report::{Curve, Label, Panel, Picture, ReportError, Style, panels_svg};
use crate::results::RunError;
use crate::scenario::Scenario;
use crate::study::StudyError;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// Stretches that a signal is kept in: about one per pixel of a picture's width.
const STRETCHES: usize = 800;

/// The paper's clearances in m, and what its figures call them.
const SIZES: [(f64, &str); 2] = [(LARGE, "(a) C = 0.5 mm"), (SMALL, "(b) C = 0.00001 mm")];

/// Draws all pictures, in the order of the page: so the paper's have their own numbers there.
pub fn draw(scenario: &Scenario, paper: &Paper) -> Result<Vec<Picture>, StudyError> {
    let mut pictures = bands(paper).map_err(RunError::from)?;
    let traces = SIZES
        .into_par_iter()
        .map(|(clearance, _)| trace(scenario, clearance))
        .collect::<Result<Vec<_>, StudyError>>()?;
    pictures.extend(figures(&traces).map_err(RunError::from)?);
    Ok(pictures)
}

/// A signal over the time in s, with clearance and without.
struct PairedSignal {
    real: Envelope,
    ideal: Envelope,
}

impl PairedSignal {
    fn new() -> Self {
        Self { real: Envelope::new(STRETCHES), ideal: Envelope::new(STRETCHES) }
    }

    fn push(&mut self, t: f64, real: f64, ideal: f64) {
        self.real.push(t, real);
        self.ideal.push(t, ideal);
    }
}

/// One run: x'', y'', φ'' of the platform, then the actuator forces.
fn trace(scenario: &Scenario, clearance: f64) -> Result<Vec<PairedSignal>, StudyError> {
    let mut machine = machine(scenario, clearance, 0, 1)?;
    let (mechanism, ideal) = (&machine.mechanism, &mut machine.ideal);
    let mut signals: Vec<PairedSignal> =
        (0..3 + mechanism.actuators.len()).map(|_| PairedSignal::new()).collect();
    // What a run that breaks down has shown before is drawn.
    let _ = engine::run(mechanism, machine.control, machine.schedule, &mut |instant| {
        let ideal = ideal.at(instant.t);
        let now = instant.evaluation;
        let real = now.accelerations[mechanism.output].iter().chain(&now.drive_forces);
        let ideal =
            ideal.acceleration.iter().chain(ideal.drive_forces).copied().collect::<Vec<_>>();
        for ((signal, real), ideal) in signals.iter_mut().zip(real).zip(ideal) {
            signal.push(instant.t, *real, ideal);
        }
    });
    Ok(signals)
}

/// Figures 4 to 9. `traces` are those of [`SIZES`].
fn figures(traces: &[Vec<PairedSignal>]) -> Result<Vec<Picture>, ReportError> {
    let named = [
        ("Acceleration of the platform along x", "x″ (m/s²)"),
        ("Acceleration of the platform along y", "y″ (m/s²)"),
        ("Angular acceleration of the platform", "φ″ (rad/s²)"),
        ("Force of the first actuator", "F1 (N)"),
        ("Force of the second actuator", "F2 (N)"),
        ("Force of the third actuator", "F3 (N)"),
    ];
    let figure = |(k, (title, label)): (usize, (&str, &str))| {
        let number = k + 4;
        let panel = |(trace, (_, size)): (&Vec<PairedSignal>, (f64, &str))| Panel {
            title: format!("{size}: {}", title.to_lowercase()),
            x_label: "time (s)".into(),
            y_label: label.into(),
            curves: vec![
                curve("with clearance", trace[k].real.points(), Style::Solid),
                curve("without clearance", trace[k].ideal.points(), Style::Reference),
            ],
        };
        let panels: Vec<Panel> = traces.iter().zip(SIZES).map(panel).collect();
        let sizes = if k < 3 {
            "The paper's caption gives no clearance; these are the two it names. "
        } else {
            ""
        };
        Ok(Picture {
            file: format!("figure-{number}.svg"),
            title: format!("{title} (the paper's figure {number})"),
            caption: format!(
                "{sizes}With clearance (blue) and without (dashed), each panel with its own scale. One \
                 of many possible motions: after the first hits only statistics are comparable."
            ),
            svg: panels_svg(&panels)?,
        })
    };
    named.into_iter().enumerate().map(figure).collect()
}

fn curve(name: &str, points: Vec<(f64, f64)>, style: Style) -> Curve {
    Curve { name: name.to_owned(), points, style }
}

/// A panel of a band: title, label of its axis, quantity, and the same of the machine without clearance.
type BandPanel = (&'static str, &'static str, Item, Option<Item>);

/// Pictures of bands: file, title, panels.
const BANDS: [(&str, &str, &[BandPanel]); 3] = [
    (
        "band-accelerations.svg",
        "Accelerations over the clearance",
        &[
            (
                "Platform acceleration, peak",
                "acceleration (m/s²)",
                Item::PeakAcceleration,
                Some(Item::IdealPeakAcceleration),
            ),
            (
                "Platform acceleration, rms deviation from ideal",
                "acceleration (m/s²)",
                Item::AccelerationDeviation,
                None,
            ),
            (
                "Angular acceleration, rms deviation from ideal",
                "alpha (rad/s²)",
                Item::AngularDeviation,
                None,
            ),
        ],
    ),
    (
        "band-forces.svg",
        "Forces over the clearance",
        &[
            (
                "Actuator force, peak",
                "force (N)",
                Item::PeakActuatorForce,
                Some(Item::IdealPeakActuatorForce),
            ),
            (
                "Actuator forces, rms deviation from ideal",
                "force (N)",
                Item::ActuatorDeviation,
                None,
            ),
            ("Contact force, peak", "force (N)", Item::PeakContactForce, None),
        ],
    ),
    (
        "band-contact.svg",
        "Path error and contact over the clearance",
        &[
            ("Path error, rms", "distance (m)", Item::PathError, None),
            ("Share of time in contact", "share", Item::ContactFraction, None),
        ],
    ),
];

/// Quantities over the clearance: the band of all assumptions, and single ones in it.
fn bands(paper: &Paper) -> Result<Vec<Picture>, ReportError> {
    let panel = |(title, y_label, item, ideal): &BandPanel| Panel {
        title: (*title).to_owned(),
        x_label: Label::log("clearance (m)"),
        y_label: Label::log(*y_label),
        curves: band(paper, *item, *ideal),
    };
    let picture = |(file, title, panels): (&str, &str, &[BandPanel])| {
        let panels: Vec<Panel> = panels.iter().map(panel).collect();
        Ok(Picture {
            file: file.into(),
            title: title.into(),
            caption: format!(
                "Means over {} starts. Grey: between the lowest and the highest of all {} sets of \
                 assumptions about what the paper does not give. Dashed, where it is drawn: the \
                 machine without clearance, under the assumed values.",
                paper.phases,
                paper.variants.len()
            ),
            svg: panels_svg(&panels)?,
        })
    };
    BANDS.into_iter().map(picture).collect()
}

/// Variants that are drawn as lines of their own: the scenario as it stands, ADAMS' defaults, and the
/// two that depart most from a circle on a table.
const LINES: [&str; 4] = ["assumed", "adams-damping", "line", "gravity"];

fn band(paper: &Paper, item: Item, ideal: Option<Item>) -> Vec<Curve> {
    let means = |variant: &VariantResult, item: Item| -> Vec<(f64, f64)> {
        let point =
            |(case, c): (&super::CaseResult, &f64)| (c.log10(), case.mean(item).mean.log10());
        variant.cases.iter().zip(&paper.clearances_m).map(point).collect()
    };
    let all: Vec<Vec<(f64, f64)>> = paper.variants.iter().map(|v| means(v, item)).collect();
    let edge = |extreme: fn(f64, f64) -> f64| -> Vec<(f64, f64)> {
        let values = |i: usize| all.iter().map(move |points| points[i].1).filter(|y| y.is_finite());
        let at = |(i, c): (usize, &f64)| (c.log10(), values(i).fold(f64::NAN, extreme));
        paper.clearances_m.iter().enumerate().map(at).collect()
    };
    let around = edge(f64::min).into_iter().chain(edge(f64::max).into_iter().rev()).collect();
    let mut curves = vec![curve("all assumptions", around, Style::Band)];
    for key in LINES {
        let variant = paper.variants.iter().find(|variant| variant.key == key);
        curves.extend(variant.map(|v| curve(short(v.label), means(v, item), Style::Solid)));
    }
    if let (Some(ideal), Some(base)) = (ideal, paper.variants.first()) {
        curves.push(curve("no clearance", means(base, ideal), Style::Reference));
    }
    curves
}

/// A label up to its colon or comma: the legend has no room for the numbers.
fn short(label: &str) -> &str {
    label.split([':', ',']).next().unwrap_or(label)
}
