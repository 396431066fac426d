//! What kind of file system a folder is on, as far as it matters for settling and for the state.

use std::path::Path;
use std::time::Duration;

/// Attributes of files are cached this long on network file systems (the `acregmax` of NFS).
const CACHED: Duration = Duration::from_secs(60);

/// File systems that other machines may write to, by the number that `statfs` gives.
#[rustfmt::skip]
const REMOTE: &[(i64, &str)] = &[
    (0x0000_6969, "NFS"),
    (0x0000_517b, "SMB"),
    (0xff53_4d42, "CIFS"),
    (0xfe53_4d42, "SMB2"),
    (0x6573_5546, "FUSE"),
    (0x0bd0_0bd0, "Lustre"),
    (0x4750_4653, "GPFS"),
    (0x1983_0326, "BeeGFS"),
    (0x00c3_6400, "Ceph"),
    (0x0102_1997, "9P"),
];

/// The name of the network file system that the folder is on, if it is on one.
pub fn network(folder: &Path) -> Option<&'static str> {
    let kind = rustix::fs::statfs(folder).ok()?.f_type;
    REMOTE.iter().find(|(number, _)| *number == kind).map(|(_, name)| *name)
}

/// Advice where the settle time is shorter than what a network file system needs.
pub fn advice(drop: &Path, settle: Duration) -> Option<String> {
    let name = network(drop)?;
    (settle < CACHED).then(|| {
        format!(
            "on {name} another machine's writes may show late: set watch.settle over {} s, or have producers \
             rename finished files into place",
            CACHED.as_secs()
        )
    })
}
