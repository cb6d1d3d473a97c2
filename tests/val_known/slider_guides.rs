//! A slider-crank whose slider has 1 mm of clearance on either side of its guides, let go with its crank at 150 rad/s.
//!
//! P. Flores, R. Leine, C. Glocker, Multibody Syst. Dyn. 23 (2010) 165–190, and the example `SliderCrank` of
//! siconos-tutorials with its kept result: first touch at 2.8 ms; turns of the crank 0.0731 at 3.7 ms, 0.1235 at 7.5 ms,
//! 0.770 at 50 ms, 1.491 at 0.1 s, 3.05 at 0.2 s. Those are figures of Moreau's and Jean's time stepping with steps of
//! 0.1 ms, which this file repeats digit by digit; as its steps go to zero they become 2.694 ms, 0.0729 and 0.1230, and
//! that is what a machine with stiff contacts has to meet.

use super::machine;
use freeplay::engine::{Schedule, StepControl, run};
use std::f64::consts::TAU;

const CRANK: f64 = 0.153;
const ROD: f64 = 0.306;
/// Half length and half height of the slider, and clearance on either side, in m.
const HALF: [f64; 2] = [0.05, 0.025];
const CLEARANCE: f64 = 1e-3;
const MASSES: [f64; 3] = [0.038, 0.038, 0.076];
const INERTIAS: [f64; 3] = [7.4e-5, 5.9e-4, 2.7e-6];
const GRAVITY: f64 = 9.81;
const RESTITUTION: f64 = 0.4;
const FRICTION: f64 = 0.01;

/// The three angles, of crank, rod and slider.
type Angles = [f64; 3];

/// M⁻¹ r at angles q.
fn accelerations(q: Angles, r: Angles) -> Angles {
    let [m1, m2, m3] = MASSES;
    let a = INERTIAS[0] + (0.25 * m1 + m2 + m3) * CRANK * CRANK;
    let b = (0.5 * m2 + m3) * CRANK * ROD * (q[1] - q[0]).cos();
    let c = INERTIAS[1] + (0.25 * m2 + m3) * ROD * ROD;
    let determinant = a * c - b * b;
    [(c * r[0] - b * r[1]) / determinant, (a * r[1] - b * r[0]) / determinant, r[2] / INERTIAS[2]]
}

/// Forces of gravity and of inertia at angles q and rates v.
fn forces(q: Angles, v: Angles) -> Angles {
    let [m1, m2, m3] = MASSES;
    let k = (0.5 * m2 + m3) * CRANK * ROD * (q[0] - q[1]).sin();
    [
        -k * v[1] * v[1] - (0.5 * m1 + m2 + m3) * GRAVITY * CRANK * q[0].cos(),
        k * v[0] * v[0] - (0.5 * m2 + m3) * GRAVITY * ROD * q[1].cos(),
        0.0,
    ]
}

/// Gap of a corner, and the derivatives of the gap and of its place along the guide.
fn corner(q: Angles, [along, across]: [f64; 2]) -> (f64, Angles, Angles) {
    let [(s0, c0), (s1, c1), (s2, c2)] = q.map(f64::sin_cos);
    let [a, b] = [along * HALF[0], across * HALF[1]];
    let height = CRANK * s0 + ROD * s1 + a * s2 + b * c2;
    (
        HALF[1] + CLEARANCE - across * height,
        [CRANK * c0, ROD * c1, a * c2 - b * s2].map(|slope| -across * slope),
        [-CRANK * s0, -ROD * s1, -a * s2 - b * c2],
    )
}

fn dot(a: Angles, b: Angles) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn plus(a: Angles, factor: f64, b: Angles) -> Angles {
    std::array::from_fn(|i| a[i] + factor * b[i])
}

/// A contact that may act in a step: its corner, its gap's rate before, its impulses along the normal and along the guide.
struct Active {
    sides: [f64; 2],
    before: f64,
    impulses: [f64; 2],
}

/// One step of Moreau's and Jean's scheme with θ = 1/2 (M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235–257):
/// momentum over the step with the masses at its end and the mean of both forces, contacts that half a step would close,
/// Newton's law of impact on them. Returns angles and rates at the end, and whether something touched.
fn step(h: f64, q: Angles, v: Angles) -> (Angles, Angles, bool) {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let near = |sides: [f64; 2]| {
        let (gap, normal, _) = corner(q, sides);
        let before = dot(normal, v);
        (gap + 0.5 * h * before <= 0.0).then_some(Active { sides, before, impulses: [0.0; 2] })
    };
    let mut active: Vec<Active> = corners.into_iter().filter_map(near).collect();
    let (start, mut u) = (forces(q, v), v);
    for _ in 0..60 {
        let end = plus(plus(q, 0.5 * h, v), 0.5 * h, u);
        let free = plus(plus([0.0; 3], 0.5 * h, start), 0.5 * h, forces(end, u));
        let old = u;
        u = plus(v, 1.0, accelerations(end, free));
        for contact in &active {
            let (_, normal, tangent) = corner(end, contact.sides);
            u = plus(u, contact.impulses[0], accelerations(end, normal));
            u = plus(u, contact.impulses[1], accelerations(end, tangent));
        }
        for _ in 0..if active.is_empty() { 0 } else { 200 } {
            for contact in &mut active {
                let (_, normal, tangent) = corner(end, contact.sides);
                let pushed = accelerations(end, normal);
                let missing = dot(normal, u) + RESTITUTION * contact.before;
                let new = (contact.impulses[0] - missing / dot(normal, pushed)).max(0.0);
                u = plus(u, new - contact.impulses[0], pushed);
                contact.impulses[0] = new;
                let pushed = accelerations(end, tangent);
                let most = FRICTION * new;
                let new = contact.impulses[1] - dot(tangent, u) / dot(tangent, pushed);
                let new = new.clamp(-most, most);
                u = plus(u, new - contact.impulses[1], pushed);
                contact.impulses[1] = new;
            }
        }
        if (0..3).all(|i| (u[i] - old[i]).abs() < 1e-11) {
            break;
        }
    }
    let touched = active.iter().any(|contact| contact.impulses[0] > 0.0);
    (plus(plus(q, 0.5 * h, v), 0.5 * h, u), u, touched)
}

/// Time in s of the first touch, and turns of the crank at some instants (s), by steps of `h` s.
fn scheme<const N: usize>(h: f64, instants: [f64; N]) -> (f64, [f64; N]) {
    let (mut q, mut v) = ([0.0; 3], [150.0, -75.0, 0.0]);
    let (mut first, mut turns) = (f64::INFINITY, [0.0; N]);
    for k in 1..=(instants[N - 1] / h).round() as usize {
        let (end, rates, touched) = step(h, q, v);
        (q, v) = (end, rates);
        let t = k as f64 * h;
        if touched {
            first = first.min(t);
        }
        for (instant, turned) in instants.iter().zip(&mut turns) {
            if (t - instant).abs() < 0.5 * h {
                *turned = q[0] / TAU;
            }
        }
    }
    (first, turns)
}

/// To as many digits as a number was printed with.
fn reads(value: f64, printed: &str) {
    let digits = printed.split('.').nth(1).map_or(0, str::len);
    assert_eq!(format!("{value:.digits$}"), printed, "{value}");
}

#[test]
fn the_published_figures_are_those_of_steps_of_a_tenth_of_a_millisecond() {
    let (first, turns) = scheme(1e-4, [3.7e-3, 7.5e-3, 0.05, 0.1, 0.2]);
    reads(1e3 * first, "2.8");
    for (turns, printed) in turns.into_iter().zip(["0.0731", "0.1235", "0.770", "1.491", "3.05"]) {
        reads(turns, printed);
    }
}

/// The slider-crank as a file, its contacts of a stiffness K (N/m^1.5).
fn described(stiffness: f64) -> String {
    format!(
        "[environment]\ngravity = [0.0, -{GRAVITY}]\n\
         [ground.points]\nO = [0.0, 0.0]\nS = [{start}, 0.0]\n\
         [[body]]\nname = \"crank\"\nmass = {}\ninertia = {}\ncenter_of_mass = [{}, 0.0]\n\
         points = {{ O = [0.0, 0.0], A = [{CRANK}, 0.0] }}\nvelocity = [0.0, 0.0, 150.0]\n\
         [[body]]\nname = \"rod\"\nmass = {}\ninertia = {}\ncenter_of_mass = [{}, 0.0]\n\
         points = {{ A = [0.0, 0.0], B = [{ROD}, 0.0] }}\nstart = [{CRANK}, 0.0, 0.0]\n\
         velocity = [0.0, {}, -75.0]\n\
         [[body]]\nname = \"slider\"\nmass = {}\ninertia = {}\npoints = {{ B = [0.0, 0.0] }}\n\
         start = [{start}, 0.0, 0.0]\n\
         [[joint]]\nname = \"O\"\nkind = \"revolute\"\nring = \"ground.O\"\njournal = \"crank.O\"\n\
         [[joint]]\nname = \"A\"\nkind = \"revolute\"\nring = \"crank.A\"\njournal = \"rod.A\"\n\
         [[joint]]\nname = \"B\"\nkind = \"revolute\"\nring = \"rod.B\"\njournal = \"slider.B\"\n\
         [[joint]]\nname = \"guide\"\nkind = \"prismatic\"\nbase = \"ground.S\"\nslider = \"slider.B\"\n\
         clearance = {CLEARANCE}\nlength = {}\nheight = {}\nfriction = {FRICTION}\n\
         restitution = {RESTITUTION}\nstiffness = {stiffness:e}\n\
         [contact]\nlaw = \"gonthier\"\n",
        MASSES[0],
        INERTIAS[0],
        0.5 * CRANK,
        MASSES[1],
        INERTIAS[1],
        0.5 * ROD,
        150.0 * CRANK,
        MASSES[2],
        INERTIAS[2],
        2.0 * HALF[0],
        2.0 * HALF[1],
        start = CRANK + ROD,
    )
}

/// Under both engines, with contacts ever stiffer: first touch, and turns of the crank at 3.7 and 7.5 ms, to three digits
/// of what the scheme becomes with steps of 2 µs.
#[test]
fn stiff_contacts_meet_the_limit_of_small_steps() {
    let (first, turns) = scheme(2e-6, [3.7e-3, 7.5e-3]);
    reads(1e3 * first, "2.694");
    for stiffness in [1e11, 1e12] {
        let mechanism = machine(&described(stiffness)).mechanism;
        for control in [StepControl::Tolerance(1e-6), StepControl::Direct(1e-6)] {
            let (mut touched, mut at) = (f64::INFINITY, Vec::new());
            let schedule = Schedule { duration: 7.5e-3, interval: 2e-6 };
            run(&mechanism, control, schedule, &mut |instant| {
                // The corners stand behind the three pins.
                if instant.tallies[3..].iter().any(|tally| tally.impacts > 0) {
                    touched = touched.min(instant.t);
                }
                if [3.7e-3, 7.5e-3].iter().any(|t| (t - instant.t).abs() < 1e-9) {
                    at.push(instant.angles[0] / TAU);
                }
            })
            .unwrap();
            println!(
                "{stiffness:e} {control:?}: touched at {touched:.6} s, {at:?}, limit {turns:?}"
            );
            assert!((touched - first).abs() < 4e-6, "{touched} {first}");
            for (found, limit) in at.iter().zip(turns) {
                assert!((found / limit - 1.0).abs() < 5e-4, "{control:?}: {found} {limit}");
            }
        }
    }
}

/// Without clearance the same file is the ideal machine; what the corners need, and what they do not take, is told.
#[test]
fn what_a_slider_with_clearance_needs_is_told() {
    use freeplay::scenario::Scenario;
    let text = described(1e11);
    let refused = |from: &str, to: &str, fragment: &str| {
        let told =
            Scenario::from_text(&text.replace(from, to), "guides", &[]).unwrap_err().to_string();
        assert!(told.contains(fragment), "{told}");
    };
    refused("length = 0.1\n", "", "length: is missing for the slider \"guide\"");
    refused("clearance = 0.001\n", "", "belongs to a slider with clearance");
    refused("law = \"gonthier\"", "law = \"liu\"", "law of conformal contact");
    refused("law = \"gonthier\"", "law = \"native\"", "made for rings");
    refused("length = 0.1\n", "length = -1.0\n", "length: is -1");
    let drive = "[[drive]]\njoint = \"guide\"\nkind = \"prescribed\"\n[contact]";
    refused("[contact]", drive, "prescribes the length of \"guide\"");
    let ideal = machine(
        &text.replace("law = \"gonthier\"", "law = \"ideal\"").replace("restitution = 0.4\n", ""),
    );
    assert!(ideal.mechanism.revolutes.len() == 3 && !ideal.mechanism.prismatics[0].play);
}
