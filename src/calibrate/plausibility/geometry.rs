//! Lengths and poses of a log held against each other and against the rig's geometry, in every unit that
//! somebody might have written them in.

use crate::calibrate::measured::recording::triple;
use crate::measure::log::{Channel, Log};
use crate::mechanism::three_rpr::Geometry;
use crate::scenario::{Mechanism, Scenario, ThreeRpr};
use crate::simulate::assemble;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Root mean square in m by which measured lengths may miss those of the measured pose, and their
/// commands: undeclared offsets and clearances are millimetres.
const MISFIT: f64 = 0.01;

/// Rows at which lengths and poses are held against each other.
const LOOKS: usize = 200;

/// Factors that turn a wrong unit into the right one, with its name, for lengths in m and angles in rad.
const LENGTHS: [(f64, &str); 3] = [(1.0, "m"), (1e-3, "mm"), (1e3, "km")];
const ANGLES: [(f64, &str); 3] = [(1.0, "rad"), (1e-3, "mrad"), (PI / 180.0, "degrees")];

/// Lengths and poses held against each other and against the rig, as (message, help).
pub(super) fn geometry(rig: &Scenario, log: &Log) -> Vec<(String, String)> {
    let Mechanism::ThreeRpr(machine) = &rig.mechanism else { return Vec::new() };
    let geometry = Geometry { base_side: machine.base_side, platform_side: machine.platform_side };
    let Some(commands) = triple(log, Channel::Command) else { return Vec::new() };
    let lengths = triple(log, Channel::Length);
    let rows: Vec<usize> = (0..log.samples).step_by((log.samples / LOOKS).max(1)).collect();
    // The column that poses are held against, and what it is called.
    let (base, name): (_, fn(usize) -> Channel) = match lengths {
        Some(lengths) => (lengths, Channel::Length),
        None => (commands, Channel::Command),
    };
    let mut found = Vec::new();
    let mut scales = [1.0; 3];
    if let Some(pose) = triple(log, Channel::Pose) {
        let fit = fit(&geometry, &rows, base, pose);
        if fit.misfit > MISFIT {
            return vec![not_closing(&fit, machine, name)];
        }
        scales = fit.lengths.map(|(factor, _)| factor);
        let lengths = (0..3).map(|leg| (name(leg), base[leg], fit.lengths[leg]));
        let poses = (0..3).map(|k| (Channel::Pose(k), pose[k], fit.pose[k]));
        for (channel, column, (factor, unit)) in lengths.chain(poses) {
            if factor != 1.0 {
                found.push(unit_error(channel, column, factor, unit));
            }
        }
    } else {
        found.extend(reachable(rig, &geometry, base, name));
        if !found.is_empty() {
            return found;
        }
    }
    if lengths.is_some() {
        for leg in 0..3 {
            let measured: Vec<f64> = rows.iter().map(|&row| scales[leg] * base[leg][row]).collect();
            found.extend(command(leg, commands[leg], &rows, &measured));
        }
    }
    found
}

/// What to say of lengths and poses that fit each other in no unit.
fn not_closing(fit: &UnitFit, machine: &ThreeRpr, name: fn(usize) -> Channel) -> (String, String) {
    let message = format!(
        "columns `{}` and `x`, `y`, `phi` do not close: the length of leg {} misses the one of \
         the measured pose by {:.3} m (rms)",
        name(fit.leg),
        fit.leg + 1,
        fit.misfit
    );
    let help = format!(
        "is this the rig of that log (base_side {} m, platform_side {} m), are columns \
         exchanged?",
        machine.base_side, machine.platform_side
    );
    (message, help)
}

/// What is wrong with a leg's command, held against its measured length (m) at these rows.
fn command(
    leg: usize,
    command: &[f64],
    rows: &[usize],
    measured: &[f64],
) -> Option<(String, String)> {
    let distance = |factor: f64| {
        let squares = rows
            .iter()
            .zip(measured)
            .map(|(&row, measured)| (factor * command[row] - measured).powi(2));
        (squares.sum::<f64>() / rows.len() as f64).sqrt()
    };
    if distance(1.0) <= MISFIT {
        return None;
    }
    let channel = Channel::Command(leg);
    Some(match LENGTHS.into_iter().find(|(factor, _)| distance(*factor) <= MISFIT) {
        Some((factor, unit)) => unit_error(channel, command, factor, unit),
        None => (
            format!(
                "columns `{channel}` and `{}` differ by {:.3} m (rms)",
                Channel::Length(leg),
                distance(1.0)
            ),
            "a drive follows its command within millimetres: are columns exchanged?".to_owned(),
        ),
    })
}

/// Units in which lengths and poses fit each other.
struct UnitFit {
    lengths: [(f64, &'static str); 3],
    pose: [(f64, &'static str); 3],
    /// Worst misfit of a leg, root mean square in m, and the leg.
    misfit: f64,
    leg: usize,
}

/// The units with the fewest surprises in which measured lengths are those of the measured poses; if
/// none are, the declared ones with their misfit.
fn fit(geometry: &Geometry, rows: &[usize], lengths: [&[f64]; 3], pose: [&[f64]; 3]) -> UnitFit {
    let wrong = |units: &[(f64, &str)]| units.iter().filter(|(factor, _)| *factor != 1.0).count();
    let mut best: Option<UnitFit> = None;
    let mut declared: Option<UnitFit> = None;
    for x in LENGTHS {
        for y in LENGTHS {
            for phi in ANGLES {
                let spans: Vec<[f64; 3]> = rows
                    .iter()
                    .map(|&row| {
                        let pose = Vector3::new(
                            x.0 * pose[0][row],
                            y.0 * pose[1][row],
                            phi.0 * pose[2][row],
                        );
                        [0, 1, 2].map(|leg| geometry.leg(pose, leg).norm())
                    })
                    .collect();
                let units = [0, 1, 2].map(|leg| {
                    let misfit = |factor: f64| {
                        let squares = rows
                            .iter()
                            .zip(&spans)
                            .map(|(&row, span)| (factor * lengths[leg][row] - span[leg]).powi(2));
                        (squares.sum::<f64>() / rows.len() as f64).sqrt()
                    };
                    let fits = LENGTHS.into_iter().find(|(f, _)| misfit(*f) <= MISFIT);
                    let unit = fits.unwrap_or(LENGTHS[0]);
                    (unit, misfit(unit.0))
                });
                let (leg, misfit) = units
                    .iter()
                    .map(|(_, misfit)| *misfit)
                    .enumerate()
                    .max_by(|a, b| a.1.total_cmp(&b.1))
                    .unwrap_or((0, 0.0));
                let fit = UnitFit {
                    lengths: units.map(|(unit, _)| unit),
                    pose: [x, y, phi],
                    misfit,
                    leg,
                };
                let surprises = |fit: &UnitFit| wrong(&fit.lengths) + wrong(&fit.pose);
                if fit.misfit <= MISFIT
                    && best.as_ref().is_none_or(|best| surprises(&fit) < surprises(best))
                {
                    best = Some(fit);
                } else if wrong(&fit.pose) == 0 {
                    declared = Some(fit);
                }
            }
        }
    }
    best.or(declared).unwrap_or(UnitFit {
        lengths: [LENGTHS[0]; 3],
        pose: [LENGTHS[0], LENGTHS[0], ANGLES[0]],
        misfit: 0.0,
        leg: 0,
    })
}

fn unit_error(channel: Channel, values: &[f64], factor: f64, unit: &str) -> (String, String) {
    let first = values.first().copied().unwrap_or_default();
    (
        format!("column `{channel}` starts with {first}, which fits the others if it is in {unit}"),
        format!("write it in {}: multiply by {factor}", channel.unit()),
    )
}

/// Whether some pose of the machine has the lengths of the first row.
fn reachable(
    rig: &Scenario,
    geometry: &Geometry,
    lengths: [&[f64]; 3],
    name: fn(usize) -> Channel,
) -> Option<(String, String)> {
    let guess = start_pose(rig);
    let reaches = |factor: f64| {
        let first = lengths.map(|column| factor * column[0]);
        first.iter().all(|q| *q > 0.0) && geometry.forward(first, guess).is_some()
    };
    if reaches(1.0) {
        return None;
    }
    if let Some((factor, unit)) = LENGTHS.into_iter().find(|(factor, _)| reaches(*factor)) {
        return Some(unit_error(name(0), lengths[0], factor, unit));
    }
    let [a, b, c] = lengths.map(|column| column[0]);
    Some((
        format!("no pose of the machine has the lengths of the first row, {a}, {b}, {c} m"),
        format!(
            "is this the rig of that log (base_side {} m, platform_side {} m)?",
            geometry.base_side, geometry.platform_side
        ),
    ))
}

/// A pose (m, m, rad) near which a machine is sought whose tracker says nothing: where its scenario's
/// motion starts.
pub fn start_pose(rig: &Scenario) -> Vector3<f64> {
    // A rig that cannot be assembled is refused elsewhere; π/6 is far from the machine's singularities.
    assemble(rig).map_or(Vector3::new(0.0, 0.0, PI / 6.0), |machine| machine.motion.at(0.0).pose)
}
