//! The page of a plan and its pictures.

use super::outcome::PlanOutcome;
use super::prepare::PreparedPlan;
use super::questions::separation::PosedQuestion;
use super::report::{MOTION_FILE, PLANNED_FILE, Planned};
use crate::calibrate::record::clean;
use crate::calibrate::results::charts::{POINTS, panel, thinned};
use crate::calibrate::results::result::CalibrateError;
use crate::calibrate::sensed::recording::Recording;
use crate::effects::Setting;
use crate::report::{Curve, PagePart, PageTable, Picture, Style, document, number, panels_svg};

/// Questions whose models are drawn: more would hide what matters.
const DRAWN: usize = 3;

/// The motion of each drive, and what each sensor would show of the models of each question.
pub fn pictures(
    prepared: &PreparedPlan,
    outcome: &PlanOutcome,
) -> Result<Vec<Picture>, CalibrateError> {
    let mut pictures = vec![motion(prepared, outcome)?];
    for (place, answered) in outcome.answers.iter().take(DRAWN).enumerate() {
        // What cannot be simulated is not drawn.
        if let Some(picture) = sensors(prepared, outcome, &answered.posed, place + 1)? {
            pictures.push(picture);
        }
    }
    Ok(pictures)
}

fn curve(name: &str, interval: f64, values: impl Iterator<Item = f64>, style: Style) -> Curve {
    let points: Vec<(f64, f64)> =
        values.enumerate().map(|(row, value)| (row as f64 * interval, value)).collect();
    Curve { name: name.to_owned(), points: thinned(&points, POINTS), style }
}

fn motion(prepared: &PreparedPlan, outcome: &PlanOutcome) -> Result<Picture, CalibrateError> {
    let PreparedPlan { interval, samples, present, declared, .. } = prepared;
    let mut panels = Vec::new();
    for (drive, (series, limit)) in outcome.motion.drives.iter().zip(&prepared.limits).enumerate() {
        let planned = |k: usize| (0..*samples).map(move |row| series.at(row as f64 * interval)[k]);
        let mut curves = Vec::new();
        if let Some(present) = present {
            let told = |reads: &crate::mechanism::Reads| matches!(reads, crate::mechanism::Reads::Command(of) if *of == drive);
            let sensor = declared.sensors.iter().position(|sensor| told(&sensor.reads));
            if let Some(command) = sensor.and_then(|sensor| present.get(sensor)) {
                curves.push(curve(
                    "present",
                    present.interval,
                    command.iter().copied(),
                    Style::Reference,
                ));
            }
        }
        curves.push(curve("planned", *interval, planned(0), Style::Solid));
        panels.push(panel(format!("{}, coordinate", limit.joint), limit.unit, curves.into_iter()));
        for (k, what, unit) in [(1, "rate", "/s"), (2, "acceleration", "/s²")] {
            let one = curve("planned", *interval, planned(k), Style::Solid);
            let unit = format!("{}{unit}", limit.unit);
            panels.push(panel(format!("{}, {what}", limit.joint), &unit, std::iter::once(one)));
        }
    }
    Ok(Picture {
        file: "motion.svg".to_owned(),
        title: "The planned motion".to_owned(),
        caption: format!(
            "What the drives are told; {MOTION_FILE} beside this page holds it row by row."
        ),
        svg: panels_svg(&panels)?,
    })
}

/// Each sensor's reading under the first model of a question less that under the second, without noise, in units of the
/// sensor's noise.
fn sensors(
    prepared: &PreparedPlan,
    outcome: &PlanOutcome,
    posed: &PosedQuestion,
    place: usize,
) -> Result<Option<Picture>, CalibrateError> {
    let PreparedPlan { described: rig, control, declared, interval, .. } = prepared;
    let recorded = |effects: &[Setting]| -> Option<Recording> {
        let all = clean((rig, effects), &outcome.like, &outcome.like, *control, 1).ok()?;
        all.into_iter().next()
    };
    let (first, second) = match posed {
        PosedQuestion::Between { pairs, .. } => {
            let Some([a, b]) = pairs.first() else { return Ok(None) };
            (recorded(std::slice::from_ref(a)), recorded(std::slice::from_ref(b)))
        }
        PosedQuestion::Detect { ways, .. } => {
            (ways.first().and_then(|way| recorded(std::slice::from_ref(way))), recorded(&[]))
        }
    };
    let (Some(first), Some(second)) = (first, second) else { return Ok(None) };
    let mut panels = Vec::new();
    for (i, sensor) in declared.sensors.iter().enumerate() {
        let Some((a, b)) = first.get(i).zip(second.get(i)).filter(|_| !sensor.tells()) else {
            continue;
        };
        let noise = crate::calibrate::sensed::simulate::deviation(sensor, b);
        let difference = a.iter().zip(b).map(|(a, b)| (a - b) / noise);
        let one = curve("difference", *interval, difference, Style::Solid);
        panels.push(panel(sensor.column.clone(), "standard deviations", std::iter::once(one)));
    }
    let what = match posed {
        PosedQuestion::Between { rivals: [a, b], .. } => format!("with {a}, against {b}"),
        PosedQuestion::Detect { effect, .. } => format!("with {effect}, less without"),
    };
    Ok(Some(Picture {
        file: format!("sensors-{place}.svg"),
        title: format!("What each sensor would show {what}"),
        caption: "Simulated along the planned motion without sensor noise, in standard deviations of it at one row; of \
                  machines that rattle the rattle of both is in it."
            .to_owned(),
        svg: panels_svg(&panels)?,
    }))
}

/// The page.
pub fn page(planned: &Planned, pictures: &[Picture]) -> String {
    let provenance = planned.provenance.lines(
        "rig",
        None,
        [
            ("The motion", format!("{MOTION_FILE}; the rig with it: {PLANNED_FILE}")),
            ("Motions tried", planned.candidates.to_string()),
            ("Seed", planned.seed.to_string()),
            ("Time of computing", format!("{} s", number(planned.wall_s))),
        ],
    );
    let mut parts = vec![PagePart::Table(separations(planned)), PagePart::Table(carried(planned))];
    if !planned.sensors.is_empty() {
        parts.push(PagePart::Table(instruments(planned)));
    }
    parts.push(PagePart::Table(limits(planned)));
    parts.push(PagePart::Pictures(pictures));
    parts.push(PagePart::Provenance(&provenance));
    let title = format!("What to record next: {}", planned.provenance.scenario_name);
    document(&title, &planned.summary, &parts)
}

fn head(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn separations(planned: &Planned) -> PageTable {
    let dash = || "–".to_owned();
    let percent = |chance: f64| format!("{:.0} %", 100.0 * chance);
    let rows = planned.questions.iter().map(|question| {
        let before = question.before.as_ref();
        let values = question.effects.iter().map(|effect| {
            let values = effect
                .params
                .iter()
                .filter_map(|(name, value)| Some(format!("{name} {}", number(value.as_f64()?))));
            format!(
                "{}{}: {}",
                effect.kind,
                effect.on.words(),
                values.collect::<Vec<_>>().join(", ")
            )
        });
        vec![
            question.question.clone(),
            values.collect::<Vec<_>>().join("; "),
            before.map_or_else(dash, |answer| number(answer.sigma)),
            number(question.after.sigma),
            number(question.wanted_sigma),
            before.map_or_else(dash, |answer| percent(answer.chance)),
            percent(question.after.chance),
        ]
    });
    PageTable {
        id: "separation",
        title: "How far apart, in standard deviations".into(),
        header: head(&["question", "held against each other", "present", "planned", "answers it", "right by chance, present", "planned"]),
        rows: rows.collect(),
        note: "Of the residuals' noise, sensors and rattle. Of rivals what no values of the other make good; of an effect \
               its way that shows least."
            .into(),
    }
}

fn carried(planned: &Planned) -> PageTable {
    let rows = planned.questions.iter().flat_map(|question| {
        question.after.carried_by.iter().map(|carried| {
            let share = format!("{:.0} %", 100.0 * carried.share);
            vec![question.question.clone(), carried.residual.clone(), share]
        })
    });
    PageTable {
        id: "carried",
        title: "What carries it on the planned motion".into(),
        header: head(&["question", "residual", "share"]),
        rows: rows.collect(),
        note: "Shares of the square of the separation. Law: a drive's measured force against its command; dynamics: \
               forces against the motion; closure and acceleration: that sensor against the others."
            .into(),
    }
}

fn instruments(planned: &Planned) -> PageTable {
    let rows = planned.sensors.iter().map(|sensor| {
        let sigma: Vec<String> = sensor.sigma.iter().map(|sigma| number(*sigma)).collect();
        vec![sensor.sensor.clone(), sigma.join("; "), format!("{} times", number(sensor.gain))]
    });
    PageTable {
        id: "sensors",
        title: "One more sensor, on the planned motion".into(),
        header: head(&["sensor", "standard deviations, question by question", "the least grows"]),
        rows: rows.collect(),
        note:
            "With the noise of the rig's own sensors of that quantity, else of a good laboratory's."
                .into(),
    }
}

fn limits(planned: &Planned) -> PageTable {
    let rows = planned.drives.iter().map(|drive| {
        let limit = &drive.limit;
        let used = |used: f64, most: f64| format!("{} of {}", number(used), number(most));
        let force = match (drive.used_force, limit.force) {
            (Some(force), Some(most)) => used(force, most),
            (Some(force), None) => format!("{}, not limited", number(force)),
            (None, Some(most)) => format!("{} at most, by the ideal machine", number(most)),
            (None, None) => "not limited".to_owned(),
        };
        vec![
            limit.joint.clone(),
            format!(
                "{} to {} of {} to {} {}",
                number(drive.used_stroke[0]),
                number(drive.used_stroke[1]),
                number(limit.stroke[0]),
                number(limit.stroke[1]),
                limit.unit
            ),
            format!("{} {}/s", used(drive.used_speed, limit.speed), limit.unit),
            format!("{} {}/s²", used(drive.used_acceleration, limit.acceleration), limit.unit),
            format!("{force} {}", drive.force_unit),
            format!("{}; {}", limit.stroke_from, limit.from),
        ]
    });
    PageTable {
        id: "limits",
        title: "Limits, and what the motion takes of them".into(),
        header: head(&["drive", "stroke", "speed", "acceleration", "force", "from"]),
        rows: rows.collect(),
        note: "Stroke from the first, the others from the second of the two.".into(),
    }
}
