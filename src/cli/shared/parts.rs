//! Work in parts, as an array of jobs in a cluster's queue does it: which part, which parts are missing, on how many
//! threads.

use super::failure::Failure;
use super::output;
use crate::study::sweep::Shard;
use clap::Args;
use std::env;
use std::path::{Path, PathBuf};

/// Which part of many runs, or what is to be known of the parts.
#[derive(Debug, Args)]
pub(in crate::cli) struct PartOptions {
    /// Make part I of N, counted from 1
    #[arg(long, value_name = "I/N", default_value_t = Shard::WHOLE)]
    pub shard: Shard,
    /// Make nothing: print which of N parts are not complete and not at work, as the list of a job array takes
    /// them (`2,5-7`); the file or folder of a part is named with `{}` for its number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST_PARTS))]
    #[arg(conflicts_with_all = ["shard", "dry_run"])]
    pub missing: Option<u32>,
    /// Make nothing: print how many there are, how many are done, and what the rest will take
    #[arg(long)]
    pub dry_run: bool,
    /// Threads [default: as many as the queue gave (SLURM_CPUS_PER_TASK, PBS's NCPUS, Grid Engine's NSLOTS, LSF's
    /// LSB_DJOB_NUMPROC), otherwise one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

/// Most parts: the largest job array that queues are commonly set up for is ten times smaller.
const MOST_PARTS: i64 = 100_000;

/// What queues call the number of cores that a job was given.
const CORES: [&str; 4] = ["SLURM_CPUS_PER_TASK", "NCPUS", "NSLOTS", "LSB_DJOB_NUMPROC"];

/// What stands for the number of a part in a name.
const NUMBER: &str = "{}";

impl PartOptions {
    /// Threads that were asked for, by the user or by the queue.
    pub fn threads(&self) -> Option<usize> {
        self.threads.map(usize::from).or_else(threads_of_queue)
    }

    /// All parts, where somebody asks which are missing. Their names have to differ.
    ///
    /// # Errors
    /// If `name`, which `flag` gave, does not say where the number of a part stands.
    pub fn asked_for(
        &self,
        flag: &str,
        name: Option<&Path>,
    ) -> Result<Option<Vec<Shard>>, Failure> {
        let Some(count) = self.missing else { return Ok(None) };
        if count > 1 && !name.is_some_and(|name| name.to_string_lossy().contains(NUMBER)) {
            let message = format!(
                "{flag}: with --missing the parts have names that differ by their number; expected `{NUMBER}` in its \
                 place, such as {flag} part-{NUMBER}"
            );
            return Err(Failure::Input(vec![message]));
        }
        let first = format!("1/{count}").parse::<Shard>().map_err(|e| Failure::Input(vec![e]))?;
        Ok(Some((0..count as usize).map(|number| first.sibling(number)).collect()))
    }

    /// The options that mean something for work in parts only and were given.
    pub fn given(&self) -> Vec<&'static str> {
        let given = [
            ("--shard", self.shard != Shard::WHOLE),
            ("--missing", self.missing.is_some()),
            ("--dry-run", self.dry_run),
            ("--threads", self.threads.is_some()),
        ];
        given.into_iter().filter(|(_, given)| *given).map(|(flag, _)| flag).collect()
    }
}

/// Number of cores that a queue gave to this job, if it is one.
pub fn threads_of_queue() -> Option<usize> {
    CORES.into_iter().find_map(cores)
}

/// The name of a part.
pub(in crate::cli) fn named(name: &Path, shard: Shard) -> PathBuf {
    name.to_string_lossy().replace(NUMBER, &shard.index().to_string()).into()
}

/// Numbers in ascending order as a list of single ones and stretches: `1,3-5`.
pub(in crate::cli) fn list(numbers: &[usize]) -> String {
    let mut stretches: Vec<[usize; 2]> = Vec::new();
    for &number in numbers {
        match stretches.last_mut() {
            Some([_, end]) if *end + 1 == number => *end = number,
            _ => stretches.push([number, number]),
        }
    }
    let words = stretches.into_iter().map(|[first, last]| match last - first {
        0 => first.to_string(),
        _ => format!("{first}-{last}"),
    });
    words.collect::<Vec<_>>().join(",")
}

/// The number that a variable of the environment holds; a warning where it holds anything else.
fn cores(variable: &str) -> Option<usize> {
    let value = env::var_os(variable)?;
    let number = value.to_str().and_then(|text| text.trim().parse().ok()).filter(|n| *n > 0);
    if number.is_none() {
        output::complain(&format!(
            "warning: {variable}={} is no number of threads and is not used; give --threads",
            value.display()
        ));
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_as_queues_read_them() {
        for (numbers, expected) in [
            (&[][..], ""),
            (&[3], "3"),
            (&[1, 2, 3], "1-3"),
            (&[1, 3, 4, 7, 9, 10], "1,3-4,7,9-10"),
        ] {
            assert_eq!(list(numbers), expected);
        }
    }

    #[test]
    fn parts_have_their_number_in_their_name() {
        let shard = "3/8".parse().expect("right");
        assert_eq!(named(Path::new("a/part-{}"), shard), PathBuf::from("a/part-3"));
        assert_eq!(named(Path::new("all"), shard), PathBuf::from("all"));
    }
}
