//! Meshes with a bit or a few bytes changed: read or refused, at once.

use std::fs;

use meshgauge::input::Compression;

use crate::attempt::{assert_tells_all, attempt_in_place};
use crate::packing::pack;
use crate::{Random, own_meshes, places};

/// Sound numbers and short bounds, whatever was changed.
pub fn assert_sound(result: meshgauge::Result<meshgauge::Summary>, what: &str) {
    match result {
        Err(error) => assert_tells_all(&error, what),
        Ok(summary) => {
            let text = summary.to_json();
            let again: Result<meshgauge::Summary, _> = serde_json::from_str(&text);
            assert!(again.is_ok_and(|again| again == summary), "{what}: does not read back: {text}");
            for (shape, found) in &summary.shapes {
                for (code, measure) in &found.measures {
                    let range = 0.0..=1.0;
                    assert!(
                        range.contains(&measure.min) && range.contains(&measure.max),
                        "{what}: {shape} {code}"
                    );
                }
            }
        }
    }
}

#[test]
fn flipped_bits_do_no_harm() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for (format, path) in own_meshes() {
        let bytes = fs::read(&path).expect("readable");
        for _ in 0..places(40, 200) {
            let (at, bit) = (random.below(bytes.len()), random.below(8));
            let mut flipped = bytes.clone();
            flipped[at] ^= 1 << bit;
            let what = format!("{format}/{} with bit {bit} of byte {at} flipped", path.display());
            assert_sound(attempt_in_place(&path, &flipped, &what), &what);
        }
    }
}

#[test]
fn flipped_bits_of_packed_meshes_do_no_harm() {
    let mut random = Random(0x9e37_79b9_7f4a_7c16);
    for (format, path) in own_meshes().into_iter().step_by(4) {
        let bytes = fs::read(&path).expect("readable");
        for compression in Compression::ALL {
            let packed = pack(compression, &bytes);
            for _ in 0..places(8, 20) {
                let (at, bit) = (random.below(packed.len()), random.below(8));
                let mut flipped = packed.clone();
                flipped[at] ^= 1 << bit;
                let what = format!("{format}, {} with bit {bit} of byte {at} flipped", compression.name());
                assert_sound(attempt_in_place(&path, &flipped, &what), &what);
            }
        }
    }
}
