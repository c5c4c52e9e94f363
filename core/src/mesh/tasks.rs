//! Linear passes over arrays, in tasks of a fixed size, so that results never depend on threads.

use rayon::prelude::*;

/// Elements of one task: some 50 µs of work, far above what handing it over costs.
pub const CHUNK: usize = 1 << 14;

/// Whether work may be shared: outside of a pool, handing it over costs more than most calls.
pub fn in_pool() -> bool {
    rayon::current_thread_index().is_some()
}

/// A value for each chunk of an array, in order; `value` gets the index of the chunk's first element.
pub fn each_chunk<T: Sync, R: Send>(
    items: &[T],
    value: impl Fn(usize, &[T]) -> R + Sync,
) -> Vec<R> {
    if items.len() <= CHUNK || !in_pool() {
        return vec![value(0, items)];
    }
    let chunks = items.par_chunks(CHUNK).enumerate();
    chunks.map(|(i, chunk)| value(i * CHUNK, chunk)).collect()
}

/// As [`each_chunk`], and fills the same chunk of another array of the same length.
pub fn fill_chunks<T: Sync, U: Send, R: Send>(
    items: &[T],
    out: &mut [U],
    value: impl Fn(usize, &[T], &mut [U]) -> R + Sync,
) -> Vec<R> {
    if items.len() <= CHUNK || !in_pool() {
        return vec![value(0, items, out)];
    }
    let chunks = items.par_chunks(CHUNK).zip(out.par_chunks_mut(CHUNK));
    let chunks = chunks.enumerate();
    chunks
        .map(|(i, (chunk, out))| value(i * CHUNK, chunk, out))
        .collect()
}

/// Two values, made at the same time where that pays.
pub fn both<A: Send, B: Send>(
    pays: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if pays && in_pool() {
        rayon::join(a, b)
    } else {
        (a(), b())
    }
}
