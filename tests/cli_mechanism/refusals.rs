//! Mechanism files that cannot be right: exit code 2, file, line, key, what is wrong, what would be right.

use crate::cli_common::{Done, Place};
use crate::files::{FOUR_BAR, SLIDER_CRANK, line, with};

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
fn four_bar(from: &str, to: &str) -> String {
    with(FOUR_BAR, from, to)
}

/// The four-bar with another motion.
fn moved(motion: &str) -> String {
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
fn keys_kinds_and_names() {
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
fn numbers_that_no_body_or_joint_can_have() {
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

#[test]
fn drives_that_ask_too_much() {
    let second = "[[drive]]\njoint = \"D\"\nkind = \"prescribed\"\n\n[motion]";
    let twice = "[[drive]]\njoint = \"O\"\nkind = \"prescribed\"\n\n[motion]";
    let prescribed = |text: &str| {
        with(text, "kind = \"servo\"\nstiffness = 400.0\ndamping = 1.5", "kind = \"prescribed\"")
    };
    refuse(vec![
        wrong(
            four_bar("[motion]", twice),
            "joint = \"O\"\nkind = \"prescribed\"",
            "drive.1.joint: \"O\" is driven twice",
            &["keep one drive of each joint"],
        ),
        wrong(
            prescribed(&four_bar("[motion]", second)),
            "[[drive]]\njoint = \"D\"",
            "drive.1: O, D are all told where to be, and without clearance the machine has 1 freedom",
            &["drive as many joints as there are freedoms"],
        ),
        wrong(
            four_bar("[motion]", second),
            second,
            "drive.",
            &["drive as many joints as there are freedoms"],
        ),
        // The rocker swings between the dead points of the crank.
        wrong(
            moved("joint = \"D\"\nkind = \"quintic\"\nto = 2.6\ntime = 0.03\n")
                .replace("[[drive]]\njoint = \"O\"", "[[drive]]\njoint = \"D\""),
            "[motion]",
            "motion: drives the machine beyond its reach at t = 0.0",
            &["locks near D = 2.", "stretched out or folded", "keep the drive within the toggle"],
        ),
        // The piston cannot pass its dead point at 0.2 m.
        wrong(
            with(SLIDER_CRANK, "to = 0.15", "to = 0.21"),
            "[motion]",
            "motion: drives the machine beyond its reach at t = 0.0",
            &["locks near slide = 0.2", "stretched out or folded"],
        ),
        wrong(
            with(
                SLIDER_CRANK,
                "[simulation]",
                "[[motion]]\njoint = \"slide\"\nkind = \"line\"\n[simulation]",
            )
            .replacen("[motion]", "[[motion]]", 1),
            "joint = \"slide\"\nkind = \"line\"",
            "motion.1.joint: \"slide\" is moved twice",
            &["keep one motion of each joint"],
        ),
        wrong(
            with(SLIDER_CRANK, "kind = \"prescribed\"", "kind = \"force\"\nvalue = 1.0"),
            "joint = \"slide\"\nkind = \"quintic\"",
            "motion.joint: \"slide\" is driven by a force: it follows no motion",
            &["take the motion out"],
        ),
        wrong(
            with(
                SLIDER_CRANK,
                "slider = \"piston.P\"\n",
                "slider = \"piston.P\"\nrange = [0.16, 0.2]\n",
            ),
            "range = ",
            "joint.3.range: slide would have to be 0.1500 m at t = 0.1",
            &["outside its range"],
        ),
    ]);
}

#[test]
fn a_singular_pose_ahead_is_refused() {
    let place = Place::new();
    let text = "[mechanism]\nkind = \"3rpr\"\n[motion]\nkind = \"quintic\"\nfrom = [0.0, 0.0, 0.4]\n\
                to = [0.0, 0.0, -0.4]\n";
    place.write("three.toml", text);
    place.refused(
        "run three.toml",
        &["three.toml:6: motion.to: the platform reaches a singularity"],
    );
    // The same machine at a safe angle, expanded, and its motion turned through 0 by hand.
    let expanded = place.good("expand three.toml --set motion.to=[0,0,0.5]");
    let expanded = with(&expanded, "to = [0.0, 0.0, 0.5]", "to = [0.0, 0.0, -0.4]");
    place.write("bad.toml", &expanded);
    let at = format!(
        "bad.toml:{}: motion: passes a singular pose at t = 0.5",
        line(&expanded, "[motion]")
    );
    let help = "keep the motion away from there, or drive another joint";
    place.refused("check bad.toml", &[&at, "although ", " drives hold", help]);
    place.refused("run bad.toml --out x", &[&at]);
    let still = with(&expanded, "from = [0.0, 0.0, 0.4]", "from = [0.0, 0.0, 0.0]");
    let still = with(&still, "to = [0.0, 0.0, -0.4]", "to = [0.01, 0.0, 0.0]");
    place.write("bad.toml", &still);
    place.refused("run bad.toml --out x", &["motion: passes a singular pose at t = "]);
}

#[test]
fn sensors_and_motions_that_mean_nothing() {
    let sensor = |keys: &str| format!("{FOUR_BAR}[[sensor]]\n{keys}");
    refuse(vec![
        wrong(
            sensor("column = \"q\"\nquantity = \"position\"\nof = \"Oo\"\n"),
            "of = \"Oo\"",
            "sensor.0.of: there is no joint \"Oo\"",
            &["did you mean \"O\"?"],
        ),
        wrong(
            sensor("column = \"q\"\nquantity = \"force\"\nof = \"A\"\n"),
            "of = \"A\"",
            "sensor.0.of: \"A\" has no drive to read",
            &["write a [[drive]] of this joint"],
        ),
        wrong(
            sensor("column = \"x\"\nquantity = \"x\"\nof = \"rocker.C\"\n"),
            "of = \"rocker.C\"",
            "sensor.0.of: \"rocker\" has no point \"C\"",
            &["B"],
        ),
        wrong(
            sensor(
                "column = \"q\"\nquantity = \"position\"\nof = \"O\"\n[[sensor]]\ncolumn = \
                 \"q\"\nquantity = \"command\"\nof = \"O\"\n",
            ),
            "column = \"q\"\nquantity = \"command\"",
            "sensor.1.column: two sensors read the column \"q\"",
            &["one sensor for each column"],
        ),
        wrong(
            sensor("column = \"q\"\nquantity = \"positon\"\nof = \"O\"\n"),
            "quantity = \"positon\"",
            "sensor.0.quantity: unknown value \"positon\"",
            &["did you mean `position`?"],
        ),
        wrong(
            format!("{FOUR_BAR}[[output]]\nbody = \"crank\"\npoint = \"crank.A\"\n"),
            "[[output]]\nbody = \"crank\"\npoint",
            "output.0: gives both body and point",
            &["write body = \"…\" or point = \"body.point\""],
        ),
        wrong(
            moved("kind = \"line\"\n"),
            "[motion]",
            "motion: does not say what it moves",
            &["write joint = \"…\", body = \"…\" or point = \"body.point\""],
        ),
        wrong(
            moved("body = \"rocker\"\nkind = \"line\"\n"),
            "[motion]",
            "motion: moves x, y and phi of \"rocker\", which takes 3 drives that follow it; 1 do",
            &["[[drive]]"],
        ),
        wrong(
            moved("kind = \"table\"\nfile = \"none.csv\"\n"),
            "file = \"none.csv\"",
            "motion.file: none.csv: No such file",
            &["t,q_O"],
        ),
    ]);
}

/// Springs, stops, shapes and starts in another unit, or against the start: a run goes on.
#[test]
fn what_is_hardly_meant_is_told_with_its_key() {
    let place = Place::new();
    let added = |section: &str| format!("{FOUR_BAR}{section}\n");
    let spring = "[[spring]]\nbetween = [\"ground.O\", \"rocker.B\"]\n";
    let mass = "mass = 0.15\ninertia = 1.5e-4\ncenter_of_mass = [0.02, 0.0]\n";
    let shape =
        "shape = { kind = \"bar\", from = \"O\", to = \"A\", diameter = 0.6, density = 7850.0 }\n";
    for (text, says) in [
        (
            added("[[spring]]\njoint = \"D\"\nstiffness = 0.0"),
            "spring.0.stiffness: is 0, and damping is too",
        ),
        (
            added(&format!("{spring}stiffness = 10.0\nfree_length = 100.0")),
            "spring.0.free_length: is 100 m",
        ),
        (
            added("[[stop]]\njoint = \"D\"\nrange = [-90.0, 90.0]\nstiffness = 1e3"),
            "stop.0.range: has an end at -90 rad, more than a whole turn",
        ),
        (
            added("[[stop]]\njoint = \"D\"\nrange = [-0.1, 0.1]\nstiffness = 1e3"),
            "stop.0.range: goes from -0.1 to 0.1 rad, and D starts at 1.57",
        ),
        (four_bar(mass, shape), "body.0.shape: makes \"crank\""),
        (
            four_bar("start = [0.0, 0.0, 0.8]", "start = [0.0, 0.0, 50.0]"),
            "body.0.start: has an angle of 50 rad, more than a whole turn; angles are in rad: 50 degrees are 0.8727",
        ),
    ] {
        place.write("four-bar.toml", &text);
        let done = place.freeplay("check four-bar.toml");
        assert!(done.err.starts_with("warning: four-bar.toml:"), "{says}\n{}", done.err);
        assert!(done.err.contains(says), "{says}\n{}", done.err);
    }
}

#[test]
fn sections_without_a_use_are_told() {
    let place = Place::new();
    for section in ["legs", "sensors"] {
        let text = format!("{FOUR_BAR}[{section}]\n");
        place.write("four-bar.toml", &text);
        let done = place.freeplay("check four-bar.toml");
        let at = line(&text, &format!("[{section}]"));
        let warning = format!("warning: four-bar.toml:{at}: {section}: is not used");
        assert!(done.code == 0 && done.err.starts_with(&warning), "{}", done.err);
        assert!(done.err.contains("take it out"), "{}", done.err);
    }
}

/// Of a described machine `[columns]` says where time stands, and `[[sensor]]`s the rest.
#[test]
fn columns_of_a_described_machine_are_its_sensors() {
    let place = Place::new();
    place.write("four-bar.toml", &format!("{FOUR_BAR}[columns]\nt = \"t_s\"\n"));
    place.good("check four-bar.toml");
    place.write("four-bar.toml", &format!("{FOUR_BAR}[columns]\nq1 = \"q\"\n"));
    place.refused("check four-bar.toml", &["columns.q1: is not known", "write a [[sensor]]"]);
}
