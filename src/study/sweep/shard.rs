//! A part of a sweep, so that many machines can share it.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Part `index` of `count`, counted from 1: every run whose number leaves `index` − 1 when divided
/// by `count`. Neighbours, which tend to cost the same, go to different parts.
///
/// ```
/// use freeplay::study::sweep::Shard;
///
/// let parts: Vec<Shard> = ["1/2", "2/2"].iter().map(|part| part.parse().unwrap()).collect();
/// assert!((0..10).all(|run| parts.iter().filter(|part| part.holds(run)).count() == 1), "each run is of one part");
/// assert!("3/2".parse::<Shard>().is_err() && Shard::WHOLE.holds(7));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Shard = Shard { index: 1, count: 1 };

    /// Whether run `run` belongs to this part.
    pub fn holds(self, run: usize) -> bool {
        run % self.count == self.index - 1
    }

    /// Which part it is, counted from 1.
    pub fn index(self) -> usize {
        self.index
    }

    /// The one of its parts, itself among them, that run `run` belongs to.
    pub fn sibling(self, run: usize) -> Shard {
        Shard { index: run % self.count + 1, count: self.count }
    }

    /// Those of `runs` runs that belong to this part.
    pub fn runs(self, runs: usize) -> impl Iterator<Item = usize> {
        (self.index - 1..runs).step_by(self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, count)| {
            Some((index.trim().parse().ok()?, count.trim().parse().ok()?))
        });
        match numbers {
            Some((index, count)) if 1 <= index && index <= count => Ok(Shard { index, count }),
            Some((index, count)) => Err(format!(
                "shard {index} of {count} does not exist; shards count from 1: 1/{0} to {0}/{0}",
                count.max(1)
            )),
            None => Err("expected I/N, such as 1/4 for the first of four parts".to_owned()),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl TryFrom<String> for Shard {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> String {
        shard.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_divide_the_runs() {
        let shards: Vec<Shard> = ["1/3", "2/3", "3/3"].map(|s| s.parse().expect("right")).into();
        for run in 0..10 {
            assert_eq!(shards.iter().filter(|shard| shard.holds(run)).count(), 1);
            assert!(shards[1].sibling(run).holds(run));
        }
        assert_eq!(shards[1].runs(8).collect::<Vec<_>>(), [1, 4, 7]);
        assert_eq!(shards[2].runs(2).count(), 0);
    }

    #[test]
    fn shards_that_do_not_exist() {
        for text in ["0/2", "3/2", "1/0", "1", "a/b", "-1/2", ""] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
