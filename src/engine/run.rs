//! A mechanism from start to end: what a run is asked for, and what it hands out.

use super::account::watch::{Peaks, RunWatch, Tally};
use super::account::wear::Rubbing;
use super::account::work::Work;
use super::clock::Clock;
use super::control::StepControl;
use super::halt::{Halt, Pace, TOO_MANY_STEPS, impossible, likely_cause};
use super::stepping::adaptive::Adaptive;
use super::stepping::direct::Direct;
use super::stepping::energy::{Books, Ledger, drift};
use super::stepping::fixed::FixedSteps;
use super::stepping::native::NativeSteps;
use super::stepping::stepper::{Stepper, meant};
use crate::mechanism::{Bearing, BodyState, Evaluation, Mechanism};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

/// By how much, as a share, times that mean the same instant differ at most: as sums of a million numbers do.
const ROUNDING: f64 = 1e-10;

/// Which instants a run hands out.
///
/// [`run`](run()) has an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Simulated time in s.
    pub duration: f64,
    /// Time between two rows in s; the first row is t = 0, the last one the end.
    pub interval: f64,
}

impl Schedule {
    /// Number of intervals; the last one is shorter if the duration is no multiple of the interval.
    pub fn intervals(&self) -> usize {
        // A relative 1e-9 forgives 0.3/0.1 = 2.9999….
        (self.duration / self.interval * (1.0 - 1e-9)).ceil().max(1.0) as usize
    }

    /// Time of row `k` in s.
    pub fn time(&self, k: usize) -> f64 {
        if k >= self.intervals() { self.duration } else { meant(k as f64 * self.interval) }
    }
}

/// Everything that is known at one instant. States, accelerations and forces belong together:
/// the forces are those at these positions and velocities, the accelerations follow from them.
///
/// [`run`](run()) has an example.
#[derive(Debug)]
pub struct Instant<'a> {
    /// Time in s.
    pub t: f64,
    /// State of each body.
    pub states: &'a [BodyState],
    /// Angle of each body in rad, whole turns counted since the start.
    pub angles: &'a [f64],
    /// Forces, accelerations, contacts, commands.
    pub evaluation: &'a Evaluation,
    /// One per revolute joint.
    pub tallies: &'a [Tally],
    /// Largest values since the row before.
    pub peaks: Peaks,
    /// What [`Work::rubbed`] has come to.
    pub rubbed: Option<&'a [Vec<f64>]>,
    /// Steps so far.
    pub steps: u64,
}

/// Simulates `mechanism` and calls `observe` at each row of the schedule.
///
/// ```
/// use freeplay::engine::{Schedule, StepControl, run};
/// use freeplay::mechanism::{Body, BodyState, Mechanism};
/// use nalgebra::Vector2;
///
/// let mut stone = Mechanism::free(vec![Body::new("stone", 2.0, 0.1, BodyState::ground())]);
/// stone.gravity = Vector2::new(0.0, -9.81);
/// let schedule = Schedule { duration: 0.1, interval: 0.05 };
/// let mut heights = Vec::new();
/// let work = run(&stone, StepControl::Fixed(1e-3), schedule, &mut |instant| {
///     heights.push(instant.states[0].position.y);
/// })?;
/// assert_eq!((heights.len(), work.steps), (schedule.intervals() + 1, 100));
/// assert!((heights[2] + 9.81 * 0.1 * 0.1 / 2.0).abs() < 1e-9);
/// # Ok::<(), freeplay::engine::Halt>(())
/// ```
///
/// # Errors
/// [`Halt`] when a state turns impossible or steps too short; the rows handed out before stand.
pub fn run(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    observe: &mut dyn FnMut(&Instant),
) -> Result<Work, Halt> {
    run_while(mechanism, control, schedule, &AtomicBool::new(false), &mut |instant| {
        observe(instant);
        ControlFlow::Continue(())
    })
}

/// [`run`] with an `observe` that may end it early, as does `stop` between any two steps once it is true:
/// the work is then what was done until there.
///
/// # Errors
/// [`Halt`] when a state turns impossible or steps too short; the rows handed out before stand.
pub fn run_while(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    stop: &AtomicBool,
    observe: &mut dyn FnMut(&Instant) -> ControlFlow<()>,
) -> Result<Work, Halt> {
    let mut stepper = stepper(mechanism, control, None, false);
    drive(&mut *stepper, mechanism, None, control, schedule, stop, observe)
}

/// [`run_while`] that also keeps the balance of energy ([`Work::energy`]) and counts where journals rub
/// ([`Work::rubbed`]). That takes up to 7 % more instructions.
///
/// ```
/// use freeplay::engine::run_balanced;
/// use freeplay::prelude::*;
/// use std::ops::ControlFlow;
/// use std::sync::atomic::AtomicBool;
///
/// let machine = assemble(&Scenario::load(None, &["simulation.duration=0.01".to_owned()])?)?;
/// let stop = AtomicBool::new(false);
/// let mut rows = 0;
/// let work = run_balanced(&machine.mechanism, machine.control, machine.schedule, &stop, &mut |_| {
///     rows += 1;
///     if rows < 4 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
/// })?;
/// assert_eq!(rows, 4, "a run ends where its observer says");
/// assert!(work.energy.is_some() && work.reached < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Halt`] when a state turns impossible or steps too short; the rows handed out before stand.
pub fn run_balanced(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    stop: &AtomicBool,
    observe: &mut dyn FnMut(&Instant) -> ControlFlow<()>,
) -> Result<Work, Halt> {
    let mut stepper = stepper(mechanism, control, Some(Books::default()), true);
    let rubbing = Some(Rubbing::new(mechanism));
    drive(&mut *stepper, mechanism, rubbing, control, schedule, stop, observe)
}

/// [`run_balanced`] that does not count where journals rub: it is for tables that say nothing of wear.
///
/// # Errors
/// [`Halt`] when a state turns impossible or steps too short; the rows handed out before stand.
pub fn run_without_wear(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    stop: &AtomicBool,
    observe: &mut dyn FnMut(&Instant) -> ControlFlow<()>,
) -> Result<Work, Halt> {
    let mut stepper = stepper(mechanism, control, Some(Books::default()), false);
    drive(&mut *stepper, mechanism, None, control, schedule, stop, observe)
}

/// The way of stepping that a mechanism and its control ask for; `rubs` where it is to be counted how much journals rub.
fn stepper(
    mechanism: &Mechanism,
    control: StepControl,
    books: Option<Books>,
    rubs: bool,
) -> Box<dyn Stepper> {
    let native = mechanism.revolutes.iter().any(|j| matches!(j.bearing, Bearing::Native { .. }));
    match control {
        StepControl::Fixed(step) if native => Box::new(NativeSteps::new(mechanism, step)),
        StepControl::Fixed(step) => Box::new(FixedSteps::new(mechanism, step, books)),
        StepControl::Tolerance(tolerance) => Box::new(Adaptive::new(mechanism, tolerance, books)),
        StepControl::Direct(tolerance) => {
            Box::new(Direct::new(mechanism, tolerance, books.is_some(), rubs))
        }
    }
}

fn drive(
    stepper: &mut dyn Stepper,
    mechanism: &Mechanism,
    rubbing: Option<Rubbing>,
    control: StepControl,
    schedule: Schedule,
    stop: &AtomicBool,
    observe: &mut dyn FnMut(&Instant) -> ControlFlow<()>,
) -> Result<Work, Halt> {
    stepper.synchronise(mechanism, 0.0);
    let mut drive = OngoingRun {
        work: Work { smallest_step: f64::INFINITY, ..Work::default() },
        watch: RunWatch::new(mechanism, rubbing),
        t: 0.0,
        clock: Clock::new(mechanism),
        pace: Pace::new(control),
        ledger: Ledger::new(mechanism, stepper.exchange()),
        stepper,
        mechanism,
        control,
        end: schedule.duration,
    };
    drive.work.energy = drive.ledger.draw(mechanism, drive.stepper.states());
    drive.watch.reach(mechanism, 0.0, drive.stepper);
    for row in 0..=schedule.intervals() {
        let at = schedule.time(row);
        while at - drive.t > ROUNDING * at {
            if stop.load(Ordering::Relaxed) {
                drive.work.stopped = true;
                drive.work.rubbed = drive.watch.rubbed().map(<[_]>::to_vec);
                return Ok(drive.work);
            }
            drive.step(at)?;
        }
        if drive.row(at, observe)?.is_break() {
            break;
        }
    }
    Ok(drive.work)
}

/// A run on its way.
struct OngoingRun<'a> {
    stepper: &'a mut dyn Stepper,
    mechanism: &'a Mechanism,
    control: StepControl,
    /// Time of the last row, and that at which the last step ended, in s.
    end: f64,
    t: f64,
    clock: Clock,
    work: Work,
    watch: RunWatch,
    pace: Pace,
    ledger: Ledger,
}

impl OngoingRun<'_> {
    /// One step towards the row at `at` s, or beyond; never beyond the last row, where nothing may be commanded.
    fn step(&mut self, at: f64) -> Result<(), Halt> {
        self.settle();
        let Self { stepper, mechanism, t, clock, work, .. } = self;
        if clock.due(*t) {
            stepper.sample(mechanism, *t, &clock.due);
        }
        let until = clock.end(if stepper.ends_at_rows() { at } else { self.end });
        let reached = stepper.advance(mechanism, *t, until);
        work.step(reached - *t, reached, *stepper);
        *t = reached;
        if let Some(what) = self.pace.exceeded(*t, work.steps) {
            let (cause, work) = (TOO_MANY_STEPS.to_owned(), work.clone().into());
            return Err(Halt { t: *t, what, cause, work });
        }
        stepper.synchronise(mechanism, *t);
        self.look_for_the_impossible(self.t, false)?;
        self.ledger.add(self.stepper.exchange());
        // The balance of each row is that of the end of the step that reached it.
        if at - self.t <= ROUNDING * at {
            self.work.energy = self.ledger.draw(self.mechanism, self.stepper.states());
        }
        Ok(())
    }

    /// Takes account of the last step once nothing inside it is asked for any more.
    fn settle(&mut self) {
        if self.watch.t < self.t {
            self.stepper.read(self.mechanism, self.t);
            self.watch.reach(self.mechanism, self.t, self.stepper);
        }
    }

    /// Hands out the row at `at` s, which the last step has reached.
    fn row(
        &mut self,
        at: f64,
        observe: &mut dyn FnMut(&Instant) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, Halt> {
        // Rows and steps that mean the same time differ by rounding.
        let inside = self.t - at > ROUNDING * at;
        if inside {
            self.stepper.read(self.mechanism, at);
        } else {
            self.settle();
        }
        self.look_for_the_impossible(at, true)?;
        let (stepper, mechanism) = (&*self.stepper, self.mechanism);
        let mut seen = self.watch.clone();
        if inside {
            seen.look(mechanism, at, stepper);
        }
        let (states, evaluation) = (stepper.states(), stepper.evaluation());
        seen.look_at_angles(states, |_, _| true);
        self.work.drift = self.work.drift.max(drift(mechanism, states));
        let RunWatch { tallies, peaks, angles, .. } = &seen;
        let rubbed = seen.rubbed();
        self.watch.new_row(mechanism, at, stepper);
        let (peaks, steps) = (*peaks, self.work.steps);
        let instant = Instant { t: at, states, angles, evaluation, tallies, peaks, rubbed, steps };
        let go_on = observe(&instant);
        if go_on.is_break() || at >= self.end {
            self.work.rubbed = rubbed.map(<[_]>::to_vec);
        }
        Ok(go_on)
    }

    /// Stops where the present instant, `t` s, holds what cannot be.
    fn look_for_the_impossible(&self, t: f64, row: bool) -> Result<(), Halt> {
        let Self { stepper, mechanism, control, work, .. } = self;
        match impossible(mechanism, stepper.states(), stepper.evaluation(), row) {
            None => Ok(()),
            Some(what) => {
                let cause = likely_cause(mechanism, *control);
                Err(Halt { t, what, cause, work: work.clone().into() })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::Body;
    use nalgebra::{UnitComplex, Vector2, Vector3};

    #[test]
    fn whole_turns_between_rows_are_counted() {
        let body = |spin| {
            let twist = Vector3::new(0.0, 0.0, spin);
            let (position, rotation) = (Vector2::zeros(), UnitComplex::new(3.0));
            Body::new("wheel", 1.0, 1.0, BodyState { position, rotation, twist })
        };
        let spins = [40.0, -25.0, 0.1];
        let mechanism = Mechanism::free(spins.map(body).to_vec());
        let schedule = Schedule { duration: 2.0, interval: 0.5 };
        for control in [StepControl::Fixed(1e-3), StepControl::Tolerance(1e-5)] {
            run(&mechanism, control, schedule, &mut |instant| {
                for (angle, spin) in instant.angles.iter().zip(spins) {
                    let expected = 3.0 + spin * instant.t;
                    assert!((angle - expected).abs() < 1e-9, "{control:?}: {angle} {expected}");
                }
            })
            .expect("runs to its end");
        }
    }
}
