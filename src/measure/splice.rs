//! Whether samples can be those of one run of a machine.

use super::log::LogError;

/// How much a column's second difference may exceed what it hardly ever exceeds (its 99.9 % quantile).
/// Recorded drives and pendulums stay below 5, resolution and noise included; two runs that were put
/// together are beyond 100.
const JUMP: f64 = 20.0;

/// Samples of a position, and what messages call them.
#[derive(Clone, Copy, Debug)]
pub struct PositionSamples<'a> {
    /// The file.
    pub place: &'a str,
    /// Its column.
    pub column: &'a str,
    /// Unit of the samples.
    pub unit: &'a str,
    /// Time of the first sample and between two samples, in s.
    pub start: f64,
    /// See `start`.
    pub interval: f64,
    /// The samples, one for each row below the header.
    pub values: &'a [f64],
}

/// Looks for a place where a position leaves its place or its speed at once, as no machine can: a
/// recording spliced from two runs.
///
/// # Errors
/// The first such place.
pub fn one_run(samples: PositionSamples) -> Result<(), LogError> {
    let PositionSamples { place, column, unit, start, interval, values } = samples;
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
    let t = start + (at + 1) as f64 * interval;
    let acceleration = bends[at] / (interval * interval);
    let message = format!(
        "column `{column}` goes from {before:.6} to {after:.6} {unit} after t = {t:.4} s, an acceleration of \
         {acceleration:.0} {unit}/s² where {:.1} is rarely exceeded: two runs put together?",
        usual / (interval * interval)
    );
    let help = "cut the file there, and use the parts one by one".to_owned();
    // The header is line 1.
    Err(LogError { place: format!("{place}:{}", at + 4), message, help })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splices_in_place_and_in_speed_are_found_where_they_are() {
        let smooth = |i: i32| 0.1 * (5e-3 * f64::from(i)).sin();
        let check = |values: Vec<f64>| {
            let (start, interval) = (0.0, 1e-3);
            let values = &values;
            one_run(PositionSamples {
                place: "a.csv",
                column: "q_m",
                unit: "m",
                start,
                interval,
                values,
            })
        };
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
