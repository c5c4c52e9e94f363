//! Tables of sources that are extended cheaply: the cost of adding a source does not depend on their number.

use std::sync::{Arc, OnceLock, RwLock, TryLockError};

use rustc_hash::FxHashMap as HashMap;

use crate::mesh::handle::Slot;
use crate::mesh::source::Source;

/// The sources of a solid or an evaluation, in the order of the expression.
///
/// The usual table has a single mesh and allocates nothing else. Longer tables are a prefix of a log that
/// other tables may share and extend.
#[derive(Clone, Debug, Default)]
pub struct SourceTable(Entries);

#[derive(Clone, Debug, Default)]
enum Entries {
    #[default]
    None,
    One(Arc<Source>),
    Many(LogPrefix),
}

/// The first `len` sources of a log. The first table that extends the log, and all tables that extend it with
/// the same sources, share it; others copy the prefix.
#[derive(Clone, Debug, Default)]
struct LogPrefix {
    log: Arc<Log>,
    len: usize,
}

type Chunk = Box<[OnceLock<Arc<Source>>]>;

/// An append-only list of sources, shared by several tables.
#[derive(Debug, Default)]
struct Log {
    /// Chunk k has room for 2^k sources, so that no source is ever moved in memory.
    chunks: [OnceLock<Chunk>; 31],
    /// The slot of each source by its id; locked while sources are added. No thread waits for the lock: in a
    /// forked process, a thread that no longer exists may own it.
    slots: RwLock<HashMap<u64, usize>>,
}

impl Log {
    fn chunk_and_index(slot: usize) -> (usize, usize) {
        let chunk = (slot + 1).ilog2() as usize;
        (chunk, slot + 1 - (1 << chunk))
    }

    fn get(&self, slot: usize) -> Option<&Arc<Source>> {
        let (chunk, at) = Self::chunk_and_index(slot);
        self.chunks.get(chunk)?.get()?.get(at)?.get()
    }

    fn push(&self, slots: &mut HashMap<u64, usize>, source: &Arc<Source>) {
        let (chunk, at) = Self::chunk_and_index(slots.len());
        let room = || (0..1usize << chunk).map(|_| OnceLock::new()).collect();
        let chunk_sources = self.chunks[chunk].get_or_init(room);
        chunk_sources[at].get_or_init(|| Arc::clone(source));
        slots.insert(source.id(), slots.len());
    }

    /// The slot of a source, if it is among the first `len` of the log; else `None`.
    fn slot(&self, source: &Source, len: usize) -> Option<usize> {
        let found = match if_free(self.slots.try_read()) {
            Some(slots) => slots.get(&source.id()).copied(),
            None => (0..len).find(|slot| self.get(*slot).is_some_and(|s| s.id() == source.id())),
        };
        found.filter(|slot| *slot < len)
    }
}

/// Return the guard of a lock, or `None` if another thread owns the lock.
fn if_free<T>(lock: Result<T, TryLockError<T>>) -> Option<T> {
    match lock {
        Ok(guard) => Some(guard),
        Err(TryLockError::Poisoned(guard)) => Some(guard.into_inner()),
        Err(TryLockError::WouldBlock) => None,
    }
}

impl<'a> FromIterator<&'a Arc<Source>> for SourceTable {
    /// The table of these sources, in the order of their first occurrences.
    fn from_iter<I: IntoIterator<Item = &'a Arc<Source>>>(sources: I) -> Self {
        Self::default().extended(sources)
    }
}

impl SourceTable {
    /// The number of sources in the table.
    pub fn len(&self) -> usize {
        match &self.0 {
            Entries::None => 0,
            Entries::One(_) => 1,
            Entries::Many(beginning) => beginning.len,
        }
    }

    /// Return whether the table has no sources.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The source in a slot of the table.
    ///
    /// # Panics
    /// If the slot is not below the number of sources.
    pub fn get(&self, slot: Slot) -> &Arc<Source> {
        let found = match &self.0 {
            Entries::One(only) if slot.0 == 0 => Some(only),
            Entries::None | Entries::One(_) => None,
            Entries::Many(beginning) => beginning.log.get(slot.index()),
        };
        found.expect("a slot of the table")
    }

    /// The slot of a source, or `None` if it is not in the table.
    pub fn slot(&self, source: &Source) -> Option<Slot> {
        match &self.0 {
            Entries::None => None,
            Entries::One(only) => (only.id() == source.id()).then_some(Slot(0)),
            Entries::Many(beginning) => beginning.slot(source).map(Slot::of),
        }
    }

    /// The sources in the order of their slots.
    pub fn iter(&self) -> impl Iterator<Item = &Arc<Source>> {
        Slot::all().take(self.len()).map(|slot| self.get(slot))
    }

    /// This table, followed by the sources of the other table that it lacks.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        if let (Entries::Many(own), Entries::Many(others)) = (&self.0, &other.0)
            && Arc::ptr_eq(&own.log, &others.log)
        {
            return if own.len < others.len { other } else { self }.clone();
        }
        self.extended(other.iter())
    }

    /// This table, followed by the given sources that it lacks.
    fn extended<'a>(&self, sources: impl IntoIterator<Item = &'a Arc<Source>>) -> Self {
        let entries = self.0.clone();
        Self(sources.into_iter().fold(entries, Entries::with))
    }
}

impl Entries {
    /// The same sources, followed by the given one unless it is among them.
    fn with(self, source: &Arc<Source>) -> Self {
        match self {
            Self::None => Self::One(Arc::clone(source)),
            Self::One(only) if only.id() == source.id() => Self::One(only),
            Self::One(only) => Self::Many(LogPrefix::default().with(&only).with(source)),
            Self::Many(beginning) => Self::Many(beginning.with(source)),
        }
    }
}

impl LogPrefix {
    fn slot(&self, source: &Source) -> Option<usize> {
        self.log.slot(source, self.len)
    }

    /// The same sources, followed by the given one unless it is among them; copies the log if it cannot
    /// extend it.
    fn with(mut self, source: &Arc<Source>) -> Self {
        if !self.add(source) {
            self.log = Arc::new(self.log.copied(self.len));
            self.add(source);
        }
        self
    }

    /// Adds a source unless it is among the prefix; returns false if the log continues with another source,
    /// or is locked.
    fn add(&mut self, source: &Arc<Source>) -> bool {
        let Some(mut slots) = if_free(self.log.slots.try_write()) else {
            return false;
        };
        match slots.get(&source.id()) {
            Some(slot) if *slot < self.len => return true,
            Some(slot) if *slot == self.len => {}
            None if slots.len() == self.len => self.log.push(&mut slots, source),
            _ => return false,
        }
        self.len += 1;
        true
    }
}

impl Log {
    /// A new log of the first `len` sources.
    fn copied(&self, len: usize) -> Self {
        let mut slots = HashMap::default();
        let copy = Self::default();
        for source in (0..len).filter_map(|slot| self.get(slot)) {
            copy.push(&mut slots, source);
        }
        Self {
            slots: RwLock::new(slots),
            ..copy
        }
    }
}
