//! Hostile files do not grow the process. A file of its own: the peak is that of the whole process.

use std::fs;
use std::io::Write;
use std::path::Path;

use meshgauge::error::Kind;
use meshgauge::input::{Input, Limits, Scratch};

/// 32 KiB that unpack to 1 GiB of zeros: blocks of 128 KiB in four bytes each.
fn zstd_bomb(window_log: u8) -> Vec<u8> {
    let mut frame = b"\x28\xb5\x2f\xfd\0".to_vec();
    frame.push((window_log - 10) << 3);
    for block in 1..=8192 {
        let header: u32 = (128 << 10) << 3 | 1 << 1 | u32::from(block == 8192);
        frame.extend_from_slice(&header.to_le_bytes()[..3]);
        frame.push(0);
    }
    frame
}

/// A gzip file of zeros, as long as it gets within the format's own ratio.
fn gzip_bomb(mib: usize) -> Vec<u8> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::new(9));
    let zeros = vec![0; 1 << 20];
    for _ in 0..mib {
        out.write_all(&zeros).expect("memory takes it");
    }
    out.finish().expect("memory takes it")
}

/// An xz stream whose one block asks for a window of 1.5 GiB; the rest does not matter.
fn xz_bomb() -> Vec<u8> {
    let mut block = vec![2, 0, 0x21, 1, 37, 0, 0, 0];
    let mut sum = flate2::Crc::new();
    sum.update(&block);
    block.extend_from_slice(&sum.sum().to_le_bytes());
    [&b"\xfd7zXZ\0\0\x04\xe6\xd6\xb4\x46"[..], &block, &[0; 4096]].concat()
}

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
        ("a window of 2 GiB", zstd_bomb(31), &limits, "window"),
        ("a small window", zstd_bomb(20), &limits, "packed byte"),
        ("no limit of the ratio", zstd_bomb(20), &no_ratio, "the size of the content"),
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
