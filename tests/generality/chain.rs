//! Closed chains in one or two loops, closed by construction from random places of their joints.

use crate::sampling::vector;
use freeplay::engine::{Instant, Schedule, StepControl, Work, run};
use freeplay::mechanism::{BodyState, Mechanism};
use freeplay::model::{Machine, assemble};
use freeplay::scenario::Scenario;
use nalgebra::{UnitComplex, Vector2};
use proptest::prelude::*;
use std::fmt::Write as _;

/// Contact stiffness of every joint with clearance, N/m^1.5.
pub const STIFFNESS: f64 = 3e9;

/// Stiffness (N/m) and free length (m) of the spring.
pub const SPRING: [f64; 2] = [300.0, 0.05];

/// Time of the driven motion, s.
const MOVING: f64 = 0.05;

/// One body, before it is put anywhere.
#[derive(Clone, Debug)]
struct Link {
    mass: f64,
    gyration: f64,
    /// Radius (m) and angle (rad, less the even distribution's) of the joint at its end.
    place: [f64; 2],
    /// Angle of its own axes, rad; origin of these and centre of mass from the middle of its joints, m.
    angle: f64,
    origin: Vector2<f64>,
    centre: Vector2<f64>,
    /// Velocity of its origin and spin.
    velocity: [f64; 3],
    /// Clearance (m) of the joint at its end, and whether that joint's ring is on the next body.
    clearance: f64,
    flipped: bool,
    /// Errors of the guessed start, as shares of a few degrees and millimetres.
    perturbation: [f64; 3],
}

/// How a chain is driven at its first joint on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Driven {
    Not,
    Prescribed,
    Servo,
    Force,
}

/// Which joints have clearance.
#[derive(Clone, Copy, Debug)]
enum Play {
    None,
    All,
    /// Those whose bit is set.
    Some(u16),
}

/// A chain: links one after another from the ground to the ground, or to a body of the first loop.
#[derive(Clone, Debug)]
pub struct Chain {
    links: Vec<Link>,
    /// Bodies of the second loop; none where there is one loop.
    second: usize,
    play: Play,
    pub driven: Driven,
    pub gravity: bool,
    pub spring: bool,
    /// Angle (rad) that the drive goes, or torque in N m.
    drive: f64,
}

fn link() -> impl Strategy<Value = Link> {
    (
        (0.05..0.5, 0.03..0.08, [0.1..0.18, -0.08..0.08], -3.0..3.0),
        (vector(0.03), vector(0.03), [-0.2..0.2, -0.2..0.2, -2.0..2.0]),
        (1e-5f64.ln()..5e-4f64.ln(), any::<bool>(), [-1.0..1.0, -1.0..1.0, -1.0..1.0]),
    )
        .prop_map(|(body, motion, joint)| Link {
            mass: body.0,
            gyration: body.1,
            place: body.2,
            angle: body.3,
            origin: motion.0,
            centre: motion.1,
            velocity: motion.2,
            clearance: joint.0.exp(),
            flipped: joint.1,
            perturbation: joint.2,
        })
}

/// Four to eight bodies in one or two loops.
pub fn chains() -> impl Strategy<Value = Chain> {
    let play = prop_oneof![
        Just(Play::None),
        Just(Play::All),
        any::<u16>().prop_map(Play::Some),
        any::<u16>().prop_map(Play::Some),
    ];
    let driven = prop_oneof![
        Just(Driven::Not),
        Just(Driven::Prescribed),
        Just(Driven::Servo),
        Just(Driven::Force)
    ];
    let links = prop::collection::vec(link(), 4..=8);
    (links, 0usize..5, play, driven, any::<bool>(), any::<bool>(), -0.1..0.1).prop_map(
        |(links, second, play, driven, gravity, spring, drive)| {
            // A first loop of three bodies at least, a second one of two at least.
            let second =
                if links.len() < 5 || second < 2 { 0 } else { second.min(links.len() - 3) };
            Chain { links, second, play, driven, gravity, spring, drive }
        },
    )
}

/// How a chain is written down.
#[derive(Clone, Debug, Default)]
pub struct Form {
    /// Bodies and joints in another order and under other names.
    pub other: bool,
    /// Guessed starts that are some degrees and millimetres off.
    pub perturbed: bool,
    /// Damping of the contacts, N s/m.
    pub c_max: f64,
}

/// A body as it is put.
struct Put {
    origin: Vector2<f64>,
    angle: f64,
    /// Joints at both ends and centre of mass, in the world.
    ends: [Vector2<f64>; 2],
    centre: Vector2<f64>,
}

impl Put {
    fn local(&self, point: Vector2<f64>) -> Vector2<f64> {
        UnitComplex::new(-self.angle) * (point - self.origin)
    }
}

/// A joint between two points `body.point`; the ground is body `None`.
struct Pin {
    ends: [(Option<usize>, &'static str); 2],
    clearance: Option<f64>,
}

impl Chain {
    pub fn bodies(&self) -> usize {
        self.links.len()
    }

    /// Names in the order of the bodies of the plain form.
    pub fn names(&self, form: &Form) -> Vec<String> {
        let name = |i: usize| if form.other { format!("Teil {}", 9 - i) } else { format!("b{i}") };
        (0..self.bodies()).map(name).collect()
    }

    /// Bodies where they are, and the ground's points a (first), d (last) and e (second loop's).
    fn put(&self) -> (Vec<Put>, [Vector2<f64>; 3]) {
        let first = self.bodies() - self.second;
        let at = |i: usize| {
            let [radius, jitter] = self.links[i.min(first - 1)].place;
            // The last joint, on the ground, mirrors the jitter of the one before.
            let jitter = if i == first { -jitter } else { jitter };
            let angle = 3.5 - 3.8 * i as f64 / first as f64 + jitter;
            UnitComplex::new(angle) * Vector2::new(radius, 0.0)
        };
        let mut sides: Vec<[Vector2<f64>; 2]> = (0..first).map(|i| [at(i), at(i + 1)]).collect();
        let carrier = sides[first / 2];
        let middle = (carrier[0] + carrier[1]) / 2.0;
        let outward = middle.normalize();
        let hinge = middle + outward * 0.04;
        let ground = hinge + outward * (0.12 + 0.04 * self.second as f64);
        let across = Vector2::new(-outward.y, outward.x);
        let place = |j: usize| {
            if j == 0 || j == self.second {
                return if j == 0 { ground } else { hinge };
            }
            let share = j as f64 / self.second as f64;
            let side = if j.is_multiple_of(2) { -1.0 } else { 1.0 };
            let jitter = self.links[first + j].place[0] - 0.1;
            ground + (hinge - ground) * share + across * side * (0.04 + jitter)
        };
        sides.extend((0..self.second).map(|j| [place(j), place(j + 1)]));
        let put = |(link, ends): (&Link, [Vector2<f64>; 2])| {
            let middle = (ends[0] + ends[1]) / 2.0;
            let (origin, centre) = (middle + link.origin, middle + link.centre);
            Put { origin, angle: link.angle, ends, centre }
        };
        let bodies: Vec<Put> = self.links.iter().zip(sides).map(put).collect();
        let grounds = [bodies[0].ends[0], bodies[first - 1].ends[1], ground];
        (bodies, grounds)
    }

    fn pins(&self) -> Vec<Pin> {
        let (n, first) = (self.bodies(), self.bodies() - self.second);
        let mut ends = vec![[(None, "a"), (Some(0), "p")]];
        ends.extend((1..first).map(|i| [(Some(i - 1), "q"), (Some(i), "p")]));
        ends.push([(Some(first - 1), "q"), (None, "d")]);
        if self.second > 0 {
            ends.push([(None, "e"), (Some(first), "p")]);
            ends.extend((first + 1..n).map(|i| [(Some(i - 1), "q"), (Some(i), "p")]));
            ends.push([(Some(n - 1), "q"), (Some(first / 2), "h")]);
        }
        let pin = |(k, mut ends): (usize, [(Option<usize>, &'static str); 2])| {
            let link = &self.links[k % n];
            if link.flipped {
                ends.swap(0, 1);
            }
            let plays = match self.play {
                Play::None => false,
                Play::All => true,
                Play::Some(bits) => bits & (1 << k) != 0,
            };
            Pin { ends, clearance: plays.then_some(link.clearance) }
        };
        ends.into_iter().enumerate().map(pin).collect()
    }

    /// Coordinate of the driven joint as the chain is put.
    fn coordinate(&self) -> f64 {
        // Between the ground and the first body.
        if self.pins()[0].ends[1].0.is_some() { self.links[0].angle } else { -self.links[0].angle }
    }

    /// The mechanism file.
    pub fn text(&self, form: &Form) -> String {
        let (put, [a, d, e]) = self.put();
        let names = self.names(form);
        let gravity = if self.gravity { -9.81 } else { 0.0 };
        let mut text = format!(
            "[environment]\ngravity = [0.0, {gravity:?}]\n[contact]\nstiffness = {STIFFNESS:?}\nc_max = \
             {:?}\n[ground.points]\na = {}\nd = {}\ne = {}\ns = [0.0, -0.25]\n",
            form.c_max,
            xy(a),
            xy(d),
            xy(e)
        );
        let mut bodies = self.body_texts(form, &put, &names);
        let mut joints = self.joint_texts(form, &names);
        if form.other {
            bodies.reverse();
            joints.rotate_left(2);
            joints.reverse();
        }
        text.extend(bodies);
        text.extend(joints);
        text += &self.drive_text(form);
        if self.spring {
            text += &format!(
                "[[spring]]\nbetween = [\"ground.s\", \"{}.q\"]\nstiffness = {:?}\nfree_length = {:?}\n",
                names[1], SPRING[0], SPRING[1]
            );
        }
        text
    }

    /// The bodies, one text each.
    fn body_texts(&self, form: &Form, put: &[Put], names: &[String]) -> Vec<String> {
        let carrier = (self.bodies() - self.second) / 2;
        let hinge = put[carrier].local(
            (put[carrier].ends[0] + put[carrier].ends[1]) / 2.0
                + ((put[carrier].ends[0] + put[carrier].ends[1]) / 2.0).normalize() * 0.04,
        );
        let mut bodies: Vec<String> = Vec::new();
        for (i, (link, body)) in self.links.iter().zip(put).enumerate() {
            let [x, y, turn] = if form.perturbed {
                let [x, y, turn] = link.perturbation;
                [5e-3 * x, 5e-3 * y, 0.05 * turn]
            } else {
                [0.0; 3]
            };
            let start = [body.origin.x + x, body.origin.y + y, body.angle + turn];
            bodies.push(format!(
                "[[body]]\nname = \"{}\"\nmass = {:?}\ninertia = {:?}\ncenter_of_mass = {}\npoints = {{ p = \
                 {}, q = {}, h = {} }}\nstart = {start:?}\nvelocity = {:?}\n",
                names[i],
                link.mass,
                link.mass * link.gyration * link.gyration,
                xy(body.local(body.centre)),
                xy(body.local(body.ends[0])),
                xy(body.local(body.ends[1])),
                xy(hinge),
                link.velocity,
            ));
        }
        bodies
    }

    /// The joints, one text each.
    fn joint_texts(&self, form: &Form, names: &[String]) -> Vec<String> {
        let end = |(body, point): (Option<usize>, &str)| match body {
            Some(i) => format!("{}.{point}", names[i]),
            None => format!("ground.{point}"),
        };
        let mut joints: Vec<String> = Vec::new();
        for (k, pin) in self.pins().into_iter().enumerate() {
            let [ring, journal] = pin.ends.map(end);
            let mut joint = format!(
                "[[joint]]\nname = \"{}\"\nkind = \"revolute\"\nring = \"{ring}\"\njournal = \
                 \"{journal}\"\n",
                joint_name(form, k)
            );
            if let Some(clearance) = pin.clearance {
                // Writing to a string cannot fail, here and below.
                let _ = writeln!(joint, "clearance = {clearance:?}\nbearing_radius = 0.008");
            }
            joints.push(joint);
        }
        joints
    }

    /// The drive of the first joint, and its motion.
    fn drive_text(&self, form: &Form) -> String {
        let mut text = String::new();
        let name = joint_name(form, 0);
        let keys = match self.driven {
            Driven::Not => None,
            Driven::Prescribed => Some("kind = \"prescribed\"".to_owned()),
            Driven::Servo => Some("kind = \"servo\"\nstiffness = 300.0\ndamping = 1.0".to_owned()),
            Driven::Force => Some(format!("kind = \"force\"\nvalue = {:?}", 10.0 * self.drive)),
        };
        if let Some(keys) = keys {
            let _ = writeln!(text, "[[drive]]\njoint = \"{name}\"\n{keys}");
        }
        if let Driven::Prescribed | Driven::Servo = self.driven {
            let from = self.coordinate();
            let _ = writeln!(
                text,
                "[[motion]]\njoint = \"{name}\"\nkind = \"quintic\"\nfrom = {from:?}\nto = {:?}\ntime = \
                 {MOVING:?}",
                from + self.drive
            );
        }
        text
    }

    /// The two ends of the spring in the world.
    pub fn spring_ends(&self, mechanism: &Mechanism, states: &[BodyState]) -> [Vector2<f64>; 2] {
        let body = self.spring_body(mechanism);
        let local = self.put().0[1].local(self.put().0[1].ends[1]);
        let end = states[body].frame(mechanism.bodies[body].reference + local).centre;
        [Vector2::new(0.0, -0.25), end]
    }

    /// The body that the spring pulls, in the plain form.
    pub fn spring_body(&self, mechanism: &Mechanism) -> usize {
        body_named(mechanism, &self.names(&Form::default())[1])
    }

    pub fn scenario(&self, form: &Form) -> Result<Scenario, String> {
        Scenario::from_text(&self.text(form), "chain.toml", &[]).map_err(|e| e.to_string())
    }

    pub fn machine(&self, form: &Form) -> Result<Machine, String> {
        assemble(&self.scenario(form)?).map_err(|e| e.to_string())
    }
}

fn xy(v: Vector2<f64>) -> String {
    format!("[{:?}, {:?}]", v.x, v.y)
}

fn joint_name(form: &Form, k: usize) -> String {
    if form.other { format!("Gelenk {}", 20 - k) } else { format!("J{k}") }
}

/// Index of the body of that name.
pub fn body_named(mechanism: &Mechanism, name: &str) -> usize {
    mechanism.bodies.iter().position(|body| body.name == name).expect("a body of that name")
}

/// A run under error control.
pub fn go(
    mechanism: &Mechanism,
    tolerance: f64,
    duration: f64,
    interval: f64,
    mut look: impl FnMut(&Instant),
) -> Result<Work, String> {
    let schedule = Schedule { duration, interval };
    run(mechanism, StepControl::Tolerance(tolerance), schedule, &mut look)
        .map_err(|h| h.to_string())
}
