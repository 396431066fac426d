//! The id of a version of a mesh: the same on every run, so that the log tells what was done whatever else was lost.

use std::fmt;
use std::path::Path;

use twox_hash::XxHash3_128;

use crate::identity::Identity;

/// 128 bits over path and version; 32 hexadecimal digits in the log and the database.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Id(u128);

impl Id {
    /// The id of the version of the mesh at `path` within the drop.
    pub fn of(path: &Path, identity: &Identity) -> Self {
        let mut bytes = path.as_os_str().as_encoded_bytes().to_vec();
        for part in identity.version() {
            bytes.extend_from_slice(&part.to_le_bytes());
        }
        Self(XxHash3_128::oneshot(&bytes))
    }

    /// Half of it, for sets in memory of what stands in the database in full.
    pub fn short(self) -> u64 {
        self.0 as u64
    }
}

impl fmt::Display for Id {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}
