//! The files that are not done with, and what each waits for.

use std::collections::{BTreeMap, HashSet, VecDeque};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::settle::Settling;
use crate::identity::Identity;
use crate::status::Waits;

/// A file that is not done with.
#[derive(Debug)]
pub struct Tracked {
    state: State,
    /// When it was first seen.
    first: Instant,
    /// Whether the log tells of it yet; what may turn out to be no mesh is not spoken of.
    announced: bool,
}

/// What a file waits for.
#[derive(Debug)]
enum State {
    /// To stand still.
    Settling(Settling),
    /// A free worker.
    Ready(Identity),
    /// Its worker.
    Running,
    /// Another try.
    Postponed { identity: Identity, until: Instant },
}

/// All of them.
#[derive(Debug)]
pub struct Tracking {
    settle: Duration,
    files: BTreeMap<PathBuf, Tracked>,
    /// Paths that became ready, the first to be ready first. Some may not be any more.
    queue: VecDeque<PathBuf>,
    settling: usize,
    running: usize,
}

impl Tracking {
    /// Nothing yet; files must stand still for `settle`.
    pub fn new(settle: Duration) -> Self {
        Self { settle, files: BTreeMap::new(), queue: VecDeque::new(), settling: 0, running: 0 }
    }

    /// Whether nothing is left to do.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Number of files that are not done with.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// Number of files that may still be changing.
    pub fn settling(&self) -> usize {
        self.settling
    }

    /// Number of files that are being scored.
    pub fn running(&self) -> usize {
        self.running
    }

    /// When the file was first seen that has been known for the longest time.
    pub fn oldest(&self) -> Option<Instant> {
        self.files.values().map(|file| file.first).min()
    }

    /// The files that wait, those that are next first: path, bytes, for what, and since when they are known.
    pub fn waiting(&self, now: Instant) -> impl Iterator<Item = (&Path, u64, Waits, Instant)> {
        let seconds = |time: Duration| time.as_secs_f64();
        let queued = self.queue.iter().filter_map(|path| match self.files.get(path) {
            Some(Tracked { state: State::Ready(identity), first, .. }) => Some((path, identity.size, *first)),
            _ => None,
        });
        let queued = queued
            .zip(1..)
            .map(|((path, bytes, first), place)| (path.as_path(), bytes, Waits::Queued(place), first));
        let others = self.files.iter().filter_map(move |(path, file)| {
            let (bytes, waits) = match &file.state {
                State::Settling(settling) => {
                    (settling.identity().size, Waits::Settling(seconds(settling.left(now, self.settle))))
                }
                State::Postponed { identity, until } => {
                    (identity.size, Waits::Postponed(seconds(until.saturating_duration_since(now))))
                }
                State::Ready(_) | State::Running => return None,
            };
            Some((path.as_path(), bytes, waits, file.first))
        });
        queued.chain(others)
    }

    /// Whether this file is known.
    pub fn contains(&self, path: &Path) -> bool {
        self.files.contains_key(path)
    }

    /// Whether the log tells of this file yet.
    pub fn is_announced(&self, path: &Path) -> bool {
        self.files.get(path).is_some_and(|file| file.announced)
    }

    /// A file that was not known.
    pub fn add(&mut self, path: PathBuf, identity: Identity, now: Instant, announced: bool) {
        let state = State::Settling(Settling::new(identity, now));
        if self.files.insert(path, Tracked { state, first: now, announced }).is_none() {
            self.settling += 1;
        }
    }

    /// Another look at a known file.
    pub fn look(&mut self, path: &Path, identity: Identity, now: Instant) {
        let Some(file) = self.files.get_mut(path) else { return };
        match &mut file.state {
            State::Settling(settling) => {
                if settling.look(identity, now, self.settle) {
                    file.state = State::Ready(settling.identity());
                    self.settling -= 1;
                    self.queue.push_back(path.to_owned());
                }
            }
            State::Ready(seen) if *seen != identity => {
                file.state = State::Settling(Settling::new(identity, now));
                self.settling += 1;
            }
            State::Postponed { identity: seen, until } if *seen != identity || *until <= now => {
                file.state = State::Settling(Settling::new(identity, now));
                self.settling += 1;
            }
            // What a worker reads is compared when the worker is done.
            State::Running | State::Ready(_) | State::Postponed { .. } => {}
        }
    }

    /// The paths of the files that may still be changing.
    pub fn unsettled(&self) -> Vec<PathBuf> {
        let unsettled = |file: &Tracked| matches!(file.state, State::Settling(_));
        self.files.iter().filter(|(_, file)| unsettled(file)).map(|(path, _)| path.clone()).collect()
    }

    /// Forgets files that are not in `present`, but for those that a worker has.
    pub fn keep(&mut self, present: &HashSet<&Path>) {
        let gone = |path: &PathBuf, file: &Tracked| {
            !present.contains(path.as_path()) && !matches!(file.state, State::Running)
        };
        let gone: Vec<_> = self.files.iter().filter(|(p, f)| gone(p, f)).map(|(p, _)| p.clone()).collect();
        for path in gone {
            self.remove(&path);
        }
    }

    /// The next file for a worker, if one is ready; it counts as running from now on.
    pub fn next(&mut self) -> Option<(PathBuf, Identity, bool)> {
        while let Some(path) = self.queue.pop_front() {
            let Some(file) = self.files.get_mut(&path) else { continue };
            if let State::Ready(identity) = file.state {
                file.state = State::Running;
                self.running += 1;
                return Some((path, identity, file.announced));
            }
        }
        None
    }

    /// Forgets a file.
    pub fn remove(&mut self, path: &Path) -> Option<Tracked> {
        let file = self.files.remove(path)?;
        match file.state {
            State::Settling(_) => self.settling -= 1,
            State::Running => self.running -= 1,
            State::Ready(_) | State::Postponed { .. } => {}
        }
        Some(file)
    }

    /// A running file turned out to be another version: it must settle again.
    pub fn unsettle(&mut self, path: &Path, identity: Identity, now: Instant) {
        if let Some(file) = self.remove(path) {
            let state = State::Settling(Settling::new(identity, now));
            self.files.insert(path.to_owned(), Tracked { state, ..file });
            self.settling += 1;
        }
    }

    /// A running file is to be tried again at `until`.
    pub fn postpone(&mut self, path: &Path, identity: Identity, until: Instant) {
        if let Some(file) = self.remove(path) {
            let state = State::Postponed { identity, until };
            self.files.insert(path.to_owned(), Tracked { state, ..file });
        }
    }

    /// Forgets the files that have not settled since they were first seen, `patience` ago or longer, and returns them.
    pub fn give_up(&mut self, now: Instant, patience: Duration) -> Vec<PathBuf> {
        let late = |file: &Tracked| {
            matches!(file.state, State::Settling(_)) && now.duration_since(file.first) >= patience
        };
        let late: Vec<_> = self.files.iter().filter(|(_, f)| late(f)).map(|(p, _)| p.clone()).collect();
        for path in &late {
            self.remove(path);
        }
        late
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTLE: Duration = Duration::from_secs(2);

    fn identity(size: u64) -> Identity {
        Identity { size, blocks: 8, ..Identity::default() }
    }

    /// Three looks at one size.
    fn settle(tracking: &mut Tracking, path: &Path, size: u64, now: &mut Instant) {
        for _ in 0..3 {
            *now += SETTLE;
            tracking.look(path, identity(size), *now);
        }
    }

    #[test]
    fn a_file_goes_from_settling_to_ready_to_running() {
        let (mut now, path) = (Instant::now(), Path::new("a.inp"));
        let mut tracking = Tracking::new(SETTLE);
        tracking.add(path.to_owned(), identity(1), now, true);
        assert!(tracking.next().is_none());
        settle(&mut tracking, path, 1, &mut now);
        assert_eq!(tracking.next(), Some((path.to_owned(), identity(1), true)));
        assert_eq!((tracking.settling(), tracking.running()), (0, 1));
        assert!(tracking.next().is_none());
    }

    #[test]
    fn a_file_that_changes_while_it_waits_for_a_worker_settles_again() {
        let (mut now, path) = (Instant::now(), Path::new("a.inp"));
        let mut tracking = Tracking::new(SETTLE);
        tracking.add(path.to_owned(), identity(1), now, true);
        settle(&mut tracking, path, 1, &mut now);
        tracking.look(path, identity(2), now);
        assert!(tracking.next().is_none());
        settle(&mut tracking, path, 2, &mut now);
        assert_eq!(tracking.next(), Some((path.to_owned(), identity(2), true)));
        assert!(tracking.next().is_none());
    }

    #[test]
    fn what_went_away_is_forgotten_unless_a_worker_has_it() {
        let mut now = Instant::now();
        let (a, b) = (Path::new("a.inp"), Path::new("b.inp"));
        let mut tracking = Tracking::new(SETTLE);
        tracking.add(a.to_owned(), identity(1), now, true);
        tracking.add(b.to_owned(), identity(1), now, true);
        settle(&mut tracking, a, 1, &mut now);
        assert!(tracking.next().is_some());
        tracking.keep(&HashSet::new());
        assert!(tracking.contains(a) && !tracking.contains(b));
        assert_eq!((tracking.settling(), tracking.running(), tracking.len()), (0, 1, 1));
    }
}
