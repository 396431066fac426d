//! Broken, lying and malicious files through the whole library: an error that names the place, in bounded time and
//! memory; never a panic, a hang or a summary of half a mesh.

#![expect(
    clippy::disallowed_methods,
    reason = "small meshes of known size are read whole, to be cut and damaged"
)]

mod attempt;
#[path = "../input/bombs.rs"]
mod bombs;
mod corpus;
mod cut;
mod flipped;
mod heap;
mod limits;
mod lines;
#[path = "../input/packing.rs"]
#[expect(dead_code, reason = "shared with the tests of input")]
mod packing;
mod promises;
mod refused;
mod values;

use std::path::{Path, PathBuf};

/// Extensions of what stands beside a mesh under its name: nodes, numbers.
const COMPANIONS: [&str; 2] = ["node", "h5"];

/// Every mesh of `tests/meshes`, with its format's name.
fn own_meshes() -> Vec<(&'static str, PathBuf)> {
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes");
    let mut found = Vec::new();
    for format in meshgauge::formats::FORMATS {
        let folder = meshes.join(format.name());
        let entries = std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
        let paths = entries.map(|entry| entry.expect("an entry").path());
        let is_mesh = |path: &PathBuf| {
            path.extension().is_some_and(|e| e != "jsonl" && !COMPANIONS.iter().any(|c| e == *c))
        };
        found.extend(paths.filter(is_mesh).map(|p| (format.name(), p)));
    }
    found.sort();
    assert!(found.len() >= 20, "{found:?}");
    found
}

/// How many places of each mesh to damage: few in daily runs, all with MESHGAUGE_HOSTILE=full in the environment.
fn places(few: usize, all: usize) -> usize {
    if std::env::var_os("MESHGAUGE_HOSTILE").is_some_and(|value| value == "full") { all } else { few }
}

/// Numbers that are the same in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end as u64) as usize
    }
}
