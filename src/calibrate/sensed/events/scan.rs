//! Every stretch of time held against the rest of a recording.

use super::lasting::rests;
use super::series::{FreedomSeries, means};
use super::spread::{MeasuredFreedom, Ruler, grounds, sizes};
use crate::calibrate::sensed::thresholds::{
    EVENT_BLOCK, EVENT_CORNER, EVENT_MARGIN, EVENT_RATIO, EVENT_SCORE, EVENT_STAYS, EVENT_WIDTHS,
    EVENTS,
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
    pub fn of(series: &FreedomSeries, cleared: &[Vec<f64>]) -> Self {
        let sizes = sizes(series);
        let grounds = grounds(series, &sizes);
        let block = series.instants(EVENT_BLOCK);
        let ruler = |width| Ruler::of(cleared, &grounds, width, block);
        Self { widths: widths(series).into_iter().map(ruler).collect(), sizes }
    }
}

/// Widths of stretches in instants: each 1.4 times the one before, up to an eighth of the recording.
fn widths(series: &FreedomSeries) -> Vec<usize> {
    let [shortest, longest] = EVENT_WIDTHS.map(|width| series.instants(width));
    let first = shortest.max(5);
    let next = |width: &usize| Some((*width as f64 * 1.4).ceil() as usize);
    let all = std::iter::successors(Some(first), next);
    all.take_while(|width| *width <= longest && *width * 8 <= series.count()).collect()
}

/// Statistics of all stretches of one width.
struct Level {
    width: usize,
    freedoms: Vec<MeasuredFreedom>,
}

/// Stretches that stand out of efforts cleared of what lasts, the clearest first, apart from each other, and how far
/// the clearest of all others stands out.
pub fn scan(series: &FreedomSeries, cleared: &[Vec<f64>], rulers: &Rulers) -> (Vec<Peak>, f64) {
    let margin = series.instants(EVENT_MARGIN);
    let grounds = grounds(series, &rulers.sizes);
    let rests = rests(series);
    let level = |ruler: &Ruler| {
        let mut freedoms = ruler.measure(cleared, &grounds);
        for (own, rests) in freedoms.iter_mut().zip(&rests) {
            let still = means(rests, ruler.width).into_iter().map(|share| share > 0.5);
            let all = own.deviations.iter_mut().zip(still);
            all.filter(|(_, still)| *still).for_each(|(value, _)| *value = 0.0);
        }
        Level { width: ruler.width, freedoms }
    };
    let fits = |ruler: &&Ruler| ruler.width * 8 <= series.count();
    let levels: Vec<Level> = rulers.widths.iter().filter(fits).map(level).collect();
    let (mut peaks, mut seen): (Vec<Peak>, Vec<Peak>) = (Vec::new(), Vec::new());
    while let Some(peak) = highest(&levels, &seen, margin).filter(|_| seen.len() <= 2 * EVENTS) {
        let peak = grown(peak, cleared);
        if peaks.len() <= EVENTS && stays(&peak, &cleared[peak.freedom], series) {
            peaks.push(peak.clone());
        }
        seen.push(peak);
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
        for (f, MeasuredFreedom { deviations, usual, .. }) in level.freedoms.iter().enumerate() {
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

/// Whether the impulse of a peak stays when its surroundings are counted in. A reading that came late or a lost step
/// of an encoder shows as a jump of the position and back, or of the position alone: its accelerations add up to
/// nothing.
fn stays(peak: &Peak, effort: &[f64], series: &FreedomSeries) -> bool {
    let skirt = peak.width.max(series.instants(1.0 / EVENT_CORNER));
    let sum = |from: usize, until: usize| effort[from..until].iter().sum::<f64>();
    let end = peak.first + peak.width;
    let own = sum(peak.first, end);
    let wide = sum(peak.first.saturating_sub(skirt), (end + skirt).min(effort.len()));
    wide / own > EVENT_STAYS
}

/// The peak at its full length: the stretch within reach of it whose sum of efforts is largest beside that of noise
/// of its length, `(Σ f)²/n`, again as long as it ends where reach does.
fn grown(mut peak: Peak, cleared: &[Vec<f64>]) -> Peak {
    let effort = &cleared[peak.freedom];
    loop {
        let from = peak.first.saturating_sub(peak.width / 2);
        let until = (peak.first + peak.width + peak.width / 2).min(effort.len());
        let [first, last] = stretch(&effort[from..until]);
        let edge = step(until - from);
        let held =
            (first > edge || from == 0) && (last + edge < until - from || until == effort.len());
        let longer = last - first > peak.width;
        (peak.first, peak.width) = (from + first, last - first);
        if held || !longer {
            return peak;
        }
    }
}

/// Ends of stretches are sought in sixtieths of the reach: finer ones than are reported are not needed.
fn step(reach: usize) -> usize {
    (reach / 60).max(1)
}

/// First and last instant of the stretch with the largest `(Σ f)²/n`.
fn stretch(effort: &[f64]) -> [usize; 2] {
    let mut sums = vec![0.0];
    for value in effort {
        sums.push(sums[sums.len() - 1] + value);
    }
    let (mut best, mut most) = ([0, effort.len()], 0.0);
    let step = step(effort.len());
    for a in (0..sums.len()).step_by(step) {
        for b in (a + 2..sums.len()).step_by(step) {
            let gain = (sums[b] - sums[a]).powi(2) / (b - a) as f64;
            if gain > most {
                (best, most) = ([a, b], gain);
            }
        }
    }
    best
}
