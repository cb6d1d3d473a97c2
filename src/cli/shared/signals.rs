//! What Ctrl-C (SIGINT), SIGTERM and the terminal's end (SIGHUP) do: a command ends without litter, or with what it has.
//!
//! A thread waits for them. By default it removes what the process has in the making and ends it; a run
//! asks to be told instead, and keeps what was computed. The second signal always ends the process.

use super::failure::{Failure, GO_ON};
use super::output::complain;
use crate::results::abandon;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::{Mutex, PoisonError};

/// A command that looks at this ends by itself.
static STOP: AtomicBool = AtomicBool::new(false);
static LOOKS: AtomicBool = AtomicBool::new(false);

/// The signal that came, or zero.
static CAME: AtomicU8 = AtomicU8::new(0);

/// The exit code where nothing is lost, or zero: then it is the signal's.
static CODE: AtomicU8 = AtomicU8::new(0);

/// What users are told of the work that was done.
static WORK: Mutex<String> = Mutex::new(String::new());

/// From now on, signals end this process as described above.
#[cfg(unix)]
pub(in crate::cli) fn watch() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let hangup = heeds_hangup().then_some(SIGHUP);
    // Where the system refuses, signals end the process at once, as they do by default: the next start
    // tidies up.
    if let Ok(mut signals) = Signals::new([SIGINT, SIGTERM].into_iter().chain(hangup)) {
        std::thread::spawn(move || {
            for signal in signals.forever() {
                received(u8::try_from(signal).unwrap_or(0));
            }
        });
    }
}

/// Whether the end of its terminal is to end this process: not under `nohup`, which has it ignored. Where the system does
/// not tell, it is left as it is.
#[cfg(unix)]
fn heeds_hangup() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    // Signal 1 is the lowest bit.
    ignored.is_some_and(|mask| mask & 1 == 0)
}

/// Elsewhere processes are ended at once; the next start tidies up.
#[cfg(not(unix))]
pub(in crate::cli) fn watch() {}

/// Says that this command looks at the flag that is returned, which turns true when it is to end.
pub(in crate::cli) fn looked_at() -> &'static AtomicBool {
    LOOKS.store(true, Ordering::Relaxed);
    &STOP
}

/// Should a signal come, what was finished is kept: users are told where, and the exit code says that the same
/// command goes on from there.
pub(in crate::cli) fn work_is(what: String) {
    CODE.store(GO_ON, Ordering::Relaxed);
    *WORK.lock().unwrap_or_else(PoisonError::into_inner) = what;
}

/// How a command fails that ended because of a signal.
pub(in crate::cli) fn interrupted() -> Failure {
    Failure::Interrupted(CAME.load(Ordering::Relaxed))
}

#[cfg(unix)]
fn received(signal: u8) {
    let first = CAME.swap(signal, Ordering::Relaxed) == 0;
    if first && LOOKS.load(Ordering::Relaxed) {
        STOP.store(true, Ordering::Relaxed);
        complain("interrupted: what was computed is being written; once more drops it");
        return;
    }
    let dropped = abandon() > 0;
    let work = WORK.lock().unwrap_or_else(PoisonError::into_inner);
    match (work.as_str(), dropped) {
        ("", true) => complain("interrupted: nothing was written"),
        ("", false) => complain("interrupted"),
        (work, _) => complain(&format!("interrupted: {work}")),
    }
    std::process::exit(match CODE.load(Ordering::Relaxed) {
        0 => 128 + i32::from(signal),
        code => i32::from(code),
    });
}
