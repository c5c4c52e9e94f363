//! Tracing of algorithms on trees.
//!
//! A traced algorithm is generic over its watcher. For `()`, which ignores events, none is made and the
//! compiled code has no trace of it; a list keeps all events. Events are plain numbers, which can be stored
//! and shown elsewhere.

/// Receives the events of an algorithm.
pub trait Watcher<E> {
    /// Whether events are used; if not, data that only events need is not computed.
    const LISTENS: bool;

    /// Takes an event, which is only made if it is used.
    fn notify(&mut self, event: impl FnOnce() -> E);
}

/// Ignores all events.
impl<E> Watcher<E> for () {
    const LISTENS: bool = false;

    #[inline]
    fn notify(&mut self, _: impl FnOnce() -> E) {}
}

/// Keeps all events in order.
impl<E> Watcher<E> for Vec<E> {
    const LISTENS: bool = true;

    fn notify(&mut self, event: impl FnOnce() -> E) {
        self.push(event());
    }
}
