//! The inverse model of a held machine: efforts along the measured motion, linear in what is sought.
//!
//! `u = Σ θ_k c_k + e` at every row, both sides filtered alike, by least squares (Gautier, *Dynamic identification of
//! robots with power model*, ICRA 1997). Whatever filters both sides alike leaves the values alone; what differs between
//! sides does not, so the filter belongs to the figure: one for all.

use super::bench::HeldBench;
use super::terms::{HeldTerm, given};
use crate::calibrate::results::report::Fitted;
use crate::calibrate::sensed::thresholds::APART;
use crate::effects::{Kind, Setting};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;
use std::sync::Arc;

/// Terms and their values.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldModel {
    /// Summands with their values.
    pub terms: Vec<(HeldTerm, f64)>,
}

impl HeldModel {
    /// The least-squares values of `terms` over `rows` of a run, beside those of `fixed`, which stay; none where the
    /// run does not tell the terms apart.
    pub fn fit(
        bench: &HeldBench,
        run: usize,
        rows: Range<usize>,
        terms: &[HeldTerm],
        fixed: &[(HeldTerm, f64)],
    ) -> Option<HeldModel> {
        let columns: Vec<Arc<Vec<f64>>> =
            terms.iter().map(|term| bench.column(run, term)).collect();
        let mut rest = DVector::from_column_slice(&bench.left(run)[rows.clone()]);
        for (term, value) in fixed {
            let column = bench.column(run, term);
            rest -= DVector::from_column_slice(&column[rows.clone()]) * *value;
        }
        let matrix = DMatrix::from_fn(rest.len(), terms.len(), |i, k| columns[k][rows.start + i]);
        // Columns of one size: masses, frictions and lags differ by decades.
        let scales: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
        let matrix = DMatrix::from_fn(rest.len(), terms.len(), |i, k| matrix[(i, k)] / scales[k]);
        // Columns that say the same leave next to nothing of themselves when the others are taken out.
        let factor = matrix.tr_mul(&matrix).cholesky()?;
        let alike = factor
            .l_dirty()
            .diagonal()
            .iter()
            .zip(matrix.column_iter())
            .any(|(left, column)| *left < 1e-6 * column.norm());
        if alike {
            return None;
        }
        let solved = factor.solve(&matrix.tr_mul(&rest));
        let found = terms.iter().cloned().zip(solved.iter().zip(&scales).map(|(x, s)| x / s));
        Some(HeldModel { terms: found.chain(fixed.iter().cloned()).collect() })
    }

    /// The value of a term; 0 where the model has none.
    pub fn value(&self, term: &HeldTerm) -> f64 {
        self.terms.iter().find(|(own, _)| own == term).map_or(0.0, |(_, value)| *value)
    }

    /// Its terms alone.
    pub fn names(&self) -> Vec<HeldTerm> {
        self.terms.iter().map(|(term, _)| term.clone()).collect()
    }

    /// Whether it means anything: nothing gives back what it should take.
    pub fn is_physical(&self) -> bool {
        self.terms.iter().all(|(term, value)| term.allows(*value))
    }

    /// What it leaves of a run.
    pub fn left(&self, bench: &HeldBench, run: usize) -> Vec<f64> {
        let mut left = bench.left(run).to_vec();
        for (term, value) in &self.terms {
            for (left, x) in left.iter_mut().zip(bench.column(run, term).iter()) {
                *left -= value * x;
            }
        }
        left
    }

    /// Norm of what it leaves over norm of what was asked, over `rows` of a run.
    pub fn error(&self, bench: &HeldBench, run: usize, rows: Range<usize>) -> f64 {
        share(&self.left(bench, run)[rows.clone()], &bench.asked(run)[rows])
    }

    /// Standard deviations of the values by `stretches` of a run, in their order: what is left is coloured, so it
    /// counts stretch by stretch, `(XᵀX)⁻¹ (Σ_b Xᵀ_b e_b eᵀ_b X_b) (XᵀX)⁻¹` (Liang, Zeger, Biometrika 73 (1986) 13–22).
    pub fn deviations(
        &self,
        bench: &HeldBench,
        run: usize,
        stretches: &[Range<usize>],
    ) -> Vec<f64> {
        let columns: Vec<Arc<Vec<f64>>> =
            self.terms.iter().map(|(term, _)| bench.column(run, term)).collect();
        let left = self.left(bench, run);
        let count = columns.len();
        let norm = |column: &Arc<Vec<f64>>| column.iter().map(|x| x * x).sum::<f64>().sqrt();
        let scales: Vec<f64> = columns.iter().map(norm).collect();
        let mut normal = DMatrix::zeros(count, count);
        let mut meat = DMatrix::zeros(count, count);
        for rows in stretches {
            let mut moment = DVector::zeros(count);
            for i in rows.clone() {
                let row = DVector::from_fn(count, |k, _| columns[k][i] / scales[k]);
                normal += &row * row.transpose();
                moment += &row * left[i];
            }
            meat += &moment * moment.transpose();
        }
        let Some(inverse) = normal.try_inverse() else { return vec![f64::NAN; count] };
        let covariance = &inverse * meat * &inverse;
        (0..count).map(|k| covariance[(k, k)].max(0.0).sqrt() / scales[k]).collect()
    }

    /// Its effects, and their values with standard deviations out of those of its terms.
    pub fn effects(&self, deviations: &[f64]) -> Vec<(Setting, Vec<(&'static str, Fitted)>)> {
        let mut found: Vec<(Setting, Vec<(&'static str, Fitted)>)> = Vec::new();
        let terms = self.terms.iter().enumerate();
        for (k, (term, value)) in terms {
            let fitted = Fitted::new(*value, deviations.get(k).copied().unwrap_or(f64::NAN));
            let own = found.iter().position(|(known, _)| belongs(term, known));
            let Some(place) = own else {
                found.push((term.with(*value), vec![(term.sought, fitted)]));
                continue;
            };
            let (known, params) = &mut found[place];
            if let Some(phase) = phase(term.kind()) {
                *params = wave(params[0], (term.sought, fitted), phase);
            } else {
                params.push((term.sought, fitted));
            }
            let rest = known.values().filter(|(name, _)| params.iter().all(|(own, _)| own != name));
            let values: Vec<(&'static str, f64)> =
                params.iter().map(|(name, fitted)| (*name, fitted.value)).chain(rest).collect();
            *known = Setting::on(known.kind, known.target.clone(), &values);
        }
        found
    }

    /// The same without deviations.
    pub fn settings(&self) -> Vec<Setting> {
        self.effects(&[]).into_iter().map(|(effect, _)| effect).collect()
    }
}

/// Norm of some values over that of others.
pub fn share(of: &[f64], whole: &[f64]) -> f64 {
    (squares(of) / squares(whole)).sqrt()
}

/// Sum of squares.
pub fn squares(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

fn phase(kind: &Kind) -> Option<&'static str> {
    kind.scan.map(|scan| scan.phase)
}

/// Whether a term is a value of an effect that others of it have made already.
fn belongs(term: &HeldTerm, known: &Setting) -> bool {
    let same = |(name, value): (&'static str, f64)| {
        Some(name) == phase(term.kind()) || given(known, name).is_none_or(|own| own == value)
    };
    known.kind.name == term.kind().name && known.target == *term.target() && term.fixed().all(same)
}

/// Amplitude and phase of the sum of a sine and a cosine; deviations are the size of the mean of both, over the
/// amplitude for the phase.
fn wave(
    (name, sin): (&'static str, Fitted),
    (_, cos): (&'static str, Fitted),
    phase: &'static str,
) -> Vec<(&'static str, Fitted)> {
    let amplitude = sin.value.hypot(cos.value);
    let std = sin.std.hypot(cos.std) / 2f64.sqrt();
    let angle = cos.value.atan2(sin.value);
    vec![(name, Fitted::new(amplitude, std)), (phase, Fitted::new(angle, std / amplitude))]
}

/// Those of `terms`, in their order, that a run tells from the ones before.
pub fn told(bench: &HeldBench, run: usize, terms: Vec<HeldTerm>) -> Vec<HeldTerm> {
    let mut directions: Vec<DVector<f64>> = Vec::new();
    let mut kept = Vec::new();
    for term in terms {
        let column = bench.column(run, &term);
        let own = DVector::from_column_slice(&column);
        let mut left = own.clone();
        for direction in &directions {
            left -= direction * direction.dot(&left);
        }
        let (norm, whole) = (left.norm(), own.norm());
        if whole > 0.0 && norm > APART * whole {
            directions.push(left / norm);
            kept.push(term);
        }
    }
    kept
}
