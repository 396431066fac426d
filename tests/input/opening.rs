//! What stands under the name: a file, or something else.

use std::fs::{self, File};
use std::time::Duration;

use meshgauge::error::Kind;
use rustix::fs::{CWD, FileType, Mode, mknodat};

use crate::packing::{content, file, mesh, open, open_bytes};

#[test]
fn a_plain_file_is_mapped() {
    let text = mesh(100);
    let input = open_bytes("pit.inp", &text).expect("a sound file");
    assert_eq!(content(&input), text);
    assert_eq!((input.compression, input.bytes_on_disk), (None, text.len() as u64));
    assert_eq!(input.scratch.used(), 0);
}

#[test]
fn only_regular_files_are_opened_and_nothing_hangs() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("folder.inp")).expect("a folder");
    mknodat(CWD, path("fifo.inp"), FileType::Fifo, Mode::RWXU, 0).expect("a FIFO");
    let _socket = std::os::unix::net::UnixListener::bind(path("socket.inp")).expect("a socket");
    std::os::unix::fs::symlink(path("fifo.inp"), path("link.inp")).expect("a link");
    let rows = [
        (path("folder.inp"), "a directory"),
        (path("fifo.inp"), "a FIFO"),
        (path("link.inp"), "a FIFO"),
        (path("socket.inp"), "a socket"),
        ("/dev/zero".into(), "a character device"),
    ];
    for (path, word) in rows {
        let (send, receive) = std::sync::mpsc::sync_channel(1);
        let name = path.clone();
        std::thread::spawn(move || send.send(open(&name).err()));
        let answer = receive.recv_timeout(Duration::from_secs(5)).expect("opening does not hang");
        let error = answer.expect("no regular file");
        let expected = format!("{}: expected a regular file, found {word}", path.display());
        assert_eq!(error.to_string(), expected);
    }
}

#[test]
fn a_link_to_a_file_is_followed() {
    let (folder, path) = file("pit.inp", b"*NODE\n");
    let link = folder.path().join("link.inp");
    std::os::unix::fs::symlink(&path, &link).expect("a link");
    let input = open(&link).expect("a sound file");
    assert_eq!((content(&input), input.source.path()), (b"*NODE\n".to_vec(), &*link));
}

#[test]
fn what_cannot_be_opened_is_named_with_the_cause() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let ring = folder.path().join("ring.inp");
    std::os::unix::fs::symlink(&ring, &ring).expect("a link");
    for path in [ring, folder.path().join("missing.inp")] {
        let error = open(&path).expect_err("no file");
        assert!(matches!(error.kind(), Kind::Unreadable(_)), "{error}");
        assert_eq!(error.path(), Some(&*path));
    }
}

#[test]
fn a_file_without_permission_is_unreadable() {
    let (_folder, path) = file("pit.inp", b"*NODE\n");
    let forbidden = std::os::unix::fs::PermissionsExt::from_mode(0o000);
    fs::set_permissions(&path, forbidden).expect("the owner may");
    if File::open(&path).is_ok() {
        eprintln!("skipped: this user may read every file");
        return;
    }
    let error = open(&path).expect_err("no permission");
    assert!(matches!(error.kind(), Kind::Unreadable(_)), "{error}");
}

#[test]
fn an_empty_file_is_empty() {
    let error = open_bytes("pit.inp", b"").expect_err("no bytes");
    assert!(matches!(error.kind(), Kind::Empty));
    assert!(error.to_string().ends_with("pit.inp: expected a mesh, found an empty file"), "{error}");
}
