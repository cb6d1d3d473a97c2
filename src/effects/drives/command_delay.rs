//! Commands that reach the drives late.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Command, Commands, Mechanism};
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "command-delay",
    summary: "commands that reach the drives late",
    equation: "the drives follow q_cmd(t - delay); the sensors are not late",
    source: "definition",
    trace: "measured forces against the servo's own law: with the commanded speed",
    targets: Targets::Commands,
    parameters: &[Parameter::size("delay_s", "s", "delay", 0.5, 1e-5)],
    variants: &[&["delay_s"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

/// Commands as they were a while ago.
#[derive(Debug)]
struct Delayed {
    inner: Arc<dyn Commands>,
    delay: f64,
}

impl Commands for Delayed {
    fn at(&self, t: f64, commands: &mut [Command]) {
        self.inner.at(t - self.delay, commands);
    }

    fn added(&self, index: usize, t: f64) -> f64 {
        self.inner.added(index, t)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let inner = Arc::clone(&mechanism.commands);
    mechanism.commands = Arc::new(Delayed { inner, delay: setting.number("delay_s") });
    Ok(())
}
