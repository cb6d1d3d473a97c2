//! What can be said against a machine before it is simulated.

use super::finding::Finding;
use super::{bodies, conformal, oil, plausible, three_rpr, unacting};
use crate::engine::{Engine, StepControl, TYPICAL_IMPACT_SPEED};
use crate::mechanism::{Bearing, Drive, JointIndex, Mechanism};
use crate::model::{DrivenPath, Machine, Singular, assemble};
use crate::scenario::{self, Scenario};

/// Gain from a drive's error to the machine's fastest point beyond which a pose counts as singular: a
/// clearance of 0.1 mm, or an encoder's step times so much, is a centimetre of the machine.
const REFUSED_GAIN: f64 = 200.0;

/// The gain beyond which a pose is doubtful: forces grow with it.
const DOUBTFUL_GAIN: f64 = 50.0;

/// Error in m or rad of a table of the inverse kinematics beyond which it is told: a thousandth of the smallest
/// clearance that is common.
const LARGEST_TABLE_ERROR: f64 = 1e-9;

/// What is doubtful about a scenario as it is written, for commands that take the motion from elsewhere.
pub fn doubts(scenario: &Scenario) -> Vec<Finding> {
    let mut found: Vec<Finding> = scenario.unused().into_iter().map(Finding::warning).collect();
    if let Ok(machine) = assemble(scenario) {
        found.extend(plausible::findings(scenario, &machine));
        // Of a joint's friction that is looked for it does matter how fast it sets in.
        let acts = |finding: &Finding| finding.problem.path == "contact.friction_velocity";
        found.extend(
            unacting::unacting(scenario, &machine).into_iter().filter(|finding| !acts(finding)),
        );
    }
    found
}

/// Everything wrong or doubtful about a machine and its motion.
pub fn findings(scenario: &Scenario, machine: &mut Machine) -> Vec<Finding> {
    let path = driven_path(scenario, machine);
    findings_along(scenario, machine, path.as_ref())
}

/// The path that the drives take a machine along, if it has one; that of a 3-RPR is looked at by its legs.
pub fn driven_path(scenario: &Scenario, machine: &mut Machine) -> Option<DrivenPath> {
    match scenario.mechanism {
        scenario::Mechanism::ThreeRpr(_) => None,
        _ => machine.driven_path(),
    }
}

/// Everything wrong or doubtful about a machine and its motion, whose driven path is known.
pub fn findings_along(
    scenario: &Scenario,
    machine: &Machine,
    path: Option<&DrivenPath>,
) -> Vec<Finding> {
    let mut found: Vec<Finding> = scenario.unused().into_iter().map(Finding::warning).collect();
    found.extend(plausible::findings(scenario, machine));
    match &scenario.mechanism {
        scenario::Mechanism::ThreeRpr(kind) => {
            three_rpr::findings(scenario, kind, &*machine.motion, &mut found);
        }
        _ => match (overdriven(scenario, machine), path) {
            (Some(finding), _) => found.push(finding),
            (None, Some(path)) => along(scenario, machine, path, &mut found),
            (None, None) => {}
        },
    }
    found.extend(floating(scenario));
    found.extend(table_error(scenario, machine));
    found.extend(bodies::findings(scenario, &machine.mechanism));
    found.extend(redundant(scenario, machine));
    found.extend(step(scenario, machine));
    found.extend(rows(scenario));
    found.extend(conformal::findings(scenario, machine));
    found.extend(oil::findings(scenario, machine));
    found.extend(table_end(scenario, machine));
    found
}

/// The place of a joint's key in the file, where the file has one.
fn joint_key(scenario: &Scenario, name: &str) -> String {
    let joints = scenario.mechanism.described().map(|described| &described.joints);
    let place = joints.and_then(|joints| joints.iter().position(|joint| joint.name() == name));
    place.map_or_else(|| "mechanism".to_owned(), |i| format!("joint.{i}"))
}

/// More drives with a command than ways to move.
fn overdriven(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    let mechanism = machine.ideal.mechanism();
    let states: Vec<_> = mechanism.bodies.iter().map(|body| body.start).collect();
    let freedoms = mechanism.freedoms(&states);
    let with_command = mechanism.actuators.iter().filter(|a| a.drive != Drive::Effort).count();
    // Otherwise they say the same twice at this pose only: a singular one.
    if with_command <= freedoms.free {
        return None;
    }
    let name = |drive: &usize| mechanism.actuators[*drive].name.as_str();
    let names: Vec<&str> = freedoms.overdriven.iter().map(name).collect();
    let message = format!(
        "{} are all told where to be, and without clearance the machine has {} {}: they fight each other",
        names.join(", "),
        freedoms.free,
        if freedoms.free == 1 { "freedom" } else { "freedoms" },
    );
    let help = "drive as many joints as there are freedoms, or give a [[drive]] kind = \"force\"";
    let key = drive_key(scenario, names.last()?);
    Some(Finding::error(scenario.problem(&key, message, help)))
}

/// The place of a joint's drive in the file, or of its motion where `[drive]` drives it.
fn drive_key(scenario: &Scenario, name: &str) -> String {
    let drives = scenario.mechanism.described().map(|described| &described.drives);
    let place = drives.and_then(|drives| drives.iter().position(|drive| drive.joint() == name));
    let motion = match &scenario.motion {
        scenario::Motion::Joints(motions) if scenario.is_list("motion") => {
            motions.iter().position(|motion| motion.joint == name)
        }
        _ => None,
    };
    match (place, motion) {
        (Some(i), _) => format!("drive.{i}"),
        (None, Some(i)) => format!("motion.{i}"),
        (None, None) => "motion".to_owned(),
    }
}

/// Drives that leave their range, toggles, singular poses, loops that turn over.
fn along(scenario: &Scenario, machine: &Machine, path: &DrivenPath, found: &mut Vec<Finding>) {
    let mechanism = &machine.mechanism;
    let unit = |drive: usize| match mechanism.actuators[drive].joint {
        JointIndex::Revolute(_) => "rad",
        JointIndex::Prismatic(_) => "m",
    };
    for (drive, t, coordinate) in &path.breaches {
        let name = &mechanism.actuators[*drive].name;
        let message = format!(
            "{name} would have to be {coordinate:.4} {} at t = {t:.4} s, outside its range",
            unit(*drive)
        );
        let help = "choose a smaller motion, or another range of the joint";
        let key = format!("{}.range", joint_key(scenario, name));
        found.push(Finding::error(scenario.problem(&key, message, help)));
    }
    if let Some((t, coordinates)) = &path.stuck {
        let at: Vec<String> = coordinates
            .iter()
            .enumerate()
            .map(|(i, q)| format!("{} = {q:.4} {}", mechanism.actuators[i].name, unit(i)))
            .collect();
        let message = format!(
            "drives the machine beyond its reach at t = {t:.4} s: it locks near {}, where a loop is stretched \
             out or folded",
            at.join(", ")
        );
        let help = "keep the drive within the toggle, or choose other lengths";
        found.push(Finding::error(scenario.problem("motion", message, help)));
        return;
    }
    if let Some(t) = path.unseen {
        let message = format!(
            "is looked at up to t = {t:.3e} s: its drives go too far for more, and what is wrong later goes unseen"
        );
        let help = "make sure that the motion only repeats itself from there on";
        found.push(Finding::warning(scenario.problem("motion", message, help)));
    }
    // A centre of mass out of this world is moved out of this world, whatever the pose.
    if bodies::findings(scenario, mechanism).is_empty() {
        let singular = path.singular;
        found.extend(singular.and_then(|singular| singular_pose(scenario, mechanism, singular)));
    }
    for (of, t) in &path.turned {
        let names: Vec<&str> = of.joints.iter().map(|&joint| mechanism.joint_name(joint)).collect();
        let message = format!(
            "turns the loop {} over at t = {t:.4} s: its area changes sign on the way",
            names.join("-")
        );
        let help = "make sure that this is the assembly that you mean";
        found.push(Finding::warning(scenario.problem("motion", message, help)));
    }
}

/// A pose in which the drives hold the machine badly or not at all.
fn singular_pose(
    scenario: &Scenario,
    mechanism: &Mechanism,
    Singular { t, share, drive }: Singular,
) -> Option<Finding> {
    let gain = 1.0 / share;
    let name = &mechanism.actuators[drive].name;
    if gain > REFUSED_GAIN {
        let message = format!(
            "passes a singular pose at t = {t:.4} s: there the machine moves although {name} and all other \
             drives hold, and no finite force holds it"
        );
        let help = "keep the motion away from there, or drive another joint";
        return Some(Finding::error(scenario.problem("motion", message, help)));
    }
    (gain > DOUBTFUL_GAIN).then(|| {
        let message = format!(
            "comes near a singular pose at t = {t:.4} s: an error of {name}, or play of its size, moves the \
             machine {gain:.0} times as far"
        );
        let help = "keep the motion farther from there: forces grow alike";
        Finding::warning(scenario.problem("motion", message, help))
    })
}

/// Bodies that hang together and that nothing connects to the ground.
fn floating(scenario: &Scenario) -> Option<Finding> {
    let described = scenario.mechanism.described()?;
    let floating = described.floating();
    let first = floating.first()?;
    let place = described.bodies.iter().position(|body| body.name == first.name)?;
    let names: Vec<String> = floating.iter().map(|body| format!("\"{}\"", body.name)).collect();
    let message =
        format!("{} float: no joint and no spring connects them to the ground", names.join(", "));
    let help = "join one to a point of the ground, or leave it so if the machine is to fly free";
    Some(Finding::warning(scenario.problem(&format!("body.{place}"), message, help)))
}

/// A table of the inverse kinematics that is coarser than any clearance allows.
fn table_error(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    let error = machine.table_error.filter(|error| *error > LARGEST_TABLE_ERROR)?;
    let message = format!(
        "moves the drives by a table of the inverse kinematics that is wrong by up to {error:.1e} m or rad"
    );
    let help = "a shorter run, or a smoother motion";
    Some(Finding::warning(scenario.problem("motion", message, help)))
}

/// Joints that say the same twice.
fn redundant(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    let mechanism = &machine.mechanism;
    let states: Vec<_> = mechanism.bodies.iter().map(|body| body.start).collect();
    let freedoms = mechanism.freedoms(&states);
    let first = *freedoms.redundant.first()?;
    let names: Vec<&str> =
        freedoms.redundant.iter().map(|&joint| mechanism.joint_name(joint)).collect();
    let message = format!(
        "{} hold the machine more often than it takes: its motion is determined, how they share the load \
         is not",
        names.join(", ")
    );
    let help =
        "the smallest forces are reported; a clearance in one of them decides who bears what";
    let key = joint_key(scenario, mechanism.joint_name(first));
    Some(Finding::warning(scenario.problem(&key, message, help)))
}

/// A step that the machine does not stand, or that its law cannot take.
fn step(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    let has = |of: fn(&Bearing) -> bool| machine.mechanism.revolutes.iter().any(|j| of(&j.bearing));
    let native = has(|bearing| matches!(bearing, Bearing::Native { .. }));
    // A fixed step where nobody asks for one: the engine is asked by name.
    if native && scenario.simulation.engine == Engine::Direct {
        return Some(Finding::error(scenario.problem(
            "simulation.engine",
            "\"direct\" does not go with contact.law = \"native\": those are the physics engine's own \
             contacts",
            "leave simulation.engine out, and set simulation.step, such as 1e-5",
        )));
    }
    match machine.control {
        StepControl::Tolerance(_) if native => Some(Finding::error(scenario.problem(
            "simulation.tolerance",
            "does not go with contact.law = \"native\": the physics engine's own contacts have no \
             error estimate",
            "set simulation.step instead, such as 1e-5",
        ))),
        StepControl::Fixed(step) if !native => {
            let longest = machine.mechanism.longest_step(TYPICAL_IMPACT_SPEED)?;
            let what = if machine.mechanism.longest_servo_step() == Some(longest) {
                "servos"
            } else if machine.mechanism.longest_smooth_step() == Some(longest) {
                "effects"
            } else {
                "hits of the journals"
            };
            let message = format!("is {step:e} s, too long for the {what}");
            let help =
                format!("use at most {:.1e} s, or simulation.tolerance", two_digits_below(longest));
            (step > longest)
                .then(|| Finding::error(scenario.problem("simulation.step", message, help)))
        }
        _ => None,
    }
}

/// The largest number with two digits that is not above a positive `limit`: good advice stays within
/// the limit that it is about.
fn two_digits_below(limit: f64) -> f64 {
    let unit = 10f64.powf(limit.log10().floor() - 1.0);
    // 1e-9 forgives rounding where the limit has two digits itself.
    (limit / unit + 1e-9).floor() * unit
}

/// A motion table that ends before the run does: the machine is commanded to stop there, at once.
fn table_end(scenario: &Scenario, machine: &Machine) -> Option<Finding> {
    let (end, duration) = (machine.known_until, scenario.simulation.duration);
    // 1e-9 forgives rounding.
    (end < duration * (1.0 - 1e-9)).then(|| {
        let message = format!(
            "ends at t = {end} s, and the run at {duration} s: from there on the motion rests at the \
             last row's pose"
        );
        let help = format!("simulate {end} s (--duration), or give a table with more rows");
        Finding::warning(scenario.problem("motion.file", message, help))
    })
}

/// Too few rows for peaks and means.
fn rows(scenario: &Scenario) -> Option<Finding> {
    let simulation = &scenario.simulation;
    let (settle, interval) = (simulation.settle(), simulation.output_interval);
    let left = simulation.duration - settle;
    // 1e-9 forgives rounding.
    (left < 2.0 * interval * (1.0 - 1e-9)).then(|| {
        let message = format!(
            "is {interval} s: that leaves fewer than two rows after the first {settle} s, which \
             peaks and means leave out (simulation.settle)"
        );
        let help = format!(
            "simulate longer than {} s, or use an interval of at most {:.1e} s",
            simulation.duration,
            two_digits_below(left / 2.0)
        );
        Finding::error(scenario.problem("simulation.output_interval", message, help))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_stays_within_its_limit() {
        for (limit, advice) in [(2.06e-5, "2.0e-5"), (1.25e-4, "1.2e-4"), (1e-5, "1.0e-5")] {
            assert_eq!(format!("{:.1e}", two_digits_below(limit)), advice);
        }
    }
}
