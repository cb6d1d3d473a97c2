//! Whether a recording can be what it is said to be: one run of this machine, in these units.

use crate::measure::log::{Channel, Log, LogError, Source};

/// How much a column's second difference may exceed what it hardly ever exceeds (its 99.9 % quantile).
/// Recorded drives and pendulums stay below 5, resolution and noise included; two runs that were put
/// together are beyond 100.
const JUMP: f64 = 20.0;

/// Factors by which units are mistaken: milli, centi, inches, degrees.
const FACTORS: [f64; 8] = [
    1e3,
    1e-3,
    1e2,
    1e-2,
    0.0254,
    1.0 / 0.0254,
    std::f64::consts::PI / 180.0,
    180.0 / std::f64::consts::PI,
];

/// Disagreement, as a share, that a wrong unit is beyond and measured machines are below.
const TOLERATED: f64 = 0.15;

fn wrong(log: &Log, line: Option<usize>, message: String, help: String) -> LogError {
    // The header is line 1.
    let place = line.map_or(log.name.clone(), |row| format!("{}:{}", log.name, row + 2));
    LogError { place, message, help }
}

/// Looks for a place where a position leaves its place or its speed at once, as no machine can: a
/// recording spliced from two runs.
///
/// # Errors
/// The first such place.
pub fn one_run(log: &Log, channel: Channel, source: &Source) -> Result<(), LogError> {
    let values = log.get(channel).unwrap_or_default();
    let bend = |i: usize| (values[i + 1] - 2.0 * values[i] + values[i - 1]).abs();
    let bends: Vec<f64> = (1..values.len().saturating_sub(1)).map(bend).collect();
    let mut sorted = bends.clone();
    sorted.sort_by(f64::total_cmp);
    let Some(usual) = sorted.get(sorted.len() * 999 / 1000) else { return Ok(()) };
    // A bend of one step of the encoder is none.
    let smallest = sorted.iter().copied().find(|bend| *bend > 0.0).unwrap_or(0.0);
    let Some(at) = bends.iter().position(|bend| *bend > JUMP * usual.max(smallest)) else {
        return Ok(());
    };
    let (before, after) = (values[at + 1], values[at + 2]);
    let t = log.start + (at + 1) as f64 * log.interval;
    let unit = channel.unit();
    let acceleration = bends[at] / (log.interval * log.interval);
    let message = format!(
        "column `{}` goes from {before:.6} to {after:.6} {unit} after t = {t:.4} s, an acceleration of \
         {acceleration:.0} {unit}/s² where {:.1} is rarely exceeded: two runs put together?",
        source.column,
        usual / (log.interval * log.interval)
    );
    let help = "cut the file there, and use the parts one by one".to_owned();
    Err(wrong(log, Some(at + 2), message, help))
}

/// Says which column has a wrong scale. `disagreement` compares the log, with the given channels
/// multiplied by a factor, with the machine's own law, as a share; `suspects` are the channels that could
/// be wrong, by themselves or together.
///
/// # Errors
/// What disagrees, and the scale at which it would not.
pub fn scale(
    log: &Log,
    law: &str,
    sources: &[(Channel, Source)],
    suspects: &[&[Channel]],
    disagreement: impl Fn(&[Channel], f64) -> f64,
) -> Result<(), LogError> {
    let now = disagreement(&[], 1.0);
    if now <= TOLERATED {
        return Ok(());
    }
    let tried = suspects.iter().flat_map(|channels| FACTORS.map(|factor| (*channels, factor)));
    let best = tried
        .map(|(channels, factor)| (disagreement(channels, factor), channels, factor))
        .filter(|(left, ..)| *left <= TOLERATED)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let message = format!("{law}: the recording is off by {:.0} %", 100.0 * now);
    let help = match best {
        Some((_, channels, factor)) => {
            let scales: Vec<String> = sources
                .iter()
                .filter(|(channel, _)| channels.contains(channel))
                .map(|(channel, source)| {
                    format!(
                        "columns.{channel} = {{ column = \"{}\", scale = {} }}",
                        source.column,
                        source.scale * factor
                    )
                })
                .collect();
            format!("it would fit with {}", scales.join(" and "))
        }
        None => {
            "look at columns and their scales, and at what is declared of the machine".to_owned()
        }
    };
    Err(wrong(log, None, message, help))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(values: Vec<f64>) -> Log {
        Log::new("a.csv", 0.0, 1e-3, vec![(Channel::Length(0), values)])
    }

    #[test]
    fn splices_in_place_and_in_speed_are_found_where_they_are() {
        let smooth = |i: i32| 0.1 * (5e-3 * f64::from(i)).sin();
        let source = Source::new("q_m", 1.0);
        let check = |values| one_run(&log(values), Channel::Length(0), &source);
        assert_eq!(check((0..4000).map(smooth).collect()), Ok(()));
        let rounded = |i: i32| (smooth(i) / 5e-8).round() * 5e-8;
        assert_eq!(check((0..4000).map(rounded).collect()), Ok(()));
        for (splice, line) in [
            (
                Box::new(|i: i32| if i < 2000 { smooth(i) } else { smooth(i + 300) })
                    as Box<dyn Fn(i32) -> f64>,
                2001,
            ),
            (
                Box::new(|i: i32| {
                    if i < 2000 {
                        smooth(i)
                    } else {
                        2.0 * smooth(2000) - smooth(4000 - i) + 1e-4 * f64::from(i - 2000)
                    }
                }),
                2001,
            ),
        ] {
            let error = check((0..4000).map(splice).collect()).expect_err("spliced");
            let found: i32 = error.place.rsplit(':').next().unwrap().parse().unwrap();
            assert!((found - line).abs() <= 2, "{error}");
        }
    }
}
