//! What does not last, found in recordings of measured machines: a part of the recorded effort is hidden, so that the
//! machine really received it and no column says so. The recordings are not part of the project; without them the
//! tests say so and pass.

use freeplay::calibrate::sensed::events::{Event, events};
use freeplay::calibrate::sensed::recording::Recording;
use freeplay::calibrate::sensed::windows::bench::Bench;
use freeplay::scenario::Scenario;
use std::path::{Path, PathBuf};

fn scratch() {
    let rig = Scenario::load(Some(Path::new("/tmp/h2/arm/calibrated.toml")), &[]).expect("rig");
    let parts = freeplay::model::parts_of(&rig).expect("parts");
    let names = ["fit_00", "fit_02", "fit_05", "validate_03", "validate_04"];
    let files = names.map(|n| PathBuf::from(format!("/work/shared/measured/two-link-arm/{n}.csv")));
    let runs: Vec<Recording> =
        files.iter().map(|f| Recording::read(f, &parts.sensors, true).expect("run")).collect();
    let bench = Bench::new(&rig, runs.clone()).expect("bench");
    let machines = bench.machines(&bench.declared).expect("machines");
    let zeros = bench.own_zeros(&bench.declared, &bench.zeros_of_runs()).expect("zeros");
    let zeros: Vec<Vec<f64>> =
        zeros.iter().map(|run| run.iter().map(|[zero, _]| *zero).collect()).collect();
    let clock = std::time::Instant::now();
    for run in 0..5 {
        let series = bench.series(&machines, &zeros, run).expect("series");
        let mut text = String::new();
        for i in 0..series.count() {
            text += &format!("{}", series.time(i));
            for f in &series.freedoms {
                let m = f.motion.as_ref().expect("motion");
                text += &format!(",{},{},{},{}", f.effort[i], m[0][i], m[1][i], m[2][i]);
            }
            text += "\n";
        }
        std::fs::write(format!("/tmp/h2/series_{}.csv", names[run]), text).expect("written");
        println!("{} {:?} {:?}", names[run], clock.elapsed(), show(&events(&series)));
    }
    let tau = ["tau1_Nm", "tau2_Nm"]
        .map(|c| parts.sensors.iter().position(|s| s.column == c).expect("column"));
    let mut seed = 7u64;
    let mut draw = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as f64 / (1u64 << 31) as f64
    };
    for size in [0.2, 0.35, 0.5, 0.7, 1.0] {
        for lasts in [0.05, 0.1, 0.2, 0.3] {
            let (mut hit, mut right, mut wrong) = ([0; 2], [0; 2], 0);
            let mut off = Vec::new();
            for trial in 0..10 {
                let (run, joint) = (trial % 5, trial / 5);
                let at = 0.5 + 8.5 * draw();
                let push = if draw() < 0.5 { -size } else { size };
                let changed = hidden(&runs[run], tau[joint], [at, at + lasts], push);
                let mut all = runs.clone();
                all[run] = changed;
                let bench = Bench::new(&rig, all).expect("bench");
                let machines = bench.machines(&bench.declared).expect("machines");
                let series = bench.series(&machines, &zeros, run).expect("series");
                for event in events(&series) {
                    let own = &event.history;
                    let middle = (own.at_s + own.until_s) / 2.0;
                    if (middle - at - lasts / 2.0).abs() < 0.1 + lasts / 2.0 {
                        hit[joint] += 1;
                        right[joint] += usize::from(own.joint == ["shoulder", "elbow"][joint]);
                        off.push(((own.at_s - at) * 1e3).round());
                        off.push((own.impulse / (push * lasts) * 100.0).round());
                    } else {
                        wrong += 1;
                    }
                }
            }
            println!("{size} {lasts}: hit {hit:?} right {right:?} wrong {wrong} {off:?}");
        }
    }
}

fn show(events: &[Event]) -> Vec<String> {
    events.iter().map(|e| format!("{} {:.1?}", e.words(), e.scores)).collect()
}

/// A recording from whose column a constant effort is taken for a while.
fn hidden(run: &Recording, column: usize, [from, until]: [f64; 2], size: f64) -> Recording {
    let columns = (0..64).map_while(|i| {
        (i < run.sensors()).then(|| {
            let values = run.get(i)?;
            let push = |(row, value): (usize, &f64)| {
                let t = row as f64 * run.interval;
                value - if i == column && (from..until).contains(&t) { size } else { 0.0 }
            };
            Some(values.iter().enumerate().map(push).collect())
        })
    });
    run.with(columns.collect())
}

#[test]
fn arm() {
    scratch();
}
