//! Watching algorithms on trees at work: what they tell, and to whom.
//!
//! An algorithm that can be watched is generic over who watches. For `()`, who does not listen, no
//! event is made and nothing is left of it in the compiled code; a list keeps all events. Events are
//! plain numbers, which can be stored and shown elsewhere.

/// A listener who is told what an algorithm does.
pub trait Watcher<E> {
    /// True if anything is listened to: what only events need is not worked out otherwise.
    const LISTENS: bool;

    /// Takes an event, which is made only if it is wanted.
    fn tell(&mut self, event: impl FnOnce() -> E);
}

/// Nobody.
impl<E> Watcher<E> for () {
    const LISTENS: bool = false;

    #[inline]
    fn tell(&mut self, _: impl FnOnce() -> E) {}
}

/// All events in their order.
impl<E> Watcher<E> for Vec<E> {
    const LISTENS: bool = true;

    fn tell(&mut self, event: impl FnOnce() -> E) {
        self.push(event());
    }
}
