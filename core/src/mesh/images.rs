//! Images: a motion makes one of a thing, as long as somebody has that.

use std::sync::{Arc, Mutex, MutexGuard, TryLockError, Weak};

use rustc_hash::FxHashMap as HashMap;

use crate::geometry::spaces::motion::Motion;

/// The images of a thing by the motions that made them. They are not kept alive.
///
/// Nobody waits for another: in a process that was forked, a thread that is not there may hold the
/// lock. Who does not get it makes an image of its own.
#[derive(Debug)]
pub struct Images<T>(Mutex<Known<T>>);

#[derive(Debug)]
struct Known<T> {
    images: HashMap<Motion, Weak<T>>,
    /// The number of images at which those that nobody has any more are left out: twice as many as
    /// were left last time, so that each costs two looks.
    full: usize,
}

impl<T> Default for Images<T> {
    fn default() -> Self {
        let images = HashMap::default();
        Self(Mutex::new(Known { images, full: 1 }))
    }
}

impl<T> Images<T> {
    /// The image that somebody has.
    pub fn get(&self, motion: &Motion) -> Option<Arc<T>> {
        self.free()?.images.get(motion)?.upgrade()
    }

    /// Remember an image for as long as somebody has it.
    pub fn keep(&self, motion: &Motion, image: &Arc<T>) {
        let Some(mut known) = self.free() else {
            return;
        };
        known.images.insert(*motion, Arc::downgrade(image));
        if known.images.len() > known.full {
            known.images.retain(|_, image| image.strong_count() > 0);
            known.full = 2 * known.images.len();
        }
    }

    fn free(&self) -> Option<MutexGuard<'_, Known<T>>> {
        match self.0.try_lock() {
            Ok(known) => Some(known),
            Err(TryLockError::Poisoned(known)) => Some(known.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_is_one_as_long_as_somebody_has_it() {
        let up = |k| Motion::of_axes(&[1, 2, 3], &[0, 0, k]).expect("a motion");
        let (images, image) = (Images::default(), Arc::new(0));
        images.keep(&up(0), &image);
        for k in 1..1000 {
            images.keep(&up(k), &Arc::new(k));
        }
        let found = images.get(&up(0)).expect("somebody has it");
        assert!(Arc::ptr_eq(&found, &image));
        assert!(images.get(&up(999)).is_none());
        assert!(images.free().expect("nobody holds it").images.len() < 10);
    }
}
