//! `pyfreeplay._native`: what the Python package calls. Names and defaults of what users see are in `pyfreeplay/`; here
//! arguments become freeplay's types, work leaves the interpreter, and results and errors come back.

mod commands;
mod error;
mod law;
mod run;
mod scenario;
mod self_test;
mod sweep;
mod table;
mod value;
mod work;

use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("__rapier_version__", freeplay::engine::RAPIER_VERSION)?;
    module.add_class::<scenario::Scenario>()?;
    module.add_class::<table::Table>()?;
    module.add_class::<run::Record>()?;
    module.add_class::<sweep::Plan>()?;
    module.add_class::<sweep::Rows>()?;
    module.add_function(wrap_pyfunction!(work::worked_s, module)?)?;
    run::add(module)?;
    sweep::add(module)?;
    commands::add(module)?;
    self_test::add(module)
}
