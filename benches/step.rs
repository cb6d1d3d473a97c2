//! Cost per step and per simulated second of the paper's machine (3-RPR, six clearance joints of
//! 0.5 mm, prescribed drives): `cargo bench --bench step`.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Case, SERVO};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use freeplay::engine::{Schedule, StepControl, run};

/// Simulated seconds of one measurement: long enough to rattle, short enough to repeat.
const DURATION: f64 = 0.1;

fn step(criterion: &mut Criterion) {
    let servo = Case { drive: SERVO, ..Case::default() };
    for (name, case, control) in [
        ("fixed step 1e-5 s, prescribed", Case::default(), StepControl::Fixed(1e-5)),
        ("tolerance 1e-5 m/s, prescribed", Case::default(), StepControl::Tolerance(1e-5)),
        ("tolerance 1e-5 m/s, servo", servo, StepControl::Tolerance(1e-5)),
    ] {
        let mechanism = case.mechanism();
        let schedule = Schedule { duration: DURATION, interval: 5e-4 };
        let simulate = || run(&mechanism, control, schedule, &mut |_| {});
        let steps = simulate().map_or(0, |work| work.steps);
        println!("{name}: {steps} steps in {DURATION} s; the time below is of {DURATION} s");
        let mut group = criterion.benchmark_group("machine");
        group.sample_size(20).throughput(Throughput::Elements(steps));
        group.bench_function(name, |bencher| bencher.iter(simulate));
        group.finish();
    }
}

criterion_group!(benches, step);
criterion_main!(benches);
