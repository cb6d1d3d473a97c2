//! The inverse model of a driven slide: the drive's force from the measured motion, linear in what is
//! sought.
//!
//! `F = M q̈ + Fv q̇ + Fc sign q̇ + offset + …` at every sample, both sides filtered alike, by least squares
//! (Gautier, *Dynamic identification of robots with power model*, ICRA 1997). Whatever filters both sides
//! alike leaves the parameters alone; what differs between sides does not, so the filter belongs to the
//! figure: one for all.

use crate::measure::filter::{ZeroPhase, derivative};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;
use std::ops::Range;

/// Order and corner in Hz of the filter, which is run forward and backward: the motion has its share
/// below 15 Hz, the encoder's steps are 0.05 µm.
const FILTER: (usize, f64) = (4, 50.0);

/// Time in s that is left out at both ends, where the filter has no neighbours.
const TRIMMED: f64 = 0.2;

/// A recording, ready for the regression.
#[derive(Clone, Debug)]
pub struct Motion {
    filter: ZeroPhase,
    /// Position (m), speed, acceleration and jerk at each sample.
    states: Vec<[f64; 4]>,
    force: Vec<f64>,
    trimmed: usize,
    interval: f64,
}

impl Motion {
    /// From lengths (m) and drive forces (N), one every `interval` s.
    pub fn new(lengths: &[f64], forces: &[f64], interval: f64) -> Self {
        let (order, corner) = FILTER;
        let filter = ZeroPhase::butterworth(order, corner, interval);
        let q = filter.apply(lengths);
        let v = derivative(&q, interval);
        let a = derivative(&v, interval);
        let j = derivative(&a, interval);
        let states = (0..q.len()).map(|i| [q[i], v[i], a[i], j[i]]).collect();
        let force = filter.apply(forces);
        Self { filter, states, force, trimmed: (TRIMMED / interval).round() as usize, interval }
    }

    /// Samples that count: all but the ends.
    pub fn rows(&self) -> Range<usize> {
        let n = self.force.len();
        self.trimmed.min(n / 2)..n - self.trimmed.min(n / 2)
    }

    /// The rows that count, cut into blocks of about `length` s.
    pub fn blocks(&self, length: f64) -> Vec<Range<usize>> {
        let rows = self.rows();
        let size = (length / self.interval).round().max(1.0) as usize;
        let count = (rows.len() / size).max(1);
        let edge = |k: usize| rows.start + rows.len() * k / count;
        (0..count).map(|k| edge(k)..edge(k + 1)).collect()
    }

    /// The filtered force in N.
    pub fn force(&self) -> &[f64] {
        &self.force
    }

    /// Filtered speed in m/s of sample `i`.
    pub fn speed(&self, i: usize) -> f64 {
        self.states[i][1]
    }

    fn column(&self, term: Term) -> Vec<f64> {
        let raw: Vec<f64> = self.states.iter().map(|state| term.value(*state)).collect();
        self.filter.apply(&raw)
    }

    /// Root mean square in N of the recorded force less a filtered one, over each of `blocks`.
    fn left(&self, filtered: &[f64], blocks: &[Range<usize>]) -> Vec<f64> {
        let square = |i: usize| (self.force[i] - filtered[i]).powi(2);
        let rms = |rows: &Range<usize>| {
            (rows.clone().map(square).sum::<f64>() / rows.len().max(1) as f64).sqrt()
        };
        blocks.iter().map(rms).collect()
    }

    /// The same of another force, which is filtered alike first.
    pub fn missed(&self, force: &[f64], blocks: &[Range<usize>]) -> Vec<f64> {
        self.left(&self.filter.apply(force), blocks)
    }

    /// Norm of the difference of a force from the recorded one over norm of the recorded one, over
    /// `rows`; the other force in N is filtered alike first.
    pub fn relative_error(&self, force: &[f64], rows: Range<usize>) -> f64 {
        let force = self.filter.apply(force);
        relative(&self.force[rows.clone()], &force[rows])
    }
}

fn relative(recorded: &[f64], model: &[f64]) -> f64 {
    let square = |sum: f64, x: f64| sum + x * x;
    let error = recorded.iter().zip(model).map(|(a, b)| a - b).fold(0.0, square);
    (error / recorded.iter().copied().fold(0.0, square)).sqrt()
}

/// One summand of the force, up to its factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Term {
    /// q̈; its factor is the moved mass in kg.
    Mass,
    /// q⃛; its factor over the mass is the time in s by which the force follows its command.
    Lag,
    /// 1; N.
    Offset,
    /// q̇; N·s/m.
    Viscous,
    /// q̇ outward (`true`) or inward only; N·s/m.
    ViscousWay(bool),
    /// sign q̇; N.
    Coulomb,
    /// 1 outward (`true`), −1 inward only; N.
    CoulombWay(bool),
    /// `sign q̇ (1 − exp(−|q̇|/v_f))`, v_f in m/s; N.
    Film(f64),
    /// `sign q̇ exp(−(q̇/v_s)²)`, v_s in m/s; N.
    Stribeck(f64),
    /// `|q̇| q̇`; N·s²/m².
    Drag,
    /// `sin` (`true`) or `cos` of `2π q/pitch`, in m; N.
    Ripple(f64, bool),
}

impl Term {
    fn value(self, [q, v, a, j]: [f64; 4]) -> f64 {
        let sign = if v == 0.0 { 0.0 } else { v.signum() };
        let way = |outward: bool| if (v > 0.0) == outward { 1.0 } else { 0.0 };
        match self {
            Term::Mass => a,
            Term::Lag => j,
            Term::Offset => 1.0,
            Term::Viscous => v,
            Term::ViscousWay(outward) => v * way(outward),
            Term::Coulomb => sign,
            Term::CoulombWay(outward) => sign * way(outward),
            Term::Film(speed) => -sign * (-v.abs() / speed).exp_m1(),
            Term::Stribeck(speed) => sign * (-(v / speed).powi(2)).exp(),
            Term::Drag => v.abs() * v,
            Term::Ripple(pitch, true) => (TAU * q / pitch).sin(),
            Term::Ripple(pitch, false) => (TAU * q / pitch).cos(),
        }
    }
}

/// A model and its factors.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Summands with their factors.
    pub terms: Vec<(Term, f64)>,
}

impl Model {
    /// The least-squares factors of `terms` over `rows` of a recording, beside those of `fixed`, which
    /// stay; `None` where the recording does not tell the terms apart.
    pub fn fit(
        motion: &Motion,
        rows: Range<usize>,
        terms: &[Term],
        fixed: &[(Term, f64)],
    ) -> Option<Model> {
        let columns: Vec<Vec<f64>> = terms.iter().map(|term| motion.column(*term)).collect();
        let mut rest = DVector::from_column_slice(&motion.force[rows.clone()]);
        for (term, factor) in fixed {
            let column = motion.column(*term);
            rest -= DVector::from_column_slice(&column[rows.clone()]) * *factor;
        }
        let matrix = DMatrix::from_fn(rest.len(), terms.len(), |i, k| columns[k][rows.start + i]);
        // Columns of one size: masses, frictions and volts differ by decades.
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
        let found = terms.iter().zip(solved.iter().zip(&scales)).map(|(t, (x, s))| (*t, x / s));
        Some(Model { terms: found.chain(fixed.iter().copied()).collect() })
    }

    /// The factor of a term; 0 where the model has none.
    pub fn factor(&self, term: Term) -> f64 {
        self.terms.iter().find(|(t, _)| *t == term).map_or(0.0, |(_, factor)| *factor)
    }

    /// The force in N that the model takes for the recorded motion, filtered.
    pub fn force(&self, motion: &Motion) -> Vec<f64> {
        let mut sum = vec![0.0; motion.force.len()];
        for (term, factor) in &self.terms {
            for (sum, x) in sum.iter_mut().zip(motion.column(*term)) {
                *sum += factor * x;
            }
        }
        sum
    }

    /// Root mean square of what the model leaves of the force in N, over each of `blocks`.
    pub fn left(&self, motion: &Motion, blocks: &[Range<usize>]) -> Vec<f64> {
        motion.left(&self.force(motion), blocks)
    }

    /// Standard deviations of the factors that were fitted over `rows`, in their order: the residual is
    /// coloured, so it counts block by block, `(XᵀX)⁻¹ (Σ_b Xᵀ_b e_b eᵀ_b X_b) (XᵀX)⁻¹` (Liang, Zeger,
    /// Biometrika 73 (1986) 13–22).
    pub fn deviations(&self, motion: &Motion, blocks: &[Range<usize>]) -> Vec<f64> {
        let columns: Vec<Vec<f64>> = self.terms.iter().map(|(t, _)| motion.column(*t)).collect();
        let force = self.force(motion);
        let count = columns.len();
        let norm = |column: &Vec<f64>| column.iter().map(|x| x * x).sum::<f64>().sqrt();
        let scales: Vec<f64> = columns.iter().map(norm).collect();
        let mut normal = DMatrix::zeros(count, count);
        let mut meat = DMatrix::zeros(count, count);
        for rows in blocks {
            let mut moment = DVector::zeros(count);
            for i in rows.clone() {
                let row = DVector::from_fn(count, |k, _| columns[k][i] / scales[k]);
                normal += &row * row.transpose();
                moment += &row * (motion.force[i] - force[i]);
            }
            meat += &moment * moment.transpose();
        }
        let Some(inverse) = normal.try_inverse() else { return vec![f64::NAN; count] };
        let covariance = &inverse * meat * &inverse;
        (0..count).map(|k| covariance[(k, k)].max(0.0).sqrt() / scales[k]).collect()
    }

    /// Relative error of the model's force over `rows`.
    pub fn error(&self, motion: &Motion, rows: Range<usize>) -> f64 {
        relative(&motion.force[rows.clone()], &self.force(motion)[rows])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_those_that_made_the_force() {
        let h = 1e-3;
        let t: Vec<f64> = (0..6000).map(|i| f64::from(i) * h).collect();
        let q: Vec<f64> =
            t.iter().map(|t| 0.03 * (3.0 * t).sin() + 0.01 * (11.0 * t).sin()).collect();
        let force: Vec<f64> = t
            .iter()
            .map(|t| {
                let v = 0.09 * (3.0 * t).cos() + 0.11 * (11.0 * t).cos();
                let a = -0.27 * (3.0 * t).sin() - 1.21 * (11.0 * t).sin();
                let way = if v > 0.0 { 150.0 } else { 210.0 };
                90.0 * a + way * v + 20.0 * v.signum() - 3.0
            })
            .collect();
        let motion = Motion::new(&q, &force, h);
        let terms = [
            Term::Mass,
            Term::ViscousWay(true),
            Term::ViscousWay(false),
            Term::Coulomb,
            Term::Offset,
        ];
        let model = Model::fit(&motion, motion.rows(), &terms, &[]).expect("told apart");
        for (term, expected) in terms.into_iter().zip([90.0, 150.0, 210.0, 20.0, -3.0]) {
            let found = model.factor(term);
            assert!((found / expected - 1.0).abs() < 5e-3, "{term:?}: {found}");
        }
        assert!(model.error(&motion, motion.rows()) < 5e-3);
        let twice = [Term::Mass, Term::Offset, Term::Offset];
        assert!(Model::fit(&motion, motion.rows(), &twice, &[]).is_none());
    }
}
