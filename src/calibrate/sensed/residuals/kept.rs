//! Starts that are kept: that of a machine that nothing holds costs more than a simulation.

use crate::calibrate::sensed::motion::released::Released;
use lru::LruCache;
use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::num::NonZeroUsize;

/// Machines that are kept as they were let go: those of two models on eight runs each.
const KEPT: NonZeroUsize = NonZeroUsize::new(16).unwrap();

/// Machines as they were let go.
#[derive(Debug)]
pub(super) struct KeptStarts {
    starts: LruCache<String, Released>,
    /// Hashes of all that were kept so far.
    known: HashSet<u64>,
}

impl Default for KeptStarts {
    fn default() -> Self {
        Self { starts: LruCache::new(KEPT), known: HashSet::new() }
    }
}

impl KeptStarts {
    /// The one of this key, if it is still kept.
    pub fn get(&mut self, key: &str) -> Option<Released> {
        self.starts.get(key).cloned()
    }

    /// Keeps one; whether it never was kept before. Which are still kept hangs on the order in which threads ask, and so would
    /// the work for them if it were counted again.
    pub fn keep(&mut self, key: String, start: Released) -> bool {
        let mut hasher = DefaultHasher::new();
        key.hash(&mut hasher);
        self.starts.put(key, start);
        self.known.insert(hasher.finish())
    }

    /// Keeps none any more.
    #[cfg(test)]
    pub fn clear(&mut self) {
        self.starts.clear();
    }
}
