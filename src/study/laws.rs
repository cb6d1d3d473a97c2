//! What a contact law does in one hit: its force over the penetration, and what it returns over the speed.

use crate::contact::laws::{LawKind, Losses};
use crate::contact::{ForceLaw, hit, impact};
use crate::mechanism::Bearing;
use crate::report::{Curve, Label, Panel, Picture, Style, panels_svg};
use crate::results::Folder;
use crate::results::to_json;
use crate::results::{RunError, refused};
use crate::scenario::{Law, Problem, Problems, Scenario};
use crate::simulate::assemble;
use serde::{Serialize, Serializer};
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

/// The JSON file of the pictures of laws, by which their folder is known.
pub const LAWS_FILE: &str = "laws.json";

/// The hit of the pictures: a journal's mass in kg and its speed in m/s, between the many slow hits of the
/// built-in machine and the few hard ones.
pub const MASS: f64 = 0.1;
/// See [`MASS`].
pub const SPEED: f64 = 0.1;

/// Range of speeds in m/s over which restitution is drawn: from those that a run's error hides to the hardest
/// hits of the built-in machine.
const SPEEDS: [f64; 2] = [1e-3, 1.0];

/// Speeds per picture: a smooth curve.
const SPEED_COUNT: usize = 25;

/// Points of a loop: one per pixel or so.
const LOOP_POINTS: usize = 400;

/// One law in one hit after another.
#[derive(Clone, Debug, Serialize)]
pub struct LawFigures {
    /// The law.
    #[serde(rename = "law", serialize_with = "by_name")]
    pub kind: &'static LawKind,
    /// Mass of the journal, kg.
    pub mass_kg: f64,
    /// Speed of the hit of the loop, m/s.
    pub speed_m_s: f64,
    /// Penetration (m) and force (N) through that hit.
    #[serde(rename = "force_over_penetration_m_N")]
    pub cycle: Vec<(f64, f64)>,
    /// Impact speed (m/s) and the share of it that is returned.
    #[serde(rename = "returned_over_speed_m_s")]
    pub returned: Vec<(f64, f64)>,
}

fn by_name<S: Serializer>(kind: &LawKind, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(kind.name)
}

/// What [`LAWS_FILE`] says.
#[derive(Serialize)]
struct WrittenLaws<'a> {
    program: &'a str,
    version: &'a str,
    laws: &'a [LawFigures],
    files: &'a [String],
}

/// Figures and their files.
#[derive(Debug)]
pub struct DrawnLaws {
    /// The text of [`LAWS_FILE`].
    pub json: String,
    /// Where the files are.
    pub folder: PathBuf,
    /// Their names.
    pub files: Vec<String>,
}

/// The law as it acts in the first joint of the built-in machine, with `sets` of the scenario.
///
/// # Errors
/// Values that the law cannot take.
pub fn law_of(kind: &'static LawKind, sets: &[String]) -> Result<Arc<dyn ForceLaw>, Problems> {
    let named = format!("contact.law={}", kind.name);
    let sets: Vec<String> = [named].into_iter().chain(sets.iter().cloned()).collect();
    let scenario = Scenario::load(None, &sets)?;
    let machine = assemble(&scenario).map_err(Problems::from)?;
    let law = machine.mechanism.revolutes.iter().find_map(|joint| match &joint.bearing {
        Bearing::Clearance(clearance) => Some(clearance.law.clone()),
        Bearing::Ideal | Bearing::Native { .. } => None,
    });
    law.ok_or_else(|| {
        let message = format!("leaves no joint to the law \"{}\"", Law::of(kind).name());
        let problem: Problem =
            scenario.problem("contact.law", message, "set parameters of the law alone");
        problem.into()
    })
}

/// What a law does in hits of [`MASS`].
///
/// ```
/// use freeplay::contact::laws::named;
/// use freeplay::study::laws::{figures, law_of};
///
/// let kind = named("hertz").unwrap();
/// let figures = figures(kind, &*law_of(kind, &[])?);
/// assert!(figures.returned.iter().all(|(_, share)| (share - 1.0).abs() < 1e-2), "an elastic law returns all");
/// # Ok::<(), freeplay::scenario::Problems>(())
/// ```
pub fn figures(kind: &'static LawKind, law: &dyn ForceLaw) -> LawFigures {
    let mut all = vec![(0.0, law.normal_force_after(f64::MIN_POSITIVE, SPEED, SPEED))];
    hit(law, MASS, SPEED, &mut |state| all.push((state.depth, state.force)));
    let stride = all.len().div_ceil(LOOP_POINTS);
    let last = all.last().copied();
    let cycle = all.into_iter().step_by(stride).chain(last).collect();
    let [slow, fast] = SPEEDS;
    let returned = (0..SPEED_COUNT).map(|k| {
        let speed = slow * (fast / slow).powf(k as f64 / (SPEED_COUNT - 1) as f64);
        (speed, impact(law, MASS, speed).rebound / speed)
    });
    let returned = returned.collect();
    LawFigures { kind, mass_kg: MASS, speed_m_s: SPEED, cycle, returned }
}

/// Writes figures and their pictures into `folder`.
///
/// # Errors
/// A file that cannot be written; the folder is left as it was.
pub fn write_laws(all: &[LawFigures], folder: Folder) -> Result<DrawnLaws, RunError> {
    let pictures = pictures(all)?;
    let files = pictures.iter().map(|picture| picture.file.clone());
    let files: Vec<String> = [LAWS_FILE.to_owned()].into_iter().chain(files).collect();
    let [program, version] = [env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION")];
    let json = to_json(&WrittenLaws { program, version, laws: all, files: &files });
    let write = |name: &str, text: &str| fs::write(folder.file(name), text).map_err(refused(name));
    write(LAWS_FILE, &json)?;
    for picture in &pictures {
        write(&picture.file, &picture.svg)?;
    }
    Ok(DrawnLaws { json, folder: folder.finish()?, files })
}

/// A group of laws that is drawn in one panel: line contacts are far stiffer than points, and too many curves hide
/// each other.
fn family(kind: &LawKind) -> &'static str {
    match kind.losses {
        _ if kind.takes("length") => "of line contact",
        Losses::Restitution => "by restitution",
        Losses::Elastic | Losses::Damping | Losses::Step => "by damping, and elastic",
    }
}

/// What is drawn of a law, in the units of the axes.
type Points = fn(&LawFigures) -> Vec<(f64, f64)>;

fn pictures(all: &[LawFigures]) -> Result<Vec<Picture>, RunError> {
    let hit = format!("one hit of {MASS} kg at {SPEED} m/s");
    let loops: Points =
        |law| law.cycle.iter().map(|(depth, force)| (1e6 * depth, *force)).collect();
    let returned: Points =
        |law| law.returned.iter().map(|(speed, e)| (speed.log10(), *e)).collect();
    Ok(vec![
        picture(
            all,
            "force-penetration.svg",
            &hit,
            ["penetration (µm)".into(), "force (N)".into()],
            loops,
        )?,
        picture(
            all,
            "restitution.svg",
            &format!("what hits of {MASS} kg return"),
            [Label::log("impact speed (m/s)"), "returned / impact speed".into()],
            returned,
        )?,
    ])
}

/// One panel a family.
fn picture(
    all: &[LawFigures],
    file: &str,
    what: &str,
    [x, y]: [Label; 2],
    points: Points,
) -> Result<Picture, RunError> {
    let mut panels: Vec<Panel> = Vec::new();
    for law in all {
        let title = format!("Laws {}: {what}", family(law.kind));
        let curve =
            Curve { name: law.kind.name.to_owned(), points: points(law), style: Style::Solid };
        match panels.iter_mut().find(|panel| panel.title == title) {
            Some(panel) => panel.curves.push(curve),
            None => panels.push(Panel {
                title,
                x_label: x.clone(),
                y_label: y.clone(),
                curves: vec![curve],
            }),
        }
    }
    let svg = panels_svg(&panels)?;
    Ok(Picture { file: file.to_owned(), title: what.to_owned(), caption: String::new(), svg })
}
