//! Linear passes over arrays, in tasks of a fixed size, so that results never depend on the number of
//! threads.

use rayon::prelude::*;

use crate::interrupt::{carried, handed_over, spend, Task};

/// The number of elements of one task: about 50 µs of work, far above the cost of scheduling it.
pub const CHUNK: usize = 1 << 14;

/// Return whether this thread belongs to a thread pool: outside of one, sharing work costs more than most
/// calls.
pub fn in_pool() -> bool {
    rayon::current_thread_index().is_some()
}

/// The results of `value` for each chunk of an array, in order; `value` gets the index of the chunk's first
/// element, and the chunk.
pub fn each_chunk<T: Sync, R: Send>(
    items: &[T],
    value: impl Fn(usize, &[T]) -> R + Sync,
) -> Vec<R> {
    let task = Task::current();
    let value = |(i, chunk): (usize, &[T])| {
        task.run(|| {
            spend(chunk.len());
            value(i * CHUNK, chunk)
        })
    };
    if items.len() <= CHUNK {
        return vec![value((0, items))];
    }
    if !in_pool() {
        return items.chunks(CHUNK).enumerate().map(value).collect();
    }
    items.par_chunks(CHUNK).enumerate().map(value).collect()
}

/// The results of `value` for each chunk of an array, in order; `value` also fills the same chunk of `out`,
/// an array of the same length.
pub fn fill_chunks<T: Sync, U: Send, R: Send>(
    items: &[T],
    out: &mut [U],
    value: impl Fn(usize, &[T], &mut [U]) -> R + Sync,
) -> Vec<R> {
    let task = Task::current();
    let value = |(i, (chunk, out)): (usize, (&[T], &mut [U]))| {
        task.run(|| {
            spend(chunk.len());
            value(i * CHUNK, chunk, out)
        })
    };
    if items.len() <= CHUNK {
        return vec![value((0, (items, out)))];
    }
    if !in_pool() {
        let chunks = items.chunks(CHUNK).zip(out.chunks_mut(CHUNK));
        return chunks.enumerate().map(value).collect();
    }
    let chunks = items.par_chunks(CHUNK).zip(out.par_chunks_mut(CHUNK));
    chunks.enumerate().map(value).collect()
}

/// The results of `value` for each item, in order; `work_size` says whether items are shared among threads.
pub fn each<T: Send, R: Send>(
    work_size: WorkSize,
    items: Vec<T>,
    value: impl Fn(T) -> R + Sync + Send,
) -> Vec<R> {
    let value = carried(value);
    let at_once = |items: Vec<T>| items.into_par_iter().map(&value).collect();
    let in_turn = |items: Vec<T>| items.into_iter().map(&value).collect();
    match work_size {
        WorkSize::Nothing => in_turn(items),
        _ if in_pool() => at_once(items),
        WorkSize::Pool if items.len() > 1 => handed_over(items, at_once).unwrap_or_else(in_turn),
        WorkSize::Task | WorkSize::Pool => in_turn(items),
    }
}

/// How much work there is: whether it pays to share it among threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorkSize {
    /// Less work than the cost of scheduling a task.
    Nothing,
    /// Enough work for a task if the caller runs in a pool.
    Task,
    /// Enough work to wake the threads of a pool.
    Pool,
}

impl WorkSize {
    /// The work size `Pool` if it pays to wake the threads of a pool (`pays`), else `Nothing`.
    #[must_use]
    pub const fn pool_if(pays: bool) -> Self {
        if pays {
            Self::Pool
        } else {
            Self::Nothing
        }
    }
}

/// The results of both functions, computed at the same time if `work_size` says that it pays.
pub fn both<A: Send, B: Send>(
    work_size: WorkSize,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    let task = Task::current();
    let at_once = |(a, b)| rayon::join(|| task.run(a), || task.run(b));
    match work_size {
        WorkSize::Task | WorkSize::Pool if in_pool() => at_once((a, b)),
        WorkSize::Nothing | WorkSize::Task => (a(), b()),
        WorkSize::Pool => handed_over((a, b), at_once).unwrap_or_else(|(a, b)| (a(), b())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interrupt::{Call, CallerHooks};

    #[test]
    fn chunks_are_the_same_in_a_pool_and_outside() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
        let pool = pool.expect("two threads");
        for len in [0, 1, CHUNK, CHUNK + 1, 3 * CHUNK - 1] {
            let items: Vec<usize> = (0..len).collect();
            let ends = || each_chunk(&items, |first, chunk| (first, chunk.len()));
            let copied = || {
                let mut out = vec![0; len];
                let firsts = fill_chunks(&items, &mut out, |first, chunk, out| {
                    out.copy_from_slice(chunk);
                    first
                });
                (firsts, out)
            };
            assert_eq!(ends(), pool.install(ends));
            assert_eq!(copied(), pool.install(copied));
            assert_eq!(ends().len(), len.div_ceil(CHUNK).max(1));
            assert_eq!(copied().1, items);
        }
    }

    /// A caller that runs all of the work itself.
    const ALONE: CallerHooks = CallerHooks {
        wants_to_stop: || false,
        hand_over: |task, share| task.run(share),
    };

    #[test]
    fn values_are_in_order_of_their_items_whoever_makes_them() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
        let pool = pool.expect("two threads");
        for work_size in [WorkSize::Nothing, WorkSize::Task, WorkSize::Pool] {
            let squares = || each(work_size, (0..9).collect(), |n: usize| n * n);
            let handed = Call::new().run_here(ALONE, || Ok(squares()));
            assert_eq!(squares(), [0, 1, 4, 9, 16, 25, 36, 49, 64]);
            assert_eq!(squares(), pool.install(squares));
            assert_eq!(Ok(squares()), handed);
        }
    }
}
