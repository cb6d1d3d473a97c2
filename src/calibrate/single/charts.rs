//! The pictures of a drive stage along a recording: each channel as it was measured and as it is
//! predicted, and what the models miss below it.

use crate::calibrate::charts::{CORNER, POINTS, low_passed, missed, panel, thinned};
use crate::calibrate::recording::stem;
use crate::measure::log::{Channel, Log};
use crate::report::{Curve, Panel, Picture, ReportError, Style, panels_svg};
use std::ops::RangeInclusive;

/// A channel as it is drawn.
struct Drawn {
    channel: Channel,
    /// What it is: its axis and its file are called so.
    quantity: &'static str,
    /// Heading of its picture.
    title: &'static str,
    /// The unit it is drawn in, and how many of it are one SI unit.
    unit: (&'static str, f64),
    /// What the heading leaves open.
    about: &'static str,
}

const POSITION: Drawn = Drawn {
    channel: Channel::Length(0),
    quantity: "position",
    title: "Position of the stage",
    unit: ("mm", 1e3),
    about: "",
};

const FORCE: Drawn = Drawn {
    channel: Channel::Force(0),
    quantity: "force",
    title: "Drive force",
    unit: ("N", 1.0),
    about: " Of a sampled drive it is the force that its controller asks for.",
};

/// Length in s of the closer look, at signals that are longer than some of them: over tens of seconds two
/// signals lie on each other that are far apart for what is read here.
const CLOSER: f64 = 2.5;
const LONG: f64 = 4.0 * CLOSER;

/// Dots of a measured signal in the closer look.
const CLOSE_DOTS: usize = 150;

/// Share of a signal's range that has to be missed to be seen beside it: two pixels of a chart.
const SEEN: f64 = 0.01;

/// Residuals below this share of another model's are drawn by themselves too.
const LOST: f64 = 0.2;

/// A model by its name, and its simulation of a recording.
pub(super) type Simulated<'a> = (&'a str, &'a Log);

/// Every channel of a recording under a model, beside what an earlier model misses. What was not measured
/// is drawn as it is predicted.
///
/// # Errors
/// If the drawing library refuses.
pub(super) fn of_run(
    log: &Log,
    role: &str,
    before: Option<Simulated>,
    after: Simulated,
) -> Result<Vec<Picture>, ReportError> {
    [FORCE, POSITION].iter().map(|what| picture(what, log, role, before, after)).collect()
}

fn picture(
    what: &Drawn,
    log: &Log,
    role: &str,
    before: Option<Simulated>,
    after: Simulated,
) -> Result<Picture, ReportError> {
    let predicted = after.0;
    let mut panels = vec![signals(what, log, after, None)];
    let mut caption = if log.get(what.channel).is_none() {
        format!("Not measured: {predicted}")
    } else {
        if let Some(stretch) = worst_stretch(what.channel, log, after.1) {
            panels.push(signals(what, log, after, Some(stretch)));
        }
        let alone = residuals(what, log, None, after);
        if before.is_some() {
            let both = residuals(what, log, before, after);
            let lost = size(&alone) < LOST * size(&both);
            panels.push(both);
            panels.extend(lost.then_some(alone));
        } else {
            panels.push(alone);
        }
        format!("Measured (dots) and {predicted}, and what is missed")
    };
    caption += &format!(", through a zero-phase low-pass of {CORNER} Hz.{}", what.about);
    Ok(Picture {
        file: format!("{}-{}.svg", what.quantity, stem(log)),
        title: format!("{}, {} ({role})", what.title, log.name),
        caption,
        svg: panels_svg(&panels)?,
    })
}

/// What models miss of a channel.
fn residuals(what: &Drawn, log: &Log, before: Option<Simulated>, after: Simulated) -> Panel {
    let subtracted = if before.is_some() { "model" } else { after.0 };
    let before = before.map(|(name, model)| (name, model, Style::Reference));
    let models: Vec<_> = before.into_iter().chain([(after.0, after.1, Style::Solid)]).collect();
    let panel = missed(what.channel, log, &models);
    let y_label = format!("{} ({})", what.quantity, panel.y_label);
    Panel { title: format!("Measured − {subtracted}"), y_label, ..panel }
}

/// The channel as it is predicted, and as it was measured if it was; all of it, or a stretch in s.
fn signals(
    what: &Drawn,
    log: &Log,
    (name, model): Simulated,
    stretch: Option<RangeInclusive<f64>>,
) -> Panel {
    let (unit, factor) = what.unit;
    let inside = |t: f64| stretch.as_ref().is_none_or(|stretch| stretch.contains(&t));
    let curve = |name: &str, of: &Log, style, count| {
        let points: Vec<(f64, f64)> = low_passed(log, of.get(what.channel)?)
            .into_iter()
            .filter(|(t, _)| inside(*t))
            .map(|(t, value)| (t, factor * value))
            .collect();
        Some(Curve { name: name.to_owned(), points: thinned(&points, count), style })
    };
    let predicted = curve(name, model, Style::Solid, POINTS);
    let dots = if stretch.is_some() { CLOSE_DOTS } else { POINTS };
    // After what is predicted, which has the colour then that it has among the residuals.
    let measured = curve("measured", log, Style::Dots, dots);
    let title = match stretch {
        Some(_) => format!("{}, {CLOSER} s where it is missed most", what.title),
        None => what.title.to_owned(),
    };
    panel(title, &format!("{} ({unit})", what.quantity), predicted.into_iter().chain(measured))
}

/// Where in a long recording a model misses most, if that can be seen beside the signal: the
/// stretch of the closer look.
fn worst_stretch(channel: Channel, log: &Log, model: &Log) -> Option<RangeInclusive<f64>> {
    if log.duration() < LONG {
        return None;
    }
    let measured = log.get(channel)?;
    let off: Vec<f64> = measured.iter().zip(model.get(channel)?).map(|(a, b)| a - b).collect();
    let off = low_passed(log, &off).into_iter().map(|(t, off)| (t, off.abs()));
    let (worst, most) = off.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let end = log.start + log.duration();
    let from = (worst - CLOSER / 2.0).min(end - CLOSER).max(log.start);
    let stretch = from..=from + CLOSER;
    let there = low_passed(log, measured).into_iter().filter(|(t, _)| stretch.contains(t));
    let [low, high] = there.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, value)| {
        [low.min(value), high.max(value)]
    });
    (most > SEEN * (high - low)).then_some(stretch)
}

/// The largest value in a chart.
fn size(panel: &Panel) -> f64 {
    let points = panel.curves.iter().flat_map(|curve| &curve.points);
    points.map(|(_, value)| value.abs()).fold(0.0, f64::max)
}
