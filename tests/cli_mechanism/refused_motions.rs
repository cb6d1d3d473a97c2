//! Drives, motions, sensors and sections of mechanism files that cannot be right.

use crate::cli_common::Place;
use crate::files::{FOUR_BAR, SLIDER_CRANK, line, with};
use crate::refusals::{four_bar, moved, refuse, wrong};

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
    ]);
}

#[test]
fn motions_that_ask_too_much() {
    refuse(vec![
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

/// What is wrong with a sensor of a joint that is not there is that, and not its drive besides.
#[test]
fn a_joint_that_is_not_there_is_told_once() {
    let place = Place::new();
    let sensor = "[[sensor]]\ncolumn = \"T\"\nquantity = \"force\"\nof = \"Oo\"\n";
    place.write("bad.toml", &format!("{FOUR_BAR}{sensor}"));
    let told = place.freeplay("run bad.toml --out x");
    assert_eq!((told.code, told.err.matches("error: ").count()), (2, 1), "{}", told.err);
    assert!(told.err.contains("there is no joint \"Oo\""), "{}", told.err);
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

#[test]
fn a_point_that_should_turn() {
    refuse(vec![
        wrong(
            moved("point = \"rocker.B\"\nkind = \"line\"\nphi = 0.1\n"),
            "phi = 0.1",
            "motion.phi: is not used",
            &["a point has no angle: take it out"],
        ),
        wrong(
            moved("point = \"rocker.B\"\nkind = \"multisine\"\ncenter = [0.1, 0.2, 0.3]\n"),
            "center = [0.1, 0.2, 0.3]",
            "motion.center: turns, which is not used",
            &["a point has no angle: write 0 for the third number"],
        ),
        wrong(
            moved(
                "point = \"rocker.B\"\nkind = \"multisine\"\nterms = [{ amplitude = [0.1, 0.0, 0.0] }, { \
                 amplitude = [0.0, 0.0, 0.1] }]\n",
            ),
            "terms = [",
            "motion.terms.1.amplitude: turns, which is not used",
            &["a point has no angle"],
        ),
    ]);
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
