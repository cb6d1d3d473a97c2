//! Work beside the interpreter: the lock is released, and Ctrl-C is looked for while it goes on.

use crate::error::Failure;
use pyo3::prelude::*;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::{Builder, scope};
use std::time::{Duration, Instant};

/// Time in ns that the work of the last call took, as the program would have done it.
static WORKED: AtomicU64 = AtomicU64::new(0);

/// Time in s that the last call worked outside the interpreter: the rest of it is what Python costs.
#[pyfunction]
pub fn worked_s() -> f64 {
    Duration::from_nanos(WORKED.load(Ordering::Relaxed)).as_secs_f64()
}

/// How often signals are looked for: nobody notices a twentieth of a second.
const LOOK: Duration = Duration::from_millis(50);

/// Stack of the thread that works, in bytes: what the main thread of a program has.
const STACK: usize = 8 << 20;

/// What a work that looks at no flag unwinds with when it is to end.
struct Cancelled;

/// Ends a work from within what it calls to tell its progress, once `stop` is true.
pub fn end_if(stop: &AtomicBool) {
    if stop.load(Ordering::Relaxed) {
        resume_unwind(Box::new(Cancelled));
    }
}

/// Does `work` on a thread of its own, the interpreter free for others. A signal (Ctrl-C) turns `stop` true, and its
/// exception is raised as soon as the work has ended. A panic becomes an exception, too.
///
/// # Errors
/// What the work says, or the exception of a signal.
pub fn detached<T: Send>(
    py: Python<'_>,
    stop: &AtomicBool,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let result: Result<T, Failure> = py.detach(|| {
        scope(|scope| {
            let (done, ended) = channel();
            let work = move || {
                let started = Instant::now();
                let result = catch_unwind(AssertUnwindSafe(work));
                let took = u64::try_from(started.elapsed().as_nanos()).unwrap_or(u64::MAX);
                WORKED.store(took, Ordering::Relaxed);
                // Whoever waits is there until the end of the scope.
                let _ = done.send(());
                result
            };
            let worker = Builder::new().stack_size(STACK).spawn_scoped(scope, work);
            let worker = match worker {
                Ok(worker) => worker,
                Err(error) => return Err(Failure::Run(format!("cannot start a thread: {error}"))),
            };
            let mut signal = None;
            while let Err(RecvTimeoutError::Timeout) = ended.recv_timeout(LOOK) {
                if signal.is_none() {
                    signal = Python::attach(|py| py.check_signals()).err();
                    stop.fetch_or(signal.is_some(), Ordering::Relaxed);
                }
            }
            let result = worker.join().unwrap_or_else(Err);
            match (signal, result) {
                (Some(signal), _) => Err(Failure::Python(signal)),
                (None, Ok(result)) => result,
                (None, Err(panic)) => Err(Failure::Run(said(&*panic))),
            }
        })
    });
    result.map_err(|failure| failure.exception(py))
}

/// What a panic said.
fn said(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    match panic.is::<Cancelled>() {
        true => "the work was stopped".to_owned(),
        false => format!("a fault of the program, please report it: {}", text.unwrap_or_default()),
    }
}
