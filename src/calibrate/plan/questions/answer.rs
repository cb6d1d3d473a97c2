//! How far apart one motion brings the models of a question.

use super::separation::{Apart, PosedQuestion, apart, detectable, nearest};
use super::sight::Sight;
use crate::effects::Setting;

/// How far apart the models of a question are on one motion.
#[derive(Clone, Debug)]
pub struct MotionAnswer {
    /// Standard deviations.
    pub sigma: f64,
    /// Residuals that carry it, by name, with their shares of its square, the largest first.
    pub carried: Vec<(String, f64)>,
    /// Smallest size of an effect that would be named.
    pub smallest: Option<f64>,
}

/// How far apart the models of a question are on a motion, rivals fitted to each other with all their values, and the
/// question with the nearest values.
pub(in crate::calibrate::plan) fn answered(
    sight: &Sight,
    posed: &PosedQuestion,
) -> (PosedQuestion, MotionAnswer) {
    let seen = sight.own();
    let carried = |apart: &Apart| {
        let names = sight.names.iter().map(|name| format!("{} of {}", name.kind.word(), name.of));
        let mut carried: Vec<(String, f64)> = names.zip(sight.shares(&apart.difference)).collect();
        carried.sort_by(|a, b| b.1.total_cmp(&a.1));
        carried
    };
    let nothing = || MotionAnswer { sigma: 0.0, carried: Vec::new(), smallest: None };
    match posed {
        PosedQuestion::Detect { effect, .. } => {
            let found = apart(sight, &seen, posed);
            let smallest = detectable(sight, &seen, effect);
            let answer = found.map(|apart| MotionAnswer {
                sigma: apart.sigma,
                carried: carried(&apart),
                smallest,
            });
            (posed.clone(), answer.unwrap_or_else(nothing))
        }
        PosedQuestion::Between { rivals, pairs } => {
            let fitted = |[truth, rival]: &[Setting; 2]| {
                let (rival, apart) = nearest(sight, &seen, std::slice::from_ref(truth), rival)?;
                Some(([truth.clone(), rival], apart))
            };
            let fits: Option<Vec<_>> = pairs.iter().map(fitted).collect();
            let Some(mut fits) = fits else { return (posed.clone(), nothing()) };
            fits.sort_by(|a, b| a.1.sigma.total_cmp(&b.1.sigma));
            let answer = fits.first().map(|(_, apart)| MotionAnswer {
                sigma: apart.sigma,
                carried: carried(apart),
                smallest: None,
            });
            let pairs = fits.into_iter().map(|(pair, _)| pair).collect();
            (
                PosedQuestion::Between { rivals: rivals.clone(), pairs },
                answer.unwrap_or_else(nothing),
            )
        }
    }
}
