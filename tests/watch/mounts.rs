//! File systems that come, go, and hang.

use std::fs;
use std::path::Path;
use std::process::Command;

use rustix::process::Signal;

use crate::daemon::{MESH, Mounted, Site, send};

/// The process that serves a mount by bindfs. It goes on when the test ends, however it ends.
struct Server(u32);

impl Server {
    fn of(mount: &Path) -> Self {
        let found = Command::new("pgrep").arg("-f").arg(format!("bindfs .*{}", mount.display())).output();
        let found = String::from_utf8(found.expect("pgrep").stdout).expect("numbers");
        Self(found.lines().next().and_then(|pid| pid.parse().ok()).expect("it runs"))
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        send(self.0, Signal::CONT);
    }
}

#[test]
fn a_mount_that_hangs_holds_up_nobody_else() {
    let site = Site::new();
    fs::create_dir(site.path("behind")).expect("a folder");
    let at = site.path("drop/hung");
    let Some(mount) = Mounted::bound(&site.path("behind"), at.clone()) else { return };
    site.write("meshgauge.toml", "[watch]\nscan_network = \"200ms\"\n[worker]\ncount = 1\n");
    let mut daemon = site.start(&["--config", "meshgauge.toml"]);
    site.write("drop/hung/a.msh", MESH);
    daemon.wait_for("mesh.scored", "hung/a.msh");
    let server = Server::of(&at);
    send(server.0, Signal::STOP);
    for i in 0..5 {
        site.write(&format!("drop/{i}.msh"), MESH);
        daemon.wait_for("mesh.scored", &format!("{i}.msh"));
    }
    send(server.0, Signal::CONT);
    site.write("drop/hung/b.msh", MESH);
    daemon.wait_for("mesh.scored", "hung/b.msh");
    send(server.0, Signal::STOP);
    daemon.signal(Signal::TERM);
    assert_eq!(daemon.end().code(), Some(0), "it stops though the mount hangs");
    drop(server);
    drop(mount);
}

#[test]
fn what_is_mounted_and_unmounted_is_found() {
    let site = Site::new();
    site.write("meshgauge.toml", "[watch]\nscan = \"200ms\"\n");
    site.write("drop/sub/beneath.msh", MESH);
    let daemon = site.start(&["--config", "meshgauge.toml"]);
    daemon.wait_for("mesh.scored", "sub/beneath.msh");
    let Some(mount) = Mounted::memory(site.path("drop/sub"), "size=1m") else { return };
    site.write("drop/sub/on-top.msh", MESH);
    daemon.wait_for("mesh.scored", "sub/on-top.msh");
    drop(mount);
    site.write("drop/sub/beneath-too.msh", MESH);
    daemon.wait_for("mesh.scored", "sub/beneath-too.msh");
    assert_eq!(site.events_of("mesh.scored", "sub/beneath.msh").len(), 1);
}

#[test]
fn a_drop_that_is_removed_and_made_again_is_found() {
    let site = Site::new();
    site.write("meshgauge.toml", "[watch]\nscan = \"200ms\"\n");
    let daemon = site.start(&["--config", "meshgauge.toml"]);
    site.write("drop/a.msh", MESH);
    daemon.wait_for("mesh.scored", "a.msh");
    fs::remove_dir_all(site.path("drop")).expect("removed");
    site.write("drop/b.msh", MESH);
    daemon.wait_for("mesh.scored", "b.msh");
}

#[test]
fn a_drop_that_can_only_be_read_is_enough() {
    let site = Site::new();
    let Some(_mount) = Mounted::memory(site.path("drop"), "size=1m") else { return };
    site.write("drop/a.msh", MESH);
    let remounted = Command::new("mount").args(["-o", "remount,ro"]).arg(site.path("drop")).status();
    assert!(remounted.is_ok_and(|status| status.success()));
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.summaries(), ["a.summary.json"]);
}
