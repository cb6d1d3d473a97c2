//! `freeplay calibrate --self-test`: its table of trials.

use crate::cli_common::Place;

/// One line of a table of trials.
const TRIAL: &str = r#"{"hidden":["payload"],"size":SIZE,"gravity":GRAVITY,"withheld":WITHHELD,"seed":SEED,"lacks":"payload","verdict":"explained","found":"payload","right":RIGHT,"values":[{"name":"payload.mass_kg","truth":0.05,"value":0.051,"std":0.001}],"floors":5.0,"worst_ratio":1.1,"simulations":80,"version":"0.1.0"}"#;

/// All trials of one kind, so that none remains to be done.
fn table() -> String {
    let mut lines = Vec::new();
    for gravity in ["true", "false"] {
        for (size, withheld, seed) in [
            ("1.0", "false", 7000),
            ("3.0", "false", 7001),
            ("8.0", "false", 7002),
            ("3.0", "true", 7005),
        ] {
            let fields = [
                ("SIZE", size),
                ("GRAVITY", gravity),
                ("WITHHELD", withheld),
                ("SEED", &seed.to_string()),
                ("RIGHT", if withheld == "true" { "false" } else { "true" }),
            ];
            lines.push(
                fields.iter().fold(TRIAL.to_owned(), |line, (key, value)| line.replace(key, value)),
            );
        }
    }
    lines.join("\n") + "\n"
}

#[test]
fn trials_of_a_table_are_not_repeated() {
    let place = Place::new();
    place.write("trials.jsonl", &table());
    let line = "calibrate --self-test --seed 7 --hidden payload --trials trials.jsonl";
    let out = place.good(line);
    for row in [
        "| one effect above three floors: named, and nothing beside it | 3 of 3 (100 %, 44–100) | 3 of 3",
        "| an effect that is no candidate: `unexplained` | 0 of 1 (0 %, 0–79) | 0 of 1",
        "| values of these right answers above three floors within 10 %, phases aside | 3 of 3",
        "| nothing hidden: `nothing-missing` | – | – |",
        "| payload (5.0 floors, with gravity, no candidate) | `explained`: payload | 1 |",
    ] {
        assert!(out.contains(row), "{row}\n{out}");
    }
    assert_eq!(place.read("trials.jsonl"), table());
    let json: Vec<serde_json::Value> =
        serde_json::from_str(&place.good(&format!("{line} --json"))).unwrap();
    assert_eq!(json.len(), 8);
}

#[test]
fn a_self_test_refuses_what_it_cannot_do() {
    let place = Place::new();
    place.refused("calibrate --self-test --hidden payloads", &["--hidden: payloads", "expected"]);
    place.write("notes.txt", "{}\n");
    place.refused(
        "calibrate --self-test --hidden payload --trials notes.txt",
        &["notes.txt:1: ", "missing field", "a table of --trials"],
    );
    assert_eq!(place.freeplay("calibrate --trials notes.txt").code, 2);
}
