//! Effects that go by two names on some machines: a search tries one of the two, under the name that says more.

use super::{CONTAINS, Setting, Target, named};
use crate::mechanism::{JointIndex, Mechanism, NamedPoint, Reads, Sensor, Use};

impl Setting {
    /// The name under which another kind in the catalogue says the same of `mechanism`, if that is the name to
    /// use:
    ///
    /// * friction in a prismatic joint is `actuator-friction` where a drive moves it, `joint-friction` where none
    ///   does: both are −(F_c sign(q̇) + F_v q̇) along its axis;
    /// * a point of the ground that carries one bearing and nothing else is moved by `anchor-offset`;
    /// * so is the only other point of the ground, the other way, where no sensor tells where the machine stands;
    /// * the wrong zero of a driven prismatic joint's encoder is `sensor-offset`, with the other sign.
    pub fn better_known_as(&self, mechanism: &Mechanism) -> Option<&'static str> {
        let index = |name: &str| mechanism.joints().find(|(joint, _)| *joint == name);
        let driven = |joint| mechanism.actuators.iter().any(|drive| drive.joint == joint);
        let prismatic = |joint: JointIndex| matches!(joint, JointIndex::Prismatic(_));
        // Joints with a common cause are of one make.
        let first = self.target.names().first().map(String::as_str);
        let joint = first.and_then(index).map(|(_, joint)| joint);
        match (self.kind.name, &self.target) {
            ("joint-friction", _) => {
                joint.filter(|j| prismatic(*j) && driven(*j)).map(|_| "actuator-friction")
            }
            ("actuator-friction", _) => {
                joint.filter(|j| prismatic(*j) && !driven(*j)).map(|_| "joint-friction")
            }
            ("point-offset", Target::Point(name)) => {
                let points = || mechanism.names.points.iter();
                let grounded = || {
                    points()
                        .filter(|(_, point)| point.mark.body.is_none() && !point.uses.is_empty())
                };
                let bearing = |point: &NamedPoint| matches!(point.uses[..], [Use::Ring(_)]);
                let (_, own) = grounded().find(|(known, _)| *known == name)?;
                let mut others = grounded().filter(|(known, _)| *known != name);
                let only = matches!((others.next(), others.next()), (Some((_, one)), None) if bearing(one));
                let placed = mechanism.sensors.iter().any(Sensor::tracks);
                (bearing(own) || only && !placed).then_some("anchor-offset")
            }
            ("encoder-zero", Target::Sensors(columns)) => {
                let [column] = &columns[..] else { return None };
                let sensor = mechanism.sensors.iter().find(|sensor| sensor.column == *column)?;
                let Reads::Position(joint) = sensor.reads else { return None };
                (prismatic(joint) && driven(joint)).then_some("sensor-offset")
            }
            _ => None,
        }
    }
}

impl Setting {
    /// Whether it becomes another effect, on the same target, at some of its values.
    pub fn contains(&self, inner: &Setting) -> bool {
        // In a prismatic joint both are −(F_c sign(q̇) + F_v q̇).
        let inner_name = match inner.kind.name {
            "joint-friction" => "actuator-friction",
            name => name,
        };
        let kinds = (self.kind.name, inner_name);
        self.target == inner.target
            && CONTAINS.iter().any(|(outer, inner)| (outer.name, inner.name) == kinds)
    }

    /// `pivot-friction` of named joints as `joint-friction`, which says the same of any joint; none of other effects.
    pub fn as_joint_friction(&self) -> Option<Setting> {
        if self.kind.name != "pivot-friction" || self.target.names().is_empty() {
            return None;
        }
        let [coulomb, viscous, velocity] =
            ["coulomb_Nm", "viscous_Nms", "velocity_rad_s"].map(|name| self.number(name));
        let mut values = vec![("coulomb", coulomb), ("viscous", viscous)];
        // The rate at which there is dry friction means nothing where there is none.
        values.extend((coulomb > 0.0).then_some(("velocity", velocity)));
        Some(Setting::on(named("joint-friction")?, self.target.clone(), &values))
    }
}

#[cfg(test)]
mod tests {
    use super::super::rigs::{SLIDER_CRANK, closed};
    use crate::effects::{ALL, Setting, named};
    use crate::mechanism::Mechanism;
    use crate::model::parts_of;
    use crate::scenario::Scenario;

    fn left_out(mechanism: &Mechanism) -> Vec<String> {
        let all = ALL.iter().flat_map(|kind| kind.candidates(mechanism));
        let twins = all.filter_map(|effect| {
            effect.better_known_as(mechanism).map(|name| format!("{effect}: {name}"))
        });
        let mut twins: Vec<String> = twins.collect();
        twins.dedup();
        twins
    }

    #[test]
    fn friction_that_falls_contains_plain_friction_of_the_same_joint() {
        let at = |kind: &str, joint| Setting::new(named(kind).unwrap(), Some(joint), &[]);
        let falling = at("stribeck-friction", "S");
        assert!(falling.contains(&at("joint-friction", "S")));
        assert!(falling.contains(&at("actuator-friction", "S")));
        assert!(!falling.contains(&at("joint-friction", "B")));
        assert!(!at("joint-friction", "S").contains(&falling));
    }

    #[test]
    fn of_two_names_the_one_that_says_more_is_left() {
        let text = "[mechanism]\nkind = \"3rpr\"\n[sensors]\n";
        let legs = parts_of(&Scenario::from_text(text, "rig", &[]).unwrap()).unwrap();
        let expected = [
            "point-offset at ground.A1: anchor-offset",
            "point-offset at ground.A2: anchor-offset",
            "point-offset at ground.A3: anchor-offset",
            "joint-friction at P1: actuator-friction",
            "joint-friction at P2: actuator-friction",
            "joint-friction at P3: actuator-friction",
            "joint-friction at P1, P2, P3: actuator-friction",
            "encoder-zero at q1: sensor-offset",
            "encoder-zero at q2: sensor-offset",
            "encoder-zero at q3: sensor-offset",
        ];
        assert_eq!(left_out(&legs), expected);
        let mut machine = closed(SLIDER_CRANK).mechanism.clone();
        let (friction, anchor) =
            ("actuator-friction at S: joint-friction", "point-offset at ground.O: anchor-offset");
        assert_eq!(left_out(&machine), [friction, anchor]);
        // Where nobody sees the place of the machine its slide is moved as its anchor is the other way.
        machine.sensors.retain(|sensor| !sensor.tracks());
        let slide = "point-offset at ground.S: anchor-offset";
        assert_eq!(left_out(&machine), [friction, anchor, slide]);
    }
}
