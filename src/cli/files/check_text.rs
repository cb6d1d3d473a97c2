//! The text of `freeplay check`.

use crate::cli::shared::table::paragraph;
use crate::report::{length, number};
use crate::study::{CheckedMachine, Engines};
use std::fmt::Write as _;

/// Everything about a machine, for people.
pub(in crate::cli) fn text(m: &CheckedMachine) -> String {
    let mut text = Text(String::new());
    text.line(&format!("{}, {} s", m.scenario_name, number(m.duration_s)));
    machine(&mut text, m);
    motion(&mut text, m);
    joints(&mut text, m);
    drives(&mut text, m);
    if let Some(engines) = &m.engines {
        two_engines(&mut text, engines);
    }
    text.0
}

/// How far the two engines are apart.
fn two_engines(text: &mut Text, engines: &Engines) {
    let Engines { tolerance_m_s, looked_at_s, apart } = engines;
    text.line("\nPhysics engine against direct integration");
    text.entry("tolerance", &format!("{} m/s a step, both", number(*tolerance_m_s)));
    let Some(apart) = apart else {
        text.line("  one of them broke down: `freeplay run` says why");
        return;
    };
    let until = if apart.to_the_end {
        format!("all of the {} s looked at", number(*looked_at_s))
    } else {
        format!("until {} s, where they are more than 1 µm apart", number(apart.until_s))
    };
    text.entry("alike", &until);
    text.entry("until then", &format!("{} of the output body", length(apart.position_m)));
    let force = format!(
        "{} of up to {} N",
        number(apart.contact_force),
        number(apart.largest_contact_force)
    );
    text.entry("  peaks of contacts", &force);
}

struct Text(String);

impl Text {
    fn line(&mut self, line: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.0, "{line}");
    }

    fn entry(&mut self, label: &str, value: &str) {
        self.0 += &paragraph(&format!("  {label:<21} "), &" ".repeat(24), value);
    }
}

fn machine(text: &mut Text, m: &CheckedMachine) {
    text.line("\nMachine");
    if let (Some(base), Some(platform)) = (m.base_side_m, m.platform_side_m) {
        let sides =
            format!("base triangle {}, platform triangle {}", length(base), length(platform));
        text.entry("sides", &sides);
    }
    for body in &m.bodies {
        let value =
            format!("{:>6} kg   {} kg m²", number(body.mass_kg), number(body.inertia_kg_m2));
        text.entry(&body.name, &value);
    }
}

/// What drives and loops of a machine other than the 3-RPR go through.
fn path(text: &mut Text, m: &CheckedMachine) {
    text.line("\nMotion");
    let f = &m.freedoms;
    let mut value = format!("{} (Grübler counts {}), {} driven", f.free, f.counted, f.driven);
    if !f.loose.is_empty() {
        let _ = write!(value, "; left to forces: {}", f.loose.join(", "));
    }
    text.entry("freedoms", &value);
    if !f.redundant.is_empty() {
        text.entry("redundant joints", &f.redundant.join(", "));
    }
    for of in &m.loops {
        let sense = if of.area_m2 > 0.0 { "counterclockwise" } else { "clockwise" };
        let value = format!("{sense}, {:.4} m²; mirrored is the other branch", of.area_m2.abs());
        text.entry(&format!("loop {}", of.joints.join("-")), &value);
    }
    for drive in &m.drives {
        let (Some([low, high]), Some(fastest)) = (drive.used, drive.fastest) else { continue };
        let unit = drive.unit;
        let mut value = format!("{low:.4} to {high:.4} {unit}, up to {} {unit}/s", number(fastest));
        if let Some(share) = drive.share_of_fastest_point {
            let _ =
                write!(value, "; the machine moves up to {} times as fast", number(1.0 / share));
        }
        text.entry(&format!("drive {}", drive.joint), &value);
    }
    if let Some(error) = m.table_error {
        text.entry("inverse kinematics", &format!("to {error:.0e} m or rad, tabulated"));
    }
}

/// The travel of the legs of a machine that has some.
fn motion(text: &mut Text, m: &CheckedMachine) {
    let (Some(fastest), Some(distance), Some(t), Some(circumradius)) = (
        m.fastest_leg_m_s,
        m.singularity_distance_m,
        m.singularity_time_s,
        m.platform_circumradius_m,
    ) else {
        path(text, m);
        return;
    };
    text.line("\nMotion");
    for (i, leg) in (1..).zip(&m.legs) {
        let [low, high] = leg.used_m;
        let [shortest, longest] = leg.stroke_m;
        let value = format!("{low:.4} to {high:.4} m   stroke {shortest} to {longest} m");
        text.entry(&format!("leg {i}"), &value);
    }
    text.entry("fastest leg", &format!("{} m/s", number(fastest)));
    let t = number(t);
    let value = if m.ideal.is_some() {
        let share = 100.0 * distance / circumradius;
        let far = length(distance);
        format!("{far} at t = {t} s ({} % of the platform's circumradius)", number(share))
    } else {
        format!("nothing: reached at t = {t} s")
    };
    text.entry("from singularity", &value);
}

fn joints(text: &mut Text, m: &CheckedMachine) {
    text.line(if m.joints.is_empty() { "\nSteps" } else { "\nJoints" });
    for joint in &m.joints {
        let mut value = match joint.clearance_m {
            Some(clearance) => format!("clearance {}", length(clearance)),
            None => "ideal".to_owned(),
        };
        if let Some(stiffness) = joint.stiffness {
            let _ = write!(value, "   K = {} N/m^n", number(stiffness));
        }
        if let Some(time) = joint.contact_time_s {
            let _ = write!(value, "   a hit lasts about {} µs", number(1e6 * time));
        }
        text.entry(&joint.joint, &value);
    }
    if m.law.kind().is_some() && !m.joints.is_empty() {
        text.line(&format!("  (hits taken at {} m/s)", number(m.impact_speed_m_s)));
    }
    let step = match (m.step_s, m.tolerance_m_s) {
        (Some(step), _) => format!("fixed, {} s", number(step)),
        (None, Some(tolerance)) => {
            format!("by error, {} m/s of velocity a step", number(tolerance))
        }
        (None, None) => String::new(),
    };
    text.entry("step", &step);
    let longest = m
        .longest_step_s
        .map_or_else(|| "nothing limits it".to_owned(), |longest| format!("{} s", number(longest)));
    text.entry("longest fixed step", &longest);
}

fn drives(text: &mut Text, m: &CheckedMachine) {
    text.line("\nDrives");
    let (force, stiffnesses) = match m.drives.first().map(|drive| drive.unit) {
        Some("rad") => ("N m", "N m/rad and {} N m s/rad"),
        _ => ("N", "N/m and {} N s/m"),
    };
    let kind = match (m.drive, m.servo_stiffness, m.servo_damping) {
        ("none", ..) => "none".to_owned(),
        ("servo", Some(stiffness), Some(damping)) => {
            let units = stiffnesses.replace("{}", &number(damping));
            format!("servo, {} {units}", number(stiffness))
        }
        ("sampled", ..) => "sampled controller".to_owned(),
        ("prescribed", ..) => "prescribed: joints follow the command exactly".to_owned(),
        (other, ..) => other.to_owned(),
    };
    text.entry("kind", &kind);
    match &m.ideal {
        Some(ideal) => {
            text.line("  without clearance the motion takes");
            for (drive, [low, high]) in m.drives.iter().zip(&ideal.actuator_forces) {
                let value = format!("{} to {} {force}", number(*low), number(*high));
                text.entry(&format!("  drive {}", drive.joint), &value);
            }
            let peak = format!("up to {} m/s²", number(ideal.peak_platform_acceleration_m_s2));
            text.entry("  acceleration", &peak);
        }
        None if m.drives.is_empty() || !m.freedoms.loose.is_empty() => {}
        None => text.line("  at a singularity no finite forces carry the motion"),
    }
}
