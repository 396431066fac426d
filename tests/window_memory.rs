//! What windows were on does not stay in memory. A file of its own: what is measured is that of the whole process.

use std::fs;
use std::io::Write;
use std::path::Path;

use meshgauge::input::Source;

/// Pages of files that the process has mapped, in KiB.
#[expect(clippy::disallowed_methods, reason = "a short file of the system")]
fn mapped_kib() -> u64 {
    let status = fs::read_to_string("/proc/self/status").expect("Linux");
    let line = status.lines().find_map(|line| line.strip_prefix("RssFile:")).expect("mapped pages");
    line.trim().trim_end_matches(" kB").parse().expect("a number")
}

/// The system maps the neighbours of a page with it, and they belong to windows that were given back already.
#[test]
fn pages_beside_a_window_do_not_stay() {
    const BYTES: u64 = 64 << 20;
    // Ends of windows lie within pages, and within the blocks that are mapped together.
    const STEP: u64 = (128 << 10) + 4100;
    let mut file = tempfile::tempfile().expect("a folder for temporary files");
    for _ in 0..BYTES >> 20 {
        file.write_all(&[1; 1 << 20]).expect("room");
    }
    let source = Source::new(Path::new("bytes"), &file).expect("it was written");
    let before = mapped_kib();
    // As of two workers: the second of a pair is done before the first.
    let mut sum = 0;
    for k in (0..BYTES / STEP).map(|k| k ^ 1) {
        sum += source.window(k * STEP..(k + 1) * STEP).iter().map(|b| u64::from(*b)).sum::<u64>();
    }
    assert!(sum > BYTES / 2);
    let stays = mapped_kib().saturating_sub(before);
    eprintln!("{stays} KiB stay mapped");
    assert!(stays < 4 << 10, "{stays} KiB stay mapped");
}
