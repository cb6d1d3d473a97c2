//! Questions with numbers: how large an effect has to be, and which values make rivals alike.

use super::motions::motion::DrivesMotion;
use super::prepare::PreparedPlan;
use super::questions::asked::Question;
use super::questions::separation::{PosedQuestion, detectable, nearest, shows, sized};
use super::questions::sight::{Seen, Sight};
use crate::calibrate::results::result::CalibrateError;
use crate::calibrate::sensed::recording::Recording;
use crate::effects::Setting;
use rayon::prelude::*;

/// How many times its present detection limit a rival is large where nobody says: clearly there, and not so large that
/// anything tells it from anything.
const LARGE: f64 = 2.0;

/// Questions with numbers. What the present motion does not show is looked for along random ones.
pub fn pose_all(
    prepared: &PreparedPlan,
    reference: &Sight,
    frozen: &Sight,
    random: &[(DrivesMotion, Recording)],
) -> Result<Vec<PosedQuestion>, CalibrateError> {
    let seen = reference.own();
    let recorded = |(_, like): &(DrivesMotion, Recording)| {
        Seen::ideal(&prepared.described, like, prepared.control).ok()
    };
    let others: Vec<Seen> = random.par_iter().filter_map(recorded).collect();
    let mut wrong = Vec::new();
    let mut posed = Vec::new();
    for question in &prepared.questions {
        match pose(question, reference, &seen, frozen, &others) {
            Ok(one) => posed.push(one),
            Err(message) => wrong.push(message),
        }
    }
    crate::calibrate::results::result::refuse(wrong)?;
    Ok(posed)
}

/// The size at which an effect would be named, on the present motion or else on the random one that shows it best.
fn size_of(
    effect: &Setting,
    reference: (&Sight, &Seen),
    frozen: &Sight,
    others: &[Seen],
) -> Result<f64, String> {
    let present = detectable(reference.0, reference.1, effect);
    let elsewhere = || {
        let sizes = others.iter().filter_map(|seen| detectable(frozen, seen, effect));
        sizes.reduce(f64::min)
    };
    present.or_else(elsewhere).ok_or_else(|| {
        let columns: Vec<&str> = reference.0.declared().sensors.iter().map(|s| s.column.as_str()).collect();
        format!(
            "{effect}: no sensor of this rig can see it, on the present motion or any of {} others, at any size that \
             makes sense; the residuals of {} stay as they are. Another sensor would have to",
            others.len(),
            columns.join(", ")
        )
    })
}

fn pose(
    question: &Question,
    reference: &Sight,
    seen: &Seen,
    frozen: &Sight,
    others: &[Seen],
) -> Result<PosedQuestion, String> {
    match question {
        Question::Detect(effect, size) => {
            let found = size_of(effect, (reference, seen), frozen, others)?;
            let mut ways = sized(reference.declared(), effect, size.unwrap_or(found));
            ways.retain(|way| {
                shows(reference, seen, way) || others.iter().any(|seen| shows(frozen, seen, way))
            });
            Ok(PosedQuestion::Detect { effect: effect.clone(), ways })
        }
        Question::Between(a, b) => {
            // An effect of a report comes with its values.
            let names: Vec<&'static str> = a.values().map(|(name, _)| name).collect();
            let neutral = Setting::neutral(a.kind, a.target.clone(), &names, reference.declared());
            let given = neutral.is_none_or(|neutral| *a != neutral);
            let large = |effect: &Setting| -> Result<Setting, String> {
                let size = LARGE * size_of(effect, (reference, seen), frozen, others)?;
                Ok(sized(reference.declared(), effect, size)
                    .into_iter()
                    .next()
                    .unwrap_or_else(|| effect.clone()))
            };
            let by = |truth: &Setting, rival: &Setting| {
                let found = nearest(reference, seen, std::slice::from_ref(truth), rival);
                found
                    .map(|(rival, _)| rival)
                    .ok_or_else(|| format!("{rival}: no value of it makes a machine that moves so"))
            };
            let (first, second) = (if given { a.clone() } else { large(a)? }, large(b)?);
            let rival = by(&first, b)?;
            // What a report holds for as good is as large as it has to be.
            let back = if given {
                [rival.clone(), first.clone()]
            } else {
                [second.clone(), by(&second, a)?]
            };
            Ok(PosedQuestion::Between {
                rivals: [a.clone(), b.clone()],
                pairs: vec![[first, rival], back],
            })
        }
    }
}
