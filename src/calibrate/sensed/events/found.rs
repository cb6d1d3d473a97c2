//! Events: when, where, how much.

use super::lasting::{Lasting, low};
use super::scan::{Peak, Rulers, scan};
use super::series::{FreedomSeries, means, scatter};
use crate::calibrate::results::report::{ActsOn, Depends, EffectReport, Fitted};
use crate::calibrate::sensed::thresholds::{EVENT_SHARE, RESTLESS};
use crate::effects::{History, OverTime, Setting};

/// Instants of a table at most.
const TABLED: usize = 40;

/// Something that acted on a machine for a while.
#[derive(Clone, Debug)]
pub struct Event {
    /// Efforts over time.
    pub history: History,
    /// Whether the coordinate of its joint is an angle.
    pub turns: bool,
    /// Largest effort at its joint in N or N·m.
    pub peak: f64,
    /// Standard deviation of the impulse at its joint.
    pub impulse_std: f64,
    /// Mean effort in deviations of means of as long stretches.
    pub deviations: f64,
    /// By how much it stands out, and the clearest stretch of the recording that is no event.
    pub scores: [f64; 2],
    /// Efforts of its joint over time that the model does not know of (s, N or N·m), for a picture.
    pub course: Vec<(f64, f64)>,
}

/// What does not last in recordings of one machine. Each is held against itself; one that is far more restless than
/// another is held against that: what acts on it half of the time is no ground to judge it by.
pub fn events(all: &[FreedomSeries]) -> Vec<Event> {
    let efforts: Vec<Vec<Vec<f64>>> = all.iter().map(low).collect();
    let lasting: Vec<Lasting> =
        all.iter().zip(&efforts).map(|(series, low)| Lasting::of(series, low)).collect();
    let own: Vec<Vec<Vec<f64>>> =
        (0..all.len()).map(|run| lasting[run].cleared(&all[run], &efforts[run])).collect();
    let unrest: Vec<Vec<f64>> =
        own.iter().map(|cleared| cleared.iter().map(|effort| scatter(effort)).collect()).collect();
    let calmest = |run: usize| {
        let calmer = |other: &usize| {
            let pairs = unrest[run].iter().zip(&unrest[*other]);
            let alike = all[run].interval.total_cmp(&all[*other].interval).is_eq();
            alike && pairs.clone().any(|(own, other)| *own > RESTLESS * other)
        };
        let total = |other: &usize| unrest[*other].iter().sum::<f64>();
        let others = (0..all.len()).filter(calmer);
        others.min_by(|a, b| total(a).total_cmp(&total(b))).unwrap_or(run)
    };
    let mut found = Vec::new();
    for (run, series) in all.iter().enumerate() {
        let by = calmest(run);
        let cleared = lasting[by].cleared(series, &efforts[run]);
        let (peaks, others) = scan(series, &cleared, &Rulers::of(&all[by], &own[by]));
        let mut events: Vec<Event> =
            peaks.iter().map(|peak| event(series, &cleared, peak, others)).collect();
        events.sort_by(|a, b| a.history.at_s.total_cmp(&b.history.at_s));
        found.extend(events);
    }
    found
}

fn event(series: &FreedomSeries, cleared: &[Vec<f64>], peak: &Peak, others: f64) -> Event {
    let freedom = &series.freedoms[peak.freedom];
    let effort = &cleared[peak.freedom];
    let [first, last] = [peak.first, peak.first + peak.width];
    let skirt = (last - first) / 4 + series.instants(0.01);
    let (from, until) = (first.saturating_sub(skirt), (last + skirt).min(series.count()));
    let impulse = |f: usize| cleared[f][from..until].iter().sum::<f64>() * series.interval;
    let pushed: Vec<usize> = (0..cleared.len())
        .filter(|&f| f == peak.freedom || peak.units[f].abs() > EVENT_SHARE * peak.deviations.abs())
        .collect();
    let hop = (until - from).div_ceil(TABLED).max(1);
    let rows: Vec<usize> = (from..until).step_by(hop).collect();
    let table = |f: &usize| -> Vec<f64> {
        let smooth = means(&cleared[*f], 2 * hop + 1);
        let at = |row: &usize| {
            let place = row.saturating_sub(hop).min(smooth.len().saturating_sub(1));
            smooth.get(place).copied().unwrap_or(0.0)
        };
        rows.iter().map(at).collect()
    };
    let efforts: Vec<Vec<f64>> = pushed.iter().map(table).collect();
    let own = &effort[first..last];
    let largest = own.iter().fold(0.0f64, |max, v| if v.abs() > max.abs() { *v } else { max });
    let total = impulse(peak.freedom);
    let names = pushed.iter().map(|&f| series.freedoms[f].joint.clone()).collect();
    Event {
        history: History {
            depends_on: OverTime::Time,
            joint: freedom.joint.clone(),
            run: Some(series.run.clone()),
            at_s: series.time(first),
            until_s: series.time(last),
            impulse: total,
            joints: names,
            t: rows.iter().map(|row| series.time(*row)).collect(),
            efforts,
        },
        turns: freedom.turns,
        peak: largest,
        impulse_std: (total / peak.deviations).abs(),
        deviations: peak.deviations,
        scores: [peak.score, others],
        course: effort.iter().enumerate().map(|(i, v)| (series.time(i), *v)).collect(),
    }
}

impl Event {
    /// The effect.
    pub fn setting(&self) -> Setting {
        Setting::unnamed_history(self.history.clone())
    }

    /// Values for a report.
    pub fn params(&self) -> Vec<(&'static str, Fitted)> {
        let (impulse, peak) = match self.turns {
            true => ("impulse_Nms", "peak_Nm"),
            false => ("impulse_Ns", "peak_N"),
        };
        let History { at_s, until_s, impulse: value, .. } = &self.history;
        let plain = |value: f64| Fitted::new(value, f64::NAN);
        vec![
            ("at_s", plain(*at_s)),
            ("until_s", plain(*until_s)),
            (impulse, Fitted::new(*value, self.impulse_std)),
            (peak, plain(self.peak)),
        ]
    }

    /// The effect in a report.
    pub fn report(&self) -> EffectReport {
        let effect = self.setting();
        EffectReport {
            kind: effect.kind.name,
            on: ActsOn::of(&effect),
            depends_on: Depends::of(&effect),
            params: self.params(),
            evidence: self.evidence(),
            as_good: Vec::new(),
            not_ruled_out: Vec::new(),
            equation: "effort at joints over time, tabulated in calibrated.toml",
        }
    }

    /// Where, when and how much, in words.
    pub fn words(&self) -> String {
        let History { at_s, until_s, impulse, joint, run, .. } = &self.history;
        let unit = if self.turns { "N m s" } else { "N s" };
        let run = run.as_ref().map_or_else(String::new, |run| format!(" of {run}"));
        format!("a push at {joint} from {at_s:.3} to {until_s:.3} s{run}, {impulse:.3} {unit}")
    }

    /// What it rests on.
    pub fn evidence(&self) -> String {
        let [own, others] = self.scores;
        let rest = match others > 0.0 {
            true => format!("no other stretch more than {others:.1} times"),
            false => "no other stretch keeps its impulse".to_owned(),
        };
        format!(
            "the mean effort of that stretch is {:.0} deviations of such means; it stands out {own:.1} times as far \
             as the largest of half a second usually does, {rest}",
            self.deviations.abs()
        )
    }
}

/// What is said of events in a summary; nothing where there are none.
pub fn sentence(events: &[Event]) -> String {
    match events.iter().map(Event::words).collect::<Vec<_>>().join(", ") {
        list if list.is_empty() => String::new(),
        list => format!(" Something acted that does not last: {list}."),
    }
}
