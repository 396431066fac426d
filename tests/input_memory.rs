//! Hostile files do not grow the process. A file of its own: the peak is that of the whole process.

#[path = "input/bombs.rs"]
mod bombs;

use std::fs;
use std::path::Path;

use meshgauge::error::Kind;
use meshgauge::input::{Input, Limits, Scratch};

use bombs::{gzip_bomb, xz_bomb, zstd_bomb};

#[expect(clippy::disallowed_methods, reason = "a short file of the system")]
fn peak_kib() -> u64 {
    let status = fs::read_to_string("/proc/self/status").expect("Linux");
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("a peak");
    line.trim().trim_end_matches(" kB").parse().expect("a number")
}

#[test]
fn bombs_are_refused_without_growth_of_memory() {
    let scratch = Scratch::new(&std::env::temp_dir(), 1 << 30);
    let limits = Limits { unpacked_bytes: 512 << 20, ..Limits::default() };
    let no_ratio = Limits { unpacked_ratio: u64::MAX, ..limits.clone() };
    let rows = [
        ("a window of 2 GiB", zstd_bomb(8192, 31), &limits, "window"),
        ("a small window", zstd_bomb(8192, 20), &limits, "packed byte"),
        ("no limit of the ratio", zstd_bomb(8192, 20), &no_ratio, "the size of the content"),
        ("gzip", gzip_bomb(80), &limits, "packed byte"),
        ("an xz window of 1.5 GiB", xz_bomb(), &limits, "window"),
    ];
    // Sets the peak back to what is in use now.
    fs::write("/proc/self/clear_refs", "5").expect("Linux");
    let before = peak_kib();
    for (name, packed, limits, expected) in rows {
        let opened = Input::from_reader(Path::new(name), &packed[..], limits, &scratch);
        let error = opened.expect_err(name);
        let refused = matches!(error.kind(), Kind::Limit { what, .. } if what.contains(expected));
        assert!(refused, "{error}");
        let grown = peak_kib() - before;
        assert!(grown < 8 << 10, "{name}: {grown} KiB more");
        eprintln!("{name}: {grown} KiB more: {error}");
    }
    assert_eq!(scratch.used(), 0);
}
