//! When a file stands still.
//!
//! No single sign tells that a file is complete: a size stands still in a file that is filled out of order, and times
//! can be set back. So everything that the file system says must stand still, over a time that the monotonic clock
//! measures, by several looks. A writer that was seen to pause is waited for three times as long as it paused.

use std::time::{Duration, Instant};

use crate::identity::Identity;

/// Fewest looks that must agree.
const LOOKS: u32 = 3;

/// An empty file is most likely about to be filled; it must stand still this many times longer.
const EMPTY: u32 = 5;

/// A file must stand still this many times as long as its writer was seen to pause.
const PAUSES: u32 = 3;

/// However long the pauses, a file that has stood still for so long is taken.
const LONGEST: Duration = Duration::from_secs(30 * 60);

/// What was seen of a file that may still be changing.
#[derive(Debug, Clone, Copy)]
pub struct Settling {
    identity: Identity,
    since: Instant,
    looks: u32,
    /// The longest time for which it stood still and then changed.
    pause: Duration,
}

impl Settling {
    /// The first look at a file.
    pub fn new(identity: Identity, now: Instant) -> Self {
        Self { identity, since: now, looks: 1, pause: Duration::ZERO }
    }

    /// How long it must stand still for, from `now` on.
    pub fn left(&self, now: Instant, settle: Duration) -> Duration {
        self.quiet(settle).saturating_sub(now.duration_since(self.since))
    }

    /// What was seen last.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// Another look; says whether the file has stood still for long enough.
    pub fn look(&mut self, identity: Identity, now: Instant, settle: Duration) -> bool {
        let still = now.duration_since(self.since);
        if identity != self.identity {
            // Two looks at one state are a pause; less may be the time between two looks.
            let pause = if self.looks > 1 { self.pause.max(still) } else { self.pause };
            *self = Self { pause, ..Self::new(identity, now) };
            return false;
        }
        self.looks = self.looks.saturating_add(1);
        self.looks >= LOOKS && still >= self.quiet(settle)
    }

    /// How long it must stand still.
    fn quiet(&self, settle: Duration) -> Duration {
        let settle = if self.identity.size == 0 {
            settle * EMPTY
        } else if self.identity.has_holes() {
            settle * 2
        } else {
            settle
        };
        settle.max((self.pause * PAUSES).min(LONGEST))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTLE: Duration = Duration::from_secs(2);

    fn identity(size: u64) -> Identity {
        Identity { device: 1, inode: 2, size, modified: (3, 4), changed: (5, 6), blocks: size.div_ceil(512) }
    }

    /// Looks once a second, at what `of` says stands there, until the file has settled.
    fn seconds_until_settled(of: impl Fn(u64) -> Identity) -> Option<u64> {
        let start = Instant::now();
        let mut settling = Settling::new(of(0), start);
        (1..100).find(|&second| settling.look(of(second), start + Duration::from_secs(second), SETTLE))
    }

    #[test]
    fn a_file_that_stands_still_settles() {
        assert_eq!(seconds_until_settled(|_| identity(100)), Some(2));
    }

    #[test]
    fn each_change_starts_the_wait_anew() {
        assert_eq!(seconds_until_settled(|second| identity(second.min(7) + 1)), Some(9));
        assert_eq!(seconds_until_settled(|second| identity(second + 1)), None);
    }

    #[test]
    fn a_file_whose_times_were_set_back_has_changed() {
        let touched = |second: u64| Identity { changed: (second.min(5).cast_signed(), 0), ..identity(100) };
        assert_eq!(seconds_until_settled(touched), Some(7));
    }

    #[test]
    fn a_writer_that_pauses_is_waited_for_longer_than_it_pauses() {
        // It writes every 1.8 s, five times, and is looked at ten times a second.
        let start = Instant::now();
        let mut settling = Settling::new(identity(1), start);
        let mut settled = Vec::new();
        for tenth in 1..400_u64 {
            let size = 1 + (tenth / 18).min(5);
            let now = start + Duration::from_millis(100 * tenth);
            if settling.look(identity(size), now, SETTLE) {
                settled.push(tenth);
                break;
            }
        }
        // The last write is seen at 9.0 s.
        assert_eq!(settled, [90 + 3 * 18]);
    }

    #[test]
    fn a_file_with_holes_waits_twice_as_long_and_an_empty_one_longer_still() {
        assert_eq!(seconds_until_settled(|_| Identity { blocks: 0, ..identity(100) }), Some(4));
        assert_eq!(seconds_until_settled(|_| identity(0)), Some(10));
    }

    #[test]
    fn two_looks_are_not_enough_however_far_apart() {
        let start = Instant::now();
        let mut settling = Settling::new(identity(1), start);
        assert!(!settling.look(identity(1), start + SETTLE * 10, SETTLE));
        assert!(settling.look(identity(1), start + SETTLE * 11, SETTLE));
    }
}
