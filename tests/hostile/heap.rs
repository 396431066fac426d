//! The heap with a counter and a cap: whoever believes a header runs into it.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Most bytes that may be in use at once, by all tests of this file together.
pub const CAP: usize = 256 << 20;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

#[global_allocator]
static HEAP: Counting = Counting;

struct Counting;

impl Counting {
    /// Whether so many bytes more are within reason; far over the cap the process ends.
    fn take(bytes: usize) -> bool {
        let live = LIVE.fetch_add(bytes, Ordering::Relaxed).saturating_add(bytes);
        PEAK.fetch_max(live, Ordering::Relaxed);
        if live > 4 * CAP {
            LIVE.fetch_sub(bytes, Ordering::Relaxed);
        }
        live <= 4 * CAP
    }
}

#[expect(unsafe_code, reason = "an allocator cannot be written otherwise")]
// SAFETY: all work is the system's, with the layouts that the caller gave; refusing is allowed.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if !Self::take(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if !Self::take(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if !Self::take(size) {
            return std::ptr::null_mut();
        }
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// The most bytes that were ever in use at once.
pub fn peak() -> usize {
    PEAK.load(Ordering::Relaxed)
}

#[test]
fn the_counter_counts() {
    let before = peak();
    let bytes = vec![1u8; 8 << 20];
    assert!(peak() >= 8 << 20 && bytes.len() == 8 << 20 && peak() >= before);
}
