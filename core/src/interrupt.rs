//! Interrupts: a caller may stop work that takes too long.
//!
//! Every loop that can run long polls. If the call that it works for was stopped, the poll unwinds to
//! [`Call::run`], which returns `Cancelled`; so a routine that refuses nothing needs no error of its own.
//! Data that calls share are never left half made: caches are set only when their values are complete.
//!
//! Polls are counted, and only one in `UNITS_BETWEEN_LOOKS` reads the shared state, so that a poll costs
//! about as much as an addition.
//!
//! # Source
//! Unwinding on cancellation as in the incremental compiler framework salsa.

use std::cell::Cell;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::error::panics::caught;
use crate::error::{Error, ErrorKind, Result};

/// The units of work between two reads of the shared state. A unit takes between 10 ns and some microseconds
/// (an element of a pass; a pair of elements; an exact question), so these are 10 µs to some milliseconds
/// apart.
const UNITS_BETWEEN_LOOKS: usize = 1 << 10;

/// The time between two checks whether the caller wants to stop, in which threads do less than a tenth of a
/// second of work.
pub const ASK_EVERY: Duration = Duration::from_millis(30);

/// Stands for the number of a call where there is none.
const NO_CALL: u64 = 0;

static NEXT: AtomicU64 = AtomicU64::new(1);

/// The number of calls of the core that were stopped and have not ended.
static STOPPING: AtomicUsize = AtomicUsize::new(0);

static STOPPED: Mutex<Vec<u64>> = Mutex::new(Vec::new());

thread_local! {
    static UNITS_LEFT: Cell<usize> = const { Cell::new(UNITS_BETWEEN_LOOKS) };
    static CURRENT: Cell<Task> = const { Cell::new(Task { call: NO_CALL }) };
    static CALLER: Cell<Option<Caller>> = const { Cell::new(None) };
}

/// A call of the core, which can be stopped while it runs.
///
/// # Example
/// ```
/// use bspcsg::error::ErrorKind;
/// use bspcsg::interrupt::{spend, Call};
///
/// let call = Call::new();
/// call.stop();
/// // Work that polls ends at its next look.
/// let ended = call.run::<()>(|| loop {
///     spend(1024);
/// });
/// let error = ended.expect_err("it was stopped");
/// assert_eq!(error.kind(), ErrorKind::Cancelled);
/// ```
#[derive(Debug)]
pub struct Call {
    number: u64,
}

/// The call of the core that a thread works for; work that this thread gives to other threads takes it along.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    call: u64,
}

/// A part of the work of a call that may be given to other threads; it runs once.
pub type Share<'a> = &'a mut (dyn FnMut() + Send);

/// What a caller provides that runs a call on its own thread.
#[derive(Clone, Copy)]
pub struct CallerHooks {
    /// Returns true if the call should stop, for example because of a signal.
    pub wants_to_stop: fn() -> bool,
    /// Runs a part of the work, for the call of a task, in a thread pool, and waits; does nothing if the
    /// system starts no threads.
    pub hand_over: fn(Task, Share<'_>),
}

/// The caller whose own thread runs the work, and when it was last asked whether to stop.
#[derive(Clone, Copy)]
struct Caller {
    hooks: CallerHooks,
    asked: Instant,
}

impl Call {
    /// Makes a call that is not stopped.
    #[must_use]
    pub fn new() -> Self {
        Self {
            number: NEXT.fetch_add(1, Ordering::Relaxed),
        }
    }

    /// Stops the call: its work ends at its next polls.
    pub fn stop(&self) {
        self.task().stop();
    }

    /// The task that stands for the call on other threads.
    #[must_use]
    pub fn task(&self) -> Task {
        Task { call: self.number }
    }

    /// Runs the work of the call.
    ///
    /// # Errors
    /// The errors of the work; `Cancelled`; `Internal` for a panic.
    pub fn run<T>(&self, work: impl FnOnce() -> Result<T>) -> Result<T> {
        caught(|| self.task().run(work))
    }

    /// Runs the work of the call on the caller's own thread; the caller is regularly asked whether to stop,
    /// and may run large shares in a pool.
    ///
    /// # Errors
    /// The errors of the work; `Cancelled`.
    pub fn run_here<T>(&self, hooks: CallerHooks, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let asked = Instant::now();
        let caller = Caller { hooks, asked };
        let _before = RestoredOnDrop::new(&CALLER, Some(caller));
        self.run(work)
    }
}

impl Default for Call {
    fn default() -> Self {
        Self::new()
    }
}

impl Drop for Call {
    fn drop(&mut self) {
        if STOPPING.load(Ordering::Acquire) == 0 {
            return;
        }
        let mut stopped = STOPPED.lock().unwrap_or_else(PoisonError::into_inner);
        stopped.retain(|number| *number != self.number);
        STOPPING.store(stopped.len(), Ordering::Release);
    }
}

impl Task {
    /// Returns the task of the call that this thread works for.
    #[must_use]
    pub fn current() -> Self {
        CURRENT.get()
    }

    /// Stops the call of this task: its work ends at its next polls.
    pub fn stop(self) {
        let mut stopped = STOPPED.lock().unwrap_or_else(PoisonError::into_inner);
        if !stopped.contains(&self.call) {
            stopped.push(self.call);
            STOPPING.store(stopped.len(), Ordering::Release);
        }
    }

    /// Runs work for this task's call, on any thread; unwinds at once if the call was stopped.
    pub fn run<T>(self, work: impl FnOnce() -> T) -> T {
        // A task may begin after others of its call have ended, and may be too short to poll.
        if self.is_stopped() {
            end();
        }
        let _before = RestoredOnDrop::new(&CURRENT, self);
        work()
    }

    fn is_stopped(self) -> bool {
        STOPPING.load(Ordering::Acquire) > 0 && {
            let stopped = STOPPED.lock().unwrap_or_else(PoisonError::into_inner);
            stopped.contains(&self.call)
        }
    }
}

/// Sets a thread-local value, and restores the previous one when this is dropped.
struct RestoredOnDrop<T: Copy + 'static> {
    place: &'static std::thread::LocalKey<Cell<T>>,
    value: T,
}

impl<T: Copy> RestoredOnDrop<T> {
    fn new(place: &'static std::thread::LocalKey<Cell<T>>, value: T) -> Self {
        let value = place.replace(value);
        Self { place, value }
    }
}

impl<T: Copy> Drop for RestoredOnDrop<T> {
    fn drop(&mut self) {
        self.place.set(self.value);
    }
}

/// Wraps work for other threads, so that it runs there for the call that this thread works for.
pub fn carried<A, T>(work: impl Fn(A) -> T) -> impl Fn(A) -> T {
    let task = Task::current();
    move |argument| task.run(|| work(argument))
}

/// Counts a unit of work; unwinds if the call was stopped.
#[inline]
pub fn poll() {
    spend(1);
}

/// Counts `units` units of work; unwinds if the call was stopped.
#[inline]
pub fn spend(units: usize) {
    match UNITS_LEFT.get().checked_sub(units) {
        Some(left) => UNITS_LEFT.set(left),
        None => check_stopped(),
    }
}

#[cold]
#[inline(never)]
fn check_stopped() {
    UNITS_LEFT.set(UNITS_BETWEEN_LOOKS);
    if Task::current().is_stopped() || caller_wants_to_stop() {
        end();
    }
}

/// Unwinds to the start of the call.
fn end() -> ! {
    let text = "the caller stopped the call";
    resume_unwind(Box::new(Error::new(ErrorKind::Cancelled, text)))
}

fn caller_wants_to_stop() -> bool {
    let Some(caller) = CALLER.get() else {
        return false;
    };
    let now = Instant::now();
    if now.duration_since(caller.asked) < ASK_EVERY {
        return false;
    }
    CALLER.set(Some(Caller {
        asked: now,
        ..caller
    }));
    (caller.hooks.wants_to_stop)()
}

/// Runs a part of the work in a thread pool, if the call runs on its caller's thread and the caller has a
/// pool.
///
/// # Errors
/// `needs`, the data of the work, if the work was not run.
pub fn handed_over<W: Send, T: Send>(needs: W, work: impl Fn(W) -> T + Sync) -> Result<T, W> {
    let Some(caller) = CALLER.get() else {
        return Err(needs);
    };
    let (mut needs, mut value) = (Some(needs), None);
    let mut share = || value = needs.take().map(&work);
    (caller.hooks.hand_over)(Task::current(), &mut share);
    match (value, needs) {
        (Some(value), _) => Ok(value),
        (None, Some(needs)) => Err(needs),
        // The thread that began the share unwound because the call was stopped.
        (None, None) => end(),
    }
}

#[cfg(test)]
mod tests {
    use std::panic::catch_unwind;
    use std::thread;

    use super::*;

    fn endless() -> Result<()> {
        loop {
            poll();
        }
    }

    #[test]
    fn a_stopped_call_ends_at_a_poll() {
        let call = Call::new();
        let result = thread::scope(|s| {
            let work = s.spawn(|| call.run(endless));
            call.stop();
            work.join()
        });
        assert_eq!(
            result.map(|r| r.map_err(|e| e.kind())).ok(),
            Some(Err(ErrorKind::Cancelled))
        );
    }

    #[test]
    fn tasks_on_other_threads_end_with_their_call() {
        let call = Call::new();
        let task = call.run(|| Ok(Task::current())).expect("not stopped");
        let ended = thread::spawn(move || catch_unwind(|| task.run(endless)).is_err());
        call.stop();
        assert!(ended.join().expect("no panic"));
    }

    #[test]
    fn tasks_of_a_stopped_call_do_not_begin() {
        let call = Call::new();
        let task = call.run(|| Ok(Task::current())).expect("not stopped");
        call.stop();
        assert!(catch_unwind(|| task.run(|| ())).is_err());
    }

    #[test]
    fn other_calls_go_on() {
        let (stopped, other) = (Call::new(), Call::new());
        stopped.stop();
        let passes = || {
            spend(2 * UNITS_BETWEEN_LOOKS);
            Ok(())
        };
        assert!(other.run(passes).is_ok());
        assert!(stopped.run(passes).is_err());
        drop(stopped);
        assert!(Call::new().run(passes).is_ok());
    }

    /// A caller that runs shares itself, and wants to stop.
    const IMPATIENT: CallerHooks = CallerHooks {
        wants_to_stop: || true,
        hand_over: |task, share| task.run(share),
    };

    /// A caller whose system starts no threads.
    const ALONE: CallerHooks = CallerHooks {
        wants_to_stop: || false,
        hand_over: |_, _| (),
    };

    #[test]
    fn the_caller_is_asked() {
        assert!(Call::new().run_here(IMPATIENT, endless).is_err());
    }

    #[test]
    fn shares_are_handed_over_once_or_given_back() {
        let shared = |hooks| {
            let work = || Ok(handed_over(20, |n| n + 1));
            Call::new().run_here(hooks, work).expect("not stopped")
        };
        assert_eq!([shared(IMPATIENT), shared(ALONE)], [Ok(21), Err(20)]);
        assert_eq!(handed_over(20, |n| n + 1), Err(20), "nobody called");
    }

    #[test]
    fn a_panic_is_a_defect() {
        let defect = || -> Result<()> { resume_unwind(Box::new("other")) };
        let found = Call::new().run(defect).map_err(|e| e.kind());
        assert_eq!(found, Err(ErrorKind::Internal));
    }
}
