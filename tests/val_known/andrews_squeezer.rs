//! Andrews' squeezing mechanism: seven bodies, three loops, a stiff spring, 2.5 turns of the crank in 30 ms.
//!
//! Data, start and solution at 0.03 s: Test Set for IVP Solvers, release 2.4 (F. Mazzia, C. Magherini,
//! University of Bari, 2008), problem Andrews; Hairer & Wanner, *Solving Ordinary Differential Equations
//! II*, §VII.7; A03 of the IFToMM benchmark library. Its angles β Θ γ Φ δ Ω ε turn the bodies K1 to K7 so:
//! K1 β, K2 β + Θ, K3 γ, K4 Φ + δ, K5 δ, K6 Ω + ε, K7 ε. K2, K3, K4 and K6 meet in one point, P.

use super::{body, machine, short, simulate};
use freeplay::engine::Schedule;

const START: [f64; 7] = [
    -0.061_713_890_014_276_4,
    0.0,
    0.455_279_819_163_070_4,
    0.222_668_390_165_885_9,
    0.487_364_979_543_842_6,
    -0.222_668_390_165_885_9,
    1.230_547_444_549_821_2,
];
const END: [f64; 7] = [
    15.810_771_196_299_04,
    -15.756_371_059_842_98,
    0.040_822_240_130_731_01,
    -0.534_730_116_322_694_8,
    0.524_409_965_880_530_5,
    0.534_730_116_322_694_8,
    1.048_080_741_042_263,
];

/// Points of the ground in m.
const A: [f64; 2] = [-0.06934, -0.00227];
const B: [f64; 2] = [-0.03635, 0.03273];
const C: [f64; 2] = [0.014, 0.072];

/// Angles of K1 to K7 in rad.
fn angles([beta, theta, gamma, phi, delta, omega, epsilon]: [f64; 7]) -> [f64; 7] {
    [beta, beta + theta, gamma, phi + delta, delta, omega + epsilon, epsilon]
}

/// The mechanism at its start. A body's axes are those that its angle turns; of K3, K5 and K7 the problem
/// says only how far the centre of mass is from their pivot, which is all that acts without gravity.
fn squeezer() -> String {
    let [[xa, ya], [xb, yb], [xc, yc]] = [A, B, C];
    let text = format!(
        "
        [ground.points]
        O = [0.0, 0.0]
        A = [{xa:?}, {ya:?}]
        B = [{xb:?}, {yb:?}]
        C = [{xc:?}, {yc:?}]
        [[drive]]
        joint = \"O\"
        kind = \"force\"
        value = 0.033
        [[spring]]
        between = [\"K3.spring\", \"ground.C\"]
        stiffness = 4530.0
        free_length = 0.07785
        "
    );
    text + &bodies() + &joints()
}

/// The bodies.
fn bodies() -> String {
    let [[xa, ya], [xb, yb]] = [A, B];
    let [d, da, e, ea, rr, ra] = [0.028, 0.0115, 0.02, 0.01421, 0.007, 0.00092f64];
    let [ss, sa, sb, sc, sd] = [0.035, 0.01874, 0.01043, 0.018, 0.02f64];
    let [ta, tb, u, ua, ub, zf, zt, fa] =
        [0.02308, 0.00916, 0.04, 0.01228, 0.00449, 0.02, 0.04, 0.01421f64];
    let turned = angles(START);
    // Where each body's axes begin.
    let along = |length: f64, angle: f64| [length * angle.cos(), length * angle.sin()];
    let crank = along(rr, turned[0]);
    let [k5, k7] = [along(zt, turned[4]), along(-u, turned[6] + std::f64::consts::FRAC_PI_2)];
    let origins = [
        [0.0, 0.0],
        crank,
        [xb, yb],
        [xa + k5[0], ya + k5[1]],
        [xa, ya],
        [xa + k7[0], ya + k7[1]],
        [xa, ya],
    ];
    let masses = [0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498];
    let inertias = [2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5];
    let centres =
        [[ra, 0.0], [-da, 0.0], [sb, -sa], [0.0, ea - e], [ta, tb], [zf - fa, 0.0], [ua, -ub]];
    let point = |name: &str, x: f64, y: f64| format!("{name} = [{x:?}, {y:?}]");
    let points = [
        point("end", rr, 0.0),
        point("P", -d, 0.0),
        [point("P", 0.0, -ss), point("spring", sd, -sc)].join(", "),
        point("P", 0.0, -e),
        point("end", zt, 0.0),
        point("P", zf, 0.0),
        point("end", 0.0, -u),
    ];
    let mut text = String::new();
    for i in 0..7 {
        let [x, y] = origins[i];
        text += &format!(
            "
            [[body]]
            name = \"K{}\"
            mass = {:?}
            inertia = {:?}
            center_of_mass = {:?}
            points = {{ pivot = [0.0, 0.0], {} }}
            start = [{x:?}, {y:?}, {:?}]
            ",
            i + 1,
            masses[i],
            inertias[i],
            centres[i],
            points[i],
            turned[i],
        );
    }
    text
}

/// The joints.
fn joints() -> String {
    let joints = [
        ("O", "ground.O", "K1.pivot"),
        ("K1K2", "K1.end", "K2.pivot"),
        ("B", "ground.B", "K3.pivot"),
        ("P3", "K2.P", "K3.P"),
        ("P4", "K2.P", "K4.P"),
        ("P6", "K2.P", "K6.P"),
        ("K5K4", "K5.end", "K4.pivot"),
        ("A5", "ground.A", "K5.pivot"),
        ("K7K6", "K7.end", "K6.pivot"),
        ("A7", "ground.A", "K7.pivot"),
    ];
    let mut text = String::new();
    for (name, ring, journal) in joints {
        text += &format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\nring = \"{ring}\"\n\
             journal = \"{journal}\"\n"
        );
    }
    text
}

#[test]
fn the_squeezer_ends_where_the_test_set_says() {
    let mechanism = machine(&squeezer()).mechanism;
    let bodies: [usize; 7] = std::array::from_fn(|i| body(&mechanism, &format!("K{}", i + 1)));
    // The starts are closed already: what putting together changes is rounding.
    for (i, angle) in angles(START).into_iter().enumerate() {
        let moved = (mechanism.bodies[bodies[i]].angle - angle).abs();
        assert!(moved < 1e-12, "K{} starts {moved:e} rad away", i + 1);
    }
    let mut end = [0.0; 7];
    let schedule = Schedule { duration: 0.03, interval: 1e-3 };
    simulate(&mechanism, 1e-8, schedule, &mut |instant| {
        end = bodies.map(|body| instant.angles[body]);
    });
    let expected = angles(END);
    let errors: [f64; 7] = std::array::from_fn(|i| (end[i] - expected[i]).abs());
    let off = short(&errors);
    println!("errors of K1 to K7: {off} rad");
    assert!(errors.iter().all(|error| *error < 1e-6), "{off} rad, ends at {end:?}");
}
