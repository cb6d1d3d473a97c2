//! Joints close from guessed starts.

use crate::chain::{Driven, Form};
use crate::every_chain;
use crate::sampling::Worst;
use freeplay::mechanism::{BodyState, Mechanism};

/// Largest distance of the centres of a joint's ring and journal at the start, m.
fn gap(mechanism: &Mechanism) -> f64 {
    let starts: Vec<BodyState> = mechanism.bodies.iter().map(|body| body.start).collect();
    let apart = |joint: &freeplay::mechanism::Revolute| {
        (joint.ring.frame(&starts).centre - joint.journal.frame(&starts).centre).norm()
    };
    mechanism.revolutes.iter().map(apart).fold(0.0, f64::max)
}

/// Largest relative speed of the centres of a joint's ring and journal at the start, m/s.
fn opening(mechanism: &Mechanism) -> f64 {
    let starts: Vec<BodyState> = mechanism.bodies.iter().map(|body| body.start).collect();
    let speed = |joint: &freeplay::mechanism::Revolute| {
        (joint.ring.frame(&starts).velocity - joint.journal.frame(&starts).velocity).norm()
    };
    mechanism.revolutes.iter().map(speed).fold(0.0, f64::max)
}

fn close(cases: u32) {
    let worst = Worst::new();
    every_chain(cases, |chain| {
        let perturbed = Form { perturbed: true, ..Form::default() };
        let [guess, exact] = [&perturbed, &Form::default()].map(|form| chain.machine(form));
        let (guess, exact) = (guess?.mechanism, exact?.mechanism);
        let moved = guess
            .bodies
            .iter()
            .zip(&exact.bodies)
            .map(|(a, b)| (a.start.position - b.start.position).norm())
            .fold(0.0, f64::max);
        let mut driven = 0.0f64;
        if let Driven::Prescribed | Driven::Servo = chain.driven {
            let joint = &guess.revolutes[0];
            let starts: Vec<BodyState> = guess.bodies.iter().map(|body| body.start).collect();
            let mut command = [freeplay::mechanism::Command::default()];
            guess.true_commands(0.0, &mut command);
            let commanded = nalgebra::UnitComplex::new(command[0].position);
            driven = commanded.rotation_to(&joint.rotation(&starts)).angle().abs();
        }
        let found = [gap(&guess), opening(&guess), driven, moved];
        worst.take(found);
        if found[0] > 1e-12 || found[1] > 1e-12 || driven > 1e-12 {
            return Err(format!("open by {found:?}"));
        }
        // It is the pose that was meant, not another branch: guesses are 7 mm and 3 degrees off.
        if moved > 0.05 { Err(format!("closed {moved} m away")) } else { Ok(()) }
    });
    let [gap, opening, driven, moved] = worst.get();
    println!(
        "{cases} chains from guesses some degrees off: joints closed to {gap:.1e} m, {opening:.1e} m/s \
         (limits 1e-12), drives to {driven:.1e} rad (1e-12), bodies {:.0} mm from the exact pose (50)",
        1e3 * moved
    );
    assert!(moved > 1e-3, "nothing was perturbed");
}

#[test]
fn chains_close_from_guesses() {
    close(256);
}

#[test]
#[ignore = "a campaign of some minutes"]
fn many_chains_close_from_guesses() {
    close(20_000);
}
