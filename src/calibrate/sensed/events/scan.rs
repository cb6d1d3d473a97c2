//! Every stretch of time held against the rest of a recording.

use super::series::Series;
use super::spread::{Measured, Ruler, grounds, sizes};
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

/// How the means of stretches scatter in a recording, width by width.
#[derive(Clone, Debug)]
pub struct Rulers {
    sizes: Vec<[f64; 2]>,
    widths: Vec<Ruler>,
}

impl Rulers {
    /// Of a recording's efforts cleared of what lasts.
    pub fn of(series: &Series, cleared: &[Vec<f64>]) -> Self {
        let sizes = sizes(series);
        let grounds = grounds(series, &sizes);
        let block = series.instants(EVENT_BLOCK);
        let ruler = |width| Ruler::of(cleared, &grounds, width, block);
        Self { widths: widths(series).into_iter().map(ruler).collect(), sizes }
    }
}

/// Widths of stretches in instants: each 1.4 times the one before, up to an eighth of the recording.
fn widths(series: &Series) -> Vec<usize> {
    let [shortest, longest] = EVENT_WIDTHS.map(|width| series.instants(width));
    let first = shortest.max(5);
    let next = |width: &usize| Some((*width as f64 * 1.4).ceil() as usize);
    let all = std::iter::successors(Some(first), next);
    all.take_while(|width| *width <= longest && *width * 8 <= series.count()).collect()
}

/// Statistics of all stretches of one width.
struct Level {
    width: usize,
    freedoms: Vec<Measured>,
}

/// Stretches that stand out of efforts cleared of what lasts, the clearest first, apart from each other, and how far
/// the clearest of all others stands out.
pub fn scan(series: &Series, cleared: &[Vec<f64>], rulers: &Rulers) -> (Vec<Peak>, f64) {
    let margin = series.instants(EVENT_MARGIN);
    let grounds = grounds(series, &rulers.sizes);
    let level =
        |ruler: &Ruler| Level { width: ruler.width, freedoms: ruler.measure(cleared, &grounds) };
    let fits = |ruler: &&Ruler| ruler.width * 8 <= series.count();
    let levels: Vec<Level> = rulers.widths.iter().filter(fits).map(level).collect();
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

/// The stretch that stands out most, none that touches the margin of another peak.
fn highest(levels: &[Level], but: &[Peak], margin: usize) -> Option<Peak> {
    let mut best: Option<(f64, usize, usize, usize)> = None;
    for (l, level) in levels.iter().enumerate() {
        let near = |first: &usize| {
            let touches = |peak: &Peak| {
                *first < peak.first + peak.width + margin
                    && peak.first < first + level.width + margin
            };
            but.iter().any(touches)
        };
        for (f, Measured { deviations, usual, .. }) in level.freedoms.iter().enumerate() {
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
        deviations: levels[l].freedoms[freedom].deviations[first],
        score,
        units: levels[l].freedoms.iter().map(|own| own.units[first]).collect(),
    })
}
