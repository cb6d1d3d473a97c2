//! Pictures of a recording beside what models predict.

use crate::calibrate::results::charts::{POINTS, panel, thinned};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::mechanism::Mechanism;
use crate::report::{Curve, Picture, ReportError, Style, panels_svg};

/// Which run is drawn, and what is said of it.
#[derive(Clone, Copy, Debug)]
pub struct DrawnRun {
    /// Its place among the runs, from 0 on.
    pub index: usize,
    /// What it serves for.
    pub role: &'static str,
    /// What the models are.
    pub caption: &'static str,
}

/// Each measured column of a run as it was recorded and as models, by name, predict it, and what they miss.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn of_run(
    machine: &Mechanism,
    recording: &Recording,
    drawn: DrawnRun,
    models: &[(&str, Style, &Recording)],
) -> Result<Vec<Picture>, ReportError> {
    let curve = |name: &str, values: &[f64], style| {
        let at = |(row, value): (usize, &f64)| {
            (recording.start + row as f64 * recording.interval, *value)
        };
        let points: Vec<(f64, f64)> = values.iter().enumerate().map(at).collect();
        Curve { name: name.to_owned(), points: thinned(&points, POINTS), style }
    };
    let (mut signals, mut missed) = (Vec::new(), Vec::new());
    for (i, sensor) in machine.sensors.iter().enumerate() {
        let measured = recording.get(i).filter(|_| !sensor.tells());
        let Some(measured) = measured else { continue };
        let unit = sensor.unit(machine);
        let predicted =
            || models.iter().filter_map(|(name, style, of)| Some((*name, *style, of.get(i)?)));
        let whole = predicted().map(|(name, style, values)| curve(name, values, style));
        let whole = std::iter::once(curve("measured", measured, Style::Solid)).chain(whole);
        signals.push(panel(sensor.column.clone(), unit, whole));
        let less = predicted().map(|(name, style, values)| {
            let less: Vec<f64> = measured.iter().zip(values).map(|(a, b)| a - b).collect();
            curve(name, &less, style)
        });
        missed.push(panel(format!("{}, measured − model", sensor.column), unit, less));
    }
    let kinds =
        [(&signals, "Measured and predicted", "signals"), (&missed, "What is missed", "missed")];
    kinds
        .into_iter()
        .map(|(panels, what, file)| {
            Ok(Picture {
                file: format!("{file}-{}.svg", drawn.index + 1),
                title: format!("{what}, {} ({})", recording.name, drawn.role),
                caption: drawn.caption.to_owned(),
                svg: panels_svg(panels)?,
            })
        })
        .collect()
}
