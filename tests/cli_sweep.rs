//! `freeplay sweep` and `freeplay merge`, the real binary.

mod cli_common;

use cli_common::{Place, names};
use serde_json::Value;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// Runs of 20 ms: a rattle has begun, and a debug build takes some hundredths of a second.
const SHORT: &str = "--duration 0.02 --set simulation.tolerance=1e-4";

const FILES: [&str; 6] = [
    "index.html",
    "over-joints.clearance.svg",
    "rows.jsonl",
    "scenario.toml",
    "sweep.csv",
    "sweep.json",
];

/// The table of a sweep as rows of cells, header first.
fn table(place: &Place, folder: &str) -> Vec<Vec<String>> {
    let text = place.read(&format!("{folder}/sweep.csv"));
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect()
}

fn column(table: &[Vec<String>], name: &str) -> Vec<String> {
    let k = table[0].iter().position(|c| c == name).unwrap();
    table[1..].iter().map(|row| row[k].clone()).collect()
}

#[test]
fn a_sweep_writes_a_row_a_run_with_the_figures_of_run() {
    let place = Place::new();
    let out = place.good(&format!("sweep {SHORT} --vary joints.clearance=1e-4,5e-4"));
    assert!(out.contains("2 of 2 runs") && out.contains("freeplay-sweep-default/index.html"));
    assert_eq!(place.entries(), ["freeplay-sweep-default"]);
    assert_eq!(names(&place.path("freeplay-sweep-default")), FILES);
    let rows = table(&place, "freeplay-sweep-default");
    assert_eq!((rows.len(), rows[0][0].as_str()), (3, "joints.clearance"));
    assert_eq!(column(&rows, "joints.clearance"), ["0.0001", "0.0005"]);
    assert_eq!(column(&rows, "status"), ["ok", "ok"]);

    place.good(&format!("run {SHORT} --set joints.clearance=5e-4 --out r"));
    let summary = place.read("r/summary.json");
    for (name, cell) in rows[0].iter().zip(&rows[2]).skip(1) {
        if name != "status" {
            assert!(summary.contains(&format!("\"{name}\": {cell},")), "{name}: {cell}");
        }
    }
    let page = place.read("freeplay-sweep-default/index.html");
    assert!(page.contains("Over joints.clearance") && page.contains("<circle"));
}

#[test]
fn json_is_the_record_and_nothing_else() {
    let place = Place::new();
    let line = format!("sweep {SHORT} --vary motion.phase=1..3:3 --out s");
    let done = place.freeplay(&format!("{line} --json"));
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    assert_eq!(done.out, place.read("s/sweep.json"));
    let record: Value = serde_json::from_str(&done.out).unwrap();
    for (key, value) in [("runs", 3), ("finished", 3), ("ok", 3), ("halted", 0), ("refused", 0)] {
        assert_eq!(record[key], value, "{key}");
    }
    assert_eq!((&record["folder"], &record["complete"]), (&"s".into(), &true.into()));
    // A finished sweep says the same again without a run.
    assert_eq!(place.good(&format!("{line} --json")), done.out);
    assert_eq!(place.good(&format!("{line} --quiet")), "");
}

#[test]
fn lists_and_ranges_combine_as_a_product() {
    let place = Place::new();
    place.good(&format!(
        "sweep {SHORT} --out p --vary contact.law=hertz-step,ideal --vary motion.phase=0..3:2 \
         --vary joints.clearance=1e-5..1e-3:log:3"
    ));
    let rows = table(&place, "p");
    let varied: Vec<String> = rows.iter().map(|row| row[..3].join(" ")).collect();
    assert_eq!(varied.len(), 13);
    assert_eq!(varied[0], "contact.law motion.phase joints.clearance");
    assert_eq!(varied[1..4], ["hertz-step 0 1e-5", "hertz-step 0 0.0001", "hertz-step 0 0.001"]);
    assert_eq!((varied[4].as_str(), varied[12].as_str()), ("hertz-step 3 1e-5", "ideal 3 0.001"));
    // What is no number has no axis.
    assert!(!names(&place.path("p")).contains(&"over-contact.law.svg".to_owned()));
    // An axis over decades says the quantity, in its unit.
    let svg = place.read("p/over-joints.clearance.svg");
    assert!(svg.contains("clearance (m)") && svg.contains("µm"));
}

#[test]
fn random_keys_are_one_joint_sample() {
    let place = Place::new();
    let vary = "--vary mechanism.platform_mass=0.1..0.3:random:8 \
                --vary joints.clearance=1e-5..1e-3:log:random:8";
    place.good(&format!("sweep {SHORT} --out a {vary}"));
    place.good(&format!("sweep {SHORT} --out b {vary} --set seed=2"));
    let rows = table(&place, "a");
    assert_eq!(rows.len(), 9, "8 runs, not 64");
    let numbers = |name| -> Vec<f64> {
        column(&rows, name).iter().map(|cell| cell.parse().unwrap()).collect()
    };
    for (name, low, high) in
        [("mechanism.platform_mass", 0.1, 0.3), ("joints.clearance", 1e-5, 1e-3)]
    {
        let values = numbers(name);
        assert!(values.iter().all(|v| (low..high).contains(v)), "{name}: {values:?}");
    }
    // Even in the logarithm: about half of the values in each decade.
    let below = numbers("joints.clearance").iter().filter(|c| **c < 1e-4).count();
    assert!((3..=5).contains(&below), "{below}");
    assert_ne!(rows[1][..2], table(&place, "b")[1][..2], "another seed, another sample");
}

/// Twelve runs of which each takes a while.
const LONG: &str = "--duration 0.2 --set simulation.tolerance=1e-5 \
                    --vary joints.clearance=1e-4..1e-3:6 --vary motion.phase=0,1";

#[test]
fn killed_at_any_moment_it_goes_on_to_the_same_table() {
    let place = Place::new();
    let clock = std::time::Instant::now();
    place.good(&format!("sweep {LONG} --out whole"));
    let whole = place.read("whole/sweep.csv");
    let took = clock.elapsed();
    let (mut kept, mut kills) = (0, 0);
    for moment in 0..10u32 {
        let out = format!("killed-{}", moment / 5);
        let mut child = Command::new(env!("CARGO_BIN_EXE_freeplay"))
            .current_dir(place.path(""))
            .args(format!("sweep {LONG} --out {out}").split_whitespace())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // Scattered moments (golden ratio) within a third of the time that all of it takes.
        let fraction = (f64::from(moment + 1) * 0.618_034).fract();
        sleep(Duration::from_secs_f64(fraction * took.as_secs_f64() / 3.0));
        kills += u32::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
        let journal = place.path(&format!("{out}/rows.jsonl"));
        let rows = std::fs::read_to_string(journal).unwrap_or_default().matches('\n').count();
        if moment % 5 == 0 {
            kept = 0;
        }
        assert!(rows >= kept, "kill {moment} lost rows: {rows} of {kept}");
        kept = rows;
    }
    assert!(kills >= 5, "the sweep was over before most of the kills");
    for out in ["killed-0", "killed-1"] {
        place.good(&format!("sweep {LONG} --out {out}"));
        assert_eq!(place.read(&format!("{out}/sweep.csv")), whole);
        assert_eq!(place.read(&format!("{out}/rows.jsonl")).lines().count(), 12, "no row twice");
        let picture = "over-joints.clearance.svg";
        let read = |folder: &str| place.read(&format!("{folder}/{picture}"));
        assert_eq!(read(out), read("whole"));
    }
}

#[test]
fn a_torn_last_line_is_made_again_and_the_others_are_not() {
    let place = Place::new();
    let line = format!("sweep {SHORT} --vary joints.clearance=1e-4..5e-4:5 --out s");
    place.good(&line);
    let (table, journal) = (place.read("s/sweep.csv"), place.read("s/rows.jsonl"));
    for cut in [journal.len() - 1, journal.len() - 30, journal.find('\n').unwrap() + 1, 0] {
        place.write("s/rows.jsonl", &journal[..cut]);
        place.good(&line);
        assert_eq!(place.read("s/sweep.csv"), table);
        let again = place.read("s/rows.jsonl");
        let whole = journal[..cut].rfind('\n').map_or(0, |end| end + 1);
        assert_eq!(again[..whole], journal[..whole]);
        assert_eq!(again.lines().count(), 5);
    }
}

#[test]
fn threads_do_not_show() {
    let place = Place::new();
    let line = format!("sweep {SHORT} --vary joints.clearance=1e-4..1e-3:8");
    place.good(&format!("{line} --threads 1 --out one"));
    place.good(&format!("{line} --threads 2 --out two"));
    assert_eq!(place.read("one/sweep.csv"), place.read("two/sweep.csv"));
    assert_eq!(place.read("one/index.html"), place.read("two/index.html"));
}

#[test]
fn shards_merge_to_the_whole() {
    let place = Place::new();
    let line = format!("sweep {SHORT} --vary joints.clearance=1e-4..1e-3:7");
    place.good(&format!("{line} --out whole"));
    for i in 1..=3 {
        place.good(&format!("{line} --shard {i}/3 --out part-{i}"));
    }
    assert_eq!(column(&table(&place, "part-2"), "joints.clearance"), ["0.00025", "0.0007"]);
    place.refused("merge part-1 part-3 --out m", &["2 of 7 rows are missing", "--partial"]);
    place.good("merge part-3 part-1 part-2 --out m");
    assert_eq!(place.read("m/sweep.csv"), place.read("whole/sweep.csv"));
    assert_eq!(place.read("m/index.html"), place.read("whole/index.html"));
    assert_eq!(names(&place.path("m")), FILES);
    place.refused("merge part-1 part-2 part-3 --out m", &["`m` already holds a result"]);

    // What is missing can be made in the result.
    place.good("merge part-1 part-2 --partial --out some");
    assert_eq!(table(&place, "some").len(), 6);
    place.good(&format!("{line} --out some"));
    assert_eq!(place.read("some/sweep.csv"), place.read("whole/sweep.csv"));

    place.good(&format!("{line} --shard 2/3 --out other --set motion.phase=1"));
    place.refused("merge part-1 other part-3 --out x", &["`other` is no part", "scenario hash"]);
    place.refused("merge part-1 no --out x", &["no/sweep.json", "cannot be read"]);
    let journal = place.read("part-2/rows.jsonl");
    place.write("part-2/rows.jsonl", &journal[..journal.len() - 20]);
    place.refused(
        "merge part-1 part-2 part-3 --out x",
        &["1 of 7 rows are missing", "`part-2` (shard 2/3) is unfinished"],
    );
    place.write("part-2/rows.jsonl", &journal.replacen("\"ok\"", "\"ko\"", 1));
    place.refused("merge part-1 part-2 part-3 --out x", &["part-2/rows.jsonl:1: was edited"]);
}

#[test]
fn wrong_input_is_refused_before_anything_is_run() {
    let place = Place::new();
    for (vary, fragments) in [
        ("joints.clearence=1,2", &["--vary joints.clearence", "did you mean `clearance`?"][..]),
        ("nonsense=1,2", &["unknown key `nonsense`"]),
        ("joints.clearance=1e-4,0.02", &["--vary joints.clearance", "run 2 of 2"]),
        ("motion.radius=0.1,0.09", &["none of the 2 runs", "--vary motion.radius", "leg 1"]),
        ("joints.clearance=1e-4..1e-4:3", &["is empty", "smaller end first"]),
        ("joints.clearance=1e-3..1e-4:3", &["is empty", "smaller end first"]),
        ("joints.clearance=1e-4..1e-3:0", &["range of 0 values"]),
        ("joints.clearance=0..1e-3:log:3", &["logarithmic", "above 0"]),
        ("joints.clearance=1e-4..1e-3", &["number of values", "PATH=lo..hi:N"]),
        ("joints.clearance", &["has no values", "PATH=a,b,c"]),
        ("seed=1..2:3", &["1.5", "whole number"]),
    ] {
        place.refused(&format!("sweep {SHORT} --out x --vary {vary}"), fragments);
    }
    let vary = "--vary joints.clearance=1e-4,5e-4";
    place.refused(&format!("sweep {SHORT} {vary} {vary} --out x"), &["given twice"]);
    place.refused(&format!("sweep missing.toml {vary} --out x"), &["cannot be read"]);
    for shard in ["0/2", "3/2", "2", "1/0"] {
        place.refused(&format!("sweep {SHORT} {vary} --out x --shard {shard}"), &["--shard"]);
    }
    place.refused(&format!("sweep {SHORT} {vary} --out x --threads 0"), &["--threads"]);
    place.refused("sweep --out x", &["--vary"]);
}

#[test]
fn folders_of_others_and_edited_files_are_refused_and_kept() {
    let place = Place::new();
    let line = format!("sweep {SHORT} --out s --vary joints.clearance=1e-4,5e-4");
    place.good(&line);
    let files = ["sweep.json", "sweep.csv", "rows.jsonl"].map(|file| format!("s/{file}"));
    let before = files.clone().map(|file| place.read(&file));
    let other = format!("sweep {SHORT} --out s --vary joints.clearance=1e-4,4e-4");
    place.refused(&other, &["`s` holds another sweep", "0.0004 here", "--force"]);
    place.refused(&format!("{line} --set motion.phase=1"), &["another sweep", "scenario hash"]);
    place.refused(&format!("{line} --shard 1/2"), &["another sweep", "--shard 1/1 there"]);
    for (file, text) in files.iter().zip(&before) {
        for edited in [text.replacen("0.0005", "0.0006", 1), text[..text.len() / 3].to_owned()] {
            // A journal cut short is one of a sweep that was killed.
            if file.ends_with("rows.jsonl") && edited.len() < text.len() - 1 {
                continue;
            }
            place.write(file, &edited);
            place.refused(&line, &["s"]);
            assert_eq!(place.read(file), edited, "nothing lost");
            place.write(file, text);
        }
    }
    assert_eq!(files.map(|file| place.read(&file)), before);
    place.good(&format!("{other} --force"));
    assert_eq!(column(&table(&place, "s"), "joints.clearance"), ["0.0001", "0.0004"]);

    place.good(&format!("run {SHORT} --out r"));
    for force in ["", "--force"] {
        let line = format!("sweep {SHORT} --out r --vary motion.phase=1,2 {force}");
        place.refused(&line, &["`r` holds", "choose another folder"]);
    }
    place.write("s/notes.txt", "mine");
    place.refused(&format!("{line} --force"), &["notes.txt"]);
}

#[test]
fn runs_that_break_down_or_cannot_be_done_get_a_row() {
    let place = Place::new();
    let line = "sweep --duration 0.2 --out h --set contact.stiffness=10 --set contact.c_max=0 \
                --vary joints.clearance=5e-4 --vary motion.radius=0.05,0.1";
    let done = place.freeplay(line);
    assert_eq!(done.code, 1, "{}", done.err);
    assert!(done.err.contains("error: 1 of 2 runs halted; the column `status` of `h/sweep.csv`"));
    assert!(done.err.contains("warning: 1 of 2 runs are refused"), "{}", done.err);
    assert!(done.out.contains("0 ok, 1 halted, 1 refused"), "{}", done.out);
    let status = column(&table(&place, "h"), "status");
    assert!(status[0].starts_with("halted: the simulation broke down at t = 0.0"), "{status:?}");
    assert!(status[1].starts_with("refused: --vary motion.radius: leg 1 "), "{status:?}");
    assert_eq!(column(&table(&place, "h"), "steps")[1], "");
    assert!(place.read("h/index.html").contains("broke down on the way"));
}

#[test]
fn two_processes_do_not_share_a_folder() {
    let place = Place::new();
    let line = format!("sweep {SHORT} --out s --vary motion.phase=1,2");
    place.good(&line);
    let journal = std::fs::File::open(place.path("s/rows.jsonl")).unwrap();
    journal.lock().unwrap();
    place.refused(&line, &["another freeplay is at work on `s`"]);
    place.refused(&format!("{line} --force"), &["another freeplay is at work on `s`"]);
}

/// Peaks of single runs were read as what a clearance does, where another start does as much.
#[test]
fn starts_give_means_with_intervals_group_by_group() {
    let place = Place::new();
    let sweep =
        "sweep --vary joints.clearance=1e-4,5e-4 --vary motion.phase=0..5:4 --duration 0.1 --quiet";
    place.good(&format!("{sweep} --out s"));
    let statistics = place.read("s/statistics.csv");
    let mut table = csv::Reader::from_reader(statistics.as_bytes());
    let heads = table.headers().unwrap().clone();
    let place_of = |name: &str| heads.iter().position(|head| head == name).unwrap();
    let rows: Vec<csv::StringRecord> = table.records().map(|row| row.unwrap()).collect();
    assert_eq!(rows.len(), 2, "a row for each clearance");
    let runs = place.read("s/sweep.csv");
    let mut runs = csv::Reader::from_reader(runs.as_bytes());
    let column =
        |heads: &csv::StringRecord, name: &str| heads.iter().position(|head| head == name).unwrap();
    let heads_of_runs = runs.headers().unwrap().clone();
    let peak = column(&heads_of_runs, "peak_contact_force_N");
    let all: Vec<(String, f64)> = runs
        .records()
        .map(|row| row.unwrap())
        .map(|row| (row[0].to_owned(), row[peak].parse().unwrap()))
        .collect();
    for row in &rows {
        let of: Vec<f64> =
            all.iter().filter(|(c, _)| c == &row[0]).map(|(_, force)| *force).collect();
        assert_eq!((&row[place_of("runs")], of.len()), ("4", 4));
        let mean = of.iter().sum::<f64>() / 4.0;
        let variance = of.iter().map(|force| (force - mean).powi(2)).sum::<f64>() / 3.0;
        // Student's t of three degrees of freedom.
        let half = 3.182_446_305_284_263 * (variance / 4.0).sqrt();
        let figure = |name: &str| row[place_of(name)].parse::<f64>().unwrap();
        assert!((figure("peak_contact_force_N_mean") - mean).abs() < 1e-9 * mean);
        assert!((figure("peak_contact_force_N_ci95_low") - mean + half).abs() < 1e-9 * mean);
        assert!((figure("peak_contact_force_N_ci95_high") - mean - half).abs() < 1e-9 * mean);
    }
    assert!(place.read("s/index.html").contains("Means over the starts"));
    // Without starts there are no means, and the page says what that is worth.
    place.good("sweep --vary joints.clearance=1e-4,5e-4 --duration 0.1 --quiet --out t");
    assert!(!place.path("t/statistics.csv").exists());
    let page = place.read("t/index.html");
    assert!(page.contains("are one draw"));
    // The median of two is their mean.
    let table = place.read("t/sweep.csv");
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let peak = rows.headers().unwrap().iter().position(|h| h == "peak_contact_force_N").unwrap();
    let peaks: Vec<f64> = rows.records().map(|row| row.unwrap()[peak].parse().unwrap()).collect();
    let middle = freeplay::report::number(0.5 * (peaks[0] + peaks[1]));
    let [low, high] =
        [peaks[0].min(peaks[1]), peaks[0].max(peaks[1])].map(freeplay::report::number);
    let facts: String =
        page.split('<').filter_map(|part| part.split_once('>')).map(|(_, t)| t).collect();
    assert!(facts.contains(&format!("{middle}median; from {low} to {high}")), "{facts}");
}

/// Runs draw no random numbers: rows that differ in their seed alone are equal and no starts of their own.
#[test]
fn a_varied_seed_is_told_and_counts_as_no_start() {
    let place = Place::new();
    let done = place.freeplay(&format!("sweep {SHORT} --vary seed=1,2,3 --out s --quiet"));
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(done.err.starts_with("warning: --vary seed changes nothing"), "{}", done.err);
    assert!(!place.path("s/statistics.csv").exists());
}

/// A key that no run looks at is told, one that some runs look at is not.
#[test]
fn keys_that_act_in_no_run_are_told() {
    let place = Place::new();
    let idle = "--set drive.stiffness=1e6";
    let done = place.freeplay(&format!(
        "sweep {SHORT} {idle} --vary joints.clearance=1e-4,2e-4 --out a --quiet"
    ));
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(
        done.err.starts_with("warning: --set drive.stiffness: changes nothing"),
        "{}",
        done.err
    );
    assert_eq!(done.err.lines().count(), 1, "{}", done.err);
    place.good(&format!("sweep {SHORT} {idle} --vary drive.mode=servo,prescribed --out b --quiet"));
}

#[test]
fn values_and_parts_that_are_given_twice_are_refused() {
    let place = Place::new();
    let says = ["--vary joints.clearance=1e-4,0.0001", "stands there twice"];
    place.refused(&format!("sweep {SHORT} --vary joints.clearance=1e-4,0.0001"), &says);
    place.good(&format!("sweep {SHORT} --vary motion.phase=0,1 --out s --quiet"));
    place.refused("merge s ./s --out all", &["`./s` is given twice", "each part once"]);
}
