//! Two models held against each other by what does not differ between them but for themselves.
//!
//! Where joints rattle, in the same noise: what few replicas make of a model's bias and of the determinant of its noise differs from
//! one set of replicas to the next, and stands in its cost. One and the same model costs some hundreds more or less.
//!
//! Where none does, by the same looks: where a journal leans is told by forces, whose noise moves it the more, the larger its
//! clearance is. What each leaves of the data in its own look differs by luck of that noise: of a worn joint and a link too short,
//! whose simulations are twins, by tens.

use super::baseline::{Baseline, BiasAndNoise};
use super::problem::RigProblem;
use crate::calibrate::values::draws::{Coefficients, difference, mean};
use crate::calibrate::values::spectrum::Noise;
use nalgebra::DVector;
use std::sync::Arc;

/// Standard deviations of chance above which biases differ.
const DIFFER: f64 = 3.0;

impl Baseline {
    /// Two models' own biases in the noise that they have in common, or the mean of their biases where these differ by no more
    /// than so many replicas do; none where they see other residuals.
    pub fn in_common(problem: &RigProblem, two: [&Self; 2]) -> Option<[Self; 2]> {
        let [a, b] = two.map(|model| model.parts.iter());
        let noises = a.zip(b).map(|(a, b)| Noise::mean([&a.noise, &b.noise]));
        let noises: Vec<Noise> = noises.collect::<Option<_>>()?;
        let mut gap = Gap::default();
        let [a, b] = two.map(|model| model.parts.iter());
        for ((a, b), noise) in a.zip(b).zip(&noises) {
            gap.add(problem, [a, b], noise)?;
        }
        let alike = !gap.stands_out();
        let pairs = two[0].parts.iter().zip(two[1].parts.iter());
        let means: Vec<Coefficients> =
            pairs.map(|(a, b)| mean(&[a.bias.clone(), b.bias.clone()])).collect();
        let with = |model: &Self| {
            let parts = model.parts.iter().zip(noises.iter().zip(&means));
            let parts = parts.map(|(part, (noise, mean))| part.beside(noise, mean, alike));
            Self { parts: Arc::new(parts.collect()), ..model.clone() }
        };
        Some(two.map(with))
    }

    /// How much more of the data the second of two models leaves than the first, Σ of squares in units of noise, by one simulation of
    /// each, both seen through the first one's machine, and through the second one's: the mean of the two. None where the machines cannot
    /// move so.
    pub fn leaves_more(problem: &RigProblem, two: [&Self; 2]) -> Option<f64> {
        let [a, b] = two;
        let mut sum = 0.0;
        for (a, b) in a.parts.iter().zip(b.parts.iter()) {
            sum += 0.5 * (a.left_by(problem, b)? - a.left_by(problem, a)?);
            sum += 0.5 * (b.left_by(problem, b)? - b.left_by(problem, a)?);
        }
        Some(sum)
    }
}

impl BiasAndNoise {
    /// Σ of squares of what the first simulation of a model leaves of the data, seen through this one's machine and in its noise.
    fn left_by(&self, problem: &RigProblem, other: &Self) -> Option<f64> {
        let simulated = problem.coefficients(other.clean.first()?, &self.machine, &self.segment)?;
        let left = difference(&self.left, &difference(&simulated, &self.bias));
        Some(self.noise.whiten(&left).norm_squared())
    }

    /// The same in that noise, with the `mean` of biases where they are `alike`.
    fn beside(&self, noise: &Noise, mean: &Coefficients, alike: bool) -> Self {
        let bias = if alike { mean } else { &self.bias };
        let mut own = self.clone();
        own.left = difference(&self.left, &difference(bias, &self.bias));
        own.bias.clone_from(bias);
        own.noise.clone_from(noise);
        own
    }
}

/// How far two biases are apart, each a mean of replicas.
#[derive(Default)]
struct Gap {
    /// Σ of squares of their difference in units of noise.
    squares: f64,
    /// What the replicas' own scatter makes of that, and the square of the standard deviation of it.
    expected: f64,
    variance: f64,
}

impl Gap {
    fn add(&mut self, problem: &RigProblem, two: [&BiasAndNoise; 2], noise: &Noise) -> Option<()> {
        let [a, b] = two.map(|part| scatter(problem, part, noise));
        let own = a? + b?;
        let [a, b] = two.map(|part| &part.bias);
        self.squares += noise.whiten(&difference(a, b)).norm_squared();
        self.expected += own.sum();
        self.variance += 2.0 * own.norm_squared();
        Some(())
    }

    fn stands_out(&self) -> bool {
        self.squares > self.expected + DIFFER * self.variance.sqrt()
    }
}

/// Squares of standard errors of a bias in units of noise, by the scatter of its replicas `x`: Σ (x − x̄)² / (R (R − 1)). None where
/// there is a single replica.
fn scatter(problem: &RigProblem, part: &BiasAndNoise, noise: &Noise) -> Option<DVector<f64>> {
    let looks =
        part.clean.iter().map(|view| problem.coefficients(view, &part.machine, &part.segment));
    let looks: Vec<Coefficients> = looks.collect::<Option<_>>()?;
    let count = looks.len() as f64;
    let mut sum = noise.whiten(&part.bias) * 0.0;
    for look in &looks {
        let off = noise.whiten(&difference(look, &part.bias));
        sum += off.component_mul(&off);
    }
    (count > 1.0).then(|| sum / (count * (count - 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::thresholds::{REPLICAS, TWINS};
    use crate::effects::{Setting, Target, named};
    use crate::mechanism::JointIndex;

    /// A payload at the output body.
    fn payload(problem: &RigProblem, mass: f64) -> Vec<Setting> {
        let values = [("mass_kg", mass), ("com_x_m", 0.0), ("com_y_m", 0.0)];
        let body = Target::Body(problem.declared.names.output.clone().unwrap());
        vec![Setting::on(named("payload").unwrap(), body, &values)]
    }

    /// What a model leaves of the data, with the determinant of its noise and without.
    fn left(problem: &RigProblem, own: &[Setting], baseline: &Baseline) -> [f64; 2] {
        let segments = problem.split().hold;
        let white = baseline.white(problem, own, &segments).unwrap().unwrap();
        let squares = white.norm_squared();
        [squares + baseline.log_determinant(&segments), squares]
    }

    /// A machine and the same with a milligram more rattle otherwise, and cost otherwise by luck of their replicas: not in the noise
    /// that they have in common. With a joint worn to half a millimetre biases differ, and are not taken for one.
    #[test]
    fn luck_of_replicas_does_not_tell_models_apart() {
        let mut problem = RigProblem::of("rigs/rig-1", "run-a.csv");
        problem.replicas = REPLICAS;
        let segments = problem.split().hold;
        let [none, hair] = [0.0, 1e-6].map(|mass| payload(&problem, mass));
        let joint = problem.declared.joint_name(JointIndex::Revolute(0)).to_owned();
        let joint = Target::Joints(vec![joint]);
        let kind = named("joint-wear").unwrap();
        let worn = vec![Setting::on(kind, joint, &[("clearance_m", 5e-4)])];
        let of = |effects: &[Setting]| Baseline::of(&problem, effects, &[], &segments).unwrap();
        let [one, other, apart] = [&none, &hair, &worn].map(|effects| of(effects));
        assert!(one.rattles && other.rattles);
        let gap = |[a, b]: [f64; 2]| (a - b).abs();
        let own = [(&none, &one), (&hair, &other)].map(|(e, b)| left(&problem, e, b)[0]);
        assert!(gap(own) > 2.0 * TWINS[0], "{own:?}");
        let common = Baseline::in_common(&problem, [&one, &other]).unwrap();
        let both = [(&none, &common[0]), (&hair, &common[1])];
        let both = both.map(|(e, b)| left(&problem, e, b)[1]);
        assert!(gap(both) < 0.2 * TWINS[0], "{both:?}");
        let differ = Baseline::in_common(&problem, [&one, &apart]).unwrap();
        assert_ne!(differ[0].parts[0].bias, differ[1].parts[0].bias);
    }

    /// Of two models the one leaves as much more as the other leaves less, whichever is asked first, and a machine leaves less of its own
    /// recording than one with a joint worn to half a millimetre; by more than by looks of each one's own, for noise moves a leaning
    /// journal the more, the larger its clearance is.
    #[test]
    fn what_leaves_more_leaves_it_in_both_looks() {
        let rig = RigProblem::of("rigs/rig-1", "run-a.csv");
        let recorded = rig.simulated(&rig.let_go(&[]).unwrap(), 1).unwrap().remove(0).remove(0);
        let problem = rig.recorded_as(recorded);
        let segments = problem.split().hold;
        let joint = problem.declared.joint_name(JointIndex::Revolute(0)).to_owned();
        let kind = named("joint-wear").unwrap();
        let worn = [Setting::on(kind, Target::Joints(vec![joint]), &[("clearance_m", 5e-4)])];
        let of = |effects: &[Setting]| Baseline::of(&problem, effects, &[], &segments).unwrap();
        let [own, other] = [of(&[]), of(&worn)];
        let more = |two: [&Baseline; 2]| Baseline::leaves_more(&problem, two).unwrap();
        assert!(more([&own, &own]).abs() < 1e-9);
        let further = more([&own, &other]);
        assert!((further + more([&other, &own])).abs() < 1e-9 * further);
        let by_its_own = left(&problem, &worn, &other)[1] - left(&problem, &[], &own)[1];
        assert!(by_its_own > 100.0 && further > 2.0 * by_its_own, "{further} {by_its_own}");
    }
}
