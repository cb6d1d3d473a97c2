//! The machines of the self-test at size one, and how each is moved.

use super::Trial;
use super::dice::Dice;
use std::f64::consts::FRAC_PI_2;

/// What moves a machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MovedBy {
    /// Each drive turns on and on.
    Turns,
    /// Each drive waves about its start by so much (rad, or m at size one).
    Waves(f64),
    /// Nothing: it is let go with its joints' angles within so much (rad) of hanging and of straight.
    Falls(f64),
}

/// A kind of machine.
#[derive(Debug)]
pub(super) struct Family {
    /// What trials call it.
    pub name: &'static str,
    /// Its rig file, in pieces.
    pub text: &'static [&'static str],
    /// What moves it.
    pub moves: MovedBy,
    /// Whether it can do without gravity.
    pub floats: bool,
}

const FOUR_BAR: &str = include_str!("../../../../assets/rigs-planar/planar-2/rig.toml");

/// All of them. Sensors beyond those of the rigs in `assets/rigs-planar` are for the trials that leave some out.
pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "slider-crank",
        text: &[
            include_str!("../../../../assets/rigs-planar/planar-1/rig.toml"),
            "\n[[sensor]]\ncolumn = \"q_slide\"\nquantity = \"position\"\nof = \"slide\"\nresolution = 5e-6\n",
        ],
        moves: MovedBy::Turns,
        floats: true,
    },
    Family {
        name: "four-bar",
        text: &[
            FOUR_BAR,
            "\n[[sensor]]\ncolumn = \"x_B\"\nquantity = \"x\"\nof = \"coupler.B\"\nstd = 1e-5\n",
            "\n[[sensor]]\ncolumn = \"y_B\"\nquantity = \"y\"\nof = \"coupler.B\"\nstd = 1e-5\n",
        ],
        moves: MovedBy::Turns,
        floats: true,
    },
    Family {
        name: "six-bar",
        text: &[FOUR_BAR, include_str!("six-bar.toml")],
        moves: MovedBy::Turns,
        floats: true,
    },
    Family {
        name: "five-bar",
        text: &[include_str!("../../../../assets/rigs-planar/planar-3/rig.toml")],
        moves: MovedBy::Waves(0.3),
        floats: true,
    },
    Family {
        name: "3-rpr",
        text: &[include_str!("three-rpr.toml")],
        // Legs that all grow by 25 mm turn the platform by 45°, past a pose in which they meet in a point.
        moves: MovedBy::Waves(0.01),
        floats: true,
    },
    Family {
        name: "double-pendulum",
        text: &[
            include_str!("../../../../assets/rigs-planar/planar-4/rig.toml"),
            "\n[[sensor]]\ncolumn = \"x_T\"\nquantity = \"x\"\nof = \"lower.T\"\nstd = 2e-5\n",
            "\n[[sensor]]\ncolumn = \"y_T\"\nquantity = \"y\"\nof = \"lower.T\"\nstd = 2e-5\n",
        ],
        moves: MovedBy::Falls(0.9),
        floats: false,
    },
];

/// The names of all machines.
pub fn machines() -> impl Iterator<Item = &'static str> {
    FAMILIES.iter().map(|family| family.name)
}

impl Trial {
    /// The family that it is of; the first of an unknown name.
    pub(super) fn family(&self) -> &'static Family {
        FAMILIES.iter().find(|family| family.name == self.machine).unwrap_or(&FAMILIES[0])
    }
}

impl Family {
    /// Coordinates in rad from which a machine that falls is let go, joint by joint: the first hangs, the others
    /// are straight where they are 0. None of one that drives move.
    pub fn let_go_at(&self, dice: &mut Dice, joints: usize) -> Vec<f64> {
        let MovedBy::Falls(most) = self.moves else { return Vec::new() };
        let rest = |joint: usize| if joint == 0 { -FRAC_PI_2 } else { 0.0 };
        (0..joints).map(|joint| rest(joint) + dice.between(-most, most)).collect()
    }
}
