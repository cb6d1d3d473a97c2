//! What candidates change of residuals beside the declared model, kept: every search for where a candidate starts asks for the
//! same ones, and beside another model they are the same but for what its effects change of the machine.

use crate::calibrate::values::draws::Coefficients;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Numbers of eight bytes that are kept together: 128 MB, some thousand responses on three seconds of a machine with nine
/// residuals.
const ROOM: usize = 16 << 20;

/// Coefficients of residuals by what they are of.
#[derive(Debug, Default)]
pub(in crate::calibrate::sensed) struct Responses(Mutex<KeptResponses>);

#[derive(Debug, Default)]
struct KeptResponses {
    known: HashMap<String, Arc<Coefficients>>,
    numbers: usize,
}

impl Responses {
    /// What was found under this key, or what is found now, kept if there is room: what is found anew is the same.
    pub fn known_or(
        &self,
        key: String,
        find: impl FnOnce() -> Option<Coefficients>,
    ) -> Option<Arc<Coefficients>> {
        let kept = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = kept().known.get(&key) {
            return Some(Arc::clone(known));
        }
        let found = Arc::new(find()?);
        let numbers = found.iter().map(Vec::len).sum::<usize>();
        let mut kept = kept();
        if kept.numbers + numbers <= ROOM && kept.known.insert(key, Arc::clone(&found)).is_none() {
            kept.numbers += numbers;
        }
        Some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What has no room is found anew.
    #[test]
    fn no_more_is_kept_than_there_is_room_for() {
        let responses = Responses::default();
        let large = || Some(vec![vec![0.0; ROOM / 2 + 1]]);
        for key in ["first", "second"] {
            responses.known_or(key.to_owned(), large);
        }
        assert!(responses.known_or("first".to_owned(), || None).is_some());
        assert!(responses.known_or("second".to_owned(), || None).is_none());
    }
}
