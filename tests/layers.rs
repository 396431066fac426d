//! Holds the layer table of ARCHITECTURE.md against the sources: a module uses only those that its row names.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// A module, and the modules of the library that it may use.
const LAYERS: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("width", &[]),
    ("input", &["error"]),
    ("mesh", &["error", "input", "width"]),
    ("formats", &["error", "input", "mesh", "width"]),
    ("measures", &["mesh", "width"]),
    ("statistics", &[]),
    ("summary", &["error", "mesh"]),
    ("compare", &["mesh", "measures", "statistics", "summary"]),
    ("pipeline", &["error", "input", "mesh", "formats", "measures", "statistics", "summary", "width"]),
    ("report", &["mesh", "measures", "summary", "compare"]),
    ("export", &["error", "input", "mesh", "measures"]),
    ("generate", &["error", "mesh"]),
];

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a source folder");
    let paths = entries.map(|entry| entry.expect("a folder entry").path());
    paths
        .flat_map(|path| if path.is_dir() { rust_files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .collect()
}

#[expect(clippy::disallowed_methods, reason = "the read is bounded by `take`")]
fn text(path: &Path) -> String {
    let mut text = String::new();
    let file = File::open(path).expect("a source file");
    file.take(1 << 20).read_to_string(&mut text).expect("UTF-8");
    text
}

/// Modules of the library that a source text names by `prefix::module`.
fn named<'t>(text: &'t str, prefix: &str) -> Vec<&'t str> {
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    code.flat_map(|line| line.split(prefix).skip(1))
        .filter_map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next())
        .collect()
}

#[test]
fn modules_use_only_the_layers_below_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for path in rust_files(&root) {
        let inside = path.strip_prefix(&root).expect("it was found there");
        let first = inside.iter().next().expect("a file has a name").to_string_lossy();
        let module = first.trim_end_matches(".rs");
        if module == "lib" || module == "bin" {
            continue;
        }
        let Some((_, allowed)) = LAYERS.iter().find(|(name, _)| *name == module) else {
            panic!("{} is in no layer", inside.display());
        };
        for used in named(&text(&path), "crate::") {
            let known = LAYERS.iter().any(|(name, _)| *name == used);
            assert!(known, "{} names crate::{used}: name modules by their own path", inside.display());
            assert!(used == module || allowed.contains(&used), "{} may not use {used}", inside.display());
        }
    }
}

#[test]
fn the_program_sees_only_the_public_library() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/bin");
    for path in rust_files(&root) {
        assert!(!text(&path).contains("#[path"), "{} includes a file of the library", path.display());
    }
}

#[test]
fn unsafe_code_stands_only_where_the_architecture_says() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    const ALLOWED: [&str; 4] = ["input/mapped.rs", "mesh/column.rs", "mesh/gather.rs", "width.rs"];
    for path in rust_files(&root) {
        let inside = path.strip_prefix(&root).expect("it was found there");
        let has_unsafe = text(&path).lines().any(|line| {
            let code = line.split("//").next().unwrap_or_default();
            code.contains("unsafe {") || code.contains("unsafe fn") || code.contains("unsafe impl")
        });
        assert!(!has_unsafe || ALLOWED.iter().any(|a| Path::new(a) == inside), "{}", inside.display());
    }
}
