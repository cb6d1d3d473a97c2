//! What candidates change of residuals beside the declared model, kept: every search for where a candidate starts asks for the
//! same ones, and beside another model they are the same but for what its effects change of the machine.

use super::problem::{RigProblem, Segment};
use crate::calibrate::measured::draws::{Coefficients, difference};
use crate::calibrate::sensed::motion::start::machine;
use crate::effects::Setting;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Numbers of eight bytes that are kept together: 128 MB, some thousand responses on three seconds of a machine with nine
/// residuals.
const ROOM: usize = 16 << 20;

/// Responses by what they are of.
#[derive(Debug, Default)]
pub(super) struct Responses(Mutex<KeptResponses>);

#[derive(Debug, Default)]
struct KeptResponses {
    known: HashMap<String, Arc<Coefficients>>,
    numbers: usize,
}

impl Responses {
    fn known(&self, key: &str) -> Option<Arc<Coefficients>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).known.get(key).cloned()
    }

    /// Keeps one if there is room: what is found anew is the same.
    fn keep(&self, key: String, response: &Arc<Coefficients>) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let numbers = response.iter().map(Vec::len).sum::<usize>();
        if kept.numbers + numbers <= ROOM {
            kept.numbers += numbers;
            kept.known.insert(key, Arc::clone(response));
        }
    }
}

impl RigProblem {
    /// What an effect changes of the coefficients of residuals on a segment, beside the declared model; none where there is no
    /// such machine.
    pub fn response(&self, effect: &Setting, segment: &Segment) -> Option<Arc<Coefficients>> {
        let declared = self.kept_look(&[], segment, |seen| seen)?;
        let effects = std::slice::from_ref(effect);
        self.kept_look(effects, segment, |seen| difference(&seen, &declared))
    }

    /// What is made of the coefficients that a model with these effects is seen with, kept.
    fn kept_look(
        &self,
        effects: &[Setting],
        segment: &Segment,
        made: impl FnOnce(Coefficients) -> Coefficients,
    ) -> Option<Arc<Coefficients>> {
        let key = format!("{segment:?} {:?} {effects:?}", self.rig.effects);
        if let Some(known) = self.responses.known(&key) {
            return Some(known);
        }
        let run = &self.runs[segment.run];
        let machine = machine(&self.rig, effects, &run.recording).ok()?;
        let made = Arc::new(made(self.coefficients(&run.view, &machine, segment)?));
        self.responses.keep(key, &made);
        Some(made)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Target, named};

    /// What a payload changes is the difference of two looks, and is found once.
    #[test]
    fn a_response_is_the_difference_of_two_looks() {
        let problem = RigProblem::planar("planar-1");
        let segment = problem.split().on.remove(0);
        let target = Target::Body("piston".to_owned());
        let payload = Setting::on(named("payload").unwrap(), target, &[("mass_kg", 0.1)]);
        let look = |effects: &[Setting]| {
            let run = &problem.runs[segment.run];
            let machine = machine(&problem.rig, effects, &run.recording).unwrap();
            problem.coefficients(&run.view, &machine, &segment).unwrap()
        };
        let expected = difference(&look(std::slice::from_ref(&payload)), &look(&[]));
        let [found, again] = [(); 2].map(|()| problem.response(&payload, &segment).unwrap());
        assert_eq!(*found, expected);
        assert!(Arc::ptr_eq(&found, &again));
    }

    /// What has no room is found anew.
    #[test]
    fn no_more_is_kept_than_there_is_room_for() {
        let responses = Responses::default();
        let response = Arc::new(vec![vec![0.0; ROOM / 2 + 1]]);
        for key in ["first", "second"] {
            responses.keep(key.to_owned(), &response);
        }
        assert!(responses.known("first").is_some() && responses.known("second").is_none());
    }
}
