//! The name of a mesh, from the name of its file.

use std::ffi::OsString;
use std::path::Path;

use super::Compression;

/// The file's name without its compression and mesh extensions: `pit` for `drop/pit.msh.zst`, `a.b` for `a.b.inp`.
///
/// `mesh_extensions` are without the dot; case does not matter. Names need not be UTF-8.
pub fn mesh_name(path: &Path, mesh_extensions: &[&str]) -> OsString {
    let name = Path::new(path.file_name().unwrap_or(path.as_os_str()));
    let name = without(name, |e| Compression::ALL.iter().any(|c| e.eq_ignore_ascii_case(c.extension())));
    let name = without(name, |e| mesh_extensions.iter().any(|mesh| e.eq_ignore_ascii_case(mesh)));
    name.as_os_str().to_owned()
}

/// `name` without its extension, if it is one of those that are known.
fn without(name: &Path, known: impl Fn(&std::ffi::OsStr) -> bool) -> &Path {
    match (name.extension(), name.file_stem()) {
        (Some(extension), Some(stem)) if known(extension) => Path::new(stem),
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    use super::*;

    #[test]
    fn known_extensions_go_and_others_stay() {
        let rows = [
            ("drop/pit.msh.zst", "pit"),
            ("a.b.inp", "a.b"),
            ("PIT.INP.GZ", "PIT"),
            ("pit.bz2", "pit"),
            ("pit.vtu.xz", "pit"),
            ("pit.inp.inp", "pit.inp"),
            ("pit.txt.gz", "pit.txt"),
            ("pit", "pit"),
            (".inp", ".inp"),
            (".inp.gz", ".inp"),
            ("pit.", "pit."),
            ("standard input", "standard input"),
        ];
        for (path, name) in rows {
            assert_eq!(mesh_name(Path::new(path), &["inp", "msh", "vtu"]), name, "{path}");
        }
    }

    #[test]
    fn names_need_not_be_utf8() {
        let path = Path::new(OsStr::from_bytes(b"\xff\xfe.inp.gz"));
        assert_eq!(mesh_name(path, &["inp"]), OsStr::from_bytes(b"\xff\xfe"));
    }
}
