//! The order of tables and the names in them do not matter.

use crate::chain::{Chain, Form, body_named};
use crate::every_chain;
use crate::sampling::Worst;
use freeplay::engine::{Schedule, StepControl, run};
use freeplay::mechanism::Mechanism;
use nalgebra::Vector2;

/// Rows that are compared, one every millisecond.
const ROWS: usize = 20;

/// Step in s. Steps under error control are taken or made shorter by a comparison, which rounding may decide the
/// other way: results then differ as far as the tolerance lets them.
const STEP: f64 = 5e-6;

/// Largest distance in m: rounding, 1e-16 m, made larger by the hits.
const LIMIT: f64 = 1e-9;

/// Places of the bodies' centres of mass at every row, in the order of the plain form.
fn places(
    chain: &Chain,
    form: &Form,
    mechanism: &Mechanism,
) -> Result<Vec<Vec<Vector2<f64>>>, String> {
    let indices: Vec<usize> =
        chain.names(form).iter().map(|name| body_named(mechanism, name)).collect();
    let mut places = Vec::new();
    let schedule = Schedule { duration: 1e-3 * ROWS as f64, interval: 1e-3 };
    run(mechanism, StepControl::Fixed(STEP), schedule, &mut |instant| {
        places.push(indices.iter().map(|&i| instant.states[i].position).collect());
    })
    .map_err(|halt| halt.to_string())?;
    Ok(places)
}

fn apart(a: &[Vector2<f64>], b: &[Vector2<f64>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

fn alike(cases: u32) {
    let worst = Worst::new();
    every_chain(cases, |chain| {
        let form = Form { c_max: 300.0, ..Form::default() };
        let other = Form { other: true, ..form.clone() };
        let [plain, other] =
            [form, other].map(|form| places(chain, &form, &chain.machine(&form)?.mechanism));
        let (plain, other) = (plain?, other?);
        let found = plain.iter().zip(&other).map(|(a, b)| apart(a, b)).fold(0.0, f64::max);
        worst.take([found]);
        if found <= LIMIT { Ok(()) } else { Err(format!("{found:e} m apart > {LIMIT:e}")) }
    });
    println!(
        "{cases} chains in another order, renamed: within {:.1e} m (limit {LIMIT:e}) over {ROWS} ms",
        worst.get()[0]
    );
}

#[test]
fn order_and_names_do_not_matter() {
    alike(60);
}

#[test]
#[ignore = "a campaign of some minutes"]
fn order_and_names_do_not_matter_to_many() {
    alike(2000);
}
