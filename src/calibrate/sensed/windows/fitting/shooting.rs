//! Values of effects, zeros of runs and starts of windows fitted together: Gauss and Newton's method in the
//! damping of Levenberg and Marquardt. Each window's start is eliminated first (Schur's complement), so that a
//! step costs as many rolls as there are values.

use super::window::{Shooter, Window, WindowStart};
use crate::mechanism::Mechanism;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Steps at most, and the share of Σ of squares that a step has to take off to go on.
const STEPS: usize = 14;
const ENOUGH: f64 = 1e-3;

/// In units of the median: root mean squares of windows above which they count less (Huber, *Ann. Math. Stat.* 35,
/// 1964): large swings miss more than small ones, and some windows hold what no
/// model knows, as somebody's push.
const OUTLIER: f64 = 2.0;

/// A value that is sought.
#[derive(Clone, Debug)]
pub struct SoughtValue {
    /// Change by which derivatives are taken.
    pub step: f64,
    /// Least and largest value.
    pub bounds: [f64; 2],
    /// Where it is without data, and how far from there it may be: one standard deviation.
    pub prior: [f64; 2],
}

/// What is fitted: values, then a zero of each compared sensor of each run.
#[derive(Clone, Debug)]
pub struct WindowsFitted {
    /// Values.
    pub values: Vec<f64>,
    /// Zeros, run by run.
    pub zeros: Vec<Vec<f64>>,
    /// Starts, window by window.
    pub starts: Vec<WindowStart>,
    /// What errors of each compared sensor are counted in.
    pub scales: Vec<f64>,
    /// Σ of squares, priors left out.
    pub squares: f64,
    /// Covariance of values and zeros from how differently windows pull at them.
    pub covariance: DMatrix<f64>,
    /// What the windows say of values and zeros: Σ of products of derivatives, starts eliminated.
    pub information: DMatrix<f64>,
}

/// The problem.
pub struct Shooting<'a> {
    /// Machines of all runs at values; none where there is no such machine.
    pub machines: &'a (dyn Fn(&[f64]) -> Option<Vec<Mechanism>> + Sync),
    /// As of [`Shooter`].
    pub shooter: Shooter<'a>,
    /// The windows.
    pub windows: &'a [Window],
    /// Values sought.
    pub sought: &'a [SoughtValue],
    /// How many first rows starts are fitted to where what is made least is the error of predictions; none where
    /// starts are fitted to all rows.
    pub head: Option<usize>,
    /// Prior of each zero of each run: where it is, and one standard deviation; 0 keeps it there.
    pub zeros: &'a [Vec<[f64; 2]>],
}

/// A window's part of the normal equations.
struct NormalPart {
    squares: f64,
    weight: f64,
    /// Whether B and r are those of a start that follows the values.
    predicts: bool,
    /// Aᵀ A, Aᵀ B, Aᵀ r of the start; Bᵀ B, Bᵀ r of values and zeros.
    aa: DMatrix<f64>,
    ab: DMatrix<f64>,
    ar: DVector<f64>,
    bb: DMatrix<f64>,
    br: DVector<f64>,
}

impl NormalPart {
    /// Equations of the values alone, damped: the start is taken out of them.
    fn reduced(&self, damping: f64) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let bb = damped(&self.bb, damping);
        if self.predicts {
            return Some((bb, self.br.clone()));
        }
        let factor = damped(&self.aa, damping).cholesky()?;
        let across = self.ab.transpose();
        Some((bb - &across * factor.solve(&self.ab), &self.br - across * factor.solve(&self.ar)))
    }
}

/// What priors add to Σ of squares.
fn penalty(priors: &[Option<[f64; 2]>]) -> f64 {
    priors.iter().flatten().map(|[d, w]| d * d * w).sum::<f64>()
}

impl Shooting<'_> {
    fn shooter<'b>(
        &'b self,
        machines: &'b [Mechanism],
        zeros: &'b [Vec<f64>],
        run: usize,
    ) -> Shooter<'b> {
        Shooter { mechanism: &machines[run], zeros: &zeros[run], ..self.shooter }
    }

    fn unknowns(&self) -> usize {
        self.sought.len() + self.zeros.iter().map(Vec::len).sum::<usize>()
    }

    fn residual(
        &self,
        machines: &[Mechanism],
        zeros: &[Vec<f64>],
        window: &Window,
        start: &WindowStart,
        scales: &[f64],
    ) -> Option<DVector<f64>> {
        let shown = self.shooter(machines, zeros, window.run).shot(start, window.rows)?;
        let n = scales.len();
        let left = shown.iter().zip(&window.measured).enumerate();
        Some(DVector::from_iterator(shown.len(), left.map(|(k, (s, m))| (m - s) / scales[k % n])))
    }

    fn part(
        &self,
        all: &[Vec<Mechanism>],
        fitted: &WindowsFitted,
        index: usize,
    ) -> Option<NormalPart> {
        let (window, start) = (&self.windows[index], &fitted.starts[index]);
        let n = fitted.scales.len();
        let shooter = self.shooter(&all[0], &fitted.zeros, window.run);
        let (shown, mut a) = shooter.derivative(start, window.rows)?;
        let rows = shown.len();
        let scaled = |v: DVector<f64>| DVector::from_fn(rows, |k, _| v[k] / fitted.scales[k % n]);
        for k in 0..rows {
            a.row_mut(k).scale_mut(1.0 / fitted.scales[k % n]);
        }
        let r = scaled(DVector::from_column_slice(&window.measured) - &shown);
        let mut b = DMatrix::zeros(rows, self.unknowns());
        for (k, value) in self.sought.iter().enumerate() {
            let there =
                self.shooter(&all[k + 1], &fitted.zeros, window.run).shot(start, window.rows)?;
            b.set_column(
                k,
                &scaled((DVector::from_vec(there) - &shown) / self.step(fitted, k, value)),
            );
        }
        for sensor in 0..n {
            let column = self.sought.len() + window.run * n + sensor;
            for row in (sensor..rows).step_by(n) {
                b[(row, column)] = 1.0 / fitted.scales[sensor];
            }
        }
        let squares = r.norm_squared();
        let seen = self.head.map_or(rows, |head| ((head + 1) * n).min(rows));
        let first = a.rows(0, seen).into_owned();
        let at = first.transpose();
        let (aa, ab, ar) = (&at * &first, &at * b.rows(0, seen), &at * r.rows(0, seen));
        let predicts = self.head.is_some();
        let (b, r) = if predicts {
            let factor = aa.clone().cholesky()?;
            (b - &a * factor.solve(&ab), r - &a * factor.solve(&ar))
        } else {
            (b, r)
        };
        let bt = b.transpose();
        let (bb, br) = (&bt * &b, &bt * &r);
        Some(NormalPart { squares, weight: 1.0, predicts, aa, ab, ar, bb, br })
    }

    fn step(&self, fitted: &WindowsFitted, k: usize, value: &SoughtValue) -> f64 {
        if fitted.values[k] + value.step > value.bounds[1] { -value.step } else { value.step }
    }

    /// Priors of all unknowns: distance from them, and their weight; unknowns that are kept have none.
    fn priors(&self, fitted: &WindowsFitted) -> Vec<Option<[f64; 2]>> {
        let prior = |value: f64, [centre, std]: [f64; 2]| {
            (std > 0.0).then(|| [value - centre, std.powi(-2)])
        };
        let values = self.sought.iter().zip(&fitted.values).map(|(s, v)| prior(*v, s.prior));
        let zeros = self.zeros.iter().flatten().zip(fitted.zeros.iter().flatten());
        values.chain(zeros.map(|(p, v)| prior(*v, *p))).collect()
    }

    /// Fits, from values, zeros and starts on.
    pub fn fit(&self, mut fitted: WindowsFitted) -> Option<WindowsFitted> {
        let mut damping = 1e-3;
        let mut machines = (self.machines)(&fitted.values)?;
        let mut last = false;
        for round in 0..=STEPS {
            let parts = self.parts(&machines, &fitted)?;
            let priors = self.priors(&fitted);
            let data: f64 = parts.iter().map(|part| part.weight * part.squares).sum();
            let before = data + penalty(&priors);
            fitted.squares = data;
            fitted.covariance = self.covariance(&parts, &priors, &fitted);
            let said = self.reduced(&parts, &[], 0.0);
            fitted.information = said.map_or_else(|| DMatrix::zeros(0, 0), |(matrix, _)| matrix);
            if last || round == STEPS {
                break;
            }
            last = true;
            for _ in 0..8 {
                let Some((change, steps)) = self.solve(&parts, &priors, &fitted, damping) else {
                    damping *= 6.0;
                    continue;
                };
                let there = self.moved(&fitted, &change, &steps);
                let tried = (self.machines)(&there.values).and_then(|machines| {
                    let squares = self.squares(&machines, &there, &parts)?;
                    Some((machines, squares))
                });
                let after = tried.map(|(m, squares)| (m, squares + penalty(&self.priors(&there))));
                if let Some((m, after)) = after.filter(|(_, after)| *after < before) {
                    last = before - after < ENOUGH * before;
                    (fitted, machines) = (there, m);
                    damping = (damping / 6.0).max(1e-8);
                    break;
                }
                damping *= 6.0;
            }
        }
        Some(fitted)
    }

    /// All windows with their derivatives, weighed: those that miss much more than others count less.
    fn parts(&self, machines: &[Mechanism], fitted: &WindowsFitted) -> Option<Vec<NormalPart>> {
        let mut all = vec![machines.to_vec()];
        for (k, value) in self.sought.iter().enumerate() {
            let mut beside = fitted.values.clone();
            beside[k] += self.step(fitted, k, value);
            all.push((self.machines)(&beside)?);
        }
        let parts = (0..self.windows.len()).into_par_iter().map(|i| self.part(&all, fitted, i));
        let mut parts = parts.collect::<Option<Vec<NormalPart>>>()?;
        let mut sizes: Vec<f64> = parts.iter().map(|part| part.squares.sqrt()).collect();
        sizes.sort_by(f64::total_cmp);
        let typical = OUTLIER * sizes[sizes.len() / 2];
        for part in &mut parts {
            part.weight = (typical / part.squares.sqrt().max(f64::MIN_POSITIVE)).min(1.0);
        }
        Some(parts)
    }

    /// Where a change of values and zeros and steps of the starts lead.
    fn moved(
        &self,
        fitted: &WindowsFitted,
        change: &DVector<f64>,
        steps: &[DVector<f64>],
    ) -> WindowsFitted {
        let mut there = fitted.clone();
        for (k, value) in there.values.iter_mut().enumerate() {
            let [low, high] = self.sought[k].bounds;
            *value = (*value + change[k]).clamp(low, high);
        }
        let zeros = there.zeros.iter_mut().flatten();
        zeros.zip(change.iter().skip(self.sought.len())).for_each(|(z, c)| *z += c);
        for (start, step) in there.starts.iter_mut().zip(steps) {
            start.values.iter_mut().zip(step.iter()).for_each(|(v, s)| *v += s);
        }
        there
    }

    /// Σ of squares of what is missed, by the weights of these parts.
    fn squares(
        &self,
        machines: &[Mechanism],
        fitted: &WindowsFitted,
        parts: &[NormalPart],
    ) -> Option<f64> {
        let squares = (0..self.windows.len()).into_par_iter().map(|i| {
            let (window, start) = (&self.windows[i], &fitted.starts[i]);
            let left = self.residual(machines, &fitted.zeros, window, start, &fitted.scales)?;
            Some(parts[i].weight * left.norm_squared())
        });
        squares.sum()
    }

    /// Normal equations of values and zeros alone, damped: matrix and right-hand side.
    fn reduced(
        &self,
        parts: &[NormalPart],
        priors: &[Option<[f64; 2]>],
        damping: f64,
    ) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let unknowns = self.unknowns();
        let mut matrix = DMatrix::zeros(unknowns, unknowns);
        let mut right = DVector::zeros(unknowns);
        for part in parts {
            let (own, pull) = part.reduced(damping)?;
            matrix += own * part.weight;
            right += pull * part.weight;
        }
        for (k, prior) in priors.iter().enumerate() {
            if let Some([distance, weight]) = prior {
                matrix[(k, k)] += weight;
                right[k] -= distance * weight;
            }
        }
        Some((matrix, right))
    }

    fn solve(
        &self,
        parts: &[NormalPart],
        priors: &[Option<[f64; 2]>],
        fitted: &WindowsFitted,
        damping: f64,
    ) -> Option<(DVector<f64>, Vec<DVector<f64>>)> {
        let (mut matrix, mut right) = self.reduced(parts, priors, damping)?;
        let kept = |k: usize| {
            let Some(value) = self.sought.get(k) else { return priors[k].is_none() };
            let [low, high] = value.bounds;
            let at = fitted.values[k];
            (at <= low && right[k] < 0.0) || (at >= high && right[k] > 0.0)
        };
        let kept: Vec<usize> = (0..self.unknowns()).filter(|&k| kept(k)).collect();
        for k in kept {
            matrix.row_mut(k).fill(0.0);
            matrix.column_mut(k).fill(0.0);
            matrix[(k, k)] = 1.0;
            right[k] = 0.0;
        }
        let scale = DVector::from_fn(right.len(), |k, _| matrix[(k, k)].max(1e-300).sqrt());
        let unit = DMatrix::from_fn(right.len(), right.len(), |i, j| {
            matrix[(i, j)] / (scale[i] * scale[j]) + if i == j { 1e-12 } else { 0.0 }
        });
        let change = unit.cholesky()?.solve(&right.component_div(&scale)).component_div(&scale);
        let steps = parts
            .iter()
            .map(|part| {
                Some(damped(&part.aa, damping).cholesky()?.solve(&(&part.ar - &part.ab * &change)))
            })
            .collect::<Option<Vec<_>>>()?;
        Some((change, steps))
    }

    /// `H⁻¹ (Σ g gᵀ + P) H⁻¹`, g each window's pull, P that of the priors (White, *Econometrica* 48, 1980): errors within a window belong
    /// together, those of different windows do not.
    fn covariance(
        &self,
        parts: &[NormalPart],
        priors: &[Option<[f64; 2]>],
        fitted: &WindowsFitted,
    ) -> DMatrix<f64> {
        let unknowns = self.unknowns();
        let found = self.reduced(parts, priors, 0.0).and_then(|(mut matrix, _)| {
            for k in 0..unknowns {
                if priors[k].is_none() {
                    matrix.row_mut(k).fill(0.0);
                    matrix.column_mut(k).fill(0.0);
                    matrix[(k, k)] = 1e300;
                }
            }
            let scale = DVector::from_fn(unknowns, |k, _| matrix[(k, k)].sqrt());
            let unit =
                DMatrix::from_fn(unknowns, unknowns, |i, j| matrix[(i, j)] / scale[i] / scale[j]);
            let inverse = unit.try_inverse()?;
            let inverse =
                DMatrix::from_fn(unknowns, unknowns, |i, j| inverse[(i, j)] / scale[i] / scale[j]);
            let mut meat = DMatrix::zeros(unknowns, unknowns);
            for (k, prior) in priors.iter().enumerate() {
                meat[(k, k)] = prior.map_or(0.0, |[_, weight]| weight);
            }
            for part in parts {
                let pull = part.reduced(0.0)?.1 * part.weight;
                meat += &pull * pull.transpose();
            }
            Some(&inverse * meat * &inverse)
        });
        found
            .unwrap_or_else(|| DMatrix::from_element(unknowns, unknowns, f64::NAN + fitted.squares))
    }
}

fn damped(matrix: &DMatrix<f64>, damping: f64) -> DMatrix<f64> {
    let mut damped = matrix.clone();
    for k in 0..damped.nrows() {
        damped[(k, k)] *= 1.0 + damping;
    }
    damped
}
