//! T15, T17, T19: what stands in the drop that is no mesh, has no decent name, or changes into something else.

use std::ffi::OsStr;
use std::fs;
use std::os::fd::AsRawFd;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::os::unix::net::UnixListener;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{scope, sleep};
use std::time::{Duration, Instant};

use rustix::process::geteuid;

use crate::daemon::{LONGER, MESH, Site};
use crate::oracle::{Follower, told};
use crate::tools::{done, has, run, times};

#[test]
fn t15_what_is_no_file() {
    let site = Site::new();
    site.write("outside.msh", MESH);
    fs::create_dir(site.path("drop/folder.msh")).expect("a folder");
    symlink("loop.msh", site.path("drop/loop.msh")).expect("linked");
    symlink(site.path("outside.msh"), site.path("drop/out.msh")).expect("linked");
    run("mkfifo", [site.path("drop/pipe.msh")]);
    let _socket = UnixListener::bind(site.path("drop/socket.msh")).expect("a socket");
    let mut expected = vec!["loop.msh", "out.msh", "pipe.msh", "socket.msh"];
    if geteuid().is_root() {
        run(
            "mknod",
            [site.path("drop/zero.msh").as_os_str(), OsStr::new("c"), OsStr::new("1"), OsStr::new("5")],
        );
        expected.push("zero.msh");
    }
    site.write("drop/good.msh", MESH);
    let start = Instant::now();
    assert_eq!(site.once(&["--settle", "50ms"]), Some(0));
    assert!(start.elapsed() < Duration::from_secs(20), "something held it up");
    let mut ignored: Vec<_> = site.events("mesh.ignored").iter().map(|event| event["mesh"].clone()).collect();
    ignored.sort_by_key(ToString::to_string);
    assert_eq!(ignored, expected);
    assert_eq!(site.summaries(), ["good.summary.json"]);
    done(
        "T15",
        "FIFO, socket, device, loop, link out, folder: each told, none opened, the mesh beside them scored",
    );
}

#[test]
fn t15_a_file_that_may_not_be_read_fails_and_is_scored_when_it_may() {
    if !has(true, &["setpriv"]) {
        return;
    }
    let site = Site::new();
    site.write("drop/secret.msh", MESH);
    let secret = site.path("drop/secret.msh");
    fs::set_permissions(&secret, fs::Permissions::from_mode(0o600)).expect("its mode");
    fs::create_dir(site.path("results")).expect("a folder");
    for folder in [".", "drop", "results"] {
        fs::set_permissions(site.path(folder), fs::Permissions::from_mode(0o777)).expect("its mode");
    }
    let as_nobody = || {
        let plain = site.command(&["--settle", "50ms"]);
        let mut command = Command::new("setpriv");
        command.args(["--reuid", "65534", "--regid", "65534", "--clear-groups"]);
        command.arg(plain.get_program()).args(plain.get_args()).arg("--once").current_dir(site.path("."));
        command.env_remove("MESHGAUGE_CONFIG").status().expect("setpriv runs").code()
    };
    assert_eq!(as_nobody(), Some(3));
    assert_eq!(site.events("mesh.failed")[0]["kind"], "unreadable");
    fs::set_permissions(&secret, fs::Permissions::from_mode(0o644)).expect("its mode");
    assert_eq!(as_nobody(), Some(0));
    assert_eq!(site.events("mesh.scored").len(), 1);
    done("T15", "a file without permission: failed, and scored once it has it");
}

#[test]
fn t17_names() {
    let site = Site::new();
    let long = format!("{}.msh", "n".repeat(240));
    let names: [&[u8]; 8] = [
        b"new\nline.msh",
        b"quote\"s.msh",
        b"\xff\xfe.msh",
        long.as_bytes(),
        b"-rf.msh",
        b"back\\slash.msh",
        "\u{202e}rtl.msh".as_bytes(),
        b"\x1b[31mred.msh",
    ];
    for name in names {
        fs::write(site.path("drop").join(OsStr::from_bytes(name)), MESH).expect("written");
    }
    let deep = "d".repeat(200);
    let deep = [deep.as_str(); 12].join("/");
    site.write(&format!("drop/{deep}/deep.msh"), MESH);
    assert_eq!(site.once(&["--settle", "50ms"]), Some(0));
    assert_eq!(site.once(&["--settle", "50ms"]), Some(0));
    let scored = site.events("mesh.scored");
    assert_eq!(scored.len(), names.len() + 1);
    for name in names {
        let exact = |event: &serde_json::Value| match &event["mesh_bytes"] {
            serde_json::Value::Null => event["mesh"].as_str().map(str::as_bytes) == Some(name),
            bytes => *bytes == serde_json::json!(name),
        };
        assert!(scored.iter().any(exact), "{}", String::from_utf8_lossy(name));
    }
    done("T17", "9 names, a path of 2400 bytes among them: scored once, told without loss");
}

/// A folder of the drop is exchanged for a link that leads out, again and again.
#[test]
fn t19_a_folder_that_becomes_a_link_out() {
    let site = Site::new();
    site.write("secret/a.msh", LONGER);
    site.write("drop/d/a.msh", MESH);
    let secret = format!("{:016x}", xxhash_rust::xxh3::xxh3_64(LONGER.as_bytes()));
    site.write("meshgauge.toml", "[watch]\nscan = \"400ms\"\nevents = false\n");
    let daemon = site.start(&["--config", "meshgauge.toml", "--settle", "20ms"]);
    let (swaps, end) = (times(300, 10_000), AtomicBool::new(false));
    // The folder itself, whatever its name.
    let folder = fs::File::open(site.path("drop/d")).expect("a folder");
    let mesh = format!("/proc/self/fd/{}/a.msh", folder.as_raw_fd());
    scope(|threads| {
        threads.spawn(|| {
            // New versions all the time, so that there is something to read.
            while !end.load(Ordering::Relaxed) {
                site.write("new.msh", MESH);
                fs::rename(site.path("new.msh"), &mesh).expect("renamed");
                sleep(Duration::from_millis(430));
            }
        });
        for swap in 0..swaps {
            let _ = fs::rename(site.path("drop/d"), site.path("real"));
            symlink(site.path("secret"), site.path("drop/d")).expect("linked");
            // Mostly short, at times as long as it takes to settle between two scans.
            sleep(Duration::from_millis(if swap % 20 == 0 { 350 } else { swap % 5 }));
            fs::remove_file(site.path("drop/d")).expect("unlinked");
            fs::rename(site.path("real"), site.path("drop/d")).expect("renamed");
            // And long enough for a scan to see what is there.
            sleep(Duration::from_millis(if swap % 20 == 19 { 500 } else { swap % 3 }));
        }
        end.store(true, Ordering::Relaxed);
    });
    site.write("drop/last.msh", MESH);
    daemon.wait_for("mesh.scored", "last.msh");
    let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
    let mut scored = 0;
    while let Some(event) = log.next() {
        assert_ne!(event["xxh3"], secret.as_str(), "a file outside was scored: {event}");
        scored += u64::from(event["event"] == "mesh.scored");
    }
    told(&site.path("results/meshgauge.jsonl"));
    done("T19", &format!("{swaps} swaps, {scored} versions scored; nothing outside was"));
}
