//! The pictures of a calibration.

use super::outcome::LegsOutcome;
use super::unnamed_picture;
use crate::calibrate::measured::recording::stem;
use crate::calibrate::sensed::thresholds::ERROR_CORNER;
use crate::calibrate::values::model::{LegsCase, LegsSegment};
use crate::effects::Setting;
use crate::measure::filter::ZeroPhase;
use crate::measure::log::{Channel, Log};
use crate::mechanism::{Command, Commands};
use crate::report::{Curve, Panel, Picture, ReportError, Style, panels_svg};
use crate::results::RunError;

/// Left out at both ends in s, where the low-pass sees beyond the log.
const TRIM: f64 = 0.06;

/// Points of a curve and of a cloud of dots: about one per pixel, and as many as can be told apart.
pub(in crate::calibrate) const POINTS: usize = 800;
const DOTS: usize = 500;

/// Runs that are drawn, the calibration run first: more would hide what matters.
const DRAWN: usize = 3;

/// Bins of a correlation ratio.
const BINS: usize = 8;

/// What the dynamics residual is looked at over, with the label of its axis.
pub const OVER: [(&str, &str); 4] = [
    ("length", "commanded length (m)"),
    ("speed", "commanded speed (m/s)"),
    ("acceleration", "commanded acceleration (m/s²)"),
    ("time", "time (s)"),
];

/// For each actuator and each of [`OVER`], the share of the variance of the dynamics residual that lies
/// between [`BINS`] bins: under the declared and under the calibrated model.
pub type Shares = [[[f64; 2]; 4]; 3];

/// Pictures, and what was found while they were drawn.
#[derive(Debug)]
pub struct Charts {
    /// Forces and pose of each drawn run.
    pub runs: Vec<Picture>,
    /// The residual of the dynamics over what it may depend on.
    pub over: Vec<Picture>,
    /// What that residual depends on.
    pub shares: Shares,
}

impl Charts {
    /// All pictures.
    pub fn pictures(&self) -> impl Iterator<Item = &Picture> {
        self.runs.iter().chain(&self.over)
    }
}

/// Draws all pictures.
pub fn draw(case: &LegsCase, outcome: &LegsOutcome) -> Result<Charts, RunError> {
    let mut runs = Vec::new();
    for (i, run) in case.runs.iter().take(DRAWN).enumerate() {
        let role = if i == 0 { "calibration" } else { "validation" };
        let models = [
            ("declared", &outcome.declared[i], Style::Reference),
            ("calibrated", &outcome.predictions[i], Style::Solid),
        ];
        runs.extend(of_run(&run.log, role, &models)?);
    }
    let (mut over, shares) = dependence(case, outcome)?;
    over.extend(unnamed_picture::pictures(outcome.effects.iter().map(|(effect, _)| effect))?);
    Ok(Charts { runs, over, shares })
}

/// Forces, what they miss, and what the pose misses, of one run under some models.
pub fn of_run(
    log: &Log,
    role: &str,
    models: &[(&str, &Log, Style)],
) -> Result<Vec<Picture>, ReportError> {
    let mut pictures = Vec::new();
    let name = stem(log);
    let present = |channel: &Channel| log.get(*channel).is_some();
    let forces: Vec<Channel> = (0..3).map(Channel::Force).filter(present).collect();
    let others: Vec<Channel> =
        (0..3).map(Channel::Pose).chain((0..3).map(Channel::Length)).filter(present).collect();
    let listed = models.iter().map(|(name, ..)| *name).collect::<Vec<_>>().join(" and ");
    if !forces.is_empty() {
        let panels = forces.iter().map(|&channel| {
            let measured = curve("measured", log, log.get(channel), Style::Solid);
            let models = models
                .iter()
                .filter_map(|(name, model, style)| curve(name, log, model.get(channel), *style));
            panel(
                format!("Actuator force {channel}"),
                "force (N)",
                measured.into_iter().chain(models),
            )
        });
        pictures.push(Picture {
            file: format!("forces-{name}.svg"),
            title: format!("Actuator forces, {} ({role})", log.name),
            caption: format!(
                "Measured and {listed}, through a zero-phase low-pass of {ERROR_CORNER} Hz."
            ),
            svg: panels_svg(&panels.collect::<Vec<_>>())?,
        });
    }
    for (channels, what, file) in
        [(&forces, "Force residual", "residual"), (&others, "Pose and length residual", "pose")]
    {
        if channels.is_empty() {
            continue;
        }
        let panels = channels.iter().map(|&channel| missed(channel, log, models));
        pictures.push(Picture {
            file: format!("{file}-{name}.svg"),
            title: format!("{what}, {} ({role})", log.name),
            caption: format!(
                "What is measured less what the model predicts, {listed}, through the same low-pass."
            ),
            svg: panels_svg(&panels.collect::<Vec<_>>())?,
        });
    }
    Ok(pictures)
}

/// What models miss of a channel, over time.
pub(super) fn missed(channel: Channel, log: &Log, models: &[(&str, &Log, Style)]) -> Panel {
    let (factor, unit) = match channel.unit() {
        "m" => (1e6, "µm"),
        "rad" => (1e3, "mrad"),
        unit => (1.0, unit),
    };
    let curves = models.iter().filter_map(|(name, model, style)| {
        let pairs = log.get(channel)?.iter().zip(model.get(channel)?);
        let missed: Vec<f64> = pairs.map(|(a, b)| factor * (a - b)).collect();
        curve(name, log, Some(&missed), *style)
    });
    panel(format!("{channel}, measured − model"), unit, curves)
}

/// A chart over time.
pub(in crate::calibrate) fn panel(
    title: String,
    y_label: &str,
    curves: impl Iterator<Item = Curve>,
) -> Panel {
    Panel { title, x_label: "time (s)".into(), y_label: y_label.into(), curves: curves.collect() }
}

/// A signal of a log, low-passed and thinned.
fn curve(name: &str, log: &Log, values: Option<&[f64]>, style: Style) -> Option<Curve> {
    let points = thinned(&low_passed(log, values?), POINTS);
    Some(Curve { name: name.to_owned(), points, style })
}

/// A signal over time (s) through the low-pass, without the ends that see beyond the log.
pub(super) fn low_passed(log: &Log, values: &[f64]) -> Vec<(f64, f64)> {
    let filtered = ZeroPhase::butterworth(4, ERROR_CORNER, log.interval).apply(values);
    let trim = (TRIM / log.interval).round() as usize;
    let inner = trim..filtered.len().saturating_sub(trim);
    inner.map(|i| (log.start + i as f64 * log.interval, filtered[i])).collect()
}

/// About so many of the points, evenly: fewer than twice as many.
pub(in crate::calibrate) fn thinned(points: &[(f64, f64)], count: usize) -> Vec<(f64, f64)> {
    points.iter().copied().step_by((points.len() / count).max(1)).collect()
}

/// The residual of the calibration run's dynamics over length, speed and acceleration, actuator by
/// actuator, and the share of its variance that each explains.
fn dependence(
    case: &LegsCase,
    outcome: &LegsOutcome,
) -> Result<(Vec<Picture>, Shares), ReportError> {
    let run = &case.runs[0];
    let rows = run.rows();
    let effects: Vec<Setting> = outcome.effects.iter().map(|(effect, _)| effect.clone()).collect();
    let residuals = [&[][..], &effects].map(|effects| residual(case, effects));
    let mut commands = [Command::default(); 3];
    // Of each actuator, what of `OVER`, row.
    let mut over = [const { [const { Vec::new() }; 4] }; 3];
    for row in rows.step_by(run.lens.stride()) {
        let t = row as f64 * run.log.interval;
        run.commands.at(t, &mut commands);
        for (columns, command) in over.iter_mut().zip(&commands) {
            let values = [command.position, command.rate, command.acceleration, t];
            for (column, value) in columns.iter_mut().zip(values) {
                column.push(value);
            }
        }
    }
    let shares: Shares = std::array::from_fn(|leg| {
        std::array::from_fn(|k| [0, 1].map(|m| share(&over[leg][k], &residuals[m][leg])))
    });
    let mut pictures = Vec::new();
    // Time has a picture already.
    for (k, (what, label)) in OVER.iter().enumerate().take(3) {
        let panels: Vec<Panel> = (0..3)
            .map(|leg| {
                let dots = |name: &str, values: &[f64]| {
                    let stride = (values.len() / DOTS).max(1);
                    let points = over[leg][k].iter().copied().zip(values.iter().copied());
                    Curve {
                        name: name.to_owned(),
                        points: points.step_by(stride).collect(),
                        style: Style::Dots,
                    }
                };
                let curves = ["declared", "calibrated"].iter().zip(&residuals);
                Panel {
                    title: format!("Actuator {}", leg + 1),
                    x_label: (*label).into(),
                    y_label: "force (N)".into(),
                    curves: curves.map(|(name, values)| dots(name, &values[leg])).collect(),
                }
            })
            .collect();
        pictures.push(Picture {
            file: format!("over-{what}.svg"),
            title: format!("Force that is not accounted for, over {what}"),
            caption: format!(
                "Measured actuator force less what inverse dynamics of the measured motion takes, \
                 {}, through the low-pass of {ERROR_CORNER} Hz: a shape is something that the model lacks, a \
                 shapeless band is noise and rattle.",
                run.log.name
            ),
            svg: panels_svg(&panels)?,
        });
    }
    Ok((pictures, shares))
}

/// The dynamics residual of each actuator on the calibration run in N, low-passed.
fn residual(case: &LegsCase, effects: &[Setting]) -> [Vec<f64>; 3] {
    let run = &case.runs[0];
    let segment = LegsSegment { run: 0, rows: run.rows() };
    let interval = run.log.interval * run.lens.stride() as f64;
    let filter = ZeroPhase::butterworth(4, ERROR_CORNER, interval);
    // A model that could be simulated can be looked at.
    case.plain(effects, &segment).map_or_else(
        |_| [const { Vec::new() }; 3],
        |(signals, _)| [6, 7, 8].map(|channel| filter.apply(&signals[channel].values)),
    )
}

/// Correlation ratio η² (Pearson): the share of the variance of `values` between bins of equal numbers
/// of `x`.
fn share(x: &[f64], values: &[f64]) -> f64 {
    let count = values.len().min(x.len());
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| x[*a].total_cmp(&x[*b]));
    let mean = |rows: &[usize]| rows.iter().map(|&i| values[i]).sum::<f64>() / rows.len() as f64;
    let all = mean(&order);
    let total: f64 = order.iter().map(|&i| (values[i] - all).powi(2)).sum();
    let between: f64 = order
        .chunks(count.div_ceil(BINS).max(1))
        .map(|bin| bin.len() as f64 * (mean(bin) - all).powi(2))
        .sum();
    between / total
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_tells_a_function_from_noise() {
        let x: Vec<f64> = (0..4000).map(|i| (f64::from(i) * 0.7).sin()).collect();
        let function: Vec<f64> = x.iter().map(|x| x * x).collect();
        let other: Vec<f64> = (0..4000).map(|i| (f64::from(i) * 0.13).cos()).collect();
        assert!(share(&x, &function) > 0.9, "{}", share(&x, &function));
        assert!(share(&x, &other) < 0.05, "{}", share(&x, &other));
    }
}
