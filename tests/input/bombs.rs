//! Small files that unpack to large ones, or ask for much memory to be unpacked.

use std::io::Write;

/// A zstd frame of zeros that asks for a window of 2^`window_log`: 128 KiB for every four bytes.
pub fn zstd_bomb(blocks: u32, window_log: u8) -> Vec<u8> {
    let mut frame = b"\x28\xb5\x2f\xfd\0".to_vec();
    frame.push((window_log - 10) << 3);
    for block in 1..=blocks {
        let header = (128 << 10) << 3 | 1 << 1 | u32::from(block == blocks);
        frame.extend_from_slice(&header.to_le_bytes()[..3]);
        frame.push(0);
    }
    frame
}

/// A gzip file of zeros, as long as it gets within the format's own ratio.
pub fn gzip_bomb(mib: usize) -> Vec<u8> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::new(9));
    let zeros = vec![0; 1 << 20];
    for _ in 0..mib {
        out.write_all(&zeros).expect("memory takes it");
    }
    out.finish().expect("memory takes it")
}

/// An xz stream whose one block asks for a window of 1.5 GiB; the rest does not matter.
pub fn xz_bomb() -> Vec<u8> {
    let mut block = vec![2, 0, 0x21, 1, 37, 0, 0, 0];
    let mut sum = flate2::Crc::new();
    sum.update(&block);
    block.extend_from_slice(&sum.sum().to_le_bytes());
    [&b"\xfd7zXZ\0\0\x04\xe6\xd6\xb4\x46"[..], &block, &[0; 4096]].concat()
}
