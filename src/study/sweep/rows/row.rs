//! A row of the table: the values of a run, its figures, how it ended.

use crate::mechanism::{Actuator, JointIndex};
use crate::scenario::Scenario;
use crate::simulate::{Summary, assemble};
use crate::study::sweep::Vary;
use csv::StringRecord;
use serde_json::Value;

/// The figures of a row, by their names in `summary.json`. What depends on the machine that computes
/// (wall time) or is the same in all rows is left out.
pub(super) const FIGURES: [&str; 18] = [
    "peak_contact_force_N",
    "peak_platform_acceleration_m_s2",
    "peak_actuator_force_N",
    "ideal_peak_platform_acceleration_m_s2",
    "ideal_peak_actuator_force_N",
    "rms_path_error_m",
    "max_path_error_m",
    "rms_acceleration_deviation_m_s2",
    "rms_actuator_force_deviation_N",
    "contact_fraction",
    "impacts",
    "impacts_per_s",
    "largest_penetration_m",
    "steps",
    "smallest_step_s",
    "largest_step_s",
    "step_error_m_s",
    "simulated_s",
];

/// Those of them that are whole numbers.
#[cfg(feature = "parquet")]
pub(super) const COUNTS: [&str; 2] = ["impacts", "steps"];

/// The last column: `ok`, or `halted: …` or `refused: …` with the reason. A run that does not balance has
/// come to its end, but not where it should: it counts as halted.
const STATUS: &str = "status";

const OK: &str = "ok";
const HALTED: &str = "halted: ";
const REFUSED: &str = "refused: ";

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::study) enum Status {
    /// It reached its end.
    Ok,
    /// It broke down on the way, and figures hold up to there; or it does not balance.
    Halted,
    /// The machine cannot do what its scenario asks for; there are no figures.
    Refused,
}

/// Figures of forces of drives: zero where drives turn, or there are none.
pub(super) const FORCES: [&str; 3] =
    ["peak_actuator_force_N", "ideal_peak_actuator_force_N", "rms_actuator_force_deviation_N"];

/// Figures of torques, of machines that have drives of revolute joints.
const TORQUES: [&str; 3] = [
    "peak_actuator_torque_Nm",
    "ideal_peak_actuator_torque_Nm",
    "rms_actuator_torque_deviation_Nm",
];

/// What a joint's columns are called, before and after its name.
const OF_JOINTS: [[&str; 2]; 3] =
    [["peak_force_", "_N"], ["contact_fraction_", ""], ["impacts_", ""]];

/// What a joint's column is, in words with its unit; none of what is no joint's.
pub(super) fn of_joint(column: &str) -> Option<String> {
    let words = ["contact force, peak (N)", "share of time in contact", "impacts"];
    OF_JOINTS.iter().zip(words).find_map(|([before, after], words)| {
        let joint = column.strip_prefix(before)?.strip_suffix(after)?;
        Some(format!("joint {joint}: {words}"))
    })
}

/// The columns that a machine has beside [`FIGURES`]: torques, and each joint with a clearance by its name. The
/// table of the machines that had one before joints had columns stays as it was.
pub(in crate::study) fn more(base: &Scenario) -> Vec<String> {
    use crate::scenario::Mechanism::{DriveStage, Pendulum, ThreeRpr};
    if matches!(base.mechanism, ThreeRpr(_) | DriveStage(_) | Pendulum(_)) {
        return Vec::new();
    }
    // What cannot be put together has no joints to name; its runs are refused one by one.
    let Ok(machine) = assemble(base) else { return Vec::new() };
    let mechanism = &machine.mechanism;
    let turns = |actuator: &Actuator| matches!(actuator.joint, JointIndex::Revolute(_));
    let torques = if mechanism.actuators.iter().any(turns) { &TORQUES[..] } else { &[] };
    let joints = machine.layout.joints.iter().map(|&joint| &mechanism.revolutes[joint].name);
    let of_joints = joints.flat_map(|name| OF_JOINTS.map(|[a, b]| format!("{a}{name}{b}")));
    torques.iter().map(|name| (*name).to_owned()).chain(of_joints).collect()
}

/// The header of the table.
pub(in crate::study) fn columns(varied: &[Vary], more: &[String]) -> Vec<String> {
    let paths = varied.iter().map(|vary| vary.path.clone());
    let figures = FIGURES.into_iter().map(str::to_owned).chain(more.iter().cloned());
    paths.chain(figures).chain([STATUS.to_owned()]).collect()
}

/// A figure of `more`: one of a joint, or one of the summary by its name.
fn figure(json: &Value, name: &str) -> Value {
    let joints = json["joints"].as_array().map(Vec::as_slice).unwrap_or_default();
    for joint in joints {
        let of = joint["joint"].as_str().unwrap_or_default();
        for ([before, after], key) in
            OF_JOINTS.iter().zip(["peak_force_N", "contact_fraction", "impacts"])
        {
            if name == format!("{before}{of}{after}") {
                return joint[key].clone();
            }
        }
    }
    json[name].clone()
}

/// The row of a run that was simulated.
pub(in crate::study) fn of_summary(
    values: Vec<String>,
    summary: &Summary,
    more: &[String],
) -> Vec<String> {
    // A summary is nothing but names, numbers and texts: it always becomes JSON.
    let json = serde_json::to_value(summary).unwrap_or_default();
    let mut row = values;
    let names = FIGURES.into_iter().chain(more.iter().map(String::as_str));
    row.extend(names.map(|name| match figure(&json, name) {
        Value::Number(number) => number.to_string(),
        // No number is an empty cell.
        _ => String::new(),
    }));
    let faults = &summary.watched.faults;
    row.push(match &summary.halted {
        None if faults.is_empty() => OK.to_owned(),
        None => format!("{HALTED}{}", faults.join("; ")),
        Some(reason) => format!("{HALTED}{reason}"),
    });
    row
}

/// The row of a run that the machine refuses.
pub(in crate::study::sweep) fn refused(
    values: Vec<String>,
    reason: &str,
    more: &[String],
) -> Vec<String> {
    let mut row = values;
    row.extend((0..FIGURES.len() + more.len()).map(|_| String::new()));
    row.push(format!("{REFUSED}{reason}"));
    row
}

/// How the run of a row ended.
pub(in crate::study::sweep) fn status(row: &StringRecord) -> Status {
    said(row.iter().next_back())
}

/// How a run ended whose last cell this is.
pub(in crate::study) fn said(status: Option<&str>) -> Status {
    match status {
        Some(OK) => Status::Ok,
        Some(text) if text.starts_with(HALTED) => Status::Halted,
        _ => Status::Refused,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Work;
    use crate::simulate::Recorder;

    /// Numbers of `summary.json` that are no figures: the same in all rows, not reproducible, or
    /// looked for by `freeplay run` alone, because they take runs of their own.
    const NO_FIGURES: [&str; 7] = [
        "seed",
        "tolerance_m_s",
        "settle_s",
        "wall_s",
        "wall_s_per_simulated_s",
        "lyapunov_exponent_1_s",
        "predictability_horizon_s",
    ];

    #[test]
    fn joints_and_torques_of_other_machines_have_columns() {
        let text = "mechanism.kind = 'four-bar'\n";
        let scenario = Scenario::from_text(text, "my.toml", &[]).expect("right");
        let machine = assemble(&scenario).expect("put together");
        let more = more(&scenario);
        assert_eq!(more[0], TORQUES[0]);
        assert!(more.contains(&"peak_force_B_N".to_owned()), "{more:?}");
        let recorder = Recorder::new(&machine.mechanism, 0.0);
        let summary = recorder.finish(&scenario, &machine, &Work::default(), 1.0, None, Vec::new());
        let row = of_summary(vec![], &summary, &more);
        assert_eq!(row.len(), columns(&[], &more).len());
        let impacts = columns(&[], &more).iter().position(|name| name == "impacts_B");
        assert_eq!(row[impacts.expect("there")], "0");
    }

    #[test]
    fn every_figure_of_the_summary_is_in_the_table() {
        let scenario = Scenario::load(None, &[]).expect("right");
        let machine = assemble(&scenario).expect("no table to read");
        let recorder = Recorder::new(&machine.mechanism, 0.0);
        let summary = recorder.finish(&scenario, &machine, &Work::default(), 1.0, None, Vec::new());
        let json = serde_json::to_value(&summary).expect("JSON");
        let object = json.as_object().expect("object");
        for name in FIGURES {
            assert!(object.contains_key(name), "{name}");
        }
        // Figures of an empty run are NaN, in JSON null; so are texts that are not there.
        let no_number = ["halted", "step_s"];
        for (name, _) in object.iter().filter(|(_, value)| value.is_number() || value.is_null()) {
            let name = name.as_str();
            let known =
                FIGURES.contains(&name) || NO_FIGURES.contains(&name) || no_number.contains(&name);
            assert!(known, "{name}: a figure of the table, or none?");
        }
        assert_eq!(
            of_summary(vec![], &summary, &[]).len() + 1,
            columns(&[Vary::parse("a=1").expect("right")], &[]).len()
        );
    }
}
