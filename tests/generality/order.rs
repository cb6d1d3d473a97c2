//! The order of tables and the names in them do not matter.

use crate::chain::{Chain, Form, body_named, go};
use crate::every_chain;
use crate::sampling::Worst;
use freeplay::mechanism::Mechanism;
use nalgebra::Vector2;

/// Places of the bodies' centres of mass at every row, in the order of the plain form.
fn places(chain: &Chain, form: &Form, mechanism: &Mechanism) -> Result<Vec<Vector2<f64>>, String> {
    let indices: Vec<usize> =
        chain.names(form).iter().map(|name| body_named(mechanism, name)).collect();
    let mut places = Vec::new();
    go(mechanism, 1e-6, 0.02, 1e-3, |instant| {
        places.extend(indices.iter().map(|&i| instant.states[i].position));
    })?;
    Ok(places)
}

fn alike(cases: u32) {
    let worst = Worst::new();
    every_chain(cases, |chain| {
        let form = Form { c_max: 300.0, ..Form::default() };
        let other = Form { other: true, ..form.clone() };
        let [plain, other] = [form, other].map(|form| {
            let mechanism = chain.machine(&form)?.mechanism;
            places(chain, &form, &mechanism)
        });
        let (plain, other) = (plain?, other?);
        assert_eq!(plain.len(), 21 * chain.bodies());
        let apart = plain.iter().zip(&other).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        worst.take([apart]);
        if apart <= 1e-9 { Ok(()) } else { Err(format!("{apart:e} m apart > 1e-9")) }
    });
    println!("{cases} chains in another order, renamed: within {:.1e} m (1e-9)", worst.get()[0]);
}

#[test]
fn order_and_names_do_not_matter() {
    alike(48);
}

#[test]
#[ignore = "a campaign of some minutes"]
fn order_and_names_do_not_matter_to_many() {
    alike(2000);
}
