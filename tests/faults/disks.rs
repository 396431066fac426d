//! T27, T29: a disk that fails, or can only be read.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use rustix::process::Signal;

use crate::daemon::{MESH, Site};
use crate::oracle::{Follower, all_well};
use crate::tools::{done, has, run, times};

/// Whatever call fails, the next start makes it good.
#[test]
fn t27_the_disk_fails_once() {
    if !has(false, &["strace"]) {
        return;
    }
    let calls = ["fsync", "fdatasync", "rename", "pwrite64", "ftruncate"];
    let most = times(2, 10);
    let mut failed = 0;
    for call in calls {
        for when in 1..=most {
            let site = Site::new();
            site.write("drop/a.msh", MESH);
            site.write("drop/b.msh", MESH);
            let plain = site.command(&["--settle", "50ms", "--once"]);
            let mut command = Command::new("strace");
            command.args(["-f", "-qq", "-o", "/dev/null", "-e", &format!("trace={call}")]);
            command.args(["-e", &format!("inject={call}:error=EIO:when={when}")]);
            command.arg(plain.get_program()).args(plain.get_args()).current_dir(site.path("."));
            let status =
                command.env_remove("MESHGAUGE_CONFIG").stdout(Stdio::null()).stderr(Stdio::null()).status();
            let code = status.expect("strace runs").code();
            assert!(matches!(code, Some(0 | 3 | 4)), "{call} {when}: {code:?}");
            failed += u64::from(code != Some(0));
            assert_eq!(site.once(&["--settle", "50ms"]), Some(0), "{call} {when}");
            all_well(&site, ["a.msh", "b.msh"]);
        }
    }
    let whole = most * calls.len() as u64;
    done(
        "T27",
        &format!(
            "{whole} errors, {failed} of which ended the run with an error; the next start made all good"
        ),
    );
}

/// A file system on a file, which goes with it.
struct Disk(PathBuf);

impl Disk {
    fn new(image: &Path, at: &Path) -> Self {
        fs::File::create(image).and_then(|file| file.set_len(32 << 20)).expect("a file");
        fs::create_dir_all(at).expect("a folder");
        run("mkfs.ext4", [OsStr::new("-q"), image.as_os_str()]);
        let disk = Self(at.to_owned());
        disk.mount(image, "loop");
        disk
    }

    fn mount(&self, image: &Path, options: &str) {
        let options = ["-o", options].map(OsStr::new);
        run("mount", options.into_iter().chain([image.as_os_str(), self.0.as_os_str()]));
    }

    fn remount(&self, options: &str) {
        run("mount", [OsStr::new("-o"), options.as_ref(), self.0.as_os_str()]);
    }

    fn unmount(&self) {
        run("umount", [&self.0]);
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("-l").arg(&self.0).stderr(Stdio::null()).status();
    }
}

#[test]
fn t29_a_disk_that_becomes_read_only_under_open_files() {
    if !has(true, &["mkfs.ext4", "e2fsck", "mount", "umount"]) {
        return;
    }
    let (count, mut waited) = (times(2, 20), 0);
    for _ in 0..count {
        let site = Site::new();
        let image = site.path("disk");
        let disk = Disk::new(&image, &site.path("results"));
        let mut daemon = site.start(&["--settle", "100ms", "--quiet"]);
        site.write("drop/a.msh", MESH);
        daemon.wait_for("mesh.scored", "a.msh");
        // As the kernel does when the device gives errors.
        disk.remount("remount,abort");
        for name in ["b.msh", "c.msh"] {
            site.write(&format!("drop/{name}"), MESH);
        }
        sleep(Duration::from_millis(1500));
        if daemon.is_alive() {
            daemon.signal(Signal::TERM);
            assert_eq!(daemon.end().code(), Some(0));
            waited += 1;
        } else {
            // It was just having something on disk: a failed fsync is the end of a run.
            assert_eq!(daemon.end().code(), Some(4));
        }
        drop(daemon);
        disk.unmount();
        // It finds errors, and mends them.
        let _ = Command::new("e2fsck")
            .arg("-fyy")
            .arg(&image)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        disk.mount(&image, "loop");
        assert_eq!(site.once(&["--settle", "50ms", "--quiet"]), Some(0));
        all_well(&site, ["a.msh", "b.msh", "c.msh"]);
    }
    done(
        "T29",
        &format!(
            "{count} times read-only under the daemon, which waited {waited} times; the next start made all good"
        ),
    );
}

#[test]
fn t29_a_disk_that_is_read_only_at_the_start() {
    if !has(true, &["mkfs.ext4", "mount", "umount"]) {
        return;
    }
    let site = Site::new();
    let disk = Disk::new(&site.path("disk"), &site.path("results"));
    disk.remount("remount,ro");
    site.write("drop/a.msh", MESH);
    let mut child =
        site.command(&["--settle", "100ms", "--quiet"]).stderr(Stdio::null()).spawn().expect("it runs");
    sleep(Duration::from_secs(1));
    assert!(child.try_wait().expect("a child").is_none(), "it ended instead of waiting");
    disk.remount("remount,rw");
    let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
    assert!(log.wait(60, |line| line["event"] == "mesh.scored").is_some());
    all_well(&site, ["a.msh"]);
    let _ = (child.kill(), child.wait());
    done("T29", "read-only at the start: it waited, and began when the disk was writable");
}
