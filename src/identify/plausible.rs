//! Whether a recording can be in the units that it is said to be in.

use crate::measure::log::{Channel, Log, LogError, Source};

/// Factors by which units are mistaken: milli, centi, inches, degrees.
pub const FACTORS: [f64; 8] = [
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
pub const TOLERATED: f64 = 0.15;

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
    Err(LogError { place: log.name.clone(), message, help })
}
