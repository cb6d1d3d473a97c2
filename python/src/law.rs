//! A function of Python as a force law.

use freeplay::contact::ForceLaw;
use freeplay::mechanism::{Bearing, Mechanism};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What a function did that it should not, and the flag that ends the run because of it.
#[derive(Debug, Default)]
pub struct Trouble {
    pub stop: AtomicBool,
    first: Mutex<Option<PyErr>>,
}

impl Trouble {
    fn report(&self, error: PyErr) {
        self.first.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        self.stop.store(true, Ordering::Relaxed);
    }

    /// The first exception, if there was one.
    pub fn take(&self) -> Option<PyErr> {
        self.first.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Normal force (N) as a function of penetration (m) and its rate (m/s) that is written in Python.
#[derive(Debug)]
struct LawFunction {
    joint: String,
    function: Py<PyAny>,
    trouble: Arc<Trouble>,
}

impl LawFunction {
    fn ask(&self, penetration: f64, rate: f64) -> PyResult<f64> {
        Python::attach(|py| {
            let value = self.function.bind(py).call1((penetration, rate))?;
            let place = || {
                let joint = &self.joint;
                format!(
                    "law of joint {joint} at penetration {penetration:e} m and rate {rate:e} m/s"
                )
            };
            // True is an int to Python, and no force.
            let force = if value.is_instance_of::<PyBool>() { None } else { value.extract().ok() };
            match force {
                None => Err(PyTypeError::new_err(format!(
                    "{}: returned {}; expected the force in N, a float",
                    place(),
                    value.repr()?
                ))),
                Some(force) if !f64::is_finite(force) => Err(PyValueError::new_err(format!(
                    "{}: returned {force}; expected a finite force in N",
                    place()
                ))),
                Some(force) => Ok(force),
            }
        })
    }

    /// Work in J that the force takes up to a penetration, without damping (Simpson's rule).
    fn work(&self, depth: f64) -> f64 {
        const HALVES: usize = 16;
        let h = depth / (2 * HALVES) as f64;
        let force = |i: usize| self.normal_force(i as f64 * h, 0.0);
        let inner: f64 =
            (1..2 * HALVES).map(|i| if i % 2 == 1 { 4.0 } else { 2.0 } * force(i)).sum();
        (force(2 * HALVES) + inner) * h / 3.0
    }
}

/// Penetrations (m) between which answers are sought: an atom, and a metre.
const DEPTHS: [f64; 2] = [1e-10, 1.0];

/// Where something that grows with penetration reaches a value: to 0.1 % by halving in the logarithm, which is more than
/// estimates of a step need.
fn reached(value: f64, of: impl Fn(f64) -> f64) -> f64 {
    let [mut low, mut high] = DEPTHS.map(f64::ln);
    while high - low > 1e-3 {
        let middle = 0.5 * (low + high);
        if of(middle.exp()) < value { low = middle } else { high = middle }
    }
    high.exp()
}

impl ForceLaw for LawFunction {
    fn normal_force(&self, penetration: f64, rate: f64) -> f64 {
        if self.trouble.stop.load(Ordering::Relaxed) {
            return 0.0;
        }
        self.ask(penetration, rate).unwrap_or_else(|error| {
            self.trouble.report(error);
            0.0
        })
    }

    fn deepest_penetration(&self, mass: f64, speed: f64) -> f64 {
        reached(0.5 * mass * speed * speed, |depth| self.work(depth))
    }

    /// `3 δ/v`: a lossless hit takes 2.94 δ/v under Hertz's law (K. L. Johnson, Contact Mechanics, 1985, section 11.4)
    /// and π δ/v under a linear one.
    fn contact_time(&self, mass: f64, speed: f64) -> f64 {
        3.0 * self.deepest_penetration(mass, speed) / speed
    }

    fn resting_penetration(&self, force: f64) -> f64 {
        reached(force, |depth| self.normal_force(depth, 0.0))
    }

    /// Five steps a hit, as freeplay's own laws have it.
    fn longest_step(&self, mass: f64, speed: f64) -> f64 {
        self.contact_time(mass, speed) / 5.0
    }
}

/// Gives joints with clearance the laws that `law` says: a function for all of them, or a dict of functions by joint.
///
/// # Errors
/// What is no function, and joints that have no clearance under a law.
pub fn give(
    law: &Bound<'_, PyAny>,
    mechanism: &mut Mechanism,
    trouble: &Arc<Trouble>,
) -> PyResult<()> {
    let by_joint = law.cast::<PyDict>().ok();
    let mut taken = Vec::new();
    for joint in &mut mechanism.revolutes {
        let Bearing::Clearance(clearance) = &mut joint.bearing else { continue };
        taken.push(joint.name.clone());
        let function = match by_joint {
            Some(dict) => match dict.get_item(&joint.name)? {
                Some(function) => function,
                None => continue,
            },
            None => law.clone(),
        };
        if !function.is_callable() {
            let (kind, name) = (function.get_type().qualname()?, &joint.name);
            let message = format!(
                "law of joint {name}: a `{kind}` cannot be called; expected a function of penetration (m) and rate \
                 (m/s) that returns a force (N)"
            );
            return Err(PyTypeError::new_err(message));
        }
        let (joint, trouble) = (joint.name.clone(), trouble.clone());
        clearance.law = Arc::new(LawFunction { joint, function: function.unbind(), trouble });
    }
    let known = if taken.is_empty() { "none".to_owned() } else { taken.join(", ") };
    for name in by_joint.iter().flat_map(|dict| dict.keys()) {
        if !taken.iter().any(|joint| name.eq(joint).unwrap_or(false)) {
            return Err(PyValueError::new_err(format!(
                "law: {} is no joint with clearance under a law; there are: {known}",
                name.repr()?
            )));
        }
    }
    if taken.is_empty() {
        let message = "law: this machine has no joint with clearance under a law".to_owned();
        return Err(PyValueError::new_err(message));
    }
    Ok(())
}
