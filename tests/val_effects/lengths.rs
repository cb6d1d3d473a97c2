//! Effects in what encoders read and in where joints are.

use super::common::{
    GEOMETRY, INSTANTS, LIVELY, assembled, at, effect, ideal, pose, starts, turned,
};
use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::simulate::Machine;
use nalgebra::{Rotation2, Vector2};
use std::f64::consts::TAU;

/// Lengths that the pose really has, from the centres of the joints, against what `true_length` makes of
/// the commands; the encoder shows the commands, and the rates are as the lengths are.
fn closes(keys: &str, kind: &str, anchor: Vector2<f64>, true_length: impl Fn(f64) -> f64) {
    let machine = ideal(
        &effect(kind, &format!("joint = \"{}1\"; {keys}", if anchor.x == 0.0 { "P" } else { "A" })),
        &[],
    );
    for t in INSTANTS {
        let (mechanism, now) = at(&machine.mechanism, t);
        let states = starts(&mechanism);
        let pose = pose(&mechanism, &states);
        let rate = mechanism.output_state(&states).twist;
        let commands = GEOMETRY.inverse(&machine.motion.at(t));
        for (leg, command) in commands.iter().enumerate() {
            let d = GEOMETRY.leg(pose, leg) - if leg == 0 { anchor } else { Vector2::zeros() };
            let arm = Rotation2::new(pose.z) * GEOMETRY.corner(leg);
            let length_rate = d.normalize().dot(&(rate.xy() + turned(arm) * rate.z));
            let truth = |q: f64| if leg == 0 { true_length(q) } else { q };
            let slope = (truth(command.position + 1e-6) - truth(command.position - 1e-6)) / 2e-6;
            assert!((d.norm() - truth(command.position)).abs() < 1e-12, "{kind} at {t}, leg {leg}");
            assert!((length_rate - slope * command.rate).abs() < 1e-7, "{kind} at {t}, leg {leg}");
            assert!(
                (mechanism.encoder(leg, &now) - command.position).abs() < 1e-12,
                "{kind} at {t}"
            );
        }
        let moved = (pose - machine.motion.at(t).pose).norm();
        assert!(moved > 1e-5, "{kind} at {t} moves the platform by {moved:e}");
    }
}

#[test]
fn lengths_and_pose_close_with_what_the_encoders_miss() {
    let none = Vector2::zeros();
    closes("relative = 0.02", "actuator-scale", none, |q| q + 0.02 * (q - 0.32));
    closes("offset_m = -2e-3", "sensor-offset", none, |q| q - 2e-3);
    closes("amplitude_m = 3e-4; pitch_m = 0.02; phase_rad = 1", "screw-ripple", none, |q| {
        q + 3e-4 * (TAU * q / 0.02 + 1.0).sin()
    });
    closes("dx_m = 2e-3; dy_m = -3e-3", "anchor-offset", Vector2::new(2e-3, -3e-3), |q| q);
}

/// The accelerations that a prescribed drive with a wrong encoder imposes are those of the lengths.
#[test]
fn a_run_with_a_wrong_encoder_follows_the_true_lengths() {
    let keys = effect("screw-ripple", "joint = \"P1\"; amplitude_m = 3e-4; pitch_m = 0.02");
    for law in ["contact.law=ideal", "contact.law=hertz-step"] {
        let Machine { mechanism, motion, .. } = assembled(&format!("{LIVELY}{keys}"), &[law]);
        let schedule = Schedule { duration: 0.1, interval: 0.005 };
        run(&mechanism, StepControl::Fixed(1e-5), schedule, &mut |instant: &Instant| {
            let read = GEOMETRY.inverse(&motion.at(instant.t))[0].position;
            let truth = read + 3e-4 * (TAU * read / 0.02).sin();
            let length = instant.evaluation.lengths[0];
            assert!((length - truth).abs() < 1e-9, "{law} at {}: {length} {truth}", instant.t);
        })
        .unwrap();
    }
}
