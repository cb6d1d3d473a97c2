//! Every stretch of time held against the rest of a recording.

use super::series::{Series, median};
use super::spread::{apart, grounds, scaled};
use crate::calibrate::sensed::thresholds::{
    EVENT_BLOCK, EVENT_MARGIN, EVENT_RATIO, EVENT_SCORE, EVENT_WIDTHS, EVENTS,
};

/// A stretch that stands out.
#[derive(Clone, Debug)]
pub struct Peak {
    /// Place of the freedom among those of the series.
    pub freedom: usize,
    /// Its first instant, and how many there are.
    pub first: usize,
    /// See there.
    pub width: usize,
    /// Its mean in deviations of such means, of the part that belongs to that freedom alone.
    pub deviations: f64,
    /// The same by how far such means go now and then: see [`EVENT_SCORE`].
    pub score: f64,
    /// Means of all freedoms there in their deviations.
    pub units: Vec<f64>,
}

/// Statistics of all stretches of one width.
struct Level {
    width: usize,
    /// By freedom: deviations, what is usual of them, and plain deviations.
    freedoms: Vec<(Vec<f64>, f64, Vec<f64>)>,
}

/// Stretches that stand out of efforts cleared of what lasts, the clearest first, apart from each other, and how far
/// the clearest of all others stands out.
pub fn scan(series: &Series, cleared: &[Vec<f64>]) -> (Vec<Peak>, f64) {
    let margin = series.instants(EVENT_MARGIN);
    let levels = levels(series, cleared);
    let mut peaks: Vec<Peak> = Vec::new();
    let mut next = highest(&levels, &peaks, margin);
    while let Some(peak) = next.filter(|_| peaks.len() <= EVENTS) {
        peaks.push(peak);
        next = highest(&levels, &peaks, margin);
    }
    // The last one that is clear of what comes after it, and all before.
    let clear = |k: &usize| {
        let after = peaks.get(k + 1).map_or(0.0, |peak| peak.score);
        peaks[*k].score >= EVENT_SCORE && peaks[*k].score >= EVENT_RATIO * after
    };
    let count = (0..peaks.len().min(EVENTS)).rev().find(clear).map_or(0, |k| k + 1);
    let others = peaks.get(count).map_or(0.0, |peak| peak.score);
    peaks.truncate(count);
    (peaks, others)
}

fn levels(series: &Series, cleared: &[Vec<f64>]) -> Vec<Level> {
    let grounds = grounds(series);
    let [shortest, longest] = EVENT_WIDTHS.map(|width| series.instants(width));
    let longest = longest.min(series.count() / 8);
    let mut widths = vec![shortest.max(5)];
    while let Some(next) = widths.last().map(|w| (*w as f64 * 1.4).ceil() as usize)
        && next <= longest
    {
        widths.push(next);
    }
    let level = |width: usize| {
        let units: Vec<Vec<f64>> =
            cleared.iter().map(|own| scaled(own, &grounds, width)).collect();
        let block = series.instants(EVENT_BLOCK).max(width);
        let usual = |deviations: &[f64]| {
            let largest = |part: &[f64]| part.iter().fold(0.0f64, |max, v| max.max(v.abs()));
            median(deviations.chunks_exact(block).map(largest).collect()).max(2.0)
        };
        let own = |(apart, units): (Vec<f64>, Vec<f64>)| (usual(&apart), apart, units);
        let freedoms = apart(&units).into_iter().zip(units).map(own);
        let freedoms = freedoms.map(|(usual, apart, units)| (apart, usual, units)).collect();
        Level { width, freedoms }
    };
    widths.into_iter().filter(|width| *width * 8 <= series.count()).map(level).collect()
}

/// The stretch that stands out most, none that touches the margin of another peak.
fn highest(levels: &[Level], but: &[Peak], margin: usize) -> Option<Peak> {
    let mut best: Option<(f64, usize, usize, usize)> = None;
    for (l, level) in levels.iter().enumerate() {
        let near = |first: &usize| {
            let touches = |peak: &Peak| {
                *first < peak.first + peak.width + margin && peak.first < first + level.width + margin
            };
            but.iter().any(touches)
        };
        for (f, (deviations, usual, _)) in level.freedoms.iter().enumerate() {
            for (first, value) in deviations.iter().enumerate() {
                let score = value.abs() / usual;
                if best.is_none_or(|(most, ..)| score > most) && !near(&first) {
                    best = Some((score, l, f, first));
                }
            }
        }
    }
    best.map(|(score, l, freedom, first)| Peak {
        freedom,
        first,
        width: levels[l].width,
        deviations: levels[l].freedoms[freedom].0[first],
        score,
        units: levels[l].freedoms.iter().map(|(_, _, units)| units[first]).collect(),
    })
}
