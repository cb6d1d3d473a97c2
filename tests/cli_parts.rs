//! Sweeps and self-tests in parts, as a queue's job arrays make them. The queue itself is in `cli_slurm`.

mod cli_common;

use assert_cmd::Command;
use cli_common::Place;
use serde_json::Value;

const SWEEP: &str =
    "sweep --duration 0.02 --set simulation.tolerance=1e-4 --vary motion.phase=1..9:9 --quiet";

#[test]
fn missing_parts_are_listed_as_an_array_takes_them() {
    let place = Place::new();
    let missing = |parts: u32| place.good(&format!("{SWEEP} --missing {parts} --out p-{{}}"));
    assert_eq!(missing(4), "1-4\n");
    for part in [1, 3] {
        place.good(&format!("{SWEEP} --shard {part}/4 --out p-{{}}"));
    }
    assert_eq!(place.entries(), ["p-1", "p-3"]);
    assert_eq!(missing(4), "2,4\n");
    place.refused(
        "merge p-1 p-3 --out all",
        &["4 of 9 rows are missing (runs 2, 4, 6, 8)", "shards 2/4, 4/4 are not among the parts"],
    );
    for part in [2, 4] {
        place.good(&format!("{SWEEP} --shard {part}/4 --out p-{{}}"));
    }
    assert_eq!(missing(4), "\n");
    place.good("merge p-1 p-2 p-3 p-4 --out all --quiet");
    place.good(&format!("{SWEEP} --out one"));
    assert_eq!(place.read("all/sweep.csv"), place.read("one/sweep.csv"));
    // A part that lost its table is made again from its rows; one that is another sweep's is named.
    std::fs::remove_file(place.path("p-2/sweep.json")).unwrap();
    let done = place.freeplay(&format!("{SWEEP} --missing 4 --out p-{{}}"));
    assert_eq!((done.code, done.out.as_str()), (0, "2\n"), "{}", done.err);
    place.refused(
        &format!("{SWEEP} --missing 3 --out p-{{}}"),
        &["`p-1` holds another sweep", "--shard 1/4 there, 1/3 here"],
    );
    place
        .refused(&format!("{SWEEP} --missing 4 --out p"), &["--out", "expected `{}` in its place"]);
}

#[test]
fn foreign_parts_are_all_named() {
    let place = Place::new();
    for (part, more) in
        [(1, ""), (2, "--set joints.clearance=1e-4"), (3, "--set joints.clearance=2e-4")]
    {
        place.good(&format!("{SWEEP} {more} --shard {part}/3 --out p-{{}}"));
    }
    place.refused(
        "merge p-1 p-2 p-3 --out x",
        &["`p-2` is no part of the sweep in `p-1`", "nor is `p-3`: scenario hash"],
    );
}

#[test]
fn more_parts_than_runs_are_joined_as_soon_as_few_ones() {
    let place = Place::new();
    place.good(&format!("{SWEEP} --shard 2/1000000000000 --out a"));
    place.refused(
        "merge a --out all",
        &[
            "8 of 9 rows are missing (runs 1, 3, 4, 5, 6, …)",
            "shards 1/1000000000000, 3/1000000000000",
            ", 6/1000000000000, … are not among the parts",
        ],
    );
}

#[test]
fn a_dry_run_says_how_many_and_how_long_and_makes_nothing() {
    let place = Place::new();
    let text = place.good(&format!("{} --dry-run", SWEEP.replace("--quiet", "")));
    assert!(
        text.starts_with("9 runs, 0 of them done; a run takes 0.0")
            && text.contains(" s (3 tried)"),
        "{text}"
    );
    assert_eq!(place.entries(), [""; 0]);
    place.good(&format!("{SWEEP} --shard 1/3 --out a"));
    let said = place.good(&format!("{SWEEP} --shard 1/3 --out a --dry-run --json --threads 2"));
    let said: Value = serde_json::from_str(&said).unwrap();
    for (key, value) in [("runs", 3), ("finished", 3), ("missing", 0), ("tried", 0), ("threads", 2)]
    {
        assert_eq!(said[key], value, "{key}");
    }
    // One run of ten minutes is judged by its first seconds.
    let clock = std::time::Instant::now();
    let said = place.good("sweep --vary motion.phase=1 --duration 1000 --dry-run --json");
    let said: Value = serde_json::from_str(&said).unwrap();
    assert!(clock.elapsed().as_secs() < 60 && said["run_s"].as_f64().unwrap() > 60.0, "{said}");
}

#[test]
fn threads_are_those_that_the_queue_gave() {
    let place = Place::new();
    let threads = |variables: &[(&str, &str)], more: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_freeplay"));
        command.envs(variables.iter().copied()).current_dir(place.path(""));
        let line = format!("{SWEEP} --dry-run --json {more}");
        let output = command.args(line.split_whitespace()).output().unwrap();
        let said: Value = serde_json::from_slice(&output.stdout).unwrap();
        (said["threads"].as_u64().unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    assert_eq!(threads(&[("SLURM_CPUS_PER_TASK", "3")], ""), (3, String::new()));
    assert_eq!(threads(&[("NSLOTS", "5")], ""), (5, String::new()));
    assert_eq!(threads(&[("SLURM_CPUS_PER_TASK", "3")], "--threads 4"), (4, String::new()));
    let (_, said) = threads(&[("SLURM_CPUS_PER_TASK", "many")], "");
    assert!(said.contains("warning: SLURM_CPUS_PER_TASK=many is no number of threads"), "{said}");
}

#[test]
fn self_tests_have_parts_too() {
    let place = Place::new();
    let line = "calibrate --self-test --count 6 --trials part-{}.jsonl";
    assert_eq!(place.good(&format!("{line} --missing 3")), "1-3\n");
    assert!(place.good(&format!("{line} --dry-run")).starts_with("6 trials, 0 of them done"));
    let dry = |line: &str| -> Value {
        serde_json::from_str(&place.good(&format!("{line} --dry-run --json"))).unwrap()
    };
    let said = dry(&format!("{line} --shard 2/3"));
    assert_eq!((&said["trials"], &said["missing"]), (&2.into(), &2.into()));
    // The tables of two parts as these leave them, of trials of which nothing was asked.
    let row = |seed: &Value| {
        format!(
            "{{\"seed\":{seed},\"machine\":\"four-bar\",\"size\":1,\"mass_exponent\":3,\"clearance_m\":1e-4,\"friction\":0,\
             \"gravity\":true,\"noise\":1,\"duration_s\":2,\"rate_Hz\":500,\"columns\":[],\"case\":\"nothing\",\"hidden\":[],\
             \"wanted\":[],\"version\":\"0\",\"unasked\":\"a test\"}}\n"
        )
    };
    let seeds = said["seeds"].as_array().unwrap();
    place.write("part-2.jsonl", &seeds.iter().map(row).collect::<String>());
    place.write("part-3.jsonl", &row(&dry(&format!("{line} --shard 3/3"))["seeds"][0]));
    assert_eq!(place.good(&format!("{line} --missing 3")), "1,3\n");
    let all = "calibrate --self-test --count 6 --trials all.jsonl --from part-2.jsonl part-3.jsonl";
    let said = dry(all);
    assert_eq!((&said["finished"], &said["missing"]), (&3.into(), &3.into()));
    assert!(
        place.good(&format!("{all} --dry-run")).starts_with("6 trials, 3 of them done; missing: ")
    );
    place.refused(all, &["part-2.jsonl: holds trials of 0", "a table is of one program"]);
    for name in ["part-2.jsonl", "part-3.jsonl"] {
        std::fs::remove_file(place.path(name)).unwrap();
    }
    for (line, fragments) in [
        ("calibrate --self-test --missing 3 --trials part.jsonl", ["--trials", "expected `{}`"]),
        (
            "calibrate --self-test --count 1 --from absent.jsonl",
            ["--from", "`absent.jsonl` is not there"],
        ),
        ("calibrate --rig r.toml --data d.csv --shard 1/2", ["--shard", "--self-test"]),
        ("calibrate --rig r.toml --data d.csv --dry-run", ["--dry-run", "--self-test"]),
    ] {
        place.refused(line, &fragments);
    }
    assert_eq!(place.entries(), [""; 0]);
}
