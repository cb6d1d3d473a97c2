//! `freeplay calibrate --self-test`: its table of trials.

use crate::cli_common::Place;

/// One line of a table of trials.
const TRIAL: &str = r#"{"seed":SEED,"machine":"MACHINE","size":1.5,"mass_exponent":2.5,"clearance_m":1e-4,"friction":0.0,"gravity":true,"noise":1.0,"duration_s":3.0,"rate_Hz":1000.0,"columns":["q_O","T_O"],"case":"CASE","hidden":["payload"],"wanted":[5.0],"version":"0.0.9 (12345678)","lacks":"payload at rod (mass_kg 0.05)","verdict":"VERDICT","found":"payload at rod (mass_kg 0.051)","right":RIGHT,"wrong_name":false,"as_good":false,"values":[{"name":"payload.mass_kg","truth":0.05,"value":0.051,"std":0.001}],"floors":5.0,"worst_ratio":1.1,"rattle":0.1,"simulations":80,"seconds":40.0}"#;

/// Three effects that were named, one that was not, and one that was no candidate.
fn table() -> String {
    let rows = [
        ("1", "slider-crank", "one", "explained", "true"),
        ("2", "slider-crank", "one", "explained", "true"),
        ("3", "five-bar", "one", "explained", "true"),
        ("4", "five-bar", "one", "nothing-missing", "false"),
        ("5", "five-bar", "withheld", "unexplained", "true"),
    ];
    let line = |(seed, machine, case, verdict, right): (&str, &str, &str, &str, &str)| {
        let fields = [("SEED", seed), ("MACHINE", machine), ("CASE", case), ("VERDICT", verdict)];
        let line =
            fields.iter().fold(TRIAL.to_owned(), |line, (key, value)| line.replace(key, value));
        line.replace("RIGHT", right) + "\n"
    };
    rows.map(line).concat()
}

#[test]
fn rates_of_a_table_are_told_without_trying_anything() {
    let place = Place::new();
    place.write("trials.jsonl", &table());
    let line = "calibrate --self-test --count 0 --trials trials.jsonl";
    let out = place.good(line);
    for row in [
        "|  | asked | all | five-bar | slider-crank |",
        "| one effect above three floors: named, and nothing beside it | ≥ 90 % | 3 of 4 (75 %, 30–95) | 1 of 2",
        "| an effect that is no candidate: `unexplained` | ≥ 90 % | 1 of 1 (100 %, 21–100) | 1 of 1",
        "| explained by a name that is not hidden | ≤ 3 % | 0 of 5 (0 %, 0–43)",
        "| values of right answers inside their 95 % intervals | 90–99 % | 4 of 4",
        "| nothing hidden, but not `nothing-missing` | ≤ 3 % | – |",
        "5 trials of 0.0.9 (12345678)",
        "| 4 | five-bar × 1.50 | one effect: payload at rod (mass_kg 0.05) | 5.0 | `nothing-missing`",
    ] {
        assert!(out.contains(row), "{row}\n{out}");
    }
    assert_eq!(place.read("trials.jsonl"), table());
    let json: Vec<serde_json::Value> =
        serde_json::from_str(&place.good(&format!("{line} --json"))).unwrap();
    assert_eq!(json.len(), 5);
}

#[test]
fn a_self_test_refuses_what_it_cannot_do() {
    let place = Place::new();
    place.refused("calibrate --self-test --set joints.clearance=1e-4", &["'--set <PATH=VALUE>'"]);
    place.refused("calibrate --self-test --hidden payloads", &["--hidden: payloads", "expected"]);
    place.refused(
        "calibrate --self-test --machine five-bars",
        &["--machine: five-bars", "expected one of slider-crank"],
    );
    place.write("notes.txt", "{}\n");
    place.refused(
        "calibrate --self-test --hidden payload --trials notes.txt",
        &["notes.txt:1: ", "missing field", "a table of --trials"],
    );
    place.write("trials.jsonl", &table());
    place.refused(
        "calibrate --self-test --count 1 --trials trials.jsonl",
        &["trials.jsonl: holds trials of 0.0.9 (12345678)", "another file"],
    );
    assert_eq!(place.freeplay("calibrate --trials notes.txt").code, 2);
    // What a flag requires is not asked for where it conflicts with another one.
    let beside_a_rig = "calibrate --rig rig.toml --data run.csv";
    for flag in
        ["--hidden payload", "--machine arm", "--count 3", "--trials t.jsonl", "--keep kept"]
    {
        let name = flag.split(' ').next().unwrap();
        place.refused(
            &format!("{beside_a_rig} {flag}"),
            &[name, "cannot be used with", "'--rig <RIG.toml>'"],
        );
    }
}
