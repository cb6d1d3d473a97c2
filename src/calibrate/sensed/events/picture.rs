//! Pictures of events.

use super::found::Event;
use crate::calibrate::results::charts::{POINTS, panel, thinned};
use crate::report::{Curve, Picture, ReportError, Style, panels_svg};

/// For each event the effort at its joint that the model does not know of, over the whole recording, and the part
/// that is the event.
pub fn pictures(events: &[Event]) -> Result<Vec<Picture>, ReportError> {
    let picture = |(index, event): (usize, &Event)| {
        let history = &event.history;
        let curve = |name: &str, points: &[(f64, f64)], style| Curve {
            name: name.to_owned(),
            points: thinned(points, POINTS),
            style,
        };
        let own: Vec<(f64, f64)> = event
            .course
            .iter()
            .filter(|(t, _)| (history.at_s..=history.until_s).contains(t))
            .copied()
            .collect();
        let curves = [
            curve("not in the model", &event.course, Style::Reference),
            curve("the event", &own, Style::Solid),
        ];
        let title = format!("effort at {}", history.joint);
        let unit = if event.turns { "N·m" } else { "N" };
        Ok(Picture {
            file: format!("event-{}.svg", index + 1),
            title: format!("What does not last: {}", event.words()),
            caption: "Effort that the recorded motion takes beside what the model knows of, below 40 Hz, without what \
                      recurs with the motion."
                .to_owned(),
            svg: panels_svg(&[panel(title, unit, curves.into_iter())])?,
        })
    };
    events.iter().enumerate().map(picture).collect()
}
