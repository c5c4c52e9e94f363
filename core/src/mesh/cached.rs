//! Values made on first use and kept.

use once_cell::race::OnceBox;

/// A value made on first use, without locks.
///
/// Threads that ask at the same time each make it, and the first answer stays. A process forked meanwhile
/// finds the value unmade, never locked by a thread that it does not have.
#[derive(Debug)]
pub struct Cached<T>(OnceBox<T>);

impl<T> Default for Cached<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Clone> Clone for Cached<T> {
    /// The same value, if it is made already.
    fn clone(&self) -> Self {
        self.get().cloned().map_or_else(Self::new, Self::of)
    }
}

impl<T> Cached<T> {
    /// No value yet.
    pub const fn new() -> Self {
        Self(OnceBox::new())
    }

    /// A value.
    pub fn of(value: T) -> Self {
        Self(OnceBox::with_value(Box::new(value)))
    }

    /// The value, if it is made already.
    pub fn get(&self) -> Option<&T> {
        self.0.get()
    }

    /// The value, made on first use. All makers must make equal ones.
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
