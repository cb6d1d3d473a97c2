//! Terms of a machine: those that it declares, and those that may be added to a model of it.

use super::bench::HeldBench;
use super::terms::{BODY, HeldTerm, WAYS, given, linear};
use crate::calibrate::sensed::thresholds::{BUILDS_UP, SIGN_AT};
use crate::effects::{Kind, ScanRange as Tried, Setting, Target, named};
use crate::mechanism::JointIndex;
use std::f64::consts::FRAC_PI_2;

/// Terms that a declared effect stands for, each with its declared value: what is not nothing.
pub fn of_declared(bench: &HeldBench, effect: &Setting) -> Vec<(HeldTerm, f64)> {
    let there = |name: &&&'static str| given(effect, name).is_some_and(|value| value != 0.0);
    let own = || linear(effect.kind).iter().filter(there);
    let fixed: Vec<(&'static str, f64)> =
        effect.values().filter(|(name, _)| !linear(effect.kind).contains(name)).collect();
    if let Some(scan) = effect.kind.scan {
        let value = |name: &str| effect.value(name).unwrap_or_default();
        let phase = value(scan.phase);
        let parts = own().flat_map(|name| {
            let size = value(name);
            let [sin, cos] = waves(effect.kind, effect.target.clone(), name, &fixed);
            [(sin, size * phase.cos()), (cos, size * phase.sin())]
        });
        return parts.collect();
    }
    let steep = |name: &str| name.starts_with("velocity");
    let fixed: Vec<(&'static str, f64)> = match bench.steep(&effect.target) {
        Some(rate) if !effect.values().any(|(name, _)| steep(name)) => {
            let own = effect.kind.parameters.iter().find(|p| steep(p.name));
            fixed.into_iter().chain(own.map(|p| (p.name, p.clamped(rate)))).collect()
        }
        _ => fixed,
    };
    let term = |name: &&'static str| {
        (
            HeldTerm::new(effect.kind, effect.target.clone(), name, &fixed),
            effect.value(name).unwrap_or_default(),
        )
    };
    own().map(term).collect()
}

/// The two parts of a wave: with the sine and with the cosine of what it goes with.
fn waves(
    kind: &'static Kind,
    target: Target,
    amplitude: &'static str,
    fixed: &[(&'static str, f64)],
) -> [HeldTerm; 2] {
    let phase = kind.scan.map_or("phase_rad", |scan| scan.phase);
    let rest: Vec<_> = fixed.iter().copied().filter(|(name, _)| *name != phase).collect();
    [0.0, FRAC_PI_2].map(|at| {
        let fixed = [rest.as_slice(), &[(phase, at)]].concat();
        HeldTerm::new(kind, target.clone(), amplitude, &fixed)
    })
}

/// What may be added to a model: the effect, its form in words, and the model's terms with it.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The effect.
    pub kind: &'static Kind,
    /// What it acts on.
    pub target: Target,
    /// Its form.
    pub what: String,
    /// Terms of the model with it.
    pub terms: Vec<HeldTerm>,
}

impl HeldBench {
    /// Joints whose efforts are looked at, by name.
    fn joints(&self) -> impl Iterator<Item = (String, JointIndex)> + '_ {
        self.machine.joints().map(|(name, joint)| (name.to_owned(), joint))
    }

    /// The rate at which dry friction of a target's joint is near its full value.
    fn steep(&self, target: &Target) -> Option<f64> {
        let name = target.names().first()?;
        let (_, joint) = self.joints().find(|(joint, _)| joint == name)?;
        Some(SIGN_AT * self.rate(joint)?)
    }

    /// Friction of a joint by the names of its values.
    pub fn friction(&self, joint: &str, names: &[&'static str]) -> Vec<HeldTerm> {
        let Some((_, index)) = self.joints().find(|(name, _)| name == joint) else {
            return Vec::new();
        };
        let prismatic = matches!(index, JointIndex::Prismatic(_));
        let kind = named(if prismatic { "actuator-friction" } else { "joint-friction" });
        let target = Target::Joints(vec![joint.to_owned()]);
        let fixed = kind.and_then(|kind| {
            let parameter = kind.parameters.iter().find(|p| p.name.starts_with("velocity"))?;
            let own = |e: &&Setting| e.kind.name == kind.name && e.target == target;
            let declared = self.declared.iter().find(own).and_then(|e| given(e, parameter.name));
            let rate = declared.or_else(|| Some(parameter.clamped(self.steep(&target)?)));
            Some((parameter.name, rate?))
        });
        let fixed: Vec<(&'static str, f64)> = fixed.into_iter().collect();
        let of = |kind: &'static Kind| {
            names.iter().map(|name| HeldTerm::new(kind, target.clone(), name, &fixed)).collect()
        };
        kind.map_or_else(Vec::new, of)
    }

    /// Viscous friction of each measured joint, masses of bodies and the lag of drives: what every machine has.
    pub fn common(&self) -> Vec<HeldTerm> {
        let mut terms = Vec::new();
        let mut add = |kind: &str, target: Target, names: &[&'static str]| {
            let Some(kind) = named(kind) else { return };
            terms.extend(names.iter().map(|name| HeldTerm::new(kind, target.clone(), name, &[])));
        };
        for body in &self.machine.bodies {
            add("mass-properties", Target::Body(body.name.clone()), &BODY);
        }
        for drive in &self.machine.actuators {
            add("drive-lag", Target::Joints(vec![drive.name.clone()]), &["lag_s"]);
        }
        let friction = self.joints().filter(|(_, joint)| self.rate(*joint).is_some());
        let viscous = |(name, joint): (String, JointIndex)| match joint {
            JointIndex::Prismatic(_) => self.friction(&name, &["viscous_Ns_m"]),
            JointIndex::Revolute(_) => self.friction(&name, &["viscous"]),
        };
        let viscous: Vec<HeldTerm> = friction.flat_map(viscous).collect();
        terms.extend(viscous);
        terms
    }

    /// Friction that builds up with speed, or falls, over a rate (m/s).
    pub fn over(&self, kind: &str, joint: &str, speed: f64) -> Vec<HeldTerm> {
        let target = Target::Joints(vec![joint.to_owned()]);
        let Some(kind) = named(kind) else { return Vec::new() };
        if kind.name == "film-friction" {
            return vec![HeldTerm::new(kind, target, "force_N", &[("speed_m_s", speed)])];
        }
        // What falls away over v_s from the top of nothing.
        let steep = self.steep(&target).unwrap_or(SIGN_AT);
        let velocity = kind.parameter("velocity_m_s").map_or(steep, |p| p.clamped(steep));
        let fixed = [("coulomb_N", 0.0), ("stribeck_m_s", speed), ("velocity_m_s", velocity)];
        vec![HeldTerm::new(kind, target, "static_N", &fixed)]
    }

    /// A force that repeats with each turn of a screw of some pitch in m.
    pub fn ripple(&self, joint: &str, pitch: f64) -> Vec<HeldTerm> {
        let target = Target::Joints(vec![joint.to_owned()]);
        let of = |kind| waves(kind, target, "amplitude_N", &[("pitch_m", pitch)]).to_vec();
        named("screw-ripple").map_or_else(Vec::new, of)
    }

    /// Everything that can be added to a model with these terms, but for kinds `without`. Forms that differ in a number
    /// only follow each other.
    pub fn candidates(&self, terms: &[HeldTerm], without: &[&str]) -> Vec<Candidate> {
        let mut forms: Vec<Form> = Vec::new();
        for (name, joint) in self.joints() {
            let Some(rate) = self.rate(joint) else { continue };
            match joint {
                JointIndex::Prismatic(_) => forms.extend(self.of_slide(&name, rate, terms)),
                JointIndex::Revolute(_) => {
                    let dry =
                        |t: &HeldTerm| t.target().names().contains(&name) && t.sought == "coulomb";
                    if !terms.iter().any(dry) {
                        let dry = self.friction(&name, &["coulomb"]);
                        forms.push(("dry friction".to_owned(), dry, terms.to_vec()));
                    }
                }
            }
        }
        for body in &self.machine.bodies {
            let target = Target::Body(body.name.clone());
            let is = |t: &HeldTerm| *t.target() == target && t.kind().name == "air-drag";
            if let (false, Some(kind)) = (terms.iter().any(is), named("air-drag")) {
                let drag = HeldTerm::new(kind, target, "force_Ns2_m2", &[]);
                let what = "drag with the square of the speed".to_owned();
                forms.push((what, vec![drag], terms.to_vec()));
            }
        }
        let candidate = |(what, own, others): Form| {
            let first = own.first()?;
            let (kind, target) = (first.kind(), first.target().clone());
            let terms = [others, own].concat();
            (!without.contains(&kind.name)).then_some(Candidate { kind, target, what, terms })
        };
        forms.into_iter().filter_map(candidate).collect()
    }

    /// The same of a prismatic joint that moves at some rate (m/s, root mean square).
    fn of_slide(&self, name: &str, rate: f64, terms: &[HeldTerm]) -> Vec<Form> {
        let at = |term: &HeldTerm| term.target().names().iter().any(|joint| joint == name);
        let has = |sought: &[&str]| terms.iter().any(|t| at(t) && sought.contains(&t.sought));
        let is = |kind: &str| terms.iter().any(|t| at(t) && t.kind().name == kind);
        let mut forms: Vec<Form> = Vec::new();
        let mut add =
            |what: &str, own: Vec<HeldTerm>| forms.push((what.to_owned(), own, terms.to_vec()));
        let (ways, dry) = (has(&WAYS), has(&["coulomb_N", "coulomb_pos_N", "coulomb_neg_N"]));
        if !ways && !dry {
            add("dry friction", self.friction(name, &["coulomb_N"]));
        }
        if !ways && !has(&["offset_N"]) {
            add("an offset of the force", self.friction(name, &["offset_N"]));
        }
        // Departures from dry friction near rest; by themselves they would stand for all of it.
        for (kind, does) in [("film-friction", "builds up"), ("stribeck-friction", "falls")] {
            for share in BUILDS_UP.into_iter().filter(|_| dry && !is(kind)) {
                let speed = share * rate;
                let what = format!("friction that {does} over {:.3} mm/s", 1e3 * speed);
                add(&what, self.over(kind, name, speed));
            }
        }
        let scan = named("screw-ripple").and_then(|kind| kind.scan).map(|scan| scan.range);
        if let (false, Some(Tried::WaveNumbers([first, last, step]))) = (is("screw-ripple"), scan) {
            let count = ((last - first) / step).floor() as usize;
            for pitch in (0..=count).map(|k| 1.0 / (first + step * k as f64)) {
                let what = format!("ripple of a screw of {:.3} mm", 1e3 * pitch);
                add(&what, self.ripple(name, pitch));
            }
        }
        if !ways && dry {
            let slides = |t: &HeldTerm| at(t) && t.kind().name == "actuator-friction";
            let others = terms.iter().filter(|t| !slides(t)).cloned().collect();
            let what = "friction that differs with direction".to_owned();
            forms.push((what, self.friction(name, &WAYS), others));
        }
        forms
    }
}

/// A form of an effect in words, its terms, and the terms that stay beside it.
type Form = (String, Vec<HeldTerm>, Vec<HeldTerm>);
