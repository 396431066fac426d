//! Works on numbered things with several threads and hands over what came of them in the order of their numbers.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use crossbeam_channel::{Receiver, Sender, bounded};

use crate::error::Result;

/// What came of a thing, with its number; nothing from a worker that has panicked.
type Done<R> = Option<(usize, Result<R>)>;

/// Calls `work` with each number under `count` and room for what comes of it, and `take` with that, in order; `take` gives
/// the room back. The first number that fails gives the error.
pub(super) fn in_order<R: Default + Send>(
    count: usize,
    threads: usize,
    work: impl Fn(usize, R) -> Result<R> + Sync,
    take: impl FnMut(usize, R) -> Result<R>,
) -> Result<()> {
    // A worker takes room before it takes a number. So there is never more room than this, and the number that is waited
    // for always has some.
    let rooms = threads + 2;
    let (empty_out, empty_in) = bounded(rooms);
    let (full_out, full_in) = bounded(rooms);
    for _ in 0..rooms {
        empty_out.send(R::default()).expect("the channel has place for every room");
    }
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..threads.min(count) {
            let (empty, full) = (empty_in.clone(), full_out.clone());
            let (next, work) = (&next, &work);
            scope.spawn(move || {
                let _end = SendsPanic(full.clone());
                while let Ok(room) = empty.recv() {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    // The other end may have gone: it has met an earlier error, which is the one that counts.
                    if number >= count || full.send(Some((number, work(number, room)))).is_err() {
                        return;
                    }
                }
            });
        }
        drop((empty_in, full_out));
        // It takes its ends of the channels along: once it has met an error, nobody waits for room.
        hand_over(full_in, empty_out, take)
    })
}

fn hand_over<R>(
    full: Receiver<Done<R>>,
    empty: Sender<R>,
    mut take: impl FnMut(usize, R) -> Result<R>,
) -> Result<()> {
    let mut waiting = BTreeMap::new();
    let mut next = 0;
    for done in full {
        // The scope of the threads passes the panic on.
        let Some((number, done)) = done else { return Ok(()) };
        waiting.insert(number, done);
        while let Some(done) = waiting.remove(&next) {
            let room = take(next, done?)?;
            next += 1;
            // No worker is left to take it: the numbers are all taken.
            let _ = empty.send(room);
        }
    }
    Ok(())
}

/// Tells the other end that a worker has panicked: what it worked on will never come.
struct SendsPanic<R>(Sender<Done<R>>);

impl<R> Drop for SendsPanic<R> {
    fn drop(&mut self) {
        if thread::panicking() {
            let _ = self.0.send(None);
        }
    }
}
