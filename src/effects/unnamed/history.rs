//! What a mechanism lacks for a while and nobody can name: efforts in joints over time.

use super::efforts::named_joints;
use crate::effects::Wrong;
use crate::mechanism::{JointIndex, Load, Mechanism, Situation};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What a history is a function of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OverTime {
    /// Time from the first row of a recording on.
    Time,
}

/// Efforts (N or N·m) on the slider or the journal's body of joints, tabulated over time: on straight lines
/// between instants, nothing before the first and after the last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct History {
    /// Always time.
    pub depends_on: OverTime,
    /// The joint where it shows most.
    pub joint: String,
    /// Name of the recording that it belongs to; none: it acts in every run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub run: Option<String>,
    /// When it begins, in s from the first row of the recording on.
    pub at_s: f64,
    /// When it ends, in s.
    pub until_s: f64,
    /// Integral of its effort at that joint over time, in N s or N m s.
    pub impulse: f64,
    /// The joints that are pushed.
    pub joints: Vec<String>,
    /// Instants in s from the first row of the recording on.
    pub t: Vec<f64>,
    /// Efforts at these instants, one list for each joint.
    pub efforts: Vec<Vec<f64>>,
}

impl History {
    /// The effort of the `k`-th of the joints at time `t` (s).
    fn at(&self, k: usize, t: f64) -> f64 {
        let next = self.t.partition_point(|instant| *instant <= t);
        if next == 0 || next == self.t.len() {
            return 0.0;
        }
        let share = (t - self.t[next - 1]) / (self.t[next] - self.t[next - 1]);
        let [before, after] = [self.efforts[k][next - 1], self.efforts[k][next]];
        before + (after - before) * share
    }

    /// Reads the keys of an `[[effect]]` of this kind.
    pub(in crate::effects) fn from_table(table: &toml::Table) -> Result<Self, Wrong> {
        let wrong = |message: &str| Wrong::torn("efforts", message);
        let read = Self::deserialize(table.clone()).map_err(|error| wrong(error.message()))?;
        let fits = |list: &Vec<f64>| list.len() == read.t.len();
        if read.efforts.len() != read.joints.len() || !read.efforts.iter().all(fits) {
            return Err(wrong("has lists that do not fit its joints and instants"));
        }
        if !read.t.is_sorted_by(|a, b| a < b) {
            return Err(wrong("has instants that do not grow"));
        }
        Ok(read)
    }
}

/// A history at work in a machine.
#[derive(Debug)]
struct AppliedHistory {
    history: Arc<History>,
    joints: Vec<JointIndex>,
}

/// Steps in s no shorter than this lead up to the first instant: a force that begins within one is no jump.
const LEAD_UP: f64 = 1e-4;

impl Load for AppliedHistory {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        for (k, joint) in self.joints.iter().enumerate() {
            let effort = self.history.at(k, at.t);
            if effort != 0.0 {
                at.push_joint(*joint, effort, wrenches);
            }
        }
    }

    /// Steps lead up to the first instant, and are no longer than from one instant to the next.
    fn longest_step_at(&self, at: Situation) -> Option<f64> {
        let t = &self.history.t;
        let (first, last) = (t.first()?, t.last()?);
        if at.t >= *last {
            return None;
        }
        let between = (last - first) / (t.len().max(2) - 1) as f64;
        Some((first - at.t).max(between).max(LEAD_UP))
    }
}

pub(super) fn apply(history: &Arc<History>, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let joints = named_joints(&history.joints, mechanism)?;
    mechanism.loads.push(Arc::new(AppliedHistory { history: Arc::clone(history), joints }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::Setting;
    use crate::effects::rigs::{WHEEL_AND_SLIDE, ended};

    const PUSH: &str = "kind = \"unnamed\"\ndepends_on = \"time\"\njoint = \"O\"\nat_s = 0.02\n\
                        until_s = 0.06\nimpulse = 0.006\njoints = [\"O\"]\nt = [0.02, 0.04, 0.06]\n\
                        efforts = [[0.0, 0.3, 0.0]]\n";

    /// Inertia 0.02 kg m², 5 rad/s before: a triangle of 0.3 N·m in 40 ms is an impulse of 6 mN·m·s.
    #[test]
    fn a_history_changes_rates_by_its_impulse() {
        let [wheel, slide] = ended(&format!("{WHEEL_AND_SLIDE}[[effect]]\n{PUSH}"), 0.1);
        assert!((wheel.twist.z - (5.0 + 0.006 / 0.02)).abs() < 1e-5, "{}", wheel.twist.z);
        assert!((slide.twist.x - 0.5).abs() < 1e-9, "{}", slide.twist.x);
    }

    #[test]
    fn a_history_is_read_as_it_is_written_and_refused_when_it_does_not_fit() {
        let table = |text: &str| {
            let mut table: toml::Table = toml::from_str(text).expect("TOML");
            table.remove("kind");
            Setting::from_table("unnamed", &table)
        };
        let read = table(PUSH).expect("a history");
        assert_eq!(table(&toml::to_string(&read).expect("TOML")), Ok(read));
        assert!(table(&PUSH.replace("0.3, 0.0]]", "0.3]]")).is_err());
        assert!(table(&PUSH.replace("[0.02, 0.04", "[0.05, 0.04")).is_err());
    }
}
