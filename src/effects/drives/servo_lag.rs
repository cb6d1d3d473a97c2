//! Commands that pass a first-order filter before the servo follows them.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Command, Commands, Mechanism};
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "servo-lag",
    summary: "a first-order filter between command and servo",
    equation: "tau dq_f/dt = q_cmd - q_f; the servo follows q_f",
    source: "definition",
    trace: "measured forces against the servo's own law: with the commanded speed, less acceleration times tau",
    targets: Targets::Commands,
    parameters: &[Parameter::size(
        "time_constant_s",
        "s",
        "time constant tau, below 1/(2 pi f) of the fastest command",
        0.5,
        1e-5,
    )],
    variants: &[&["time_constant_s"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

/// Nodes and weights of Gauss–Laguerre quadrature with six points (Abramowitz and Stegun,
/// table 25.9): exact where the command is a polynomial of degree 11 over the filter's memory.
const LAGUERRE: [[f64; 2]; 6] = [
    [0.222_846_604_179_26, 0.458_964_673_949_964],
    [1.188_932_101_672_62, 0.417_000_830_772_121],
    [2.992_736_326_059_31, 0.113_373_382_074_045],
    [5.775_143_569_104_51, 0.010_399_197_453_148],
    [9.837_467_418_382_59, 2.610_172_028_149_32e-4],
    [15.982_873_980_601_7, 8.985_479_064_296_21e-7],
];

/// `q_f(t) = ∫₀^∞ e^{−s} q_cmd(t − τ s) ds`: the filter's answer to all of its past. It needs no
/// state, and commands are smooth functions of time. The quadrature errs by 2e-7 of an oscillation at
/// ω τ = 0.5, by 3e-4 at 1 and by 5 % at 2.
#[derive(Debug)]
struct Filtered {
    inner: Arc<dyn Commands>,
    time_constant: f64,
}

impl Commands for Filtered {
    fn at(&self, t: f64, commands: &mut [Command]) {
        let mut past = commands.to_vec();
        commands.fill(Command::default());
        for [node, weight] in LAGUERRE {
            self.inner.at(t - self.time_constant * node, &mut past);
            for (sum, term) in commands.iter_mut().zip(&past) {
                sum.position += weight * term.position;
                sum.rate += weight * term.rate;
                sum.acceleration += weight * term.acceleration;
            }
        }
    }

    fn added(&self, index: usize, t: f64) -> f64 {
        self.inner.added(index, t)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let inner = Arc::clone(&mechanism.commands);
    let time_constant = setting.number("time_constant_s");
    mechanism.commands = Arc::new(Filtered { inner, time_constant });
    Ok(())
}
