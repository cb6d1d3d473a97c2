//! The page of a run: the main result in words, the figures in a table, the pictures.

use super::chaos;
use crate::report::{self, Fact, PagePart, Picture, length, number};
use crate::results::{PLAYER_FILE, SCENARIO_FILE};
use crate::scenario::Law;
use crate::simulate::Summary;

/// The page as HTML.
/// `body` is the name of the output body.
pub(super) fn page(summary: &Summary, body: &str, pictures: &[Picture]) -> String {
    let title = format!("Run: {}", summary.provenance.scenario_name);
    let (facts, provenance) = (facts(summary, body), provenance(summary));
    let player =
        PagePart::Link { file: PLAYER_FILE, text: "▶ Watch the machine and its joints move" };
    let parts = [
        player,
        PagePart::Facts(&facts),
        PagePart::Pictures(pictures),
        PagePart::Provenance(&provenance),
    ];
    let doubts = summary.watched.doubts.iter().map(|doubt| format!(" Doubtful: {doubt}."));
    let lead = lead(summary, body) + &doubts.collect::<String>();
    report::document(&title, &lead, &parts)
}

/// The main result in words.
fn lead(s: &Summary, body: &str) -> String {
    if let Some(reason) = &s.halted {
        return format!(
            "The run did not reach its end: {reason}. What follows holds up to {} s.",
            number(s.simulated_s)
        );
    }
    if s.interrupted {
        return format!(
            "The run was interrupted. What follows holds up to {} s.",
            number(s.simulated_s)
        );
    }
    if !s.watched.faults.is_empty() {
        return format!("Do not trust this run: {}.", s.watched.faults.join("; "));
    }
    let drives = s.drive_peaks();
    if s.without_play() {
        let needs: Vec<String> =
            drives.iter().map(|(peak, _, unit)| format!("{} {unit}", number(*peak))).collect();
        return format!(
            "Without clearance, {}the {body} accelerates at up to {} m/s² ({} s simulated).",
            if needs.is_empty() {
                String::new()
            } else {
                format!("the actuators need up to {}, and ", needs.join(" and "))
            },
            number(s.peak_platform_acceleration_m_s2),
            number(s.simulated_s)
        );
    }
    format!(
        "With {} in its joints, the {body} strays from its ideal path by up to {} and accelerates \
         at up to {} m/s², where the machine without clearance needs {} m/s². The journals hit \
         their bearings {} times a second, with up to {} N{}.{}",
        clearance(s),
        length(s.max_path_error_m),
        number(s.peak_platform_acceleration_m_s2),
        number(s.ideal_peak_platform_acceleration_m_s2),
        number(s.impacts_per_s),
        number(s.peak_contact_force),
        felt(&drives),
        after_the_start(s),
    )
}

/// Path error in m that is rounding.
const ROUNDING_M: f64 = 1e-12;

/// What the drives feel.
fn felt(drives: &[(f64, f64, &str)]) -> String {
    let each = |(peak, ideal, unit): &(f64, f64, &str)| {
        format!("{} {unit} instead of {} {unit}", number(*peak), number(*ideal))
    };
    let all: Vec<String> = drives.iter().map(each).collect();
    if all.is_empty() {
        String::new()
    } else {
        format!("; the actuators feel up to {}", all.join(" and "))
    }
}

fn after_the_start(s: &Summary) -> String {
    if s.settle_s > 0.0 {
        format!(
            " These figures leave out the first {} s, in which the journals find their rings.",
            number(s.settle_s)
        )
    } else {
        String::new()
    }
}

/// "500 µm of clearance", or the span where joints differ.
fn clearance(s: &Summary) -> String {
    let clearances = || s.joints.iter().filter_map(|joint| joint.clearance_m);
    let smallest = clearances().fold(f64::INFINITY, f64::min);
    let largest = clearances().fold(0.0, f64::max);
    // Bearing radius less journal radius: equal clearances differ by rounding.
    if largest - smallest < 1e-9 * largest + 1e-15 {
        format!("{} of clearance", length(largest))
    } else {
        format!("{} to {} of clearance", length(smallest), length(largest))
    }
}

fn facts(s: &Summary, body: &str) -> Vec<Fact> {
    let mut facts = Vec::new();
    if s.has_figures() {
        facts.extend(peaks(s, body));
        if strays(s) {
            facts.extend(deviations(s));
        }
        facts.extend(drives(s));
        if !s.without_play() {
            facts.extend(contacts(s));
        }
    }
    facts.extend(s.lyapunov_exponent_1_s.map(|rate| prediction(s, rate)));
    facts.extend(balance(s));
    facts.push(steps(s));
    facts
}

fn fact(label: &str, value: String, note: String) -> Fact {
    Fact { label: label.into(), value, note }
}

fn with_unit(value: f64, unit: &str) -> String {
    format!("{} {unit}", number(value))
}

fn of_ideal(value: f64, unit: &str) -> String {
    format!("ideal machine: {} {unit}", number(value))
}

/// Whether a machine does not follow its ideal: what rounding leaves of one that does is no result.
fn strays(s: &Summary) -> bool {
    s.max_path_error_m > ROUNDING_M
}

fn peaks(s: &Summary, body: &str) -> [Fact; 2] {
    [
        fact(
            &format!("Peak {body} acceleration"),
            with_unit(s.peak_platform_acceleration_m_s2, "m/s²"),
            of_ideal(s.ideal_peak_platform_acceleration_m_s2, "m/s²"),
        ),
        fact(
            if s.without_play() { "Peak joint force" } else { "Peak contact force" },
            with_unit(s.peak_contact_force, "N"),
            hardest_joint(s),
        ),
    ]
}

/// How far the machine is from its ideal.
fn deviations(s: &Summary) -> [Fact; 2] {
    [
        fact(
            "Path error, largest",
            length(s.max_path_error_m),
            format!("root mean square: {}", length(s.rms_path_error_m)),
        ),
        fact(
            "Acceleration, rms deviation from ideal",
            with_unit(s.rms_acceleration_deviation_m_s2, "m/s²"),
            String::new(),
        ),
    ]
}

/// What the drives have to do.
fn drives(s: &Summary) -> Vec<Fact> {
    let mut facts = Vec::new();
    for (peak, ideal_peak, of) in s.drive_peaks() {
        let (name, deviation) = match of {
            "N" => ("force", s.rms_actuator_force_deviation),
            _ => ("torque", s.rms_actuator_torque_deviation.unwrap_or(f64::NAN)),
        };
        facts.push(fact(
            &format!("Peak actuator {name}"),
            with_unit(peak, of),
            of_ideal(ideal_peak, of),
        ));
        if strays(s) {
            facts.push(fact(
                &format!("Actuator {name}s, rms deviation from ideal"),
                with_unit(deviation, of),
                "mean of all actuators".into(),
            ));
        }
    }
    facts
}

/// How journals and rings meet.
fn contacts(s: &Summary) -> [Fact; 3] {
    [
        fact(
            "Impacts",
            s.impacts.to_string(),
            format!("{} a second, in all joints together", number(s.impacts_per_s)),
        ),
        fact(
            "Share of time in contact",
            with_unit(100.0 * s.contact_fraction, "%"),
            "mean of all joints".into(),
        ),
        fact(
            "Deepest penetration",
            length(s.largest_penetration_m),
            "of the instants in timeseries.csv".into(),
        ),
    ]
}

/// For how long small differences, growing at a rate in 1/s, leave a prediction right.
fn prediction(s: &Summary, rate: f64) -> Fact {
    let horizon = s.predictability_horizon_s;
    fact(
        "Prediction holds",
        horizon.map_or_else(
            || format!("beyond {} s", number(chaos::WINDOW.min(s.simulated_s))),
            |t| format!("for {} s", number(t)),
        ),
        if chaos::chaotic(rate, s.simulated_s) {
            format!(
                "until then the path is exact to 1 µm; small differences grow like e^({} t/s), \
                 and later digits are one of many possible motions",
                number(rate)
            )
        } else if rate < 0.0 {
            format!(
                "until then the path is exact to 1 µm; small differences die out like e^({} t/s)",
                number(rate)
            )
        } else {
            "until then the path is exact to 1 µm; small differences hardly grow".to_owned()
        },
    )
}

fn steps(s: &Summary) -> Fact {
    fact(
        "Steps",
        s.steps.to_string(),
        format!(
            "{} long; {} s of computing for {} s",
            step_lengths(s),
            number(s.wall_s),
            number(s.simulated_s)
        ),
    )
}

/// What the run saw of its own errors.
fn balance(s: &Summary) -> Vec<Fact> {
    let watched = &s.watched;
    let mut facts = Vec::new();
    if let Some(energy) = &watched.energy {
        facts.push(Fact {
            label: "Energy is off by at most".into(),
            value: format!("{} %", number(100.0 * energy.imbalance_share)),
            note: format!(
                "{} J of {} J that changed hands; drives put in {} J, contacts and loads took {} J",
                number(energy.imbalance),
                number(energy.turned_over),
                number(energy.put_in),
                number(energy.taken)
            ),
        });
    }
    if let Some(own) = &watched.own_error {
        facts.push(Fact {
            label: "Own error".into(),
            value: length(own.position_m),
            note: format!(
                "until t = {} s, and {} N in peaks of contact forces, against a run with a tenth of the error; {} hits \
                 until then",
                number(own.until_s),
                number(own.contact_force),
                own.hits
            ),
        });
    }
    facts
}

fn step_lengths(s: &Summary) -> String {
    let (smallest, largest) = (number(s.smallest_step_s), number(s.largest_step_s));
    if smallest == largest { format!("{smallest} s") } else { format!("{smallest} to {largest} s") }
}

fn hardest_joint(s: &Summary) -> String {
    let hardest = s.joints.iter().max_by(|a, b| a.peak_force.total_cmp(&b.peak_force));
    hardest.map_or_else(String::new, |joint| format!("in joint {}", joint.joint))
}

fn provenance(s: &Summary) -> Vec<(String, String)> {
    let step = match (s.step_s, s.tolerance_m_s) {
        (Some(step), _) => format!("fixed, {} s", number(step)),
        (None, Some(tolerance)) => {
            format!("by error, {} m/s of velocity a step", number(tolerance))
        }
        (None, None) => String::new(),
    };
    let drive = match s.drive {
        "prescribed" => "prescribed: joints follow the command exactly",
        "sampled" => "sampled controller",
        "force" => "a force or torque over time",
        other => other,
    };
    let more = [
        ("Seed", s.seed.to_string()),
        ("Contact law", law(s.law)),
        ("Drive", drive.to_owned()),
        ("Step", step),
        ("Figures leave out", format!("the first {} s", number(s.settle_s))),
    ];
    s.provenance.lines("scenario", Some(SCENARIO_FILE), more)
}

fn law(law: Law) -> String {
    let about = match law {
        Law::HertzStep => "Hertz stiffness with damping that steps in",
        Law::Native => "the physics engine's own rigid contacts",
        Law::Ideal => "no clearance",
        Law::Other(kind) => kind.summary,
    };
    format!("{}: {about}", law.name())
}
