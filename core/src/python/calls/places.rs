//! Pins the threads of a pool to free processors at the beginning of a call.
//!
//! Linux wakes a thread on the waker's processor if the processor where the thread ran last seems busy. That
//! processor seems busy even if the caller has worked there and now waits, or if the host of a virtual
//! machine has put it to sleep. Threads that share a processor stay there until the kernel balances loads,
//! some milliseconds later: longer than many calls take. So if processors are free, a call pins each thread
//! to a processor of its own at the start, and soon releases the threads again.

#[cfg(target_os = "linux")]
pub use linux::Places;
#[cfg(not(target_os = "linux"))]
pub use others::Places;

#[cfg(target_os = "linux")]
mod linux {
    use std::fs::read_to_string;
    use std::sync::{Mutex, MutexGuard};
    use std::time::{Duration, Instant};

    use rayon::ThreadPool;
    use rustix::thread::{gettid, sched_getaffinity, sched_getcpu, sched_setaffinity, CpuSet, Pid};

    /// The largest number of threads that are pinned: each costs a system call, and among more processors
    /// threads seldom meet.
    const MAX_THREADS_PLACED: usize = 8;

    /// The time for which the result of a test for free processors stays valid: a hundred times as long as
    /// the test takes.
    const MAX_AGE: Duration = Duration::from_millis(5);

    /// The threads of a pool, to be pinned to processors.
    pub struct Places {
        threads: Vec<Pid>,
        /// The time and the result of the last test for free processors. Locked while threads are pinned.
        seen: Mutex<Option<(Instant, bool)>>,
    }

    /// Threads pinned to processors of their own until this value is dropped.
    pub struct Held<'p> {
        threads: &'p [Pid],
        allowed: CpuSet,
        _seen: MutexGuard<'p, Option<(Instant, bool)>>,
    }

    impl Places {
        /// Finds the threads of a pool; waits until all of them run.
        pub fn of(pool: &ThreadPool) -> Self {
            Self {
                threads: pool.broadcast(|_| gettid()),
                seen: Mutex::new(None),
            }
        }

        /// Pins each thread of the pool to its own processor; the first thread gets the processor of the
        /// caller, who is about to wait. `None` if that would slow other work, or if another call has pinned
        /// the threads.
        pub fn hold(&self) -> Option<Held<'_>> {
            if !(2..=MAX_THREADS_PLACED).contains(&self.threads.len()) {
                return None;
            }
            let mut seen = self.seen.try_lock().ok()?;
            let allowed = sched_getaffinity(None).ok()?;
            let fresh = seen.filter(|(when, _)| when.elapsed() < MAX_AGE);
            let (_, free) = *seen.insert(fresh.unwrap_or_else(|| {
                let others = others_that_run(&self.threads);
                let room = |n| n + self.threads.len() <= allowed.count() as usize;
                (Instant::now(), others.is_some_and(room))
            }));
            if !free {
                return None;
            }
            for (&thread, processor) in self.threads.iter().zip(from_here(&allowed)) {
                let mut only = CpuSet::new();
                only.set(processor);
                let _ = sched_setaffinity(Some(thread), &only);
            }
            Some(Held {
                threads: &self.threads,
                allowed,
                _seen: seen,
            })
        }
    }

    impl Drop for Held<'_> {
        fn drop(&mut self) {
            for &thread in self.threads {
                let _ = sched_setaffinity(Some(thread), &self.allowed);
            }
        }
    }

    /// Returns how many threads of the machine run or wait for a processor, without this thread and its
    /// pool's; `None` if the system does not report it.
    fn others_that_run(own: &[Pid]) -> Option<usize> {
        let loads = read_to_string("/proc/loadavg").ok()?;
        let all: usize = loads.split([' ', '/']).nth(3)?.parse().ok()?;
        let others = all.saturating_sub(1);
        if others == 0 {
            return Some(0);
        }
        // The threads of a pool stay awake for a moment after a call.
        let awake = own.iter().filter(|&&thread| runs(thread)).count();
        Some(others.saturating_sub(awake))
    }

    /// Returns true if a thread of this process runs or waits for a processor.
    fn runs(thread: Pid) -> bool {
        let path = format!("/proc/self/task/{}/stat", thread.as_raw_pid());
        let state = |stat: &str| stat.rsplit(')').next()?.trim_start().chars().next();
        read_to_string(path).is_ok_and(|stat| state(&stat) == Some('R'))
    }

    /// Yields the allowed processors in a circle, starting with the one where this thread runs.
    fn from_here(allowed: &CpuSet) -> impl Iterator<Item = usize> + '_ {
        let here = sched_getcpu();
        let circle = (here..CpuSet::MAX_CPU).chain(0..here);
        circle.filter(|&processor| allowed.is_set(processor))
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        fn pool() -> ThreadPool {
            let built = rayon::ThreadPoolBuilder::new().num_threads(2).build();
            built.expect("two threads")
        }

        fn processors(thread: Pid) -> u32 {
            sched_getaffinity(Some(thread))
                .expect("a thread that lives")
                .count()
        }

        #[test]
        fn threads_are_held_apart_and_let_go() {
            let pool = pool();
            let places = Places::of(&pool);
            let all = processors(gettid());
            *places.seen.lock().expect("nobody else") = Some((Instant::now(), all >= 2));
            let Some(held) = places.hold() else {
                assert!(all < 2);
                return;
            };
            assert_eq!(places.threads.iter().map(|&t| processors(t)).max(), Some(1));
            assert!(places.hold().is_none(), "held by another call");
            drop(held);
            assert_eq!(
                places.threads.iter().map(|&t| processors(t)).min(),
                Some(all)
            );
        }

        #[test]
        fn threads_are_left_alone_where_processors_are_not_free() {
            let pool = pool();
            let places = Places::of(&pool);
            *places.seen.lock().expect("nobody else") = Some((Instant::now(), false));
            assert!(places.hold().is_none());
        }
    }
}

#[cfg(not(target_os = "linux"))]
mod others {
    use rayon::ThreadPool;

    /// The threads of a pool, on systems that do not allow pinning.
    pub struct Places;

    impl Places {
        /// Waits until all threads of the pool run.
        pub fn of(pool: &ThreadPool) -> Self {
            pool.broadcast(|_| ());
            Self
        }

        /// Does nothing: the system decides where the threads run.
        pub fn hold(&self) -> Option<()> {
            None
        }
    }
}
