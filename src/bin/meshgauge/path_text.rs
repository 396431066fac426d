//! Paths in JSON, without loss: a string where the path is UTF-8, else the array of its bytes.

use std::ffi::OsString;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

/// A path as it stands in JSON.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum PathText {
    /// A path of UTF-8.
    Text(String),
    /// Any other path.
    Bytes(Vec<u8>),
}

impl From<&Path> for PathText {
    fn from(path: &Path) -> Self {
        match path.to_str() {
            Some(text) => PathText::Text(text.to_owned()),
            None => PathText::Bytes(path.as_os_str().as_bytes().to_vec()),
        }
    }
}

impl From<PathText> for PathBuf {
    fn from(text: PathText) -> Self {
        match text {
            PathText::Text(text) => text.into(),
            PathText::Bytes(bytes) => OsString::from_vec(bytes).into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_survives() {
        for name in [&b"pit.inp"[..], b"a\nb\".inp", b"\xff\xfe.inp"] {
            let path = PathBuf::from(OsString::from_vec(name.to_vec()));
            let json = serde_json::to_string(&PathText::from(&*path)).expect("names have JSON");
            let back: PathText = serde_json::from_str(&json).expect("it was just written");
            assert_eq!(PathBuf::from(back), path);
        }
    }
}
