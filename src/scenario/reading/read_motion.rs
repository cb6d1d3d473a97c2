//! From the text of `[motion]` to what it moves, and how.

use super::lists::{OneOrMany, each, few, kind};
use super::reader::Reader;
use crate::scenario::{
    JointLine, JointMotion, JointMultisine, JointPath, JointQuintic, JointTable, Mechanism, Motion,
    MotionTarget,
};
use toml::{Table, Value};

/// The motion of a machine with a kind.
pub(super) fn motion(
    reader: &mut Reader<'_>,
    mechanism: &Mechanism,
    section: Option<OneOrMany>,
) -> Motion {
    match section {
        None => mechanism.default_motion(),
        Some(OneOrMany::One(mut table)) if mechanism.has_crank() => {
            table.entry("joint").or_insert_with(|| Value::String("O".to_owned()));
            let motion = joint_motion(reader, "motion", table);
            Motion::Joints(motion.into_iter().collect())
        }
        Some(OneOrMany::One(table)) => path(reader, table, Motion::default()),
        Some(OneOrMany::Many(_)) => {
            let help = "write [motion]: this machine has one";
            reader.complain("motion", "is a list".to_owned(), help.to_owned());
            Motion::default()
        }
    }
}

fn path(reader: &mut Reader<'_>, mut table: Table, default: Motion) -> Motion {
    let given = table.contains_key("kind");
    match reader.take_kind("motion", &mut table, &Motion::KINDS) {
        Some("line") => Motion::Line(reader.read("motion", table)),
        Some("quintic") => Motion::Quintic(reader.read("motion", table)),
        Some("multisine") => Motion::Multisine(reader.read("motion", table)),
        Some("table") => Motion::Table(reader.read("motion", table)),
        // An unknown kind is reported; its keys belong to nothing that could be checked.
        None if given => default,
        _ => Motion::Circle(reader.read("motion", table)),
    }
}

/// The motion of a machine that describes itself: of a body or a point, joint by joint, or from a table
/// of coordinates.
pub(super) fn described_motion(
    reader: &mut Reader<'_>,
    section: Option<OneOrMany>,
) -> (Motion, Option<MotionTarget>) {
    let mut table = match section {
        None => return (Motion::Rest, None),
        Some(OneOrMany::Many(tables)) => {
            let tables = few(reader, "motion", tables);
            let joints = each(reader, "motion", tables, joint_motion);
            return (Motion::Joints(joints), None);
        }
        Some(OneOrMany::One(table)) if table.contains_key("joint") => {
            let joint = joint_motion(reader, "motion", table);
            return (Motion::Joints(joint.into_iter().collect()), None);
        }
        Some(OneOrMany::One(table)) => table,
    };
    let mut target = None;
    for (key, of) in
        [("body", MotionTarget::Body as fn(String) -> MotionTarget), ("point", MotionTarget::Point)]
    {
        match table.remove(key) {
            Some(Value::String(name)) if target.is_none() => target = Some(of(name)),
            Some(Value::String(_)) => {
                let help = "keep one: body moves x, y and phi, point moves x and y".to_owned();
                reader.complain(&format!("motion.{key}"), "stands beside `body`".to_owned(), help);
            }
            Some(other) => reader.complain(
                &format!("motion.{key}"),
                format!("found {other}"),
                "expected a name, in quotes".to_owned(),
            ),
            None => {}
        }
    }
    let of_joints = table.get("kind").and_then(Value::as_str) == Some("table");
    if target.is_none() && !of_joints {
        let help = "write joint = \"…\", body = \"…\" or point = \"body.point\"; or a table of joint coordinates";
        reader.complain("motion", "does not say what it moves".to_owned(), help.to_owned());
    }
    if let Some(MotionTarget::Point(_)) = target {
        let mut unused = |at: &str, what: &str, instead: &str| {
            let help = format!("a point has no angle: {instead}, or move a body");
            reader.complain(&format!("motion.{at}"), what.to_owned(), help);
        };
        if table.contains_key("phi") {
            unused("phi", "is not used", "take it out");
        }
        for at in turning(&table) {
            unused(&at, "turns, which is not used", "write 0 for the third number");
        }
    }
    (path(reader, table, Motion::Rest), target)
}

/// Poses of a motion that turn, by keys.
fn turning(motion: &Table) -> Vec<String> {
    let turns = |pose: Option<&Value>| {
        let angle = pose.and_then(Value::as_array).and_then(|pose| pose.get(2));
        angle.is_some_and(|angle| angle.as_float() != Some(0.0) && angle.as_integer() != Some(0))
    };
    let poses = ["center", "from", "to"].into_iter().filter(|key| turns(motion.get(*key)));
    let terms = motion.get("terms").and_then(Value::as_array).into_iter().flatten().enumerate();
    let terms = terms.filter(|(_, term)| turns(term.get("amplitude")));
    let terms = terms.map(|(i, _)| format!("terms.{i}.amplitude"));
    poses.map(str::to_owned).chain(terms).collect()
}

fn joint_motion(reader: &mut Reader<'_>, path: &str, mut table: Table) -> Option<JointMotion> {
    let joint = match table.remove("joint") {
        Some(Value::String(joint)) => joint,
        Some(other) => {
            let help = "expected the name of a joint, in quotes".to_owned();
            reader.complain(&format!("{path}.joint"), format!("found {other}"), help);
            return None;
        }
        None => {
            let help = "write joint = \"…\": a list of motions moves joints".to_owned();
            reader.complain(&format!("{path}.joint"), "is missing".to_owned(), help);
            return None;
        }
    };
    let coordinate = match kind(reader, path, &mut table, &JointPath::KINDS, "motion")? {
        "quintic" => JointPath::Quintic(reader.required::<JointQuintic>(path, table)?),
        "multisine" => JointPath::Multisine(reader.read::<JointMultisine>(path, table)),
        "table" => JointPath::Table(reader.read::<JointTable>(path, table)),
        _ => JointPath::Line(reader.read::<JointLine>(path, table)),
    };
    Some(JointMotion { joint, path: coordinate })
}
