//! A slider-crank that is pressed together: its pins lean on their rings, and where they turn friction has them climb
//! these by the angle of friction (J. L. Meriam, L. G. Kraige, Engineering Mechanics: Statics, journal bearings: the circle
//! of friction). Inverse dynamics says where; the simulation of the contacts knows nothing of that.

use super::{body, machine, short, simulate};
use freeplay::engine::Schedule;
use freeplay::mechanism::{Imposed, Tracker};

const PLAY: f64 = 2e-4;
const FRICTION: f64 = 0.4;

/// Crank, rod and slider at 4 rad/s under 40 m/s² along the slide, so that the rod is pressed for the whole of the run.
const MACHINE: &str = "
    [environment]
    gravity = [-40.0, 0.0]
    [ground.points]
    O = [0.0, 0.0]
    [[body]]
    name = \"crank\"
    mass = 0.1
    inertia = 1e-5
    points = { O = [0.0, 0.0], A = [0.05, 0.0] }
    start = [0.0, 0.0, 0.3]
    [[body]]
    name = \"rod\"
    mass = 0.1
    inertia = 1e-4
    center_of_mass = [0.08, 0.0]
    points = { A = [0.0, 0.0], B = [0.16, 0.0] }
    start = [0.048, 0.015, -0.1]
    [[body]]
    name = \"slider\"
    mass = 5.0
    inertia = 1e-3
    points = { B = [0.0, 0.0] }
    start = [0.207, 0.0, 0.0]
    [[joint]]
    name = \"O\"
    kind = \"revolute\"
    ring = \"ground.O\"
    journal = \"crank.O\"
    [[joint]]
    name = \"slide\"
    kind = \"prismatic\"
    base = \"ground.O\"
    slider = \"slider.B\"
    [[drive]]
    joint = \"O\"
    kind = \"prescribed\"
    [[motion]]
    joint = \"O\"
    kind = \"line\"
    start = 0.3
    velocity = 4.0
    [contact]
    stiffness = 1e9
    c_max = 1e4
    d_max = 1e-6
    ";

/// That with its pins.
fn text(friction: f64) -> String {
    let pin = |name: &str, ring: &str, journal: &str| {
        format!(
            "
            [[joint]]
            name = \"{name}\"
            kind = \"revolute\"
            ring = \"{ring}.{name}\"
            journal = \"{journal}.{name}\"
            clearance = {PLAY:?}
            friction = {friction:?}
            "
        )
    };
    [MACHINE, &pin("A", "crank", "rod"), &pin("B", "rod", "slider")].concat()
}

/// Mean differences between the simulation of a machine with this friction and journals that lean where this `assumed`
/// one says, over 50 ms in which vibrations have died down but for small ones and no joint turns back: in clearances, of the slider
/// along its slide and of the rod at right angles to itself; of the crank's torque, as a share of it.
fn differences(friction: f64, assumed: f64) -> [f64; 3] {
    let [real, assumed] = [friction, assumed].map(|friction| machine(&text(friction)).mechanism);
    let [rod, slider] = ["rod", "slider"].map(|name| body(&real, name));
    let ideal = assumed.without_clearance();
    let starts = ideal.bodies.iter().map(|body| body.start).collect();
    let mut tracker = Tracker::new(ideal, Imposed::Drives, starts, 0.0).unwrap();
    let mut sums = [0.0; 3];
    let mut rows = 0.0;
    let schedule = Schedule { duration: 0.25, interval: 1e-3 };
    simulate(&real, 1e-5, schedule, &mut |now| {
        if now.t < 0.2 {
            return;
        }
        tracker.advance(now.t).unwrap();
        let taken = tracker.posed().unwrap().taken(&assumed, now.t, &[], &[]).unwrap();
        let gap = |body: usize| now.states[body].position - taken.leaning[body].position;
        let across = (taken.leaning[rod].rotation.inverse() * gap(rod)).y;
        let torque = now.evaluation.drive_forces[0] / taken.efforts[0] - 1.0;
        rows += 1.0;
        for (sum, found) in sums.iter_mut().zip([gap(slider).x / PLAY, across / PLAY, torque]) {
            *sum += found;
        }
    });
    sums.map(|sum: f64| sum.abs() / rows)
}

#[test]
fn journals_that_turn_have_climbed_their_rings() {
    let found = differences(FRICTION, FRICTION);
    let ignored = differences(FRICTION, 0.0);
    println!("{} with friction, {} without", short(&found), short(&ignored));
    for (k, what) in ["slider", "rod", "torque"].into_iter().enumerate() {
        assert!(found[k] < 2e-3, "{what}: {:.1e}", found[k]);
        assert!(ignored[k] > 0.05, "{what} without friction: {:.1e}", ignored[k]);
    }
}
