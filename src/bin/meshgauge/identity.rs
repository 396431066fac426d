//! Which version of a file stands under a name, as far as the file system can tell.

use std::fs::{self, Metadata, OpenOptions};
use std::io;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;

use meshgauge::formats;
use rustix::fs::OFlags;
use serde::{Deserialize, Serialize};

/// What the file system says about a file. Seconds and nanoseconds for times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Identity {
    /// The device; not the same after every mount.
    pub device: u64,
    /// The file's number on the device.
    pub inode: u64,
    /// Number of bytes.
    pub size: u64,
    /// When the content changed, as far as nobody set it back.
    pub modified: (i64, i64),
    /// When content or status changed; nobody can set it back.
    pub changed: (i64, i64),
    /// Number of 512-byte blocks that are allocated.
    pub blocks: u64,
}

impl Identity {
    /// What stands under a path now: a file, or the files of the mesh that a folder is, taken together.
    pub fn of(path: &Path) -> io::Result<Self> {
        if !path.is_dir() {
            // A FIFO that took the name must not hold us up.
            let flags = (OFlags::NONBLOCK | OFlags::NOCTTY).bits().cast_signed();
            let file = OpenOptions::new().read(true).custom_flags(flags).open(path)?;
            return Ok(Self::from(&file.metadata()?));
        }
        let mut all = Self::from(&fs::metadata(path)?);
        let Some(Ok(files)) = formats::files(path) else { return Ok(all) };
        (all.size, all.blocks, all.modified, all.changed) = (0, 0, (0, 0), (0, 0));
        // A file that is not there yet changes the whole once it is.
        for one in files.iter().filter_map(|file| fs::metadata(file).ok()).map(|data| Self::from(&data)) {
            all.inode = all.inode.rotate_left(7) ^ one.inode;
            all.size += one.size;
            all.blocks += one.blocks;
            all.modified = all.modified.max(one.modified);
            all.changed = all.changed.max(one.changed);
        }
        Ok(all)
    }

    /// Whether both are the same version of the same file. The device's number may change between mounts, and blocks
    /// may be allocated after the last write, so neither counts.
    pub fn same_version(&self, other: &Self) -> bool {
        self.version() == other.version()
    }

    /// What makes up the version.
    pub fn version(&self) -> [u64; 6] {
        let bits =
            |(seconds, nanoseconds): (i64, i64)| [seconds.cast_unsigned(), nanoseconds.cast_unsigned()];
        let ([m, mn], [c, cn]) = (bits(self.modified), bits(self.changed));
        [self.inode, self.size, m, mn, c, cn]
    }

    /// Whether fewer blocks are allocated than the size asks for, as in a file that is filled out of order.
    pub fn has_holes(&self) -> bool {
        self.blocks.saturating_mul(512) < self.size
    }
}

impl From<&Metadata> for Identity {
    fn from(data: &Metadata) -> Self {
        Self {
            device: data.dev(),
            inode: data.ino(),
            size: data.size(),
            modified: (data.mtime(), data.mtime_nsec()),
            changed: (data.ctime(), data.ctime_nsec()),
            blocks: data.blocks(),
        }
    }
}
