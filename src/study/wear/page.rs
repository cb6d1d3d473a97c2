//! The page of a prediction of wear.

use super::around::{rings as round_rings, round};
use super::files::{SHAPES_FILE, STAGES_FILE, WEAR_PREDICTED_FILE, WORN_FILE};
use super::result::{RingWear, WearSummary, depths};
use super::rings::Ring;
use super::stage::Stage;
use crate::report::{
    Curve, PagePart, PageTable, Panel, Picture, ReportError, Style, document, length, number,
    panels_svg,
};
use crate::results::SCENARIO_FILE;

/// Stages whose shapes are drawn beside the last.
const DRAWN: usize = 4;

/// The pictures, in the order of the page.
pub(super) fn pictures(rings: &[Ring], stages: &[Stage]) -> Result<Vec<Picture>, ReportError> {
    Ok(vec![clearances(rings, stages)?, shapes(rings, stages)?, rubbed(rings, stages)?])
}

fn clearances(rings: &[Ring], stages: &[Stage]) -> Result<Picture, ReportError> {
    let panel = |(i, ring): (usize, &Ring)| {
        let curve = |name: &str, of: &dyn Fn(&Stage) -> f64| Curve {
            name: name.to_owned(),
            points: stages.iter().map(|stage| (stage.cycles, 1e6 * of(stage))).collect(),
            style: Style::Solid,
        };
        Panel {
            title: format!("Joint {}", ring.name),
            x_label: "cycles".into(),
            y_label: "clearance (µm)".into(),
            curves: vec![
                curve("mean", &|stage| stage.plays[i].mean()),
                curve("where it is widest", &|stage| stage.plays[i].largest()),
            ],
        }
    };
    let panels: Vec<Panel> = rings.iter().enumerate().map(panel).collect();
    Ok(Picture {
        file: "clearances.svg".to_owned(),
        title: "Clearance over cycles".to_owned(),
        caption:
            "Radial clearance of each joint: its mean round the ring, and where the ring is widest."
                .to_owned(),
        svg: panels_svg(&panels)?,
    })
}

/// Stages to be drawn: the last, and those nearest to equal parts of the way.
fn drawn(stages: &[Stage]) -> Vec<&Stage> {
    let end = stages.last().map_or(0.0, |stage| stage.cycles);
    let mut chosen: Vec<&Stage> = Vec::new();
    for part in 1..=DRAWN {
        let wanted = end * part as f64 / DRAWN as f64;
        let far = |stage: &&Stage| (stage.cycles - wanted).abs();
        let near = stages.iter().skip(1).min_by(|a, b| far(a).total_cmp(&far(b)));
        if let Some(near) = near.filter(|near| chosen.iter().all(|c| c.cycles != near.cycles)) {
            chosen.push(near);
        }
    }
    chosen
}

fn shapes(rings: &[Ring], stages: &[Stage]) -> Result<Picture, ReportError> {
    let joint = |(i, ring): (usize, &Ring)| {
        let curve = |stage: &&Stage| {
            let depths = depths(&stages[0].plays[i], &stage.plays[i]);
            let depths: Vec<f64> = depths.iter().map(|depth| 1e6 * depth).collect();
            round(&format!("{} cycles", number(stage.cycles)), &depths)
        };
        (ring.name.clone(), drawn(stages).iter().map(curve).collect())
    };
    let joints: Vec<_> = rings.iter().enumerate().map(joint).collect();
    round_rings(
        &joints,
        "depth (µm)",
        "depths.svg",
        [
            "How deep the rings have worn",
            "What is worn off each ring by the direction in which its surface faces, seen from the ring's body.",
        ],
    )
}

fn rubbed(rings: &[Ring], stages: &[Stage]) -> Result<Picture, ReportError> {
    let last = &stages[stages.len() - 1];
    let joint = |(i, ring): (usize, &Ring)| {
        let (new, worn) = (round("new", &stages[0].rubbed[i]), round("worn", &last.rubbed[i]));
        (ring.name.clone(), vec![new, worn])
    };
    let joints: Vec<_> = rings.iter().enumerate().map(joint).collect();
    round_rings(
        &joints,
        "J per cycle and degree",
        "wear.svg",
        [
            "Where the rings wear",
            "Normal force times sliding distance in a cycle, on the new rings and in the last run.",
        ],
    )
}

/// The page as HTML.
pub(super) fn page(summary: &WearSummary, pictures: &[Picture]) -> String {
    let title = format!("Wear: {}", summary.provenance.scenario_name);
    let by_growth = |a: &&RingWear, b: &&RingWear| a.worn.depth_m.total_cmp(&b.worn.depth_m);
    let most = summary.joints.iter().max_by(by_growth);
    let most = most.map_or(String::new(), |joint| {
        format!(
            " Joint {} wears most: by {} where it is deepest, its mean clearance of {} grows by {}.",
            joint.joint,
            length(joint.worn.depth_m),
            length(joint.new_clearance_m),
            length(joint.worn.clearance_m - joint.new_clearance_m)
        )
    });
    let lead = format!(
        "The rings after {} cycles of {} s, by Archard's law.{most} {WORN_FILE} beside this page is the worn machine.",
        number(summary.cycles),
        number(summary.period_s)
    );
    let more = [
        (
            "Figures",
            format!("{WEAR_PREDICTED_FILE}, {STAGES_FILE}, {SHAPES_FILE} beside this page"),
        ),
        ("Time of computing", format!("{} s", number(summary.wall_s))),
    ];
    let provenance = summary.provenance.lines("scenario", Some(SCENARIO_FILE), more);
    let parts = [
        PagePart::Table(table(summary)),
        PagePart::Pictures(pictures),
        PagePart::Provenance(&provenance),
    ];
    document(&title, &lead, &parts)
}

fn table(summary: &WearSummary) -> PageTable {
    let header = [
        "joint",
        "wear coefficient (1/Pa)",
        "clearance new",
        "worn, mean",
        "worn, largest",
        "deepest wear",
        "volume (mm³)",
        "error",
    ];
    let row = |joint: &RingWear| {
        vec![
            joint.joint.clone(),
            format!("{:e}", joint.coefficient),
            length(joint.new_clearance_m),
            length(joint.worn.clearance_m),
            length(joint.worn.largest_clearance_m),
            length(joint.worn.depth_m),
            number(1e9 * joint.worn.volume_m3),
            length(joint.error_m),
        ]
    };
    PageTable {
        id: "rings",
        title: "Rings".to_owned(),
        header: header.map(str::to_owned).to_vec(),
        rows: summary.joints.iter().map(row).collect(),
        note: match summary.stages.len() - 1 {
            1 => "The error is what halving the one jump over cycles changes.".to_owned(),
            jumps => format!(
                "The error is what halving the jumps over cycles changes, of all {jumps} jumps together."
            ),
        },
    }
}
