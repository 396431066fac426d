//! What kind of file system a folder is on, as far as it matters for settling and for the state.

use std::path::Path;

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

/// Whether the kernel's name of a type of file system is that of a network one.
pub fn is_network(kind: &str) -> bool {
    const KINDS: [&str; 11] =
        ["nfs", "nfs4", "cifs", "smb3", "smbfs", "lustre", "gpfs", "beegfs", "ceph", "9p", "afs"];
    KINDS.contains(&kind) || kind == "fuse" || kind.starts_with("fuse.")
}
