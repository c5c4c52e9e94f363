//! Traces of algorithms on trees: reports of their steps.
//!
//! A traced algorithm is generic over a [`Watcher`]. For the watcher `()`, which ignores events, no event is
//! made, and the compiled code does nothing for it; a `Vec` stores all events. Events are plain numbers,
//! which can be saved and displayed elsewhere.

/// Receives the events that a traced algorithm reports.
pub trait Watcher<E> {
    /// True if the watcher uses events; if false, the algorithm skips computing data that only events
    /// contain.
    const LISTENS: bool;

    /// Receives an event, by a function that makes it; a watcher that ignores events does not call the
    /// function.
    fn notify(&mut self, event: impl FnOnce() -> E);
}

/// A watcher that ignores all events.
impl<E> Watcher<E> for () {
    const LISTENS: bool = false;

    #[inline]
    fn notify(&mut self, _: impl FnOnce() -> E) {}
}

/// A watcher that stores all events in order.
impl<E> Watcher<E> for Vec<E> {
    const LISTENS: bool = true;

    fn notify(&mut self, event: impl FnOnce() -> E) {
        self.push(event());
    }
}
