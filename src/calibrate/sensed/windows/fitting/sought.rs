//! Which values are sought of a machine that nothing holds, and how far they may be from what is declared.

use super::shooting::SoughtValue;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::{effort_sensor, position_sensor};
use crate::effects::{Setting, Target, named};
use crate::mechanism::{Axes, Drive, JointIndex, Mechanism};

/// Shares of the declared ones by which masses and moments, and inertias, are expected to be off: drawings leave
/// out screws and cables.
const MASS: f64 = 0.2;
const INERTIA: f64 = 0.3;

/// Share of what gravity does to the machine that friction is expected to be.
const FRICTION: f64 = 0.2;

/// What the air can do: `½ ρ c_w` of a plate across the flow, `½ · 1.2 kg/m³ · 2` in N s²/m⁴, on the square of the
/// machine's size (Hoerner, *Fluid-Dynamic Drag*, 1965, ch. 3: c_w of 2 for a long plate).
const AIR: f64 = 1.2;

/// Expected share by which the scale of an effort is off, and the offset in shares of what gravity does.
const SCALE: f64 = 0.1;
const OFFSET: f64 = 0.02;

/// Share of its joint's rate (root mean square) at which Coulomb friction is near its full value: windows do not
/// show how steep it is at rest.
const STEEP: f64 = 0.01;

/// Share of the distance of a centre of mass that an axis has to have of it for a moment along it to be sought.
const BESIDE: f64 = 0.05;

/// Steps of derivatives in expected sizes.
const STEP: f64 = 1e-4;

/// Effects whose values are sought, beside those that stay as declared.
#[derive(Clone, Debug)]
pub struct Sought {
    /// All effects.
    pub effects: Vec<Setting>,
    /// How many of them, the first ones, the rig declares.
    declared: usize,
    /// Effect and value of it of each value that is sought.
    places: Vec<(usize, usize)>,
    /// The values.
    pub values: Vec<SoughtValue>,
    /// Where they start.
    pub start: Vec<f64>,
}

impl Sought {
    /// Effects with these values.
    pub fn settings(&self, values: &[f64]) -> Vec<Setting> {
        let mut settings = self.effects.clone();
        for ((effect, place), value) in self.places.iter().zip(values) {
            let mut all: Vec<f64> = settings[*effect].values().map(|(_, value)| value).collect();
            all[*place] = *value;
            settings[*effect] = settings[*effect].with(&all);
        }
        settings
    }

    /// Places among the sought values of those of an effect.
    pub fn of(&self, effect: usize) -> Vec<usize> {
        (0..self.places.len()).filter(|&k| self.places[k].0 == effect).collect()
    }

    /// Names of the sought values of an effect, in the order of [`of`](Self::of).
    pub fn names(&self, effect: usize) -> Vec<&'static str> {
        let names: Vec<&'static str> =
            self.effects[effect].values().map(|(name, _)| name).collect();
        self.of(effect).into_iter().map(|k| names[self.places[k].1]).collect()
    }

    /// Values that come and go together: each amount (which is nothing at 0 and never less) is one of its own,
    /// the others of an effect belong together.
    pub fn terms(&self) -> Vec<Vec<usize>> {
        let mut terms: Vec<Vec<usize>> = Vec::new();
        for k in 0..self.values.len() {
            let beside = |term: &&mut Vec<usize>| {
                let first = term[0];
                !self.is_amount(first) && self.places[first].0 == self.places[k].0
            };
            match terms.iter_mut().find(beside).filter(|_| !self.is_amount(k)) {
                Some(term) => term.push(k),
                None => terms.push(vec![k]),
            }
        }
        terms
    }

    /// Whether a value is an amount of something that is not there at 0.
    pub fn is_amount(&self, k: usize) -> bool {
        self.values[k].bounds[0] == 0.0
    }

    /// The effect that a value belongs to.
    pub fn effect_of(&self, k: usize) -> usize {
        self.places[k].0
    }

    /// The same with some values kept where `fixed` says, the others sought from `values` on; without effects of
    /// which nothing is sought any more and that the rig does not declare.
    pub fn with_fixed(&self, fixed: &[Option<f64>], values: &[f64]) -> Self {
        let at = fixed.iter().zip(values).map(|(fixed, value)| fixed.unwrap_or(*value));
        let at: Vec<f64> = at.collect();
        let mut left = Self {
            effects: Vec::new(),
            declared: self.declared,
            places: Vec::new(),
            values: Vec::new(),
            start: Vec::new(),
        };
        for (i, effect) in self.settings(&at).into_iter().enumerate() {
            let free: Vec<usize> = self.of(i).into_iter().filter(|&k| fixed[k].is_none()).collect();
            if free.is_empty() && i >= self.declared {
                continue;
            }
            for k in free {
                left.places.push((left.effects.len(), self.places[k].1));
                left.values.push(self.values[k].clone());
                left.start.push(at[k]);
            }
            left.effects.push(effect);
        }
        left
    }

    /// The same with dry friction of a pivot (effect `index`) as that of bristles, which hold what has stopped and
    /// bend before it slides; none of other effects. Values start at `values`.
    pub fn with_bristles(
        &self,
        index: usize,
        values: &[f64],
        mechanism: &Mechanism,
    ) -> Option<Self> {
        let friction = &self.effects[index];
        let Target::Joints(joints) = &friction.target else { return None };
        let turns = |name: &String| {
            mechanism
                .joints()
                .any(|(of, joint)| of == name && matches!(joint, JointIndex::Revolute(_)))
        };
        let k = self.of(index).into_iter().zip(self.names(index));
        let (k, _) = k.into_iter().find(|(_, name)| *name == "coulomb")?;
        if friction.kind.name != "joint-friction" || !joints.iter().all(turns) {
            return None;
        }
        let mut nothing = values.to_vec();
        nothing[k] = 0.0;
        let mut other = Self { start: values.to_vec(), ..self.clone() };
        other.effects = self.settings(&nothing);
        let kind = named("bristle-friction")?;
        let dry = [(kind.parameters[0].name, values[k])];
        other.places[k] = (other.effects.len(), 0);
        other.effects.push(Setting::on(kind, friction.target.clone(), &dry));
        Some(other)
    }

    fn add(
        &mut self,
        kind: &str,
        target: Target,
        sizes: &[(&'static str, f64)],
        fixed: &[(&'static str, f64)],
    ) {
        let Some(kind) = named(kind) else { return };
        let neutral: Vec<(&'static str, f64)> =
            sizes.iter().map(|(name, _)| (*name, 0.0)).collect();
        let all = [neutral.as_slice(), fixed].concat();
        let mut effect = Setting::on(kind, target, &all);
        let declared = self.effects.iter().position(|known| known.is(&effect));
        if let Some(declared) = declared {
            // Values that are declared stay where they are not sought, and are where the others start.
            let known = &self.effects[declared];
            let values: Vec<f64> =
                all.iter().map(|(name, value)| known.value(name).unwrap_or(*value)).collect();
            let extra: Vec<(&'static str, f64)> = known
                .values()
                .filter(|(name, _)| all.iter().all(|(other, _)| other != name))
                .collect();
            let names: Vec<(&'static str, f64)> = all
                .iter()
                .zip(values)
                .map(|((name, _), value)| (*name, value))
                .chain(extra)
                .collect();
            effect = Setting::on(kind, effect.target.clone(), &names);
        }
        let index = declared.unwrap_or(self.effects.len());
        for (place, (name, size)) in sizes.iter().enumerate() {
            let Some(parameter) = kind.parameter(name) else { continue };
            let start = effect.values().nth(place).map_or(0.0, |(_, value)| value);
            self.places.push((index, place));
            let prior = [start, *size];
            self.values.push(SoughtValue { step: STEP * size, bounds: parameter.bounds, prior });
            self.start.push(start);
        }
        match declared {
            Some(declared) => self.effects[declared] = effect,
            None => self.effects.push(effect),
        }
    }
}

/// Everything that is sought of a machine, beside effects that its rig declares; none of the kinds `without`.
pub fn sought(
    mechanism: &Mechanism,
    declared: &[Setting],
    recordings: &[Recording],
    without: &[&str],
) -> Sought {
    let known = declared.iter().map(|e| e.as_joint_friction().unwrap_or_else(|| e.clone()));
    let mut sought = Sought {
        effects: known.collect(),
        declared: declared.len(),
        places: Vec::new(),
        values: Vec::new(),
        start: Vec::new(),
    };
    let size = mechanism.size();
    let mass: f64 = mechanism.bodies.iter().map(|body| body.mass).sum();
    // Without gravity a machine of its size that turns with 3 rad/s sets the scale.
    let weight = mass * mechanism.gravity.norm().max(9.0 * size);
    let expected = ExpectedSizes { mechanism, recordings, without, size, mass, weight };
    for (name, axes) in &mechanism.names.bodies {
        expected.add_body(&mut sought, name, axes);
    }
    let joints: Vec<(String, JointIndex)> =
        mechanism.joints().map(|(name, joint)| (name.to_owned(), joint)).collect();
    for (name, joint) in joints {
        expected.add_joint(&mut sought, name, joint);
    }
    sought
}

/// How large effects on a machine are expected to be.
struct ExpectedSizes<'a> {
    mechanism: &'a Mechanism,
    recordings: &'a [Recording],
    /// Kinds that are not sought.
    without: &'a [&'a str],
    /// The machine's size in m.
    size: f64,
    /// Of all bodies in kg.
    mass: f64,
    /// What loads the machine, in N.
    weight: f64,
}

impl ExpectedSizes<'_> {
    fn allows(&self, kind: &str) -> bool {
        !self.without.contains(&kind)
    }

    /// Mass and drag of a body that moves.
    fn add_body(&self, sought: &mut Sought, name: &str, axes: &Axes) {
        let Some(index) = axes.origin.body else { return };
        let size = self.size;
        let body = &self.mechanism.bodies[index];
        let moment = MASS * body.mass * size;
        let inertia = INERTIA * (body.inertia + body.mass * size * size);
        // A centre of mass beside its declared line is no different from wrong zeros of sensors.
        let centre = axes.centre.point - axes.origin.point;
        let turn = nalgebra::UnitComplex::new(-axes.angle);
        let line = turn * centre / centre.norm().max(f64::MIN_POSITIVE);
        let mut sizes = vec![("mass_kg", MASS * body.mass), ("inertia_kg_m2", inertia)];
        for (name, share) in [("moment_x_kg_m", line.x.abs()), ("moment_y_kg_m", line.y.abs())] {
            if share > BESIDE {
                sizes.push((name, share * moment));
            }
        }
        let target = Target::Body(name.to_owned());
        if self.allows("mass-properties") {
            sought.add("mass-properties", target.clone(), &sizes, &[]);
        }
        if self.allows("air-drag") {
            let sizes = [("force_Ns2_m2", AIR * size.powi(2)), ("torque_Nms2", AIR * size.powi(5))];
            sought.add("air-drag", target, &sizes, &[]);
        }
    }

    /// Friction of a joint, and what its drive may have.
    fn add_joint(&self, sought: &mut Sought, name: String, joint: JointIndex) {
        let mechanism = self.mechanism;
        let effort = match joint {
            JointIndex::Revolute(_) => self.weight * self.size,
            JointIndex::Prismatic(_) => self.weight,
        };
        let rate = rate(mechanism, self.recordings, joint);
        let target = Target::Joints(vec![name]);
        let friction = FRICTION * effort;
        let sizes = [("coulomb", friction), ("viscous", friction / rate)];
        if self.allows("joint-friction") {
            sought.add("joint-friction", target.clone(), &sizes, &[("velocity", STEEP * rate)]);
        }
        let drive = mechanism.actuators.iter().position(|drive| drive.joint == joint);
        let Some(drive) = drive.filter(|&i| mechanism.actuators[i].drive == Drive::Effort) else {
            return;
        };
        if self.allows("rotor-inertia") && matches!(joint, JointIndex::Revolute(_)) {
            let inertia = INERTIA * self.mass * self.size * self.size;
            sought.add("rotor-inertia", target, &[("inertia_kg_m2", inertia)], &[]);
        }
        let recorded = |sensor: &usize| self.recordings.iter().all(|r| r.get(*sensor).is_some());
        if let Some(sensor) = effort_sensor(mechanism, drive).filter(recorded) {
            let target = Target::Sensors(vec![mechanism.sensors[sensor].column.clone()]);
            if self.allows("force-scale") {
                sought.add("force-scale", target.clone(), &[("relative", SCALE)], &[]);
            }
            if self.allows("force-offset") {
                sought.add("force-offset", target, &[("offset", OFFSET * effort)], &[]);
            }
        }
    }
}

/// Root mean square rate of a joint in recordings; 1 where nobody measured it.
fn rate(mechanism: &Mechanism, recordings: &[Recording], joint: JointIndex) -> f64 {
    /// Time in s over which rates are taken: longer than encoders' steps show.
    const OVER: f64 = 0.02;
    let Some(sensor) = position_sensor(mechanism, joint) else { return 1.0 };
    let (mut squares, mut count) = (0.0, 0usize);
    for recording in recordings {
        let Some(values) = recording.get(sensor) else { continue };
        let rows = (OVER / recording.interval).ceil().max(1.0) as usize;
        for pair in values.windows(rows + 1).step_by(rows) {
            squares += ((pair[rows] - pair[0]) / (rows as f64 * recording.interval)).powi(2);
            count += 1;
        }
    }
    if count == 0 { 1.0 } else { (squares / count as f64).sqrt().max(1e-3) }
}
