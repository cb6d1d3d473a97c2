//! What a fit by windows can do without: values that nothing tells from others, and terms that are not certain.

use super::sought::Sought;
use crate::calibrate::sensed::thresholds::{CERTAIN, TOLD};
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};

/// What an elimination leaves: values that are fixed and where, all values, and effects that went with what their
/// last term was worth.
#[derive(Debug)]
pub struct KeptValues {
    /// Where fixed ones are.
    pub fixed: Vec<Option<f64>>,
    /// All of them.
    pub values: Vec<f64>,
    /// By index of effect.
    pub gains: Vec<(usize, f64)>,
}

/// What is left of what was sought: first values are fixed that windows cannot tell from others, then terms
/// that are not certain, the least certain first. A term goes to nothing or to what is declared, whichever is nearer,
/// and the others become what they then are, `θ − C_d C_dd⁻¹ δ` with covariance `C − C_d C_dd⁻¹ C_dᵀ`.
pub fn eliminated(
    sought: &Sought,
    values: Vec<f64>,
    mut covariance: DMatrix<f64>,
    information: &DMatrix<f64>,
) -> KeptValues {
    let mut now = DVector::zeros(covariance.nrows());
    now.rows_mut(0, values.len()).copy_from_slice(&values);
    let mut fixed: Vec<Option<f64>> = vec![None; values.len()];
    let mut fix = |places: &[usize], at: &[f64], now: &mut DVector<f64>, c: &mut DMatrix<f64>| {
        for (k, value) in places.iter().zip(at) {
            fixed[*k] = Some(*value);
        }
        let across = c.select_columns(places);
        let Some(inverse) = inverse(&across.select_rows(places)) else { return };
        let part = DVector::from_fn(places.len(), |i, _| now[places[i]] - at[i]);
        *now -= &across * (&inverse * part);
        *c -= &across * inverse * across.transpose();
        for (k, value) in sought.values.iter().enumerate() {
            now[k] = now[k].clamp(value.bounds[0], value.bounds[1]);
        }
    };
    let twins = untold(sought, information);
    for k in &twins {
        fix(&[*k], &[sought.values[*k].prior[0]], &mut now, &mut covariance);
    }
    let mut terms = sought.terms();
    terms.iter_mut().for_each(|term| term.retain(|k| !twins.contains(k)));
    terms.retain(|term| !term.is_empty());
    let mut lost = vec![None; sought.effects.len()];
    while let Some((least, at, gain)) =
        least_certain(sought, &terms, &covariance, &now).filter(|(_, _, gain)| *gain < CERTAIN)
    {
        let term = terms.swap_remove(least);
        fix(&term, &at, &mut now, &mut covariance);
        let effect = sought.effect_of(term[0]);
        if terms.iter().all(|term| sought.effect_of(term[0]) != effect) {
            lost[effect] = Some(gain);
        }
    }
    let gains = lost.iter().enumerate().filter_map(|(i, gain)| Some((i, (*gain)?))).collect();
    KeptValues { fixed, values: now.rows(0, values.len()).iter().copied().collect(), gains }
}

/// The term whose change from nothing or from what is declared is least certain, where that is, and its gain.
fn least_certain(
    sought: &Sought,
    terms: &[Vec<usize>],
    covariance: &DMatrix<f64>,
    now: &DVector<f64>,
) -> Option<(usize, Vec<f64>, f64)> {
    let tried = terms.iter().enumerate().flat_map(|(i, term)| {
        let declared: Vec<f64> = term.iter().map(|&k| sought.values[k].prior[0]).collect();
        let nothing = sought.is_amount(term[0]).then(|| vec![0.0; term.len()]);
        nothing.into_iter().chain([declared]).map(move |at| {
            let mut change = now.clone();
            term.iter().zip(&at).for_each(|(&k, at)| change[k] -= at);
            let gain = gain(covariance, &change, term);
            (i, at, gain)
        })
    });
    tried.min_by(|a, b| a.2.total_cmp(&b.2))
}

/// Values that windows do not tell from others together, by the trace that each leaves in units of what is expected
/// of it. Amounts are not among them: they come first, and go where they are not certain.
fn untold(sought: &Sought, information: &DMatrix<f64>) -> Vec<usize> {
    let n = sought.values.len();
    if information.nrows() < n {
        return Vec::new();
    }
    let size = |k: usize| sought.values.get(k).map_or(1.0, |value| value.prior[1]);
    let all = information.nrows();
    let mut left = DMatrix::from_fn(all, all, |i, j| information[(i, j)] * size(i) * size(j));
    let own: Vec<f64> = left.diagonal().iter().copied().collect();
    let told = |k: usize, left: &DMatrix<f64>| left[(k, k)] > 1.0f64.max(TOLD * TOLD * own[k]);
    let (first, mut rest): (Vec<usize>, Vec<usize>) =
        (0..all).partition(|&k| k >= n || sought.is_amount(k));
    let take = |k: usize, left: &mut DMatrix<f64>| {
        let column = left.column(k).into_owned();
        *left -= &column * column.transpose() / column[k];
    };
    for k in first {
        if told(k, &left) {
            take(k, &mut left);
        }
    }
    while let Some(k) = rest
        .iter()
        .copied()
        .filter(|&k| told(k, &left))
        .max_by(|a, b| left[(*a, *a)].total_cmp(&left[(*b, *b)]))
    {
        take(k, &mut left);
        rest.retain(|other| *other != k);
    }
    rest
}

/// Whether an effect does nothing: every value is 0 that is 0 where it is not given.
pub fn is_nothing(effect: &Setting) -> bool {
    let amounts = effect.kind.parameters.iter().filter(|p| p.default == Some(0.0));
    let mut amounts =
        amounts.map(|parameter| effect.value(parameter.name).unwrap_or(0.0)).peekable();
    amounts.peek().is_some() && amounts.all(|value| value == 0.0)
}

/// Inverse of a covariance, in units of its deviations; values that are not known at all are left alone.
fn inverse(block: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale: Vec<f64> = (0..block.nrows()).map(|i| block[(i, i)].max(1e-300).sqrt()).collect();
    let unit = DMatrix::from_fn(block.nrows(), block.ncols(), |i, j| {
        block[(i, j)] / (scale[i] * scale[j]) + if i == j { 1e-9 } else { 0.0 }
    });
    let inverse = unit.try_inverse()?;
    Some(DMatrix::from_fn(block.nrows(), block.ncols(), |i, j| {
        inverse[(i, j)] / (scale[i] * scale[j])
    }))
}

/// `θᵀ C⁻¹ θ` of some places.
pub fn gain(covariance: &DMatrix<f64>, change: &DVector<f64>, places: &[usize]) -> f64 {
    let block = covariance.select_columns(places).select_rows(places);
    let part = change.select_rows(places);
    inverse(&block).map_or(0.0, |inverse| part.dot(&(inverse * &part)))
}
