//! Values that are made on first use and then stored.

use once_cell::race::OnceBox;

/// A value that is made on first use and then stored, without locks.
///
/// Threads that ask at the same time each make the value, and the first one made is stored. In a process
/// forked meanwhile the value is not yet made; it is never locked by a thread that the process does not have.
#[derive(Debug)]
pub struct Cached<T>(OnceBox<T>);

impl<T> Default for Cached<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Clone> Clone for Cached<T> {
    /// A copy of the value if it is made already, else an empty cache.
    fn clone(&self) -> Self {
        self.get().cloned().map_or_else(Self::new, Self::of)
    }
}

impl<T> Cached<T> {
    /// A cache whose value is not yet made.
    pub const fn new() -> Self {
        Self(OnceBox::new())
    }

    /// A cache that already stores this value.
    pub fn of(value: T) -> Self {
        Self(OnceBox::with_value(Box::new(value)))
    }

    /// The value if it is made already, else `None`.
    pub fn get(&self) -> Option<&T> {
        self.0.get()
    }

    /// The value, made by `make` if it is not stored yet. All calls must make equal values.
    pub fn get_or_make(&self, make: impl FnOnce() -> T) -> &T {
        self.0.get_or_init(|| Box::new(make()))
    }
}

#[cfg(test)]
mod tests {
    use super::Cached;
    use std::sync::mpsc::channel;
    use std::thread::scope;

    #[test]
    fn nobody_waits_for_a_maker_that_never_ends() {
        let cached = &Cached::new();
        let ((started, starts), (end, ends)) = (channel(), channel::<()>());
        scope(|threads| {
            let slow = move || {
                started.send(()).expect("somebody listens");
                ends.recv().expect("the end is called");
                1
            };
            let slow = threads.spawn(move || *cached.get_or_make(slow));
            starts.recv().expect("the slow maker starts");
            assert_eq!(cached.get(), None);
            assert_eq!(*cached.get_or_make(|| 2), 2);
            end.send(()).expect("the slow maker waits");
            assert_eq!(slow.join().expect("no panic"), 2, "the first answer stays");
        });
    }
}
