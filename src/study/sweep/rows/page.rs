//! The page of a sweep: how the runs ended, the spread of the figures, the pictures.

use super::journal::RunRows;
use super::pictures;
use super::row::{FORCES, Status, of_joint, status};
use super::statistics::{self, Spread, groups, has_starts, shared};
use crate::report::{self, Fact, PagePart, PageTable, Picture, number};
use crate::results::SCENARIO_FILE;
use crate::study::compare::QUANTITIES;
use crate::study::sweep::Record;
use statrs::statistics::{Data, OrderStatistics};

/// The page as HTML.
pub(in crate::study::sweep) fn page(
    record: &Record,
    rows: &RunRows,
    pictures: &[Picture],
) -> String {
    let title = format!("Sweep: {}", record.identity.provenance.scenario_name);
    let (facts, provenance) = (facts(record, rows), provenance(record));
    let groups = over_starts(record, rows).map(PagePart::Table);
    let rest =
        [PagePart::Facts(&facts), PagePart::Pictures(pictures), PagePart::Provenance(&provenance)];
    let parts: Vec<PagePart> = groups.into_iter().chain(rest).collect();
    report::document(&title, &lead(record, rows), &parts)
}

/// How the runs ended, in words.
fn lead(record: &Record, rows: &RunRows) -> String {
    let identity = &record.identity;
    let paths = identity.columns.iter().zip(&identity.vary).map(|(path, _)| path.as_str());
    let mut lead = format!(
        "{} of {} runs over {}",
        record.finished,
        record.runs_of_shard,
        paths.collect::<Vec<_>>().join(", ")
    );
    if record.runs_of_shard < identity.runs {
        lead += &format!(" (shard {} of a sweep of {} runs)", record.shard, identity.runs);
    }
    lead += &format!(": {} reached their end", record.ok);
    for (count, how, wanted) in [
        (record.halted, "broke down on the way or do not balance", Status::Halted),
        (record.refused, "cannot be done by the machine", Status::Refused),
    ] {
        let first = rows.values().find(|row| status(row) == wanted);
        if let Some(reason) = first.and_then(|row| row.iter().next_back()) {
            lead += &format!(", {count} {how} (the first: {reason})");
        }
    }
    lead += ". Each figure below is that of a run, taken as a single run takes it; sweep.csv has \
             one row a run.";
    if has_starts(identity) {
        return lead
            + " Means over the starts, with their 95 % intervals, stand in statistics.csv.";
    }
    lead + " Where joints rattle, the peaks and counts of a run are one draw: what differs from run to run may be \
            chaos. Varying where the motion starts (--vary motion.phase=0..5.5:12 of a circle, motion.start of a crank) \
            gives each value twelve starts, and means with intervals."
}

/// Groups of a page's table: more are in the file.
const MOST_GROUPS: usize = 50;

/// Figures of the table: where the machine is, what its joints and its output feel, how often.
const SHOWN: [&str; 5] = [
    "rms_path_error_m",
    "peak_contact_force_N",
    "peak_platform_acceleration_m_s2",
    "contact_fraction",
    "impacts_per_s",
];

/// Means over the starts, group by group; none where no start was varied.
fn over_starts(record: &Record, rows: &RunRows) -> Option<PageTable> {
    let identity = &record.identity;
    if !has_starts(identity) {
        return None;
    }
    let figures = &identity.columns[identity.vary.len()..];
    let place = |name: &&str| figures.iter().position(|known| known == name);
    let shown: Vec<usize> = SHOWN.iter().filter_map(place).collect();
    let all = groups(identity, rows);
    let cell = |spread: Option<Spread>| match spread {
        Some(Spread { mean, half }) if half.is_finite() => {
            format!("{} ± {}", number(mean), number(half))
        }
        Some(Spread { mean, .. }) => number(mean),
        None => "–".to_owned(),
    };
    let row = |group: &statistics::StartsGroup| {
        let first = group.values.iter().map(|value| short(value)).chain([group.runs.to_string()]);
        first.chain(shown.iter().map(|k| cell(group.figures[*k]))).collect()
    };
    let heads = shared(identity).into_iter().map(pictures::in_words).chain(["runs".to_owned()]);
    let more = all.len().saturating_sub(MOST_GROUPS);
    let and_more = if more > 0 {
        format!(" {more} more groups are in {}.", statistics::FILE)
    } else {
        String::new()
    };
    Some(PageTable {
        id: "starts",
        title: "Means over the starts".to_owned(),
        header: heads.chain(shown.iter().map(|k| in_words(&figures[*k]))).collect(),
        rows: all.iter().take(MOST_GROUPS).map(row).collect(),
        note: format!(
            "Means over runs that differ in their starts alone, ± half of the 95 % interval (Student's t): values whose \
             intervals lie apart differ by more than chaos.{and_more}"
        ),
    })
}

/// A varied value for people.
fn short(value: &str) -> String {
    value.parse().map_or_else(|_| value.to_owned(), number)
}

/// Figures that no comparison has.
const OTHERS: [(&str, &str); 9] = [
    ("ideal_peak_platform_acceleration_m_s2", "ideal machine: output acceleration, peak (m/s²)"),
    ("ideal_peak_actuator_force_N", "ideal machine: actuator force, peak (N)"),
    ("ideal_peak_actuator_torque_Nm", "ideal machine: actuator torque, peak (N m)"),
    ("peak_actuator_torque_Nm", "actuator torque, peak (N m)"),
    ("rms_actuator_torque_deviation_Nm", "actuator torques, rms deviation from ideal (N m)"),
    ("smallest_step_s", "shortest step (s)"),
    ("largest_step_s", "longest step (s)"),
    ("step_error_m_s", "error of a step (m/s)"),
    ("simulated_s", "time simulated (s)"),
];

/// What a figure is, in words with its unit.
fn in_words(column: &str) -> String {
    let quantity = QUANTITIES.iter().find(|quantity| quantity.key == column);
    match quantity {
        Some(quantity) if quantity.unit.is_empty() => quantity.label.to_owned(),
        Some(quantity) => format!("{} ({})", quantity.label, quantity.unit),
        None => {
            let other = OTHERS.iter().find(|(name, _)| *name == column);
            let words = other.map(|(_, words)| (*words).to_owned());
            words.or_else(|| of_joint(column)).unwrap_or_else(|| column.replace('_', " "))
        }
    }
}

/// Median and span of each figure over the runs that reached their end. Its columns stand behind those of the
/// varied values; the status, the last one, is no number.
fn facts(record: &Record, rows: &RunRows) -> Vec<Fact> {
    let identity = &record.identity;
    let columns = identity.columns.iter().enumerate().skip(identity.vary.len());
    columns
        .filter_map(|(column, name)| {
            let ended = rows.values().filter(|row| status(row) == Status::Ok);
            let mut values: Vec<f64> =
                ended.filter_map(|row| row.get(column)?.parse().ok()).collect();
            values.sort_by(f64::total_cmp);
            let (least, most) = (values.first()?, values.last()?);
            if FORCES.contains(&name.as_str()) && (*least, *most) == (0.0, 0.0) {
                return None;
            }
            Some(Fact {
                label: in_words(name),
                note: format!("median; from {} to {}", number(*least), number(*most)),
                value: number(Data::new(values).median()),
            })
        })
        .collect()
}

fn provenance(record: &Record) -> Vec<(String, String)> {
    let identity = &record.identity;
    let more = [
        ("SHA-256 of all runs' scenarios", identity.runs_hash.clone()),
        ("Seed", identity.seed.to_string()),
    ];
    let mut entries = identity.provenance.lines("scenario", Some(SCENARIO_FILE), more);
    entries.extend(identity.vary.iter().map(|vary| ("Varied".to_owned(), vary.clone())));
    entries
}
