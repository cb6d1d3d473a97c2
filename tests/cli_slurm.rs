//! A sweep as a job array of a real Slurm, on one node of its own: tasks are killed, what is missing is resubmitted, and the
//! parts join to the table of one machine. Where Slurm is not installed (Debian: slurmctld, slurmd, slurm-client, munge)
//! the test says so and is skipped.
#![cfg(unix)]

mod cli_common;

use cli_common::Place;
use std::process::{Command, Output};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Longest time that anything here may take: the whole array takes some seconds on a computer that is busy.
const PATIENCE: Duration = Duration::from_secs(300);

/// A cluster of this computer alone, with its keys, ports and files in one folder.
struct Cluster {
    place: Place,
}

impl Cluster {
    /// None where Slurm is not installed, or somebody without the rights starts it.
    fn start() -> Option<Cluster> {
        let found = |name: &str| Command::new(name).arg("-V").output().is_ok();
        let root = Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout == b"0\n");
        if !(root && ["munged", "slurmctld", "slurmd", "sbatch"].into_iter().all(found)) {
            eprintln!("skipped: Slurm is not installed, or this is not root");
            return None;
        }
        let place = Place::new();
        let folder = place.path("");
        let at = folder.display();
        let name = Command::new("hostname").arg("-s").output().unwrap().stdout;
        let name = String::from_utf8(name).unwrap();
        for folder in ["slurm", "slurm/state", "slurm/spool"] {
            std::fs::create_dir(place.path(folder)).unwrap();
        }
        place.write(
            "slurm/munge.key",
            &"a key of this test alone, which nobody else reads. ".repeat(3),
        );
        place.write("slurm/slurm.conf", &configuration(name.trim(), &format!("{at}/slurm")));
        // munge wants a key that is its owner's, below folders that nobody else may write to.
        run(Command::new("chmod").args(["600", &format!("{at}/slurm/munge.key")]));
        run(Command::new("chmod").args(["755", &format!("{at}"), &format!("{at}/slurm")]));
        let cluster = Cluster { place };
        let munge = ["key-file=munge.key", "socket=munge.sock", "pid-file=munged.pid"]
            .into_iter()
            .chain(["log-file=munged.log", "seed-file=munge.seed"])
            .map(|option| option.replacen('=', &format!("={at}/slurm/"), 1));
        run(Command::new("munged").arg("--force").args(munge.map(|option| format!("--{option}"))));
        run(&mut cluster.slurm("slurmctld", ""));
        run(&mut cluster.slurm("slurmd", ""));
        cluster.until("the node is idle", || cluster.say("sinfo", "-h -o %T") == "idle");
        Some(cluster)
    }

    /// A command of Slurm about this cluster, its arguments split at blanks.
    fn slurm(&self, command: &str, arguments: &str) -> Command {
        let mut slurm = Command::new(command);
        slurm.env("SLURM_CONF", self.place.path("slurm/slurm.conf"));
        slurm.current_dir(self.place.path("")).args(arguments.split_whitespace());
        slurm
    }

    /// What a command of Slurm prints.
    fn say(&self, command: &str, arguments: &str) -> String {
        let output = run(&mut self.slurm(command, arguments));
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    }

    fn until(&self, what: &str, holds: impl Fn() -> bool) {
        let started = Instant::now();
        while !holds() {
            let log = || std::fs::read_to_string(self.place.path("slurm/slurmctld.log"));
            assert!(
                started.elapsed() < PATIENCE,
                "not in time: {what}\n{}",
                log().unwrap_or_default()
            );
            sleep(Duration::from_millis(50));
        }
    }

    /// Waits until all tasks of a job have ended.
    fn wait_for(&self, job: &str) {
        self.until("the array has ended", || self.say("squeue", "-h -o %i").is_empty());
        assert!(!self.say("scontrol", &format!("show job {job}")).is_empty());
    }

    /// State and exit code of a task.
    fn ended(&self, job: &str, task: u32) -> String {
        let shown = self.say("scontrol", &format!("-o show job {job}_{task}"));
        let value = |key: &str| {
            let found = shown.split(' ').find_map(|word| word.strip_prefix(key));
            found.unwrap_or_else(|| panic!("no {key} in {shown}")).to_owned()
        };
        format!("{} {}", value("JobState="), value("ExitCode="))
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        for daemon in ["slurmd", "slurmctld", "munged"] {
            let file = self.place.path(&format!("slurm/{daemon}.pid"));
            if let Ok(id) = std::fs::read_to_string(file) {
                let _ = Command::new("kill").arg(id.trim()).status();
            }
        }
        // They write into the folder until they have ended.
        sleep(Duration::from_millis(500));
    }
}

fn configuration(name: &str, at: &str) -> String {
    format!(
        "ClusterName=freeplay\nSlurmctldHost={name}(127.0.0.1)\nSlurmctldPort=46817\nSlurmdPort=46818\n\
         AuthType=auth/munge\nAuthInfo=socket={at}/munge.sock\nSlurmUser=root\nSlurmdUser=root\n\
         StateSaveLocation={at}/state\nSlurmdSpoolDir={at}/spool\nSlurmctldPidFile={at}/slurmctld.pid\n\
         SlurmdPidFile={at}/slurmd.pid\nSlurmctldLogFile={at}/slurmctld.log\nSlurmdLogFile={at}/slurmd.log\n\
         ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nMpiDefault=none\nReturnToService=2\n\
         SelectType=select/cons_tres\nSelectTypeParameters=CR_CPU\nJobAcctGatherType=jobacct_gather/none\n\
         AccountingStorageType=accounting_storage/none\nMinJobAge=600\nKillWait=2\n\
         NodeName={name} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\n\
         PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n"
    )
}

fn run(command: &mut Command) -> Output {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    output
}

fn rows(place: &Place, part: u32) -> String {
    std::fs::read_to_string(place.path(&format!("part-{part}/rows.jsonl"))).unwrap_or_default()
}

fn sorted_lines(place: &Place, name: &str) -> Vec<String> {
    let mut lines: Vec<String> = place.read(name).lines().map(str::to_owned).collect();
    lines.sort();
    lines
}

impl Cluster {
    /// Ends a task by a signal: the queue's own way by SIGTERM; by what nobody can answer, as when memory is short, else.
    fn end(&self, job: &str, task: u32, signal: &str) {
        match signal {
            // It ends with 1 where the task is gone before it looks again: what became of the task is what counts.
            "TERM" => {
                let arguments = format!("--signal=TERM --full {job}_{task}");
                drop(self.slurm("scancel", &arguments).output().unwrap());
            }
            _ => {
                let process = self.place.read(&format!("pid-{task}"));
                drop(run(Command::new("kill").args(["-KILL", process.trim()])));
            }
        }
    }
}

/// Ten runs a task, each of a quarter of a second: long enough to be ended between two of them.
const SWEEP: &str = "sweep --duration 0.8 --vary joints.clearance=1e-4..1e-3:log:20 --vary motion.phase=0..5:4 --quiet";

/// An array of `parts` tasks, of which two are ended in the middle: one by SIGTERM, as a queue does at the end of its time,
/// one at once.
fn killed_and_resubmitted(sweep: &str, parts: u32) {
    let Some(cluster) = Cluster::start() else { return };
    let place = &cluster.place;
    let program = env!("CARGO_BIN_EXE_freeplay");
    // As docs/clusters.md has it.
    place.write(
        "job.sh",
        &format!("#!/bin/sh\necho $$ > pid-$SLURM_ARRAY_TASK_ID\nexec {program} {sweep} --shard $SLURM_ARRAY_TASK_ID/{parts} --out 'part-{{}}'\n"),
    );
    let submit = |tasks: &str| {
        let options = "--parsable --cpus-per-task=1 --output=log-%a.txt --no-requeue";
        cluster.say("sbatch", &format!("{options} --array={tasks} job.sh"))
    };
    let missing =
        || place.good(&format!("{sweep} --missing {parts} --out part-{{}}")).trim().to_owned();
    assert_eq!(missing(), format!("1-{parts}"));

    let job = submit(&format!("1-{parts}"));
    let [first, second] = [2, parts - 2];
    let mut before = Vec::new();
    for (task, signal) in [(first, "TERM"), (second, "KILL")] {
        cluster.until("the task has made a row", || rows(place, task).contains('\n'));
        cluster.end(&job, task, signal);
        cluster.until("the task has ended", || !cluster.ended(&job, task).starts_with("RUNNING"));
        before.push((task, rows(place, task)));
    }
    cluster.wait_for(&job);
    assert_eq!(cluster.ended(&job, first), "FAILED 75:0", "{}", place.read("log-2.txt"));
    assert_eq!(cluster.ended(&job, second), "FAILED 0:9");
    assert_eq!(cluster.ended(&job, 1), "COMPLETED 0:0");
    let log = place.read(&format!("log-{first}.txt"));
    assert!(log.contains("the same command goes on from there"), "{log}");

    assert_eq!(missing(), format!("{first},{second}"));
    let given: Vec<String> = (1..=parts).map(|part| format!("part-{part}")).collect();
    let given = given.join(" ");
    let unfinished = format!("`part-{first}` (shard {first}/{parts}) is unfinished");
    place.refused(&format!("merge {given} --out all"), &["rows are missing", &unfinished]);

    let job = submit(&missing());
    cluster.wait_for(&job);
    assert_eq!(cluster.ended(&job, first), "COMPLETED 0:0");
    assert_eq!(missing(), "");
    for (task, made) in before {
        assert!(
            rows(place, task).starts_with(&made),
            "part {task} was made again from its beginning"
        );
    }
    place.good(&format!("merge {given} --out all --quiet"));
    place.good(&format!("{sweep} --out one"));
    for file in ["sweep.csv", "scenario.toml"] {
        assert_eq!(place.read(&format!("all/{file}")), place.read(&format!("one/{file}")));
    }
    assert_eq!(sorted_lines(place, "all/rows.jsonl"), sorted_lines(place, "one/rows.jsonl"));
}

#[test]
fn an_array_of_eight_two_of_them_killed_gives_the_table_of_one_machine() {
    killed_and_resubmitted(SWEEP, 8);
}
