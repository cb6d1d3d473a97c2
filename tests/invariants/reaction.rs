//! What a journal does to its ring, the ring does to the journal.

use crate::common::hertz;
use crate::sampling::{Worst, config, vector};
use freeplay::contact::{Clearance, CoulombFriction, Frame};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::cell::Cell;
use std::sync::Arc;

#[test]
fn action_equals_reaction() {
    let frames = (vector(0.5), vector(0.2), vector(1.0), -20.0..20.0);
    let other = (vector(7e-4), vector(0.2), vector(1.0), -20.0..20.0);
    let (worst, touched) = (Worst::new(), Cell::new(0));
    TestRunner::new(config(64))
        .run(&(frames, other, 0.0..0.5), |(ring, journal, coefficient)| {
            let frame = |centre, (_, arm, velocity, spin): (_, _, _, f64)| Frame {
                centre,
                arm,
                velocity,
                spin,
            };
            let frames = [frame(ring.0, ring), frame(ring.0 + journal.0, journal)];
            let joint = Clearance {
                bearing_radius: 0.01,
                journal_radius: 0.0098,
                law: Arc::new(hertz(0.01, 0.0098)),
                friction: Some(CoulombFriction { coefficient, velocity: 1e-3 }.into()),
            };
            let (contact, forces) = joint.forces(&frames[0], &frames[1]);
            let Some(wrenches) = forces else {
                prop_assert!(contact.penetration <= 0.0, "a touching journal without force");
                return Ok(());
            };
            touched.set(touched.get() + 1);
            let size = wrenches[0].xy().norm();
            let sum = (wrenches[0].xy() + wrenches[1].xy()).norm();
            let moment: f64 = frames
                .iter()
                .zip(&wrenches)
                .map(|(f, w)| w.z + (f.centre - f.arm).perp(&w.xy()))
                .sum();
            // Arms are of the order of 0.1 m; a force of zero is as good as any.
            let relative = [sum / size.max(1e-9), moment.abs() / size.max(1e-9)];
            worst.take(relative);
            prop_assert!(relative[0] <= 1e-15, "forces differ by {:e} > 1e-15", relative[0]);
            prop_assert!(relative[1] <= 1e-14, "moments by {:e} m > 1e-14 m", relative[1]);
            Ok(())
        })
        .unwrap();
    let (worst, touched) = (worst.get(), touched.get());
    println!(
        "{touched} contacts: forces differ by {:.1e} (limit 1e-15), moments by {:.1e} m (1e-14)",
        worst[0], worst[1]
    );
    assert!(touched > 16, "only {touched} of 64 in contact");
}
