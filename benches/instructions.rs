//! Instructions per rapier step and per simulated second, counted by valgrind's callgrind: the same
//! for the same binary, whatever else the machine is doing, so that two commits can be compared.
//!
//! `cargo bench --bench instructions`; without valgrind it says so and stops.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Case, SERVO};
use freeplay::engine::{Schedule, StepControl, run, run_balanced};
use std::ops::ControlFlow::Continue;
use std::process::Command;
use std::sync::atomic::AtomicBool;

/// What is run: its name, the control of the step, whether servos drive it, whether its energy is balanced.
type Counted = (&'static str, StepControl, bool, bool);

const CASES: [Counted; 9] = [
    ("fixed 1e-5 s, prescribed", StepControl::Fixed(1e-5), false, false),
    ("the same, energy balanced", StepControl::Fixed(1e-5), false, true),
    ("tolerance 1e-5 m/s, prescribed", StepControl::Tolerance(1e-5), false, false),
    ("the same, energy balanced", StepControl::Tolerance(1e-5), false, true),
    ("tolerance 1e-5 m/s, servo", StepControl::Tolerance(1e-5), true, false),
    ("the same, energy balanced", StepControl::Tolerance(1e-5), true, true),
    ("tolerance 1e-4 m/s, prescribed", StepControl::Tolerance(1e-4), false, false),
    ("direct, 1e-5 m/s, prescribed", StepControl::Direct(1e-5), false, false),
    ("direct, 1e-5 m/s, servo", StepControl::Direct(1e-5), true, false),
];

/// Simulated time of the shorter and of the longer run, in s; their difference is what counts.
const DURATIONS: [f64; 2] = [0.05, 0.15];

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, child, case, duration] = &arguments[..]
        && child == "--child"
    {
        let case = CASES[case.parse::<usize>().unwrap_or(0)];
        println!("steps {}", simulate(case, duration.parse().unwrap_or(0.0)));
        return;
    }
    println!("| case | instructions per step | million per simulated second |");
    println!("|---|---|---|");
    for (index, (name, ..)) in CASES.iter().enumerate() {
        let counts = DURATIONS.map(|duration| count(index, duration));
        let [Some((short, few)), Some((long, many))] = counts else {
            println!("skipped: valgrind is not installed");
            return;
        };
        let (instructions, steps) = ((long - short) as f64, (many - few) as f64);
        let seconds = DURATIONS[1] - DURATIONS[0];
        let (each, total) = (instructions / steps, instructions / seconds / 1e6);
        println!("| {name} | {each:.0} | {total:.0} |");
    }
}

fn simulate((_, control, servo, balanced): Counted, duration: f64) -> u64 {
    let case = if servo { Case { drive: SERVO, ..Case::default() } } else { Case::default() };
    let schedule = Schedule { duration, interval: 5e-4 };
    let mechanism = case.mechanism();
    let never = AtomicBool::new(false);
    let work = if balanced {
        run_balanced(&mechanism, control, schedule, &never, &mut |_| Continue(()))
    } else {
        run(&mechanism, control, schedule, &mut |_| {})
    };
    work.map_or(0, |work| work.steps)
}

/// Instructions and steps of a run in a process of its own.
fn count(case: usize, duration: f64) -> Option<(u64, u64)> {
    let program = std::env::current_exe().ok()?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args(["--child", &case.to_string(), &duration.to_string()])
        .output()
        .ok()?;
    let number = |text: &str| text.replace(',', "").trim().parse().ok();
    let (report, printed) =
        (String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
    let instructions = report.lines().find_map(|line| line.split_once("Collected :"))?.1;
    Some((number(instructions)?, number(printed.trim().strip_prefix("steps ")?)?))
}
