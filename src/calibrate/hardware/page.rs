//! The pages of the hardware studies.

use super::{ResultsTable, emps, pendulum};
use crate::calibrate::results::charts::{POINTS, thinned};
use crate::calibrate::results::result::to_json;
use crate::report::{self, Curve, PagePart, Panel, Picture, Style, panels_svg};
use crate::results::{Folder, PAGE_FILE, RunError, refused};
use serde_json::json;
use std::fs;
use std::path::PathBuf;

/// The JSON file of a study, by which its folder is known.
pub const STUDY_FILE: &str = "study.json";

/// A study on its way to its folder.
struct Page<'a> {
    title: &'a str,
    lead: String,
    tables: Vec<report::PageTable>,
    picture: Picture,
    limits: &'a [String],
}

impl Page<'_> {
    fn write(&self, folder: Folder) -> Result<PathBuf, RunError> {
        let picture = std::slice::from_ref(&self.picture);
        let mut parts: Vec<PagePart> = self.tables.iter().cloned().map(PagePart::Table).collect();
        parts.push(PagePart::Pictures(picture));
        let title = "What this does not prove";
        parts.push(PagePart::Text { id: "limits", title, paragraphs: self.limits });
        let html = report::document(self.title, &self.lead, &parts);
        let tables: serde_json::Map<String, serde_json::Value> = (self.tables.iter())
            .map(|table| {
                let rows: Vec<_> = [&table.header].into_iter().chain(&table.rows).collect();
                (table.id.to_owned(), json!(rows))
            })
            .collect();
        let files = [PAGE_FILE, &self.picture.file];
        let result = json!({
            "program": env!("CARGO_PKG_NAME"),
            "version": env!("CARGO_PKG_VERSION"),
            "study": self.title,
            "result": self.lead,
            "tables": tables,
            "files": files,
        });
        let write =
            |name: &str, text: &str| fs::write(folder.file(name), text).map_err(refused(name));
        write(STUDY_FILE, &to_json(&result))?;
        write(PAGE_FILE, &html)?;
        write(&self.picture.file, &self.picture.svg)?;
        Ok(folder.finish()?)
    }
}

fn table(id: &'static str, title: &str, table: ResultsTable, note: &str) -> report::PageTable {
    report::PageTable {
        id,
        title: title.to_owned(),
        header: table.header,
        rows: table.rows,
        note: note.to_owned(),
    }
}

fn picture(file: &str, title: &str, caption: &str, panels: &[Panel]) -> Result<Picture, RunError> {
    let svg = panels_svg(panels)?;
    Ok(Picture { file: file.to_owned(), title: title.to_owned(), caption: caption.to_owned(), svg })
}

fn panel(title: &str, label: &str, curves: Vec<(&str, Vec<(f64, f64)>)>) -> Panel {
    let curve = |(name, points): (&str, Vec<(f64, f64)>)| Curve {
        name: name.to_owned(),
        points,
        style: Style::Solid,
    };
    Panel {
        title: title.to_owned(),
        x_label: "time (s)".into(),
        y_label: label.into(),
        curves: curves.into_iter().map(curve).collect(),
    }
}

/// Seconds of the training recording that are drawn: one stroke and its turns.
const DRAWN: std::ops::Range<f64> = 2.0..6.0;

/// Writes the page of the drive stage.
///
/// # Errors
/// Files that cannot be written.
pub fn emps_page(
    found: &emps::StageOutcome,
    folder: Folder,
) -> Result<(String, PathBuf), RunError> {
    let residual = |step: &emps::StageModel| -> Vec<(f64, f64)> {
        step.left.iter().copied().filter(|(t, _)| DRAWN.contains(t)).collect()
    };
    let panels: Vec<Panel> = (found.steps[1..].iter())
        .map(|step| {
            panel(&format!("With {}", step.name), "force left (N)", vec![("left", residual(step))])
        })
        .collect();
    let lead = found.lead();
    let page = Page {
        title: "A measured drive stage (EMPS)",
        lead: lead.clone(),
        tables: vec![
            table(
                "errors",
                "Errors of the force, step by step",
                found.table(),
                "Norm of the error over norm of the force, both through the same filter (Butterworth, \
                 fourth order, forward and backward, 50 Hz; 0.2 s left out at both ends). Each line has \
                 all that stands above it. All models are fitted to the training recording only; the \
                 halves are fitted each by itself and judged on the other. Simulated: the closed loop \
                 with the recorded reference as its only input. Published: Janot, Gautier, Brunot 2019.",
            ),
            table("traces", "What pointed to each effect", found.traces(), ""),
            table(
                "parameters",
                "What carries over to the pulses",
                found.parameters(),
                "Anew: identified on the first half of the pulses, judged on the second half in the next \
                 table. The phase of the screw is another one in the other recording, its amplitude alike: \
                 likely the encoder counts from elsewhere. Carried over with the wrong phase, the ripple \
                 makes the pulses worse.",
            ),
            table("anew", "Pulses, second half", found.second_half(), ""),
        ],
        picture: picture(
            "residual.svg",
            "What is left of the force",
            "Recorded less modelled force over one stroke of the training recording.",
            &panels,
        )?,
        limits: &[
            "Nobody has measured a clearance in this machine: nothing here says that the model of joints \
             with clearance is right. It says that the drive of a prismatic joint, simulated by the same \
             engine, is that of a real one to the given error."
                .to_owned(),
            "On the pulses most of what is left lies within a tenth of a second of their edges: whatever \
             gives way or answers late there is in the lag as far as one number goes, and not beyond."
                .to_owned(),
        ],
    };
    Ok((lead, page.write(folder)?))
}

/// Writes the page of the pendulum.
///
/// # Errors
/// Files that cannot be written.
pub fn pendulum_page(
    found: &pendulum::PendulumOutcome,
    folder: Folder,
) -> Result<(String, PathBuf), RunError> {
    let lead = found.lead();
    let mrad = |step: &pendulum::PendulumModel| -> Vec<(f64, f64)> {
        let points: Vec<_> = step.missed.iter().map(|(t, off)| (*t, 1e3 * off)).collect();
        thinned(&points, POINTS)
    };
    let steps = [&found.declared].into_iter().chain(&found.steps);
    let panels: Vec<Panel> = steps
        .map(|step| panel(step.name, "error (mrad)", vec![("predicted - recorded", mrad(step))]))
        .collect();
    let page = Page {
        title: "A measured pendulum",
        lead: lead.clone(),
        tables: vec![
            table(
                "errors",
                "Errors of the angle, model by model",
                found.table(),
                "Root mean square over windows of 2.5 s side by side, the start of each fitted through the model \
                 to the first 0.25 s, the rest compared. All models are fitted to id. Inertia and the encoder's \
                 zero are sought in all of them; what is not certain is left out.",
            ),
            table("carried", "For other swings of this pendulum", found.numbers(), ""),
        ],
        picture: picture(
            "deviation.svg",
            "Predicted less recorded angle",
            "Windows of val, model by model.",
            &panels,
        )?,
        limits: &[
            "Nobody has measured a clearance in this joint: nothing here says that the model of joints \
             with clearance is right. It says that a revolute joint and its friction, simulated by the \
             same equations, are those of a real one to the given error."
                .to_owned(),
            "Dry friction found in large swings is less than what the smallest swings show: below half \
             a radian the amplitude falls a little faster than any of these models says."
                .to_owned(),
            "A free swing shows m a g/J and friction over J, never mass or inertia by themselves."
                .to_owned(),
        ],
    };
    Ok((lead, page.write(folder)?))
}
