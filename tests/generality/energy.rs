//! Energy: conserved without losses, never growing with them, balanced by the work of drives.

use crate::chain::{Chain, Driven, Form, SPRING, STIFFNESS, go};
use crate::common::kinetic_energy;
use crate::every_chain;
use crate::sampling::Worst;
use freeplay::engine::Instant;
use freeplay::mechanism::{Bearing, Mechanism};
use std::cell::Cell;

const TOLERANCE: f64 = 1e-6;
const DURATION: f64 = 0.03;

/// Kinetic energy, height and spring, J.
fn mechanical(chain: &Chain, mechanism: &Mechanism, instant: &Instant) -> f64 {
    let bodies = mechanism.bodies.iter().zip(instant.states);
    let height: f64 =
        bodies.map(|(body, state)| -body.mass * mechanism.gravity.dot(&state.position)).sum();
    let mut spring = 0.0;
    if chain.spring {
        let [from, to] = chain.spring_ends(mechanism, instant.states);
        spring = 0.5 * SPRING[0] * ((to - from).norm() - SPRING[1]).powi(2);
    }
    kinetic_energy(mechanism, instant.states) + height + spring
}

/// What the contacts hold as springs, `K δ^2.5/2.5`, J.
fn held(mechanism: &Mechanism, instant: &Instant) -> f64 {
    let joints = mechanism.revolutes.iter().zip(&instant.evaluation.contacts);
    joints
        .filter(|(joint, _)| matches!(joint.bearing, Bearing::Clearance(_)))
        .map(|(_, contact)| STIFFNESS * contact.penetration.max(0.0).powf(2.5) / 2.5)
        .sum()
}

/// What a run did with its energy, in shares of the largest kinetic energy and work.
struct Balance {
    /// Largest change of the energy with what contacts hold and less the work of the drive.
    change: f64,
    /// Largest growth of that over its lowest value before.
    growth: f64,
    /// Largest change of the energy with what the contacts have taken by their own account, and less the
    /// work of the drive.
    account: f64,
    /// Energy that the contacts have taken for good.
    lost: f64,
    hits: u64,
}

fn balance(chain: &Chain, c_max: f64) -> Result<Balance, String> {
    let mechanism = chain.machine(&Form { c_max, ..Form::default() })?.mechanism;
    let interval = if chain.driven == Driven::Not { 1e-3 } else { 1e-5 };
    let (mut first, mut lowest, mut work) = (None, f64::INFINITY, 0.0);
    let mut before: Option<(f64, f64)> = None;
    let (mut scale, mut change, mut growth, mut account, mut lost) =
        (0.0f64, 0.0f64, 0.0f64, 0.0f64, 0.0);
    let mut hits = 0;
    go(&mechanism, TOLERANCE, DURATION, interval, |instant| {
        if chain.driven != Driven::Not {
            let rate = mechanism.revolutes[0].spin(instant.states);
            let power = instant.evaluation.drive_forces[0] * rate;
            if let Some((t, was)) = before {
                work += 0.5 * (power + was) * (instant.t - t);
            }
            before = Some((instant.t, power));
        }
        let without = mechanical(chain, &mechanism, instant) - work;
        let now = without + held(&mechanism, instant);
        let taken: f64 = instant
            .tallies
            .iter()
            .zip(&mechanism.revolutes)
            .filter(|(_, joint)| matches!(joint.bearing, Bearing::Clearance(_)))
            .map(|(tally, _)| tally.energy)
            .sum();
        let start = *first.get_or_insert(now);
        change = change.max((now - start).abs());
        account = account.max((without + taken - start).abs());
        lowest = lowest.min(now);
        growth = growth.max(now - lowest);
        lost = start - now;
        scale = scale.max(kinetic_energy(&mechanism, instant.states)).max(work.abs());
        hits = instant.tallies.iter().map(|tally| tally.impacts).sum();
    })?;
    let share = |energy: f64| energy / scale;
    Ok(Balance {
        change: share(change),
        growth: share(growth),
        account: share(account),
        lost: share(lost),
        hits,
    })
}

/// Limits in shares of the largest kinetic energy or work: of the energy where nothing drives the chain, where a
/// drive's work is summed up from rows by the trapezoidal rule, and of what contacts say that they have taken, which
/// is summed up from steps by the same rule.
const CHANGE: f64 = 1e-5;
const WITH_WORK: f64 = 2e-4;
const ACCOUNT: f64 = 1e-3;

fn limit(chain: &Chain) -> f64 {
    if chain.driven == Driven::Not { CHANGE } else { WITH_WORK }
}

fn conserved(cases: u32) {
    let (worst, hits) = (Worst::new(), Cell::new(0));
    every_chain(cases, |chain| {
        let Balance { change, account, hits: count, .. } = balance(chain, 0.0)?;
        hits.set(hits.get() + count);
        let driven = chain.driven != Driven::Not;
        worst.take([if driven { 0.0 } else { change }, if driven { change } else { 0.0 }, account]);
        if change > limit(chain) || account > ACCOUNT {
            return Err(format!("{:?} drive: energy off by {change:e}, {account:e}", chain.driven));
        }
        Ok(())
    });
    let [free, driven, account] = worst.get();
    println!(
        "{cases} chains without losses, {} hits: energy off by {free:.1e} (limit {CHANGE:e}), with a drive \
         {driven:.1e} ({WITH_WORK:e}), by the contacts' own account {account:.1e} ({ACCOUNT:e})",
        hits.get()
    );
    assert!(hits.get() > 100, "only {} hits", hits.get());
}

fn damped(cases: u32) {
    let (worst, most) = (Worst::new(), Cell::new(0.0f64));
    every_chain(cases, |chain| {
        let Balance { growth, account, lost, .. } = balance(chain, 500.0)?;
        most.set(most.get().max(lost));
        worst.take([growth, account]);
        if growth > limit(chain) || account > ACCOUNT {
            return Err(format!(
                "{:?} drive: grew by {growth:e}, off by {account:e}",
                chain.driven
            ));
        }
        Ok(())
    });
    let [growth, account] = worst.get();
    println!(
        "{cases} chains with damping lose up to {:.0} % of their energy: it grew by {growth:.1e} at most (limit \
         {CHANGE:e}, with a drive {WITH_WORK:e}), off by {account:.1e} by the contacts' account ({ACCOUNT:e})",
        100.0 * most.get()
    );
    assert!(most.get() > 0.1, "the damping took only {}", most.get());
}

#[test]
fn energy_is_conserved_without_losses() {
    conserved(40);
}

#[test]
fn energy_never_grows_with_losses() {
    damped(40);
}

#[test]
#[ignore = "a campaign of some minutes"]
fn energy_of_many_is_conserved_without_losses() {
    conserved(1000);
}

#[test]
#[ignore = "a campaign of some minutes"]
fn energy_of_many_never_grows_with_losses() {
    damped(1000);
}
