//! Mechanism files that cannot be right: exit code 2, file, line, key, what is wrong, what would be right.

use crate::cli_common::{Done, Place};
use crate::files::{FOUR_BAR, line, with};

/// A file with one mistake.
pub struct Wrong {
    text: String,
    /// The mistake stands on the line of this passage.
    at: &'static str,
    /// What follows `file:line: `: the key and the message.
    says: &'static str,
    /// What else must be said, the help among it.
    and: &'static [&'static str],
}

pub fn wrong(
    text: String,
    at: &'static str,
    says: &'static str,
    and: &'static [&'static str],
) -> Wrong {
    Wrong { text, at, says, and }
}

/// The four-bar with one passage replaced.
pub fn four_bar(from: &str, to: &str) -> String {
    with(FOUR_BAR, from, to)
}

/// The four-bar with another motion.
pub fn moved(motion: &str) -> String {
    four_bar("joint = \"O\"\nkind = \"line\"\nvelocity = 6.0\n", motion)
}

/// All of them must be refused by `check` and by `run`, which leaves nothing behind.
pub fn refuse(cases: Vec<Wrong>) {
    let place = Place::new();
    let mut missed = String::new();
    for Wrong { text, at, says, and } in cases {
        place.write("bad.toml", &text);
        let said = format!("bad.toml:{}: {says}", line(&text, at));
        for command in ["check bad.toml", "run bad.toml --out x"] {
            let done = place.freeplay(command);
            let mut lacks: Vec<&str> =
                and.iter().copied().filter(|f| !done.err.contains(f)).collect();
            if !done.err.contains(&said) {
                lacks.push(&said);
            }
            let right = done.code == 2 && done.err.starts_with("error: ") && lacks.is_empty();
            if !right || place.entries() != ["bad.toml"] {
                let Done { code, err, .. } = done;
                missed += &format!("{command}: code {code}, says\n{err}  lacks {lacks:?}\n\n");
            }
        }
    }
    assert!(missed.is_empty(), "{missed}");
}

#[test]
fn names_that_nothing_has() {
    let drive = "[[drive]]\njoint = \"O\"\n";
    refuse(vec![
        wrong(
            four_bar("\"crank.A\"", "\"crnak.A\""),
            "ring = \"crnak.A\"",
            "joint.1.ring: there is no body \"crnak\"",
            &["did you mean \"crank\"?"],
        ),
        wrong(
            four_bar("\"coupler.B\"", "\"coupler.Bb\""),
            "journal = \"coupler.Bb\"",
            "joint.2.journal: \"coupler\" has no point \"Bb\"",
            &["did you mean \"B\"?"],
        ),
        wrong(
            four_bar("ring = \"ground.D\"", "ring = \"ground.Q\""),
            "ring = \"ground.Q\"",
            "joint.3.ring: \"ground\" has no point \"Q\"",
            &["known here: D, O"],
        ),
        wrong(
            four_bar("ring = \"ground.D\"", "ring = \"D\""),
            "ring = \"D\"",
            "joint.3.ring: is \"D\"",
            &["expected \"body.point\", such as \"ground.O\""],
        ),
        wrong(
            four_bar("ring = \"ground.D\"\n", ""),
            "[[joint]]\nname = \"D\"",
            "joint.3.ring: is missing",
            &["expected \"body.point\""],
        ),
        wrong(
            four_bar(drive, "[[drive]]\njoint = \"Oo\"\n"),
            "joint = \"Oo\"",
            "drive.0.joint: there is no joint \"Oo\"",
            &["did you mean \"O\"?"],
        ),
        wrong(
            moved("joint = \"crank\"\nkind = \"line\"\n"),
            "joint = \"crank\"",
            "motion.joint: there is no joint \"crank\"",
            &["known here: O, A, B, D"],
        ),
        wrong(
            format!("{FOUR_BAR}[[spring]]\nbetween = [\"rocker.B\", \"ground.S\"]\n"),
            "between = ",
            "spring.0.between.1: \"ground\" has no point \"S\"",
            &["known here: D, O"],
        ),
        wrong(
            format!("{FOUR_BAR}[[output]]\nbody = \"roker\"\n"),
            "body = \"roker\"",
            "output.0.body: there is no body \"roker\"",
            &["did you mean \"rocker\"?"],
        ),
    ]);
}

#[test]
fn unknown_keys_and_missing_kinds() {
    refuse(vec![
        wrong(
            four_bar("bearing_radius = 0.008", "bearing_radus = 0.008"),
            "bearing_radus",
            "unknown key `joint.1.bearing_radus`",
            &["did you mean `bearing_radius`?"],
        ),
        wrong(
            four_bar("mass = 0.2\n", "mas = 0.2\n"),
            "mas = 0.2",
            "unknown key `body.1.mas`",
            &["did you mean `mass`?"],
        ),
        wrong(four_bar("[[joint]]\n", "[[joints]]\n"), "[[joints]]", "joints: ", &["[[joint]]"]),
        wrong(
            four_bar("name = \"D\"\nkind = \"revolute\"\n", "name = \"D\"\n"),
            "[[joint]]\nname = \"D\"",
            "joint.3.kind: is missing",
            &["write kind = \"revolute\", or prismatic, fixed"],
        ),
        wrong(
            four_bar("kind = \"servo\"\n", ""),
            "[[drive]]",
            "drive.0.kind: is missing",
            &["write kind = \"prescribed\", or servo, sampled, force"],
        ),
        wrong(
            four_bar("kind = \"servo\"\n", "kind = \"srevo\"\n"),
            "kind = \"srevo\"",
            "drive.0.kind: \"srevo\" is not a kind of drive",
            &["did you mean `servo`?"],
        ),
        wrong(
            four_bar("stiffness = 400.0\n", ""),
            "[[drive]]",
            "drive.0.stiffness: is missing",
            &["write stiffness = …"],
        ),
        wrong(
            moved("joint = \"O\"\nvelocity = 6.0\n"),
            "[motion]",
            "motion.kind: is missing",
            &["line"],
        ),
    ]);
}

#[test]
fn names_that_are_taken() {
    refuse(vec![
        wrong(
            four_bar("name = \"coupler\"", "name = \"crank\""),
            "name = \"crank\"\nmass = 0.2",
            "body.1.name: \"crank\" is taken already",
            &["give the body a name of its own"],
        ),
        wrong(
            four_bar("name = \"B\"", "name = \"A\""),
            "name = \"A\"\nkind = \"revolute\"\nring = \"rocker.B\"",
            "joint.2.name: \"A\" is taken already",
            &["give the joint a name of its own"],
        ),
        wrong(
            four_bar("name = \"crank\"", "name = \"ground\""),
            "name = \"ground\"",
            "body.0.name: \"ground\" is taken already",
            &["a name of its own"],
        ),
        wrong(
            format!("{FOUR_BAR}[mechanism]\nkind = \"four-bar\"\n"),
            "[mechanism]",
            "mechanism: stands beside a description by [[body]] and [[joint]]",
            &["keep [mechanism] with a kind"],
        ),
    ]);
}

#[test]
fn numbers_that_no_joint_can_have() {
    let law = "ring = \"ground.O\"\njournal = \"crank.O\"\n";
    refuse(vec![
        wrong(
            four_bar("clearance = 2e-4", "clearance = 0.008"),
            "clearance = 0.008",
            "joint.2.clearance: is 0.008 m in the joint \"B\"",
            &["below the bearing radius, 0.008 m"],
        ),
        wrong(
            four_bar("clearance = 2e-4", "clearance = -2e-4"),
            "clearance = -2e-4",
            "joint.2.clearance: is -0.0002 m",
            &["0 or no clearance is an ideal joint"],
        ),
        wrong(
            four_bar(law, &format!("{law}law = \"ideal\"\nc_max = 300.0\n")),
            "c_max = 300.0",
            "joint.0.c_max: belongs to a contact law, and this joint is ideal",
            &["take one of both out"],
        ),
        wrong(
            four_bar(law, &format!("{law}friction = 0.1\n")),
            "friction = 0.1",
            "joint.0.friction: belongs to a contact law, and this joint is ideal",
            &["give the joint a clearance, or take this out"],
        ),
        wrong(
            four_bar(law, &format!("{law}law = \"hertz-step\"\n")),
            "law = \"hertz-step\"",
            "joint.0.law: is a contact law, and this joint is ideal",
            &["give the joint a clearance"],
        ),
    ]);
}

#[test]
fn numbers_that_no_body_or_drive_can_have() {
    refuse(vec![
        wrong(
            four_bar("mass = 0.2\n", "mass = 0.0\n"),
            "mass = 0.0",
            "body.1.mass: is 0 for the body \"coupler\"",
            &["expected above 0 kg"],
        ),
        wrong(
            four_bar("mass = 0.2\n", ""),
            "[[body]]\nname = \"coupler\"",
            "body.1.mass: is missing for the body \"coupler\"",
            &["write mass = … (kg), or a shape"],
        ),
        wrong(
            four_bar("inertia = 6.7e-4", "inertia = 0.67"),
            "inertia = 0.67",
            "body.1.inertia: of 0.67 kg m² makes the radius of gyration of \"coupler\" 1.830 m",
            &["1 kg mm² is 1e-6 kg m²"],
        ),
        wrong(
            four_bar("center_of_mass = [0.02, 0.0]", "center_of_mass = [20.0, 0.0]"),
            "center_of_mass = [20.0, 0.0]",
            "body.0.center_of_mass: lies 19.940 m from the nearest joint of \"crank\", in a machine of 0.200 m",
            &["30 mm are 0.03"],
        ),
        wrong(
            four_bar("mass = 0.2\n", "mass = nan\n"),
            "mass = nan",
            "body.1.mass: is NaN",
            &["expected a finite number"],
        ),
        wrong(
            four_bar("damping = 1.5", "damping = -1.5"),
            "damping = -1.5",
            "drive.0.damping: is -1.5",
            &["expected above 0"],
        ),
    ]);
}

#[test]
fn shapes_without_extent_and_fixed_joints_that_do_not_fit() {
    let mass = "mass = 0.2\ninertia = 6.7e-4\ncenter_of_mass = [0.09, 0.0]\n";
    let shape = |keys: &str| four_bar(mass, &format!("shape = {{ {keys}, density = 7800.0 }}\n"));
    let fixed = |joints: &str| four_bar("[[drive]]", &format!("{joints}\n[[drive]]"));
    refuse(vec![
        wrong(
            shape("kind = \"bar\", from = \"A\", to = \"A\", diameter = 0.01"),
            "shape = ",
            "body.1.shape: of the body \"coupler\" has no extent",
            &["a bar between two places"],
        ),
        wrong(
            shape("kind = \"polygon\", corners = [\"A\", \"B\", \"A\"], thickness = 0.01"),
            "shape = ",
            "body.1.shape: of the body \"coupler\" has no extent",
            &["a polygon with an area"],
        ),
        wrong(
            fixed("[[joint]]\nname = \"F\"\nkind = \"fixed\"\nbase = \"crank.A\"\npart = \"coupler.A\"\n"),
            "[[joint]]\nname = \"A\"",
            "joint.1: \"A\" joins two parts that fixed joints make one body",
            &["take it out, or the fixed joint"],
        ),
        wrong(
            four_bar("kind = \"revolute\"\nring = \"crank.A\"\njournal = \"coupler.A\"\nclearance = 1.5e-4\nbearing_radius = 0.008", "kind = \"fixed\"\nbase = \"crank.A\"\npart = \"coupler.A\"")
                .replacen(
                    "[[drive]]",
                    "[[joint]]\nname = \"F\"\nkind = \"fixed\"\nbase = \"crank.O\"\npart = \
                     \"coupler.B\"\nangle = 0.1\n\n[[drive]]",
                    1,
                ),
            "[[joint]]\nname = \"F\"",
            "joint.4: \"F\" contradicts the other fixed joints of its bodies: 240.000 mm and 0.1000 rad",
            &["a second one must fit"],
        ),
    ]);
}

#[test]
fn joints_that_do_not_close_and_bodies_that_nothing_holds() {
    let free = "[[body]]\nname = \"loose\"\nmass = 0.1\ninertia = 1e-4\n\n[[joint]]\nname = \"O\"";
    let pinned = "B = [0.13, 0.0]";
    refuse(vec![
        // 60 + 180 + 20 mm reach from O; D is 200 mm away.
        wrong(
            four_bar("D = [0.2, 0.0]", "D = [0.5, 0.0]"),
            "[[joint]]\nname = \"A\"",
            "joint.1: \"A\" does not close: its two points stay ",
            &[
                " mm apart",
                "coupler is 180.000 mm long between ",
                "; 330.215 to 590.215 mm would close the loop",
            ],
        ),
        wrong(
            four_bar(pinned, "B = [0.43, 0.0]"),
            "[[joint]]\nname = \"D\"",
            "joint.3: \"D\" does not close: its two points stay ",
            &[" mm apart", "coupler is 180.000 mm long between ", "; 266.052 to 593.948 mm would"],
        ),
        wrong(
            four_bar("[[joint]]\nname = \"O\"", free),
            "[[body]]\nname = \"loose\"",
            "body.3: \"loose\" is free: no joint and no spring holds it",
            &["give it a joint, or take it out"],
        ),
    ]);
}
