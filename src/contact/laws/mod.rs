//! The normal force laws of the literature, one file each; [`ALL`] is their list.
//!
//! Most are a [`spring`](spring::ElasticForce) with a [`loss`](Loss), so that a law's file says its equation,
//! its source, where it holds, and the numbers that it puts into them. Symbols: δ penetration, δ̇ its rate,
//! δ̇⁻ the impact speed (`rate`, `impact_speed` in texts), e the coefficient of restitution.

mod conformal;
mod damped;
mod dubowsky_freudenstein;
mod esdu_78035;
mod flores;
mod goldsmith;
mod gonthier;
mod herbert_mcwhannell;
mod hertz;
mod hertz_step;
mod hu_guo;
mod hunt_crossley;
mod johnson;
mod kelvin_voigt;
mod kind;
mod lankarani_nikravesh;
mod lee_wang;
mod liu;
mod loss;
mod radzimovsky;
mod spring;
mod zhiying_qishao;

pub use damped::Damped;
pub use flores::factor as dissipation;
pub use hertz_step::HERTZ_STEP;
pub use kind::{Given, LawKind, LawParameter, LawRange, Losses, RESTITUTION};
pub use loss::Loss;
pub use spring::{ElasticForce, Logarithmic, PowerSpring};

/// All laws, in the order in which they are listed.
pub const ALL: &[&LawKind] = &[
    &HERTZ_STEP,
    &hertz::KIND,
    &kelvin_voigt::KIND,
    &hunt_crossley::KIND,
    &herbert_mcwhannell::KIND,
    &lee_wang::KIND,
    &lankarani_nikravesh::KIND,
    &gonthier::KIND,
    &zhiying_qishao::KIND,
    &flores::KIND,
    &hu_guo::KIND,
    &johnson::KIND,
    &radzimovsky::KIND,
    &goldsmith::KIND,
    &dubowsky_freudenstein::KIND,
    &esdu_78035::KIND,
    &liu::KIND,
];

/// The law of a name.
pub fn named(name: &str) -> Option<&'static LawKind> {
    ALL.iter().copied().find(|kind| kind.name == name)
}

#[cfg(test)]
mod tests;
