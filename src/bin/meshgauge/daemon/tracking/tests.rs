//! A file on its way, from its first look to a worker.

use super::*;

const SETTLE: Duration = Duration::from_secs(2);
const PLACE: Place = Place { mount: 0, scan: 1 };

fn look(size: u64, word: Word, now: Instant) -> Look {
    Look { identity: Identity { size, blocks: 8, ..Identity::default() }, word, now, settle: SETTLE }
}

/// Three looks at one size.
fn settle(tracking: &mut Tracking, path: &Path, size: u64, now: &mut Instant) {
    for _ in 0..3 {
        *now += SETTLE;
        tracking.look(path, look(size, Word::None, *now));
    }
}

fn run(tracking: &mut Tracking) -> Option<(PathBuf, u64)> {
    let next = tracking.next()?;
    tracking.run(&next);
    Some((next.path, next.identity.size))
}

#[test]
fn a_file_goes_from_settling_to_ready_to_running() {
    let (mut now, path) = (Instant::now(), Path::new("a.inp"));
    let mut tracking = Tracking::default();
    tracking.add(path.to_owned(), PLACE, look(1, Word::None, now), true);
    assert!(tracking.next().is_none());
    settle(&mut tracking, path, 1, &mut now);
    assert_eq!(tracking.next(), tracking.next(), "it is there until it runs");
    assert_eq!(run(&mut tracking), Some((path.to_owned(), 1)));
    assert_eq!((tracking.settling(), tracking.running()), (0, 1));
    assert!(tracking.next().is_none());
}

#[test]
fn a_file_that_changes_while_it_waits_for_a_worker_settles_again() {
    let (mut now, path) = (Instant::now(), Path::new("a.inp"));
    let mut tracking = Tracking::default();
    tracking.add(path.to_owned(), PLACE, look(1, Word::None, now), true);
    settle(&mut tracking, path, 1, &mut now);
    tracking.look(path, look(2, Word::None, now));
    assert!(tracking.next().is_none());
    settle(&mut tracking, path, 2, &mut now);
    assert_eq!(run(&mut tracking), Some((path.to_owned(), 2)));
    assert!(tracking.next().is_none());
}

#[test]
fn the_producers_word_goes_before_the_wait() {
    let (mut now, path) = (Instant::now(), Path::new("a.inp"));
    let mut tracking = Tracking::default();
    tracking.add(path.to_owned(), PLACE, look(1, Word::NotYet, now), true);
    for _ in 0..5 {
        now += SETTLE;
        tracking.look(path, look(1, Word::NotYet, now));
    }
    assert!(tracking.next().is_none());
    tracking.look(path, look(1, Word::Whole, now));
    assert_eq!(run(&mut tracking), Some((path.to_owned(), 1)));
    tracking.add("b.inp".into(), PLACE, look(3, Word::Whole, now), true);
    assert_eq!(run(&mut tracking), Some(("b.inp".into(), 3)));
    assert_eq!((tracking.settling(), tracking.running()), (0, 2));
}

#[test]
fn what_went_away_is_forgotten_unless_a_worker_has_it() {
    let mut now = Instant::now();
    let (a, b, elsewhere) = (Path::new("a.inp"), Path::new("b.inp"), Path::new("mount/c.inp"));
    let mut tracking = Tracking::default();
    for path in [a, b] {
        tracking.add(path.to_owned(), PLACE, look(1, Word::None, now), true);
    }
    tracking.add(elsewhere.to_owned(), Place { mount: 1, scan: 1 }, look(1, Word::None, now), true);
    settle(&mut tracking, a, 1, &mut now);
    assert!(run(&mut tracking).is_some());
    tracking.keep(Place { mount: 0, scan: 2 });
    assert!(tracking.contains(a) && !tracking.contains(b) && tracking.contains(elsewhere));
    tracking.unmounted(1);
    assert_eq!((tracking.settling(), tracking.running(), tracking.len()), (0, 1, 1));
}
