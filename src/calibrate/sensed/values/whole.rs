//! Whole simulations of runs, held against what was recorded. Of a machine that its drives hold residuals are: what a run
//! looks like is compared, in units of noise. What nothing holds falls wherever it is pushed, a little further with every
//! swing, which no acceleration shows as well as the coordinates do: there what sensors show is compared, and where it was
//! let go is fitted beside the values of effects, for a recording tells both only together.

use super::errors::{OVERSAMPLED, floors_of, in_floors};
use crate::calibrate::sensed::motion::released::SMALL;
use crate::calibrate::sensed::residuals::baseline::Baseline;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Segment, Stopped};
use crate::calibrate::values::least_squares::{
    Best, FitEffort, Free, derivative, jacobian, least_squares,
};
use crate::calibrate::values::least_squares::{free, values, with_values};
use crate::calibrate::values::normal::{inverse_normal, pull};
use crate::calibrate::values::rough::{around, closest};
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};

/// Simulations of runs from where a model lets them begin.
pub(in crate::calibrate::sensed) struct Whole<'a> {
    problem: &'a RigProblem,
    segments: &'a [Segment],
    compared: ComparedBy,
}

/// What is compared.
enum ComparedBy {
    /// Residuals, with the bias and noise of a model.
    Looks(Baseline),
    /// What sensors show: floors column by column, and coordinates in m or rad from which the machine is let go, both
    /// segment by segment.
    Columns { floors: Vec<Vec<Option<f64>>>, starts: Vec<Vec<f64>> },
}

impl<'a> Whole<'a> {
    /// Those of a model with these effects; bias and noise on the segments are asked for where residuals are compared.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn of(
        problem: &'a RigProblem,
        effects: &[Setting],
        segments: &'a [Segment],
        baseline: impl FnOnce() -> Result<Baseline, Stopped>,
    ) -> Result<Self, Stopped> {
        let begins = problem.let_go(effects)?;
        if !begins.iter().any(|start| start.is_fitted()) {
            return Ok(Self { problem, segments, compared: ComparedBy::Looks(baseline()?) });
        }
        let mut floors = Vec::new();
        for Segment { run, rows } in segments {
            let one = |replica| problem.one(effects, *run, rows.end, replica);
            let replicas: Vec<_> =
                (0..problem.replicas as u64).map(one).collect::<Result<_, _>>()?;
            floors.push(floors_of(&problem.declared, &replicas));
        }
        let start = |segment: &Segment| begins[segment.run].coordinates().to_vec();
        let starts = segments.iter().map(start).collect();
        Ok(Self { problem, segments, compared: ComparedBy::Columns { floors, starts } })
    }

    /// Whether starts are fitted, too.
    pub fn falls(&self) -> bool {
        matches!(self.compared, ComparedBy::Columns { .. })
    }

    /// The residual in units of noise with these effects; none where there is no such machine.
    pub fn look(&self, effects: &[Setting]) -> Option<DVector<f64>> {
        self.look_from(effects, &self.coordinates())
    }

    /// The derivative of the residual of a model, which is `left`, by each coordinate from which it was let go.
    pub fn by_start(&self, effects: &[Setting], left: &DVector<f64>) -> Option<Vec<DVector<f64>>> {
        let (own, free) = (self.coordinates(), self.free_starts());
        let look = |coordinates: &[f64]| self.look_from(effects, coordinates);
        (0..own.len()).map(|i| derivative(&look, &free, &own, left, i)).collect()
    }

    /// The effects at the values that leave the least, from these on, and the mean square of that in units of noise; none where
    /// there is no such machine. Where it was let go with them is known from then on.
    pub fn fitted(&self, effects: &[Setting], effort: FitEffort) -> Option<(Vec<Setting>, f64)> {
        let look = |all: &[f64]| self.look_at(effects, all);
        let best = least_squares(&look, &self.free(effects), self.all(effects), effort, None)?;
        let left = best.residual.norm_squared() / best.residual.len().max(1) as f64;
        Some((self.let_go(effects, &best.values)?, left))
    }

    /// The covariance of the values of a model's effects, whatever the starts: `(JᵀJ)⁻¹`, J in units of noise, larger where
    /// what is left is larger than noise or noise pulls values further.
    pub fn covariance(&self, effects: &[Setting]) -> Option<DMatrix<f64>> {
        let left = self.look(effects)?;
        let look = |all: &[f64]| self.look_at(effects, all);
        let own = jacobian(&look, &self.free(effects), &self.all(effects), &left)?;
        self.covariance_by(&own, &left, values(effects).len())
    }

    /// The effects at the values that leave the least, [closely](closest), from those of a fit on, which ends where a step brings
    /// little, and their [covariance](Self::covariance).
    pub fn closest(&self, effects: &[Setting]) -> Option<(Vec<Setting>, DMatrix<f64>)> {
        let look = |all: &[f64]| self.look_at(effects, all);
        let Best { values: all, residual, jacobian } =
            closest(&look, self.free(effects), self.all(effects))?;
        let covariance = self.covariance_by(&jacobian?, &residual, values(effects).len())?;
        Some((self.let_go(effects, &all)?, covariance))
    }

    /// The effects at values, of these and others [around](around) them, that leave the least.
    pub fn around(&self, effects: &[Setting]) -> Option<Vec<Setting>> {
        let look = |all: &[f64]| self.look_at(effects, all);
        let all = around(&look, self.free(effects), &self.all(effects))?;
        self.let_go(effects, &all)
    }

    /// The covariance of the first `count` values by derivatives of what is `left`.
    fn covariance_by(
        &self,
        own: &DMatrix<f64>,
        left: &DVector<f64>,
        count: usize,
    ) -> Option<DMatrix<f64>> {
        let inverse = inverse_normal(own)?;
        let independent = left.len() as f64;
        let factor = match &self.compared {
            ComparedBy::Looks(baseline) => {
                let pulled = pull(own, &inverse, &baseline.draws(self.segments));
                pulled.max(left.norm_squared() / independent.max(1.0))
            }
            ComparedBy::Columns { .. } => {
                left.norm_squared() / (independent / OVERSAMPLED).max(1.0)
            }
        };
        Some(inverse.view((0, 0), (count, count)) * factor.max(1.0))
    }

    /// The effects with the first of these values; that they are let go at the others is known from then on.
    fn let_go(&self, effects: &[Setting], all: &[f64]) -> Option<Vec<Setting>> {
        let (own, mut coordinates) = all.split_at(values(effects).len());
        let effects = with_values(effects, own);
        for (segment, start) in self.segments.iter().zip(self.starts()) {
            let (own, others) = coordinates.split_at(start.len());
            coordinates = others;
            self.problem.let_go_near(&effects, segment.run, own).ok()?;
        }
        Some(effects)
    }

    /// The coordinates from which the machine is let go, segment by segment.
    fn starts(&self) -> &[Vec<f64>] {
        match &self.compared {
            ComparedBy::Looks(_) => &[],
            ComparedBy::Columns { starts, .. } => starts,
        }
    }

    /// The coordinates of all runs, in a row.
    fn coordinates(&self) -> Vec<f64> {
        self.starts().concat()
    }

    /// The values of effects, and the coordinates of all runs.
    fn all(&self, effects: &[Setting]) -> Vec<f64> {
        [values(effects), self.coordinates()].concat()
    }

    /// Steps and bounds of these.
    fn free(&self, effects: &[Setting]) -> Vec<Free> {
        [free(effects), self.free_starts()].concat()
    }

    fn free_starts(&self) -> Vec<Free> {
        let free = Free { step: SMALL, bounds: [-f64::MAX, f64::MAX] };
        vec![free; self.coordinates().len()]
    }

    /// The residual of these effects with such values.
    fn look_at(&self, effects: &[Setting], all: &[f64]) -> Option<DVector<f64>> {
        let (own, coordinates) = all.split_at(values(effects).len());
        self.look_from(&with_values(effects, own), coordinates)
    }

    fn look_from(&self, effects: &[Setting], coordinates: &[f64]) -> Option<DVector<f64>> {
        let problem = self.problem;
        let (floors, starts) = match &self.compared {
            ComparedBy::Looks(baseline) => {
                return baseline.simulated_white(problem, effects, self.segments).ok().flatten();
            }
            ComparedBy::Columns { floors, starts } => (floors, starts),
        };
        let (mut rest, mut all) = (coordinates, Vec::new());
        for ((Segment { run, rows }, floors), start) in self.segments.iter().zip(floors).zip(starts)
        {
            let (own, others) = rest.split_at(start.len());
            rest = others;
            let simulated = problem.from(effects, *run, rows.end, own).ok()?;
            let recording = problem.runs[*run].recording.first(simulated.duration());
            all.extend(in_floors(&problem.declared, &recording, &[simulated], floors));
        }
        // As many squares as there are values that are independent.
        Some(DVector::from_vec(all) / OVERSAMPLED.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::super::fit::FitTarget;
    use super::super::trajectory::shorter;
    use super::*;
    use crate::effects::named;

    /// A pendulum that lacks nothing is not dragged, by a ten thousandth of what is tried first, and
    /// residuals, which are accelerations, tell that less closely than the way that it falls.
    #[test]
    fn how_a_pendulum_falls_tells_drag_better_than_its_accelerations() {
        let problem = RigProblem::planar("planar-4");
        let on: Vec<Segment> =
            problem.split().on.iter().map(|whole| shorter(&problem, whole, Some(1.2))).collect();
        let mut all = named("drag").unwrap().candidates(&problem.declared).into_iter();
        let candidate = all.find(|drag| drag.to_string() == "drag at lower").unwrap();
        let drag = |force: f64| vec![candidate.with(&[force, 0.0])];
        let baseline = Baseline::of(&problem, &[], &[], &on).unwrap();
        let whole = Whole::of(&problem, &[], &on, || Ok(baseline.clone())).unwrap();
        assert!(whole.falls());
        let effort = FitEffort { steps: 4, enough: 1.0, secant: false };
        let (fitted, _) = whole.fitted(&drag(0.01), effort).unwrap();
        let found = values(&fitted)[0];
        let deviation = |covariance: DMatrix<f64>| covariance[(0, 0)].sqrt();
        let own = deviation(whole.covariance(&fitted).unwrap());
        assert!(found.abs() < 1e-4 * 0.01, "{found} ± {own}");
        let target = FitTarget { problem: &problem, baseline: &baseline, on: &on };
        let looked = target.look(&drag(0.0)).unwrap();
        let by_looks = deviation(inverse_normal(&target.jacobian(&looked).unwrap()).unwrap());
        assert!(own < 0.7 * by_looks, "{own} {by_looks}");
    }
}
