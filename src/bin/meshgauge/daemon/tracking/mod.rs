//! The files that are not done with, and what each waits for.

#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::producer::Word;
use super::settle::Settling;
use crate::identity::Identity;
use crate::status::Waits;

/// So many files are minded at a time, whatever the drop holds; the others come up in a later scan.
const MOST: usize = 32_000;

/// A file that is not done with.
#[derive(Debug)]
pub struct Tracked {
    /// What it waits for.
    pub state: State,
    /// The mount that it is on.
    pub mount: u64,
    /// When it was first seen.
    first: Instant,
    /// How long it must stand still, as far as it is known.
    settle: Duration,
    /// The scan that it was last seen by.
    scan: u64,
    /// Whether the log tells of it yet; what may turn out to be no mesh is not spoken of.
    announced: bool,
}

/// What a file waits for.
#[derive(Debug)]
pub enum State {
    /// Its producer's word.
    Awaiting(Identity),
    /// To stand still.
    Settling(Settling),
    /// A free worker.
    Ready(Identity),
    /// Its worker.
    Running,
    /// Another try.
    Postponed { identity: Identity, until: Instant },
}

/// A look at a file.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    /// What was seen.
    pub identity: Identity,
    /// What its producer says.
    pub word: Word,
    /// When.
    pub now: Instant,
    /// How long the file must stand still without a word.
    pub settle: Duration,
}

/// Where a file was come upon.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    /// The mount.
    pub mount: u64,
    /// The mount's scan.
    pub scan: u64,
}

/// A file that a worker is to get.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Next {
    /// Its path within the drop.
    pub path: PathBuf,
    /// The version that settled.
    pub identity: Identity,
    /// Whether the log tells of it yet.
    pub announced: bool,
}

/// All of them.
#[derive(Debug, Default)]
pub struct Tracking {
    files: BTreeMap<PathBuf, Tracked>,
    /// Paths that became ready, the first to be ready first. Some may not be any more.
    queue: VecDeque<PathBuf>,
    settling: usize,
    running: usize,
}

impl Tracking {
    /// Whether nothing is left to do.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// For how many further files there is room.
    pub fn room(&self) -> usize {
        MOST.saturating_sub(self.files.len())
    }

    /// Whether there is room for many files.
    pub fn has_room(&self) -> bool {
        self.files.len() < MOST / 2
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

    /// The files, in the order of their paths.
    pub fn files(&self) -> impl Iterator<Item = (&Path, &Tracked)> {
        self.files.iter().map(|(path, file)| (path.as_path(), file))
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
                State::Awaiting(identity) => (identity.size, Waits::Word),
                State::Settling(settling) => {
                    (settling.identity().size, Waits::Settling(seconds(settling.left(now, file.settle))))
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

    /// The log tells of this file now.
    pub fn announce(&mut self, path: &Path) {
        if let Some(file) = self.files.get_mut(path) {
            file.announced = true;
        }
    }

    /// A file that was not known.
    pub fn add(&mut self, path: PathBuf, place: Place, look: Look, announced: bool) {
        let state = first_state(&look);
        let Place { mount, scan } = place;
        self.remove(&path);
        self.enter(&path, &state);
        self.files
            .insert(path, Tracked { state, mount, scan, first: look.now, settle: look.settle, announced });
    }

    /// A scan came upon a known file.
    pub fn seen(&mut self, path: &Path, place: Place) {
        if let Some(file) = self.files.get_mut(path) {
            (file.mount, file.scan) = (place.mount, place.scan);
        }
    }

    /// Another look at a known file.
    pub fn look(&mut self, path: &Path, look: Look) {
        let Some(file) = self.files.get_mut(path) else { return };
        let Look { identity, word, now, settle } = look;
        file.settle = settle;
        let next = match &mut file.state {
            // What a worker reads is compared when the worker is done.
            State::Running => None,
            State::Postponed { identity: seen, until } => {
                (*seen != identity || *until <= now).then(|| first_state(&look))
            }
            State::Awaiting(_) => (word != Word::NotYet).then(|| first_state(&look)),
            State::Ready(seen) => (*seen != identity).then(|| first_state(&look)),
            State::Settling(settling) => match word {
                Word::Whole => Some(State::Ready(identity)),
                Word::NotYet => Some(State::Awaiting(identity)),
                Word::None => settling.look(identity, now, settle).then_some(State::Ready(identity)),
            },
        };
        if let Some(state) = next {
            self.change(path, state);
        }
    }

    fn change(&mut self, path: &Path, state: State) {
        let Some(file) = self.files.get_mut(path) else { return };
        let left = std::mem::replace(&mut file.state, State::Running);
        self.leave(&left);
        self.enter(path, &state);
        if let Some(file) = self.files.get_mut(path) {
            file.state = state;
        }
    }

    fn leave(&mut self, state: &State) {
        match state {
            State::Settling(_) => self.settling -= 1,
            State::Running => self.running -= 1,
            State::Awaiting(_) | State::Ready(_) | State::Postponed { .. } => {}
        }
    }

    fn enter(&mut self, path: &Path, state: &State) {
        match state {
            State::Settling(_) => self.settling += 1,
            State::Running => self.running += 1,
            State::Ready(_) => self.queue.push_back(path.to_owned()),
            State::Awaiting(_) | State::Postponed { .. } => {}
        }
    }

    /// The paths of the files on a mount that may still be changing.
    pub fn unsettled(&self, mount: u64) -> Vec<PathBuf> {
        let unsettled = |file: &Tracked| file.mount == mount && matches!(file.state, State::Settling(_));
        self.files.iter().filter(|(_, file)| unsettled(file)).map(|(path, _)| path.clone()).collect()
    }

    /// Forgets the files of a mount that its last scan did not come upon, but for those that a worker has.
    pub fn keep(&mut self, place: Place) {
        self.forget(|file| {
            file.mount == place.mount && file.scan != place.scan && !matches!(file.state, State::Running)
        });
    }

    /// Forgets the files of a mount that is no more, but for those that a worker has.
    pub fn unmounted(&mut self, mount: u64) {
        self.forget(|file| file.mount == mount && !matches!(file.state, State::Running));
    }

    /// Forgets the files that are not whole yet and were first seen `patience` ago or longer, and returns them.
    pub fn give_up(&mut self, now: Instant, patience: Duration) -> Vec<PathBuf> {
        self.forget(|file| {
            matches!(file.state, State::Settling(_) | State::Awaiting(_))
                && now.duration_since(file.first) >= patience
        })
    }

    fn forget(&mut self, unwanted: impl Fn(&Tracked) -> bool) -> Vec<PathBuf> {
        let gone = self.files.iter().filter(|(_, file)| unwanted(file));
        let gone: Vec<_> = gone.map(|(path, _)| path.clone()).collect();
        for path in &gone {
            self.remove(path);
        }
        gone
    }

    /// The next file for a worker, if one is ready.
    pub fn next(&mut self) -> Option<Next> {
        while let Some(path) = self.queue.front() {
            if let Some(Tracked { state: State::Ready(identity), announced, .. }) = self.files.get(path) {
                return Some(Next { path: path.clone(), identity: *identity, announced: *announced });
            }
            self.queue.pop_front();
        }
        None
    }

    /// A worker has the file that `next` told of.
    pub fn run(&mut self, next: &Next) {
        self.queue.pop_front();
        self.change(&next.path, State::Running);
    }

    /// Forgets a file.
    pub fn remove(&mut self, path: &Path) -> Option<Tracked> {
        let file = self.files.remove(path)?;
        self.leave(&file.state);
        Some(file)
    }

    /// The file changed while a worker had it.
    pub fn unsettle(&mut self, path: &Path, identity: Identity, now: Instant) {
        self.change(path, State::Settling(Settling::new(identity, now)));
    }

    /// The file is tried again later.
    pub fn postpone(&mut self, path: &Path, identity: Identity, until: Instant) {
        self.change(path, State::Postponed { identity, until });
    }
}

/// What a file waits for at the first look.
fn first_state(look: &Look) -> State {
    match look.word {
        Word::Whole => State::Ready(look.identity),
        Word::NotYet => State::Awaiting(look.identity),
        Word::None => State::Settling(Settling::new(look.identity, look.now)),
    }
}
