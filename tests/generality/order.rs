//! The order of tables and the names in them do not matter.

use crate::chain::{Chain, Form, body_named};
use crate::every_chain;
use crate::sampling::Worst;
use freeplay::engine::{Schedule, StepControl, run};
use freeplay::mechanism::Mechanism;
use nalgebra::Vector2;
use std::cell::Cell;

/// Rows that are compared at most, one every millisecond.
const ROWS: usize = 15;

/// Step in s. Steps under error control are taken or made shorter by a comparison, which rounding may decide the
/// other way: results then differ as far as the tolerance lets them.
const STEP: f64 = 5e-6;

/// A displacement of the start in m, some hundred times what rounding makes, that hits make larger in the same
/// way.
const SHIFT: f64 = 1e-13;

/// Largest distance in m of two runs that differ by rounding, and by the displacement, for as long as they are
/// compared. Beyond, the hits' chaos decides.
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
    let (worst, compared, all) = (Worst::new(), Cell::new(0), Cell::new(0));
    every_chain(cases, |chain| {
        let form = Form { c_max: 300.0, ..Form::default() };
        let other_form = Form { other: true, ..form.clone() };
        let mechanism = chain.machine(&form)?.mechanism;
        let plain = places(chain, &form, &mechanism)?;
        let shifted = mechanism.displaced(Vector2::new(SHIFT, SHIFT));
        let shifted = places(chain, &form, &shifted)?;
        let other = places(chain, &other_form, &chain.machine(&other_form)?.mechanism)?;
        all.set(all.get() + plain.len());
        for (k, plain) in plain.iter().enumerate() {
            if apart(plain, &shifted[k]) > LIMIT {
                break;
            }
            compared.set(compared.get() + 1);
            let found = apart(plain, &other[k]);
            worst.take([found]);
            if found > LIMIT {
                let shifted = apart(plain, &shifted[k]);
                return Err(format!("{found:e} m apart > {LIMIT:e} at {k} ms ({shifted:e} m)"));
            }
        }
        Ok(())
    });
    let (compared, all) = (compared.get(), all.get());
    println!(
        "{cases} chains in another order, renamed: within {:.1e} m (limit {LIMIT:e}) over {compared} of {all} ms",
        worst.get()[0]
    );
    assert!(2 * compared > all, "only {compared} of {all} ms compared");
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
