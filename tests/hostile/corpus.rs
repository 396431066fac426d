//! Other people's meshes, cut and with bits flipped: as with our own, an error or a sound summary, at once.

use std::fs;
use std::path::PathBuf;

use crate::attempt::{attempt, attempt_in_place};
use crate::cut::is_unseen;
use crate::flipped::assert_sound;
use crate::{Random, places};

/// The meshes of the corpus that can be scored apart from their folder, each with its format.
fn meshes() -> Vec<(String, PathBuf)> {
    let Some(corpus) = std::env::var_os("MESHGAUGE_CORPUS").map(PathBuf::from) else {
        eprintln!("skipped: MESHGAUGE_CORPUS names no folder");
        return Vec::new();
    };
    let (mut folders, mut found) = (vec![corpus], Vec::new());
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            if path.is_dir() {
                folders.push(path);
            } else if let Ok(summary) = attempt(&path, "whole")
                && attempt_in_place(&path, &fs::read(&path).expect("readable"), "whole, elsewhere").is_ok()
            {
                found.push((summary.mesh.format, path));
            }
        }
    }
    found.sort();
    assert!(found.len() >= 100, "{}", found.len());
    found
}

#[test]
fn meshes_of_others_that_are_cut_or_changed_do_no_harm() {
    let mut random = Random(0x2007_0303);
    let mut half = Vec::new();
    for (format, path) in meshes() {
        let bytes = fs::read(&path).expect("readable");
        for _ in 0..places(4, 50) {
            let cut = random.below(bytes.len());
            let what = format!("{format}: {} cut to {cut} of {} bytes", path.display(), bytes.len());
            let (kept, lost) = bytes.split_at(cut);
            if attempt_in_place(&path, kept, &what).is_ok() && !is_unseen(&format, kept, lost) {
                half.push(what);
            }
        }
        for _ in 0..places(8, 200) {
            let (at, bit) = (random.below(bytes.len()), random.below(8));
            let mut flipped = bytes.clone();
            flipped[at] ^= 1 << bit;
            let what = format!("{format}: {} with bit {bit} of byte {at} flipped", path.display());
            assert_sound(attempt_in_place(&path, &flipped, &what), &what);
        }
    }
    assert!(half.is_empty(), "half of a mesh was taken for the whole:\n{}", half.join("\n"));
}
