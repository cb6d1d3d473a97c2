//! Values from whole simulations, held against the recording point by point.
//!
//! Where loads keep the joints in contact nothing is chaotic: a complete model started like the machine
//! meets every sample up to the sensors' noise, which is white and declared. No lens gets as much out of
//! a recording: one leg may be nearly unloaded for an instant, and when its journal crosses over hangs on
//! the third digit of what loads it. The start is fitted with the values ([`crate::calibrate::measured::start`]).

use super::axes::ValueAxes;
use super::fit::LegsFit;
use super::least_squares::{
    FitEffort, Free, ResidualAt, free, jacobian, least_squares, values, with_values,
};
use super::model::{LegsCase, LegsSegment};
use crate::calibrate::measured::rattle::noise;
use crate::calibrate::measured::spectrum::{Signal, transform};
use crate::calibrate::measured::start::{KICKS, Kicks, SHOWN, SwingStart, kicked, still};
use crate::effects::Setting;
use crate::measure::log::{Channel, Log};
use crate::mechanism::Mechanism;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::Range;

/// Highest frequencies in Hz that count: all that a platform does, and its motion alone. Where a leg is
/// nearly unloaded its journal crosses over, which is a matter of milliseconds: a model whose values
/// are off does so at another time.
const BAND: f64 = 100.0;
const ALL: f64 = f64::INFINITY;
const MOTION: f64 = 15.0;

/// A stage of a fit.
struct FitStage {
    /// Time in s from the start of a segment in which the swing counts; thereafter only the motion does.
    seen: f64,
    /// Highest frequency in Hz that counts.
    band: f64,
    /// Share of the swing by which it may be missed.
    share: f64,
    /// Steps of Gauss and Newton, at most.
    steps: usize,
    /// Drop of the sum of squares, and parts of a thousand, below which another step is not worth its
    /// simulations.
    enough: f64,
    /// Whether it begins with the derivatives of the stage before, which saw the same rows.
    kept: bool,
}

/// First whatever the swing: its phase has many wrong answers for values that are off.
const ROUGH: [FitStage; 1] =
    [FitStage { seen: ALL, band: MOTION, share: 2.0, steps: 4, enough: 30.0, kept: false }];
/// Then for so short a time that a frequency which is off has not lost a period, and longer and longer: the
/// swing's phase pins values that are nearly right. The last one twice, for better axes.
const CLOSE: [FitStage; 5] = [
    FitStage { seen: 0.3, band: BAND, share: 0.1, steps: 4, enough: 1.0, kept: false },
    FitStage { seen: 1.0, band: BAND, share: 0.1, steps: 4, enough: 1.0, kept: false },
    FitStage { seen: ALL, band: BAND, share: 0.05, steps: 3, enough: 1.0, kept: false },
    FitStage { seen: ALL, band: BAND, share: 0.0, steps: 6, enough: 0.1, kept: true },
    FitStage { seen: ALL, band: BAND, share: 0.0, steps: 6, enough: 0.1, kept: false },
];

/// Share of a parameter's step, or of a kick's size, by which derivatives are taken at first: the swing's
/// phase bends what is straight through the lens, and a hundredth is less than simulations are wrong by
/// where two values do nearly the same. Then steps are some standard deviations each.
const STEP: f64 = 0.1;

/// Standard deviations of a value by which derivatives are taken.
const SIGMAS: f64 = 2.0;

/// Mean square in units of noise, after any stage, beyond which a model is not complete: its values would
/// make good what it lacks, and stages in which the swing counts more come no nearer.
const COMPLETE: f64 = 1.2;

/// How many times as large it may be after the first steps of a stage, and the share that further steps
/// have to leave of it, for still further ones to be worth it.
const SLOW: f64 = 6.0;
const FALLING: f64 = 0.8;

/// Standard deviations at which it is seen how what is missed grows.
const FARTHER: [f64; 2] = [4.0, 16.0];

/// Half the number of neighbouring frequencies over which a swing's size is averaged.
const NEIGHBOURS: usize = 8;

/// Residuals by channel and frequency.
type Spectra = Vec<Vec<f64>>;

/// The values of a model near `effects` whose motion meets segments, whatever its swing; none where no
/// values make the model nearly complete.
pub fn rough(
    case: &LegsCase,
    on: &[LegsSegment],
    effects: &[Setting],
    starts: &[SwingStart],
) -> Option<Vec<Setting>> {
    let released = released(case, effects, starts)?;
    Some(from(case, on, effects, &released, &ROUGH, true)?.effects)
}

/// The values of a model very near `effects`, whose runs start like `starts`, that meet segments point by
/// point, with residual and derivatives from which intervals follow; none where no values make the model
/// complete.
///
/// With values that are right to a hundredth a release may swing unlike the recording, with right ones
/// like it: kicks are taken only where the release does not do.
pub fn close(
    case: &LegsCase,
    on: &[LegsSegment],
    effects: &[Setting],
    starts: &[SwingStart],
) -> Option<LegsFit> {
    let from = |starts: &[SwingStart], patient| from(case, on, effects, starts, &CLOSE, patient);
    let kicks = starts.iter().any(|start| start.kicks.is_some());
    let mut best = from(&released(case, effects, starts)?, !kicks);
    if mean_square(best.as_ref()) > SHOWN && kicks {
        let kicked = from(starts, true);
        if mean_square(kicked.as_ref()) < mean_square(best.as_ref()) {
            best = kicked;
        }
    }
    best
}

/// The same starts with machines that are let go.
fn released(
    case: &LegsCase,
    effects: &[Setting],
    starts: &[SwingStart],
) -> Option<Vec<SwingStart>> {
    let machines = case.released(effects).ok()?;
    let pairs = starts.iter().zip(machines);
    Some(pairs.map(|(start, machine)| start.without_kicks(machine)).collect())
}

fn mean_square(fit: Option<&LegsFit>) -> f64 {
    fit.map_or(f64::INFINITY, |fit| fit.chi2 / fit.white.len() as f64)
}

/// The same from starts of one kind, in these stages; a `patient` fit that does not come near takes more
/// steps as long as they help.
fn from(
    case: &LegsCase,
    on: &[LegsSegment],
    effects: &[Setting],
    starts: &[SwingStart],
    stages: &[FitStage],
    patient: bool,
) -> Option<LegsFit> {
    let (sought, mut progress) = SegmentUnknowns::new(case, on, effects, starts)?;
    for (i, stage) in stages.iter().enumerate() {
        let last = i + 1 == stages.len();
        progress.take(&sought, stage, patient, last)?;
    }
    let (residual, jacobian) = progress.fit?;
    Some(sought.fit(&progress.now, residual, &jacobian))
}

/// What is fitted to segments: values of effects, then kicks where starts have them.
struct SegmentUnknowns<'a> {
    case: &'a LegsCase,
    on: &'a [LegsSegment],
    effects: &'a [Setting],
    starts: &'a [SwingStart],
    /// Number of the effects' values.
    count: usize,
    free: Vec<Free>,
    /// One a segment.
    swings: Vec<Swing>,
}

impl<'a> SegmentUnknowns<'a> {
    /// That, and a fit that has not begun.
    fn new(
        case: &'a LegsCase,
        on: &'a [LegsSegment],
        effects: &'a [Setting],
        starts: &'a [SwingStart],
    ) -> Option<(Self, FitProgress)> {
        let count = values(effects).len();
        let mut free: Vec<Free> = free(effects);
        let mut now = values(effects);
        for kicks in on.iter().filter_map(|segment| starts[segment.run].kicks) {
            now.extend(kicks.iter());
            free.extend([Free { step: 1.0, bounds: [f64::NEG_INFINITY, f64::INFINITY] }; KICKS]);
        }
        let axes = ValueAxes::along(&free, STEP / SIGMAS);
        let swings = on.iter().map(|segment| Swing::of(case, segment, &starts[segment.run]));
        let swings: Vec<Swing> = swings.collect::<Option<_>>()?;
        let sought = Self { case, on, effects, starts, count, free, swings };
        Some((sought, FitProgress { now, axes, fit: None, last: None }))
    }

    /// What counts of each segment in a stage.
    fn parts(&self, stage: &FitStage) -> Option<Vec<Vec<CountedRows>>> {
        let case = self.case;
        let of = |(segment, swing): (&LegsSegment, &Swing)| {
            let interval = case.runs[segment.run].log.interval;
            let rows = segment.rows.clone();
            let end = ((stage.seen / interval) as usize).saturating_add(rows.start).min(rows.end);
            let whole = end == rows.end;
            let first = CountedRows::new(case, swing, rows.start..end, stage.band, stage.share)?;
            let motion = || CountedRows::new(case, swing, rows.clone(), MOTION, ROUGH[0].share);
            Some(if whole { vec![first] } else { vec![first, motion()?] })
        };
        self.on.iter().zip(&self.swings).map(of).collect()
    }

    /// What simulations with these values miss of what counts.
    fn missed(&self, parts: &[Vec<CountedRows>], values: &[f64]) -> Option<DVector<f64>> {
        let case = self.case;
        let (own, mut rest) = values.split_at(self.count);
        let effects = with_values(self.effects, own);
        let mut white = Vec::new();
        for (segment, parts) in self.on.iter().zip(parts) {
            let mut machine = case.runs[segment.run].released(&case.rig, &effects).ok()?;
            if self.starts[segment.run].kicks.is_some() {
                let (own, others) = rest.split_at(KICKS);
                rest = others;
                let still = still(&case.simulator, &machine).ok()?;
                machine = kicked(&still, &Kicks::from_column_slice(own));
            }
            let simulated = simulate(case, segment, &machine)?;
            for part in parts {
                white.extend(part.missed(case, &case.runs[segment.run].log, &simulated)?);
            }
        }
        Some(DVector::from_vec(white))
    }

    /// The fit that numbers make, kicks among them.
    fn fit(&self, now: &[f64], residual: DVector<f64>, jacobian: &DMatrix<f64>) -> LegsFit {
        let count = self.count;
        let chi2 = residual.norm_squared();
        // What kicks could do as well tells nothing of values.
        let mut own = jacobian.columns(0, count).into_owned();
        if jacobian.ncols() > count {
            let others = jacobian.columns(count, jacobian.ncols() - count).into_owned().qr().q();
            own -= &others * (others.transpose() * &own);
        }
        let effects = with_values(self.effects, &now[..count]);
        LegsFit { effects, chi2, white: residual, jacobian: Some(own) }
    }
}

/// How far a fit has come.
struct FitProgress {
    now: Vec<f64>,
    axes: ValueAxes,
    /// What is missed, and its derivatives.
    fit: Option<(DVector<f64>, DMatrix<f64>)>,
    /// Derivatives along the axes in units of what may be missed, and those units.
    last: Option<(DMatrix<f64>, DVector<f64>)>,
}

impl FitProgress {
    /// Takes the steps of a stage, the `last` one or not; none where they do not come near enough for more.
    fn take(
        &mut self,
        sought: &SegmentUnknowns,
        stage: &FitStage,
        patient: bool,
        last: bool,
    ) -> Option<()> {
        let parts = sought.parts(stage)?;
        let free = &sought.free;
        let look = |values: &[f64]| sought.missed(&parts, values);
        let count = self.now.len();
        let sigmas = vec![Free { step: SIGMAS, bounds: [-1e9, 1e9] }; count];
        let units = units(&parts);
        if self.fit.is_none() {
            let along = |steps: &[f64]| look(&self.axes.values(free, &self.now, steps));
            let zero = vec![0.0; count];
            let first = jacobian(&along, &sigmas, &zero, &along(&zero)?)?;
            self.axes = self.axes.turned(free, &first)?;
        }
        let mut known = self.last.take().filter(|_| stage.kept).map(|(mut along, before)| {
            let scale = before.component_div(&units);
            along.column_iter_mut().for_each(|mut column| column.component_mul_assign(&scale));
            along
        });
        // With axes that were wrong a fit may have ended too soon.
        let mut before = SLOW * COMPLETE;
        loop {
            let along = |steps: &[f64]| look(&self.axes.values(free, &self.now, steps));
            let effort = FitEffort { steps: stage.steps, enough: stage.enough, secant: true };
            let best = least_squares(&along, &sigmas, vec![0.0; count], effort, known.take())?;
            let left = best.residual.norm_squared() / best.residual.len() as f64;
            if left > f64::max(COMPLETE, FALLING * before) || (left > COMPLETE && !patient) {
                return None;
            }
            self.now = self.axes.values(free, &self.now, &best.values);
            let derivatives = best.jacobian.as_ref()?;
            let mut own = self.axes.derivatives(derivatives)?;
            let turned = self.axes.turned(free, derivatives)?;
            if sought.case.chaotic && last {
                let along = |steps: &[f64]| look(&turned.values(free, &self.now, steps));
                let slopes = turned.derivatives_along(&own);
                own = turned.derivatives(&smoothed(&along, slopes, &best.residual))?;
            }
            self.last = Some((turned.derivatives_along(&own), units.clone()));
            self.axes = turned;
            self.fit = Some((best.residual, own));
            if left < COMPLETE {
                return Some(());
            }
            before = left;
        }
    }
}

/// Slopes along axes no larger than what is missed grows farther away. Where joints rattle that friction has
/// calmed, a motion is a rough function of values: at a point it may rise steeply, and be as low again some
/// standard deviations on.
fn smoothed(along: ResidualAt, mut slopes: DMatrix<f64>, missed: &DVector<f64>) -> DMatrix<f64> {
    let least = missed.norm_squared();
    let flat = |axis: usize| {
        let steps = FARTHER.iter().flat_map(|reach| [-reach, *reach]);
        let ratios = steps.map(|reach| {
            let steps: Vec<f64> =
                (0..slopes.ncols()).map(|i| if i == axis { reach } else { 0.0 }).collect();
            let rise = along(&steps).map_or(f64::INFINITY, |there| there.norm_squared() - least);
            rise.max(1.0).sqrt() / reach.abs()
        });
        ratios.fold(1.0, f64::min)
    };
    let ratios: Vec<f64> = (0..slopes.ncols()).into_par_iter().map(flat).collect();
    for (mut slope, ratio) in slopes.column_iter_mut().zip(ratios) {
        slope *= ratio;
    }
    slopes
}

/// A machine on a segment, without sensor noise; none where it cannot be simulated.
fn simulate(case: &LegsCase, segment: &LegsSegment, machine: &Mechanism) -> Option<Log> {
    let log = case.runs[segment.run].log.part(0..segment.rows.end);
    case.simulator.record(machine, &log, 0).ok()
}

/// A start's motion with and without its swing.
struct Swing {
    with: Log,
    without: Log,
}

impl Swing {
    fn of(case: &LegsCase, segment: &LegsSegment, start: &SwingStart) -> Option<Self> {
        let both = [&start.machine, &start.still];
        let (with, without) =
            rayon::join(|| simulate(case, segment, both[0]), || simulate(case, segment, both[1]));
        Some(Self { with: with?, without: without? })
    }

    /// Its square on rows in units of noise, smooth over frequency.
    fn squares(&self, case: &LegsCase, rows: &Range<usize>) -> Option<Spectra> {
        let smooth = |channel: Vec<f64>| {
            let mean = |k: usize| {
                let near = k.saturating_sub(NEIGHBOURS)..(k + NEIGHBOURS + 1).min(channel.len());
                let count = near.len() as f64;
                channel[near].iter().map(|value| value * value).sum::<f64>() / count
            };
            (0..channel.len()).map(mean).collect()
        };
        let difference = difference(case, rows, &self.with, &self.without)?;
        Some(difference.into_iter().map(smooth).collect())
    }
}

/// What counts of a segment: rows, and by how much each frequency of them may be missed.
struct CountedRows {
    rows: Range<usize>,
    noise: Spectra,
}

impl CountedRows {
    fn new(
        case: &LegsCase,
        swing: &Swing,
        rows: Range<usize>,
        band: f64,
        share: f64,
    ) -> Option<Self> {
        let mut noise = swing.squares(case, &rows)?;
        for channel in &mut noise {
            channel.truncate((channel.len() as f64 * band / BAND).ceil() as usize);
            channel.iter_mut().for_each(|square| *square = (1.0 + share * share * *square).sqrt());
        }
        Some(Self { rows, noise })
    }

    /// Recording less simulation in units of what may be missed.
    fn missed(&self, case: &LegsCase, log: &Log, simulated: &Log) -> Option<Vec<f64>> {
        let missed = difference(case, &self.rows, log, simulated)?;
        let pairs = missed.iter().zip(&self.noise);
        Some(pairs.flat_map(|(r, noise)| r.iter().zip(noise).map(|(r, noise)| r / noise)).collect())
    }
}

/// By how much each number that counts may be missed.
fn units(parts: &[Vec<CountedRows>]) -> DVector<f64> {
    let channels = parts.iter().flatten().flat_map(|part| part.noise.iter().flatten());
    DVector::from_iterator(channels.clone().count(), channels.copied())
}

/// Difference of two logs on rows in units of noise.
fn difference(case: &LegsCase, rows: &Range<usize>, a: &Log, b: &Log) -> Option<Spectra> {
    let signal = |channel: Channel| {
        let unit = noise(&case.simulator.sensors, channel)?;
        let [a, b] = [a, b].map(|log| log.get(channel).map(|v| &v[rows.clone()]));
        let values = a?.iter().zip(b?).map(|(a, b)| (a - b) / unit).collect();
        Some(Signal { values, band: BAND })
    };
    let signals: Vec<Signal> = a.channels().filter_map(signal).collect();
    Some(transform(&signals, a.interval))
}
