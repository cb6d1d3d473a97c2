//! Oil in the gap between journal and bearing.

use crate::contact::{Extent, Film};
use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Mechanism, OilFilm};
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "lubricant-film",
    summary: "oil in the gap between journal and bearing: it resists being squeezed out",
    equation: "force on the journal -C (1 + 2 eps^2)/(1 - eps^2)^(5/2) along the line of centres and \
               -C/(1 - eps^2)^(3/2) across, times the velocity of its centre in axes that turn with the \
               mean of both bodies; eps = eccentricity/clearance, taken as at most eps_max; \
               C = pi mu R L^3/c^3 for viscosity mu, radius R, width L, clearance c",
    source: "short bearing, full film: Ocvirk, NACA TN 2808 (1952); Booker, J. Basic Eng. 87 (1965) 537-546",
    trace: "rattle: slower and softer hits; forces of the joints with the speed of their journals",
    targets: Targets::JointOrAll(JointKinds::Bearing),
    parameters: &[
        Parameter::size(
            "damping_Ns_m",
            "N s/m",
            "C, the damping of a centred journal: 25 for oil of 0.1 Pa s in a bearing with R = L = 10 mm and \
             c = 0.5 mm",
            1e5,
            0.2,
        ),
        Parameter {
            name: "eccentricity_max",
            unit: "",
            about: "eps_max, from which the film grows no stiffer: surfaces are rough, and films tear; steps shorten with its stiffness there",
            bounds: [0.0, 0.99],
            step: 0.01,
            default: Some(0.8),
        },
    ],
    variants: &[&["damping_Ns_m"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for joint in setting.revolutes(mechanism)? {
        let film = Film {
            damping: setting.number("damping_Ns_m"),
            extent: Extent::Full,
            eccentricity_max: setting.number("eccentricity_max"),
            fades: false,
        };
        mechanism.loads.push(Arc::new(OilFilm { joint, film, clearance: None }));
    }
    Ok(())
}
