//! Error against time: this project's ways of stepping, and a solver in minimal coordinates written
//! for this one machine (`minimal_coordinates/`), all measured in one run; and error against
//! tolerance.
//!
//! `cargo bench --bench work_precision` prints the tables and draws `assets/work-precision.svg` and
//! `assets/error-over-tolerance.svg`. Errors are geometric means over start phases, against the
//! minimal-coordinate solver at a tolerance of 1e-12 (a single run's error is luck by a factor of five).

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/minimal/mod.rs"]
mod minimal;

use common::{Case, SERVO};
use freeplay::engine::{Schedule, StepControl, run};
use freeplay::mechanism::Mechanism;
use freeplay::report::{Curve as Line, Label, Panel, Style, panels_svg};
use std::time::Instant;

/// Start phases over which an error of the diagram is averaged.
const PHASES: usize = 8;
/// Rows at which positions are compared, in s: far enough apart not to hinder long steps.
const INTERVAL: f64 = 0.01;
/// Each time is the shortest of so many.
const REPEATS: usize = 5;
/// Tolerances of the diagrams, in m/s.
const DECADES: [f64; 5] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7];

fn main() {
    let base = Case::default();
    let servo = Case { drive: SERVO, ..base };
    let down = -9.81;
    let friction = Case { friction: 0.1, ..servo };
    let means = [
        Means::new("prescribed, c = 0.5 mm", base, 0.05),
        Means::new("servo, c = 0.5 mm", servo, 0.05),
        Means::new("servo, gravity", Case { gravity: down, ..servo }, 0.06),
        Means::new("prescribed, gravity", Case { gravity: down, ..base }, 0.03),
        Means::new("prescribed, c = 1e-8 m", Case { clearance: 1e-8, ..base }, 0.2),
        Means::new("servo, friction 0.1", friction, 0.04),
    ];
    println!(
        "\nWall seconds per simulated second at an error of 1e-8 m, means over {PHASES} starts:"
    );
    println!("| case | solver | rapier | direct | rapier / solver | direct / solver |");
    println!("|---|---|---|---|---|---|");
    means.iter().for_each(race);
    let by_tolerance: Vec<Vec<(f64, f64)>> = means
        .iter()
        .map(|means| DECADES.map(|t| means.ours(StepControl::Tolerance(t))).to_vec())
        .collect();
    let panels: Vec<Panel> = means
        .iter()
        .zip(&by_tolerance)
        .take(3)
        .map(|(means, found)| diagram(means, found))
        .collect();
    draw("work-precision.svg", &panels);
    draw("error-over-tolerance.svg", &[over_tolerance(&means, &by_tolerance)]);
}

fn draw(name: &str, panels: &[Panel]) {
    let file = format!("{}/assets/{name}", env!("CARGO_MANIFEST_DIR"));
    match panels_svg(panels).map(|svg| std::fs::write(&file, svg)) {
        Ok(Ok(())) => println!("drawn: {file}"),
        other => println!("not drawn: {other:?}"),
    }
}

/// What an error of 1e-8 m (geometric mean over the phases) costs: wall seconds per simulated second, between
/// two tolerances of a ladder by the straight line in logarithms.
fn cost(at: impl Fn(f64) -> (f64, f64)) -> Option<f64> {
    const WANTED: f64 = 1e-8;
    let mut before: Option<(f64, f64)> = None;
    for k in 0..14 {
        let (wall, error) = at(1e-3 * 10f64.powf(-0.5 * f64::from(k)));
        match before {
            Some((earlier, coarser)) if error <= WANTED => {
                let share = (coarser / WANTED).ln() / (coarser / error).ln();
                return Some(earlier * (wall / earlier).powf(share));
            }
            _ => before = Some((wall, error)),
        }
    }
    None
}

/// One row of the race at 1e-8 m.
fn race(means: &Means) {
    let solver = cost(|tolerance| means.theirs(tolerance));
    let rapier = cost(|tolerance| means.ours(StepControl::Tolerance(tolerance)));
    let direct = cost(|tolerance| means.ours(StepControl::Direct(tolerance)));
    let (Some(solver), Some(rapier), Some(direct)) = (solver, rapier, direct) else {
        println!("| {} | not reached |", means.name);
        return;
    };
    println!(
        "| {} | {solver:.4} | {rapier:.4} | {direct:.4} | {:.1} | {:.2} |",
        means.name,
        rapier / solver,
        direct / solver
    );
}

/// A case at several start phases, with what a run at each should give.
struct Means {
    name: &'static str,
    until: f64,
    phases: Vec<Case>,
    truths: Vec<Vec<[f64; 2]>>,
    mechanisms: Vec<Mechanism>,
}

impl Means {
    fn new(name: &'static str, case: Case, until: f64) -> Self {
        let phases: Vec<Case> = (0..PHASES)
            .map(|k| std::f64::consts::TAU * k as f64 / PHASES as f64)
            .map(|phase| Case { phase, ..case })
            .collect();
        let truth = |case| minimal::positions(case, 1e-12, &times(until)).0;
        let truths = phases.iter().map(truth).collect();
        let mechanisms = phases.iter().map(Case::mechanism).collect();
        Self { name, until, phases, truths, mechanisms }
    }

    /// Wall seconds per simulated second and error in m of this project.
    fn ours(&self, control: StepControl) -> (f64, f64) {
        mean(self.mechanisms.iter().zip(&self.truths).map(|(mechanism, truth)| {
            let (error, wall, _) = measure(mechanism, control, self.until, truth);
            (error, wall)
        }))
    }

    /// The same of the minimal-coordinate solver.
    fn theirs(&self, tolerance: f64) -> (f64, f64) {
        mean(self.phases.iter().zip(&self.truths).map(|(case, truth)| {
            let (error, wall, _) = measure_minimal(case, tolerance, self.until, truth);
            (error, wall)
        }))
    }
}

/// One panel: log10 of the error over log10 of the wall time per simulated second.
fn diagram(means: &Means, by_tolerance: &[(f64, f64)]) -> Panel {
    let line = |name: &str, points: &[(f64, f64)]| {
        println!("{} — {name}: wall s/s, error m", means.name);
        for (wall, error) in points {
            println!("  {wall:.4} {error:.2e}");
        }
        let points = points.iter().map(|(wall, error)| (wall.log10(), error.log10())).collect();
        Line { name: name.to_owned(), points, style: Style::Solid }
    };
    let direct = DECADES.map(|tolerance| means.ours(StepControl::Direct(tolerance)));
    let fixed = [2e-5, 1e-5, 5e-6, 2e-6, 1e-6].map(|step| means.ours(StepControl::Fixed(step)));
    let minimal = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8].map(|tolerance| means.theirs(tolerance));
    Panel {
        title: format!("{}, up to {:.0} ms", means.name, means.until * 1e3),
        x_label: Label::log("wall time per simulated second (s)"),
        y_label: Label::log("error (m)"),
        curves: vec![
            line("fixed step", &fixed),
            line("tolerance", by_tolerance),
            line("direct integration", &direct),
            line("minimal coordinates, this machine only", &minimal),
        ],
    }
}

/// log10 of the error over log10 of the tolerance, a line for each case.
fn over_tolerance(means: &[Means], by_tolerance: &[Vec<(f64, f64)>]) -> Panel {
    println!("Error in m at tolerances of {DECADES:?} m/s:");
    let mut curves: Vec<Line> = means
        .iter()
        .zip(by_tolerance)
        .map(|(means, found)| {
            let errors: Vec<String> = found.iter().map(|(_, e)| format!("{e:.1e}")).collect();
            println!("  {}: {}", means.name, errors.join(", "));
            let points = DECADES.iter().zip(found).map(|(t, (_, e))| (t.log10(), e.log10()));
            let name = format!("{}, {:.0} ms", means.name, means.until * 1e3);
            Line { name, points: points.collect(), style: Style::Solid }
        })
        .collect();
    let proportional = DECADES.map(|tolerance| (tolerance.log10(), (1e-4 * tolerance).log10()));
    curves.push(Line {
        name: "in proportion".to_owned(),
        points: proportional.to_vec(),
        style: Style::Reference,
    });
    Panel {
        title: "error of the platform's position, mean of 8 starts".to_owned(),
        x_label: Label::log("tolerance (m/s)"),
        y_label: Label::log("error (m)"),
        curves,
    }
}

fn times(until: f64) -> Vec<f64> {
    (0..=(until / INTERVAL).round() as usize).map(|k| k as f64 * INTERVAL).collect()
}

fn worst(rows: &[[f64; 2]], truth: &[[f64; 2]]) -> f64 {
    rows.iter().zip(truth).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}

/// Largest error in m, wall seconds and steps per simulated second.
fn measure(
    mechanism: &Mechanism,
    control: StepControl,
    until: f64,
    truth: &[[f64; 2]],
) -> (f64, f64, f64) {
    let mut best = (0.0, f64::INFINITY, 0.0);
    for _ in 0..REPEATS {
        let mut rows = Vec::new();
        let schedule = Schedule { duration: until, interval: INTERVAL };
        let start = Instant::now();
        let work = run(mechanism, control, schedule, &mut |instant| {
            let p = instant.states[mechanism.output].position;
            rows.push([p.x, p.y]);
        });
        let wall = start.elapsed().as_secs_f64() / until;
        let steps = work.map_or(f64::NAN, |work| work.steps as f64 / until);
        best = (worst(&rows, truth), wall.min(best.1), steps);
    }
    best
}

/// The same of the minimal-coordinate solver: error in m, wall seconds per simulated second, and
/// nanoseconds of the whole solver per evaluation of its equations of motion.
fn measure_minimal(case: &Case, tolerance: f64, until: f64, truth: &[[f64; 2]]) -> (f64, f64, f64) {
    let (mut best, times) = ((0.0, f64::INFINITY, 0.0), times(until));
    for _ in 0..REPEATS {
        let start = Instant::now();
        let (rows, evaluations) = minimal::positions(case, tolerance, &times);
        let seconds = start.elapsed().as_secs_f64();
        if seconds / until < best.1 {
            best = (worst(&rows, truth), seconds / until, seconds / evaluations as f64 * 1e9);
        }
    }
    best
}

/// Mean wall time and geometric mean of the error, as a point (wall, error).
fn mean(runs: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    let (errors, walls): (Vec<f64>, Vec<f64>) = runs.unzip();
    let n = errors.len() as f64;
    (walls.iter().sum::<f64>() / n, (errors.iter().map(|e| e.ln()).sum::<f64>() / n).exp())
}
