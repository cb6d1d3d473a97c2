//! The coordinates that a motion is integrated in. Two bodies that nothing but a slide holds together have those of
//! one body (their common centre of mass and their angle) and their length, which a drive may prescribe: what the slide
//! holds cannot drift, and four numbers move where there would be six. Other bodies have their own three.
//!
//! In a row stand three of each body by itself (m, m, rad), three of each pair, and the length of each pair (m) that
//! no drive prescribes.

use super::Dynamics;
use super::pairs::{Pair, PairStart};
use crate::mechanism::equations::telescope::{PairMotion, Telescope};
use crate::mechanism::{BodyState, Evaluation, Mechanism, turn};
use nalgebra::{UnitComplex, Vector2, Vector3};

impl Dynamics {
    /// How many coordinates there are.
    pub fn coordinates(&self) -> usize {
        let free = self.telescopes.iter().filter(|pair| pair.prescribed.is_none()).count();
        3 * self.turning() + free
    }

    /// How many bodies and pairs turn, each with three coordinates.
    fn turning(&self) -> usize {
        self.unpaired.len() + self.telescopes.len()
    }

    /// Radii in m of gyration at these states, which make speeds of angular ones, of all that turn.
    pub fn radii(&self, mechanism: &Mechanism, states: &[BodyState]) -> Vec<f64> {
        let alone = self.unpaired.iter().map(|&body| &mechanism.bodies[body]);
        let alone = alone.map(|body| (body.inertia / body.mass).sqrt());
        let pairs = self.telescopes.iter();
        let pairs = pairs.map(|pair| pair.masses.radius(pair.telescope(states).offset[0]));
        alone.chain(pairs).collect()
    }

    /// Lets a step start at these states: fills `rates` and `row` with the rates of the coordinates and their
    /// accelerations, from those of the bodies.
    pub fn start(
        &mut self,
        states: &[BodyState],
        accelerations: &[Vector3<f64>],
        rates: &mut [f64],
        row: &mut [f64],
    ) {
        let (threes, lengths) = rates.split_at_mut(3 * self.turning());
        let (alone, pairs) = threes.as_chunks_mut().0.split_at_mut(self.unpaired.len());
        for (rate, &body) in alone.iter_mut().zip(&self.unpaired) {
            *rate = states[body].twist.into();
        }
        let mut lengths = lengths.iter_mut();
        self.starts.clear();
        for (rate, pair) in pairs.iter_mut().zip(&self.telescopes) {
            let state = pair.telescope(states);
            let [base, slider] = pair.bodies.map(|body| &states[body]);
            let centre = pair.mean([base.position, slider.position]);
            self.starts.push(PairStart { centre, length: state.offset[0] });
            *rate = pair.mean([base.twist.xy(), slider.twist.xy()]).push(state.spin).into();
            if pair.prescribed.is_none()
                && let Some(length) = lengths.next()
            {
                *length = state.length_rate;
            }
            self.prismatics[pair.joint] = state;
        }
        self.gather(accelerations, row);
    }

    /// Fills `row` with the accelerations of the coordinates from those of the bodies, at the states that these were
    /// asked for last.
    pub fn gather(&self, accelerations: &[Vector3<f64>], row: &mut [f64]) {
        let (threes, lengths) = row.split_at_mut(3 * self.turning());
        let (alone, pairs) = threes.as_chunks_mut().0.split_at_mut(self.unpaired.len());
        for (a, &body) in alone.iter_mut().zip(&self.unpaired) {
            *a = accelerations[body].into();
        }
        let mut lengths = lengths.iter_mut();
        for (a, pair) in pairs.iter_mut().zip(&self.telescopes) {
            let [base, slider] = pair.bodies.map(|body| accelerations[body]);
            *a = pair.mean([base.xy(), slider.xy()]).push(base.z).into();
            if pair.prescribed.is_none()
                && let Some(length) = lengths.next()
            {
                *length = self.prismatics[pair.joint].extension(slider - base, base.z);
            }
        }
    }

    /// Puts bodies to where they are at time `t` (s), when the coordinates have come so far from the step's start
    /// and have those rates; where commands prescribe lengths, `out` has them.
    #[inline]
    pub fn place(
        &mut self,
        mechanism: &Mechanism,
        t: f64,
        start: &[BodyState],
        [ways, rates]: [&[f64]; 2],
        (states, out): (&mut [BodyState], &mut Evaluation),
    ) {
        out.t = t;
        if self.prescribes {
            out.command(mechanism);
        }
        let turning = self.turning();
        let [(ways, longer), (rates, length_rates)] =
            [ways, rates].map(|row| row.split_at(3 * turning));
        let (ways, rates) = (ways.as_chunks::<3>().0, rates.as_chunks::<3>().0);
        let (ways_alone, ways) = ways.split_at(self.unpaired.len());
        let (rates_alone, rates) = rates.split_at(self.unpaired.len());
        for (&body, (by, rate)) in self.unpaired.iter().zip(ways_alone.iter().zip(rates_alone)) {
            let from = &start[body];
            states[body] = BodyState {
                position: from.position + Vector2::new(by[0], by[1]),
                rotation: from.rotation * turn(by[2]),
                twist: Vector3::from(*rate),
            };
        }
        let mut longer = longer.iter().zip(length_rates);
        let pairs = self.telescopes.iter().zip(&self.starts);
        for ((pair, from), (by, rate)) in pairs.zip(ways.iter().zip(rates)) {
            let along = match pair.prescribed {
                Some(drive) => [pair.reach(out.commands[drive].position), out.commands[drive].rate],
                None => longer.next().map_or([0.0; 2], |(way, rate)| [from.length + way, *rate]),
            };
            let [base, slider] = pair.bodies;
            let turned = turn(by[2]);
            let rotations = [start[base].rotation * turned, start[slider].rotation * turned];
            let state = pair.reaching(rotations[0], along, rate[2]);
            let centre = from.centre + Vector2::new(by[0], by[1]);
            [states[base], states[slider]] =
                pair.around(&state, centre, Vector2::new(rate[0], rate[1]), rotations);
            self.prismatics[pair.joint] = state;
        }
    }

    /// How far each body has come from its state at the start to that at the end (m, m, rad), the coordinates having
    /// come so far.
    pub fn shifts(
        &self,
        ways: &[f64],
        [start, end]: [&[BodyState]; 2],
        shifts: &mut [Vector3<f64>],
    ) {
        let (alone, pairs) = ways.as_chunks::<3>().0.split_at(self.unpaired.len());
        for (&body, by) in self.unpaired.iter().zip(alone) {
            shifts[body] = Vector3::from(*by);
        }
        for (Pair { bodies, .. }, by) in self.telescopes.iter().zip(pairs) {
            for &body in bodies {
                shifts[body] = (end[body].position - start[body].position).push(by[2]);
            }
        }
    }

    /// Finds what acts at states that [`place`](Self::place) has made of time `t` (s), where nobody asks where journals
    /// in flight are, for lengths and for coordinates; fills `row` with the accelerations of the coordinates. Those of
    /// paired bodies are found only where `each` body's are asked for.
    #[inline]
    pub fn act(
        &mut self,
        mechanism: &Mechanism,
        states: &[BodyState],
        out: &mut Evaluation,
        (row, each): (&mut [f64], bool),
    ) {
        let t = out.t;
        self.touch_on_path(mechanism, t, states, out);
        match &self.servos {
            None => self.drive_any(mechanism, t, states, out),
            Some(servos) if servos.is_empty() => {}
            Some(servos) => {
                out.command(mechanism);
                for servo in servos {
                    servo.push(&self.prismatics[servo.joint], out);
                }
            }
        }
        self.load(mechanism, t, states, out);
        self.accelerate_unpaired(mechanism, states, out);
        let (threes, lengths) = row.split_at_mut(3 * self.turning());
        let (alone, pairs) = threes.as_chunks_mut().0.split_at_mut(self.unpaired.len());
        for (a, &body) in alone.iter_mut().zip(&self.unpaired) {
            *a = out.accelerations[body].into();
        }
        let mut lengths = lengths.iter_mut();
        for (a, pair) in pairs.iter_mut().zip(&self.telescopes) {
            let wrenches = pair.bodies.map(|body| out.wrenches[body]);
            let motion = pair.go_on(&self.prismatics[pair.joint], &wrenches, out);
            *a = PairMotion::of_centre(&pair.masses, &wrenches).push(motion.alpha).into();
            if pair.prescribed.is_none()
                && let Some(length) = lengths.next()
            {
                *length = motion.extension;
            }
            if each {
                let [base, slider] = pair.bodies;
                [out.accelerations[base], out.accelerations[slider]] =
                    motion.of_bodies(&pair.masses, &wrenches);
            }
        }
    }
}

impl Pair {
    /// The mean of what its two bodies have, weighed by their masses: of places that of the common centre of mass.
    #[inline(always)]
    fn mean(&self, [base, slider]: [Vector2<f64>; 2]) -> Vector2<f64> {
        let [s0, s1] = self.masses.shares();
        base * s1 + slider * s0
    }

    /// States of base and slider with that common centre of mass (m, m/s), and these rotations.
    #[inline(always)]
    fn around(
        &self,
        state: &Telescope,
        centre: Vector2<f64>,
        velocity: Vector2<f64>,
        [base, slider]: [UnitComplex<f64>; 2],
    ) -> [BodyState; 2] {
        let [s0, s1] = self.masses.shares();
        let d = state.between_centres();
        let body = |share: f64, rotation| BodyState {
            position: centre + d * share,
            rotation,
            twist: (velocity + state.rate * share).push(state.spin),
        };
        [body(-s0, base), body(s1, slider)]
    }
}
