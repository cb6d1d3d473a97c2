//! What a prediction of wear comes to.

use super::around::{angles, table};
use super::request::WearRequest;
use super::rings::Ring;
use super::stage::Stage;
use crate::contact::Play;
use crate::scenario::Scenario;
use crate::simulate::Provenance;
use serde::Serialize;

/// The figures of a prediction.
#[derive(Clone, Debug, Serialize)]
pub struct WearSummary {
    /// Program, versions, scenario.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Cycles predicted.
    pub cycles: f64,
    /// Time of one in s.
    pub period_s: f64,
    /// Largest error of a jump, as a share of a clearance.
    pub tolerance: f64,
    /// Each ring before and after.
    pub joints: Vec<RingWear>,
    /// After each jump, from the start on.
    pub stages: Vec<StageSummary>,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
}

/// One ring before and after.
#[derive(Clone, Debug, Serialize)]
pub struct RingWear {
    /// Name of its joint.
    pub joint: String,
    /// Wear coefficient in 1/Pa.
    #[serde(rename = "wear_coefficient_1_Pa")]
    pub coefficient: f64,
    /// Axial length in m.
    pub length_m: f64,
    /// Clearance before in m: its mean round the ring.
    pub new_clearance_m: f64,
    /// What it is after all cycles.
    #[serde(flatten)]
    pub worn: JointWear,
    /// What halving the jumps changes in m: the prediction's own error.
    pub error_m: f64,
}

/// The rings after some cycles.
#[derive(Clone, Debug, Serialize)]
pub struct StageSummary {
    /// Cycles since the start.
    pub cycles: f64,
    /// Each ring.
    pub joints: Vec<JointWear>,
}

/// One ring after some cycles.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct JointWear {
    /// Mean clearance round the ring in m.
    pub clearance_m: f64,
    /// Where it is widest, in m.
    pub largest_clearance_m: f64,
    /// Deepest wear in m.
    pub depth_m: f64,
    /// Volume worn off in m³.
    pub volume_m3: f64,
    /// Normal force times sliding distance in J per cycle.
    #[serde(rename = "wear_J_per_cycle")]
    pub rubbed_per_cycle: f64,
}

fn joint(ring: &Ring, new: &Play, worn: &Play, rubbed: &[f64]) -> JointWear {
    JointWear {
        clearance_m: worn.mean(),
        largest_clearance_m: worn.largest(),
        depth_m: new.apart(worn),
        volume_m3: ring.volume(new, worn),
        rubbed_per_cycle: rubbed.iter().sum(),
    }
}

/// A stage's rings; `start` is the first stage.
fn joints(rings: &[Ring], start: &Stage, stage: &Stage) -> Vec<JointWear> {
    let each = rings.iter().enumerate();
    each.map(|(i, ring)| joint(ring, &start.plays[i], &stage.plays[i], &stage.rubbed[i])).collect()
}

pub(super) fn summary(
    scenario: &Scenario,
    rings: &[Ring],
    request: WearRequest,
    stages: &[Stage],
) -> WearSummary {
    let of = |stage: &Stage| StageSummary {
        cycles: stage.cycles,
        joints: joints(rings, &stages[0], stage),
    };
    let (start, end) = (&stages[0], &stages[stages.len() - 1]);
    let ends = joints(rings, start, end);
    let each = rings.iter().zip(ends).enumerate();
    let ring = |(i, (ring, worn)): (usize, (&Ring, JointWear))| RingWear {
        joint: ring.name.clone(),
        coefficient: ring.coefficient,
        length_m: ring.length,
        new_clearance_m: start.plays[i].mean(),
        worn,
        error_m: end.errors[i],
    };
    WearSummary {
        provenance: Provenance::of(scenario),
        cycles: request.cycles,
        period_s: request.period,
        tolerance: request.tolerance,
        joints: each.map(ring).collect(),
        stages: stages.iter().map(of).collect(),
        wall_s: 0.0,
        files: Vec::new(),
    }
}

/// `cycles`, and for each joint J `clearance_J`, `largest_clearance_J`, `depth_J` (m), `wear_J` (J per cycle).
pub(super) fn stages_csv(rings: &[Ring], stages: &[Stage]) -> String {
    let names = rings.iter().flat_map(|ring| {
        ["clearance", "largest_clearance", "depth", "wear"]
            .map(|head| format!("{head}_{}", ring.name))
    });
    let heads: Vec<String> = ["cycles".to_owned()].into_iter().chain(names).collect();
    let rows = stages.iter().map(|stage| joints(rings, &stages[0], stage)).collect::<Vec<_>>();
    let of = |figure: fn(&JointWear) -> f64, i: usize| -> Vec<f64> {
        rows.iter().map(|row| figure(&row[i])).collect()
    };
    let figures: [fn(&JointWear) -> f64; 4] = [
        |joint| joint.clearance_m,
        |joint| joint.largest_clearance_m,
        |joint| joint.depth_m,
        |joint| joint.rubbed_per_cycle,
    ];
    let cycles = stages.iter().map(|stage| stage.cycles).collect();
    let columns = (0..rings.len()).flat_map(|i| figures.map(|figure| of(figure, i)));
    table(&heads, &[cycles].into_iter().chain(columns).collect::<Vec<_>>())
}

/// `angle` (rad), and for each joint J `depth_J`, how deep its ring has worn there in m, and `profile_J`, what the ring is
/// wider by than its declared clearance (m), as the key `profile` of a joint takes it.
pub(super) fn shapes_csv(rings: &[Ring], stages: &[Stage]) -> String {
    let names = rings
        .iter()
        .flat_map(|ring| ["depth", "profile"].map(|head| format!("{head}_{}", ring.name)));
    let heads: Vec<String> = ["angle".to_owned()].into_iter().chain(names).collect();
    let last = &stages[stages.len() - 1];
    let columns = rings.iter().enumerate().flat_map(|(i, ring)| {
        [depths(&stages[0].plays[i], &last.plays[i]), last.plays[i].widening(ring.clearance)]
    });
    table(&heads, &[angles().collect()].into_iter().chain(columns).collect::<Vec<_>>())
}

/// How deep a ring has worn in each direction, in m.
pub(super) fn depths(new: &Play, worn: &Play) -> Vec<f64> {
    new.support().iter().zip(worn.support()).map(|(new, worn)| worn - new).collect()
}
