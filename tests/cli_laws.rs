//! `freeplay laws`, scenarios that choose a law, and `freeplay compare --laws`.

mod cli_common;

use cli_common::Place;
use freeplay::contact::laws::ALL;
use serde_json::Value;

#[test]
fn every_law_is_explained_with_an_example_that_runs() {
    let place = Place::new();
    let listed = place.good("laws");
    for kind in ALL {
        assert!(listed.contains(&format!("\n{}\n", kind.name)), "{} is not listed", kind.name);
        let shown = place.good(&format!("laws {}", kind.name));
        let example = shown.split("Example:").nth(1).expect("an example");
        place.write("example.toml", &format!("[mechanism]\nkind = \"3rpr\"\n{example}"));
        let name = kind.name;
        place.good(&format!("run example.toml --duration 0.01 --quiet --out {name}"));
        // What a run writes beside its results is the same scenario.
        place.good(&format!("run {name}/scenario.toml --quiet --force --out again"));
        let [a, b] = [name, "again"].map(|folder| place.read(&format!("{folder}/timeseries.csv")));
        assert!(a == b, "{name}");
    }
}

#[test]
fn laws_are_drawn_and_told_as_json() {
    let place = Place::new();
    let all: Value = serde_json::from_str(&place.good("laws --json")).unwrap();
    assert_eq!(all.as_array().map(Vec::len), Some(ALL.len()));
    let drawn = place.good("laws flores --set contact.restitution=0.5 --json --out flores");
    let drawn: Value = serde_json::from_str(&drawn).unwrap();
    // Flores asked for 0.5 returns 0.47, at any speed.
    for point in drawn["laws"][0]["returned_over_speed_m_s"].as_array().unwrap() {
        let returned = point[1].as_f64().unwrap();
        assert!((returned - 0.470).abs() < 1e-3, "{point}");
    }
    for file in ["force-penetration.svg", "restitution.svg"] {
        assert!(place.read(&format!("flores/{file}")).contains("<svg"), "{file}");
    }
    place.refused("laws flores --out flores", &["already holds a result"]);
    place.refused("laws flores --set contact.restitution=0.5", &["give --out DIR"]);
    place.refused("laws flores --out x --set contact.restitution=2", &["above 0, at most 1"]);
}

#[test]
fn a_law_on_the_command_line_drops_the_keys_of_the_files_law() {
    let place = Place::new();
    place.write(
        "my.toml",
        "[mechanism]\nkind = \"3rpr\"\n[contact]\nc_max = 300.0\n[simulation]\nduration = 0.01\n",
    );
    place.good("run my.toml --quiet --out a --set contact.law=hunt-crossley");
    assert!(!place.read("a/scenario.toml").contains("c_max"));
    place.refused(
        "run my.toml --out b --set contact.law=hunt-crossley --set contact.c_max=200",
        &["--set contact.c_max: means nothing to the law \"hunt-crossley\""],
    );
}

#[test]
fn joints_have_laws_of_their_own() {
    let place = Place::new();
    place.write("m.toml", &place.good("expand --duration 0.06"));
    let line =
        "run m.toml --quiet --out own --set joint.C1.law=flores --set joint.C1.restitution=0.5";
    place.good(line);
    place.good("run m.toml --quiet --out default");
    let [own, default] =
        ["own", "default"].map(|folder| place.read(&format!("{folder}/timeseries.csv")));
    assert!(own != default, "the law of C1 makes no difference");
    // c_max stays: the other joints' law takes it.
    assert!(place.read("own/scenario.toml").contains("c_max"));
    place.good("run own/scenario.toml --quiet --out again");
    assert!(place.read("again/timeseries.csv") == own);
    place.refused(
        "run m.toml --out x --set joint.C1.law=flores --set joint.C1.damping=3",
        &[
            "--set joint.3.damping: means nothing to the law \"flores\"",
            "that law takes restitution",
        ],
    );
}

/// A journal that rests under a law by restitution is damped by `h F/δ̇⁻`: steps longer than the time m/c of that
/// damping got its velocity wrong without seeing it, the force was cut to zero for good, and the journal left its
/// ring after 0.14 s.
#[test]
fn journals_that_rest_under_stiff_damping_stay_in_their_rings() {
    let place = Place::new();
    let line = "run --duration 0.2 --quiet --out r --set contact.law=johnson --set contact.restitution=0.54";
    place.good(line);
}

/// The same law twice in a list is one; the scenario's own comes first, and what is matched is.
#[test]
fn laws_are_compared_at_equal_restitution() {
    let place = Place::new();
    let line =
        "compare --laws flores,hertz,flores --starts 2 --duration 0.03 --quiet --json --out c";
    let compared: Value = serde_json::from_str(&place.good(line)).unwrap();
    let rows = compared["rows"].as_array().unwrap();
    let names: Vec<&str> = rows.iter().map(|row| row["law"].as_str().unwrap()).collect();
    assert_eq!(names, ["hertz-step", "flores", "hertz"]);
    let asked = compared["restitution"].as_f64().unwrap();
    let returned = |i: usize| rows[i]["returned"].as_f64().unwrap();
    assert!((returned(1) - asked).abs() < 1e-3 && rows[1]["matched"] == true);
    assert!(returned(2) > 0.999 && rows[2]["matched"] == false);
    // Below about 0.7, what is asked of Flores' law is more than what it returns.
    assert!(rows[1]["value"].as_f64().unwrap() > asked);
    for file in ["index.html", "compare-laws.csv", "compare-laws.json", "laws.svg", "scenario.toml"]
    {
        assert!(place.path(&format!("c/{file}")).exists(), "{file}");
    }
    place.refused("compare --laws hertz,flors", &["--laws: `flors` is not a law", "`flores`"]);
    place.refused(
        "compare --laws all --set mechanism.kind=drive-stage --duration 0.3",
        &["has no joint with clearance"],
    );
}

/// The formulas of conformal contact have no force beyond some depth: in a joint with so little clearance that hits go
/// deeper that is told once, with both depths.
#[test]
fn laws_of_conformal_contact_say_where_they_end() {
    let place = Place::new();
    let told = |line: &str| {
        let done = place.freeplay(&format!("check --set contact.law={line}"));
        (done.out + &done.err).matches("its tangent is taken").count()
    };
    assert_eq!(told("johnson"), 0);
    assert_eq!(told("liu --set joints.clearance=1e-6"), 0);
    assert_eq!(told("johnson --set joints.clearance=1e-6"), 1);
    let done = place.freeplay("check --set contact.law=johnson --set joints.clearance=1e-6");
    let all = done.out + &done.err;
    let words = all.split_whitespace().collect::<Vec<_>>().join(" ");
    let fragment =
        "holds down to 4.0e-7 m in the joint A1, and a hit at 0.2 m/s goes 9.4e-7 m deep";
    assert!(words.contains(fragment), "{all}");

    // At radii that differ by a fifth nothing conforms; Liu's law knows that, and the default law has no such end.
    let told = |line: &str| {
        let done =
            place.freeplay(&format!("check --set joints.clearance=2e-3 --set contact.law={line}"));
        (done.out + &done.err)
            .matches("up to a clearance of 0.1 of the ring's radius, and that of A1 is 0.20")
            .count()
    };
    assert_eq!(
        [told("johnson"), told("esdu-78035"), told("liu"), told("hertz-step")],
        [1, 1, 0, 0]
    );
}

/// Options that do nothing are told by their own names.
#[test]
fn options_of_pictures_are_told_by_their_names() {
    let place = Place::new();
    place.refused("laws --engine direct", &["--engine: ", "--out DIR"]);
    place.refused("laws --set contact.law=liu --force", &["--set, --force: ", "--out DIR"]);
}
