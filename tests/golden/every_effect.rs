//! Every effect there is, by the main figures and the last row of a short run.

use crate::cli_common::Place;
use crate::{asset, figures, json, series};
use serde_json::{Map, Value};

/// On a machine that a servo carries against gravity, in equal steps.
const OF_THE_3RPR: [&str; 28] = [
    "payload mass_kg=0.1 com_x_m=0.01 com_y_m=-0.02",
    "leg-density relative=0.1",
    "gravity gx_m_s2=0.2 gy_m_s2=-9.6",
    "actuator-friction joint=P1 coulomb_pos_N=1 coulomb_neg_N=2 viscous_Ns_m=3 offset_N=0.5",
    "stribeck-friction joint=P2 coulomb_N=0.5 static_N=1 viscous_Ns_m=2",
    "film-friction joint=P3 force_N=2",
    "journal-friction joint=C1 mu=0.2",
    "pivot-friction joint=A2 coulomb_Nm=0.01 viscous_Nms=0.02",
    "bristle-friction coulomb_Nm=0.01",
    "anchor-offset joint=A1 dx_m=1e-4 dy_m=-2e-4",
    "joint-wear joint=A3 clearance_m=3e-4",
    "out-of-round joint=C1 amplitude_m=5e-5 direction_rad=0.7",
    "lubricant-film joint=C2 damping_Ns_m=2",
    "contact-damping relative=0.3",
    "contact-law restitution=0.5",
    "command-delay delay_s=1e-3",
    "servo-lag time_constant_s=1e-3",
    "servo-gain joint=P1 stiffness_relative=0.1",
    "drive-backlash play_m=5e-5",
    "drive-compliance joint=P1 compliance_m_N=1e-6",
    "sensor-offset joint=P1 offset_m=1e-4",
    "actuator-scale joint=P2 relative=1e-3",
    "screw-ripple amplitude_m=2e-5 phase_rad=0.3",
    "tether stiffness_N_m=20 anchor_x_m=0.1 anchor_y_m=0.2 rest_length_m=0.01",
    "drag force_Ns_m=2 torque_Nms=0.02",
    "base-vibration ax_m_s2=1 ay_m_s2=2 frequency_Hz=30 phase_rad=0.2",
    "unbalance mass_radius_kg_m=1e-4 frequency_Hz=30 phase_rad=0.2",
    "air-drag force_Ns2_m2=2 torque_Nms2=0.02",
];

/// Beside the friction that each of these machines has.
const OF_ONE_JOINT: [(&str, &str); 5] = [
    ("pendulum.toml", "pivot-friction joint=A1 coulomb_Nm=1e-3 viscous_Nms=1e-3"),
    ("pendulum.toml", "payload mass_kg=0.02 com_x_m=0.03 com_y_m=0.01"),
    ("drive-stage.toml", "film-friction joint=P1 force_N=12"),
    ("drive-stage.toml", "stribeck-friction joint=P1 coulomb_N=5 static_N=10"),
    ("drive-stage.toml", "drive-lag joint=P1 lag_s=3e-4"),
];

/// `--set` for each part of an effect.
fn set(place: usize, effect: &str) -> String {
    let parts = format!("kind={effect}");
    let parts = parts.split_whitespace();
    parts.map(|part| format!(" --set effect.{place}.{part}")).collect()
}

fn short_run(line: &str) -> Value {
    let place = Place::new();
    let mut figures = json(&place, &format!("run {line} --out r"));
    let text = place.read("r/timeseries.csv");
    let (head, rows) = series::rows(&text);
    let last = head.iter().zip(rows.last().unwrap());
    let last = last.map(|(name, value)| ((*name).to_owned(), (*value).into()));
    let figures = figures.as_object_mut().unwrap();
    // The joints stand in the row.
    figures.remove("joints");
    figures.insert("last_row".to_owned(), last.collect::<Map<_, _>>().into());
    figures.clone().into()
}

#[test]
fn on_the_3rpr() {
    let mut all = Map::new();
    let line = "--duration 0.02 --set drive.mode=servo --set environment.gravity=[0,-9.81] \
                --set simulation.step=1e-5";
    for effect in OF_THE_3RPR {
        all.insert(effect.to_owned(), short_run(&format!("{line}{}", set(0, effect))));
    }
    figures::compare("effects", all.into(), 1e-5);
}

#[test]
fn on_machines_of_one_joint() {
    let mut all = Map::new();
    for (machine, effect) in OF_ONE_JOINT {
        // Behind those that the file has.
        let place = if machine == "pendulum.toml" { 2 } else { 1 };
        let line = format!("{} --duration 0.1{}", asset(machine), set(place, effect));
        all.insert(format!("{machine} {effect}"), short_run(&line));
    }
    figures::compare("effects-of-one-joint", all.into(), 1e-9);
}
