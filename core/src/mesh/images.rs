//! Images of an object under lattice motions, shared by all who use them.

use std::sync::{Arc, Mutex, MutexGuard, TryLockError, Weak};

use rustc_hash::FxHashMap as HashMap;

use crate::geometry::spaces::motion::Motion;

/// The images of an object under lattice motions, as weak references.
///
/// No call blocks for ever. In a forked process, a thread that no longer exists may own the lock; a call that
/// does not get the lock then uses an image of its own.
#[derive(Debug)]
pub struct Images<T>(Mutex<ImageTable<T>>);

#[derive(Debug)]
struct ImageTable<T> {
    images: HashMap<Motion, Weak<T>>,
    /// Above this number of images, those no longer in use are dropped. It is twice the number left after the
    /// last drop, so that each image is checked about twice.
    full: usize,
}

/// The number of times that a thread yields to other threads before it gives up waiting for the lock. A
/// thread owns the lock while it looks up an image or drops unused images; in a process forked meanwhile,
/// nobody releases the lock.
const MAX_YIELDS: usize = 1000;

impl<T> Default for Images<T> {
    fn default() -> Self {
        let images = HashMap::default();
        Self(Mutex::new(ImageTable { images, full: 1 }))
    }
}

impl<T> Images<T> {
    /// The image under a motion, if it is in use; else `None`.
    pub fn get(&self, motion: &Motion) -> Option<Arc<T>> {
        self.if_unlocked()?.images.get(motion)?.upgrade()
    }

    /// The image under a motion that is already in use, else the given one, which is stored.
    pub fn keep(&self, motion: &Motion, image: Arc<T>) -> Arc<T> {
        let Some(mut known) = self.if_unlocked() else {
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

    fn if_unlocked(&self) -> Option<MutexGuard<'_, ImageTable<T>>> {
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
        assert!(images.if_unlocked().expect("nobody holds it").images.len() < 10);
    }

    // Formerly, threads that moved one solid at the same time could make two images of its source, which
    // differed as `mesh.source`.
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
