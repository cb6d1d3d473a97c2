//! Sensors that show what was.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Senses, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "sensor-latency",
    summary: "a sensor, or some that share a clock, that shows what was a while ago; no drive hears of it",
    equation: "shows y(t - delay)",
    source: "definition",
    trace: "that column against the others: with its own rate",
    targets: Targets::Sensor(Senses::Any),
    parameters: &[Parameter::size("delay_s", "s", "delay", 0.5, 1e-5)],
    variants: &[&["delay_s"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for index in setting.sensors(mechanism)? {
        mechanism.sensors[index].delay += setting.number("delay_s");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{SLIDER_CRANK, closed};

    #[test]
    fn sensors_that_share_a_clock_are_late_together() {
        let late =
            "[[effect]]\nkind = \"sensor-latency\"\nsensor = [\"q_O\", \"x_B\"]\ndelay_s = 0.004\n";
        let machine = closed(&format!("{SLIDER_CRANK}{late}{late}"));
        for sensor in &machine.mechanism.sensors {
            let due = if ["q_O", "x_B"].contains(&sensor.column.as_str()) { 0.008 } else { 0.0 };
            assert_eq!(sensor.delay, due, "{}", sensor.column);
        }
    }
}
