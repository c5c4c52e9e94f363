//! Images of a thing under motions, shared while in use.

use std::sync::{Arc, Mutex, MutexGuard, TryLockError, Weak};

use rustc_hash::FxHashMap as HashMap;

use crate::geometry::spaces::motion::Motion;

/// The images of a thing by the motions that made them, as weak references.
///
/// No call blocks for ever. In a forked process a thread that no longer exists may hold the lock; whoever
/// does not get it uses an image of its own.
#[derive(Debug)]
pub struct Images<T>(Mutex<ImageTable<T>>);

#[derive(Debug)]
struct ImageTable<T> {
    images: HashMap<Motion, Weak<T>>,
    /// Beyond this many images, drop those no longer in use. It is twice the number kept last time, so that
    /// each image costs two looks.
    full: usize,
}

/// Yields before the lock counts as held for ever. A thread holds it while it looks up an image, and at
/// times while it drops old ones; a process forked meanwhile never gets it.
const MAX_YIELDS: usize = 1000;

impl<T> Default for Images<T> {
    fn default() -> Self {
        let images = HashMap::default();
        Self(Mutex::new(ImageTable { images, full: 1 }))
    }
}

impl<T> Images<T> {
    /// The image, if one is in use.
    pub fn get(&self, motion: &Motion) -> Option<Arc<T>> {
        self.free()?.images.get(motion)?.upgrade()
    }

    /// The image in use by now, else this one, which is remembered.
    pub fn keep(&self, motion: &Motion, image: Arc<T>) -> Arc<T> {
        let Some(mut known) = self.free() else {
            return image;
        };
        if let Some(found) = known.images.get(motion).and_then(Weak::upgrade) {
            return found;
        }
        known.images.insert(*motion, Arc::downgrade(&image));
        if known.images.len() > known.full {
            known.images.retain(|_, image| image.strong_count() > 0);
            known.full = 2 * known.images.len();
        }
        image
    }

    fn free(&self) -> Option<MutexGuard<'_, ImageTable<T>>> {
        for _ in 0..MAX_YIELDS {
            match self.0.try_lock() {
                Ok(known) => return Some(known),
                Err(TryLockError::Poisoned(known)) => return Some(known.into_inner()),
                Err(TryLockError::WouldBlock) => std::thread::yield_now(),
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_is_one_as_long_as_somebody_has_it() {
        let up = |k| Motion::of_axes(&[1, 2, 3], &[0, 0, k]).expect("a motion");
        let (images, image) = (Images::default(), Arc::new(0));
        images.keep(&up(0), Arc::clone(&image));
        for k in 1..1000 {
            images.keep(&up(k), Arc::new(k));
        }
        let found = images.get(&up(0)).expect("somebody has it");
        assert!(Arc::ptr_eq(&found, &image));
        assert!(images.get(&up(999)).is_none());
        assert!(images.free().expect("nobody holds it").images.len() < 10);
    }

    // Found: threads that moved one solid at the same time could make two images of its source, which
    // `mesh.source` showed as different.
    #[test]
    fn threads_that_make_an_image_at_once_share_one() {
        let motion = Motion::of_axes(&[1, 2, 3], &[0, 0, 1]).expect("a motion");
        for _ in 0..100 {
            let images = Images::default();
            let made = std::thread::scope(|scope| {
                let threads = [0, 1, 2].map(|k| {
                    let images = &images;
                    scope.spawn(move || images.keep(&motion, Arc::new(k)))
                });
                threads.map(|thread| thread.join().expect("it ends"))
            });
            assert!(made.iter().all(|image| Arc::ptr_eq(image, &made[0])));
        }
    }
}
