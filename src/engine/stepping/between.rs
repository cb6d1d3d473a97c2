//! What lies between a step's two ends.

use crate::mechanism::BodyState;
use nalgebra::Vector3;

/// One end of a step: the state of a body there, and its acceleration (m/s², m/s², rad/s²).
pub(super) type End<'a> = (&'a BodyState, Vector3<f64>);

/// The state of a body at the share `s` of a step of `h` s: the quintic through states and accelerations at both
/// ends; `shift` is the way from one to the other (m, m, rad). It errs by h⁶.
pub(super) fn state(h: f64, s: f64, [from, to]: [End; 2], shift: Vector3<f64>) -> BodyState {
    let (mut by, mut twist) = (Vector3::zeros(), Vector3::zeros());
    for k in 0..3 {
        let rates = [from.0.twist[k], to.0.twist[k]];
        (by[k], twist[k]) = coordinate(h, s, rates, [from.1[k], to.1[k]], shift[k]);
    }
    BodyState { twist, ..from.0.displaced(by) }
}

/// How far a coordinate has come at the share `s` of a step of `h` s, and its rate there: the quintic through
/// rates `v`, accelerations `a` and the whole way `shift`.
pub(super) fn coordinate(h: f64, s: f64, v: [f64; 2], a: [f64; 2], shift: f64) -> (f64, f64) {
    let (hv, hha) = (h * v[0], h * h * a[0]);
    // What the parabola from the start misses at the end: place, slope, curvature.
    let place = shift - hv - 0.5 * hha;
    let slope = h * v[1] - hv - hha;
    let curvature = h * h * a[1] - hha;
    let c3 = 10.0 * place - 4.0 * slope + 0.5 * curvature;
    let c4 = -15.0 * place + 7.0 * slope - curvature;
    let c5 = 6.0 * place - 3.0 * slope + 0.5 * curvature;
    let way = s * (hv + s * (0.5 * hha + s * (c3 + s * (c4 + s * c5))));
    (way, (hv + s * (hha + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / h)
}

/// By how much a quantity has grown at the share `s` of a step of `h` s over which it grows by `growth`: the cubic
/// through its rates at both ends.
pub(super) fn growth(h: f64, s: f64, rates: [f64; 2], growth: f64) -> f64 {
    let [from, to] = rates.map(|rate| h * rate);
    let (c2, c3) = (3.0 * growth - 2.0 * from - to, from + to - 2.0 * growth);
    s * (from + s * (c2 + s * c3))
}
