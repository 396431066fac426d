//! T12-T14, T18: file systems that come, go, are blind, tell late or are read-only.

use std::fs;
use std::io::Write;
use std::thread::sleep;
use std::time::Duration;

use crate::daemon::{MESH, Site};
use crate::oracle::{Follower, all_well, told};
use crate::tools::{Mounted, done, has, times};

const CONFIG: &str = "[watch]\nscan = \"500ms\"\n";
const OPTIONS: [&str; 4] = ["--config", "meshgauge.toml", "--settle", "100ms"];

#[test]
fn t12_mounted_over_unmounted_and_made_anew() {
    if !has(true, &["mount", "umount"]) {
        return;
    }
    let site = Site::new();
    site.write("meshgauge.toml", CONFIG);
    fs::create_dir(site.path("drop/sub")).expect("a folder");
    let daemon = site.start(&OPTIONS);
    let count = times(2, 50);
    for round in 0..count {
        let mounted = Mounted::tmpfs(&site.path("drop/sub"), "size=1m");
        site.write(&format!("drop/sub/over{round}.msh"), MESH);
        daemon.wait_for("mesh.scored", &format!("sub/over{round}.msh"));
        drop(mounted);
        site.write(&format!("drop/sub/under{round}.msh"), MESH);
        daemon.wait_for("mesh.scored", &format!("sub/under{round}.msh"));
        fs::rename(site.path("drop"), site.path(&format!("gone{round}"))).expect("renamed");
        sleep(Duration::from_millis(20 * (round % 40)));
        fs::create_dir_all(site.path("drop/sub")).expect("made anew");
        site.write(&format!("drop/anew{round}.msh"), MESH);
        daemon.wait_for("mesh.scored", &format!("anew{round}.msh"));
    }
    let told = told(&site.path("results/meshgauge.jsonl"));
    assert_eq!(told.scored.len() as u64, 3 * count);
    assert!(told.scored.values().all(|&count| count == 1) && told.failed.is_empty());
    done(
        "T12",
        &format!("{count} times mounted over, unmounted, the root removed and made; all found, once"),
    );
}

#[test]
fn t13_a_file_system_that_tells_of_nothing() {
    if !has(true, &["bindfs"]) {
        return;
    }
    let site = Site::new();
    site.write("meshgauge.toml", CONFIG);
    fs::create_dir(site.path("back")).expect("a folder");
    let (_mounted, mut bindfs) = Mounted::bindfs(&site.path("back"), &site.path("drop"), "attr_timeout=0");
    let _daemon = site.start(&OPTIONS);
    let count = times(10, 100);
    for round in 0..count {
        site.write(&format!("back/{round}.msh"), MESH);
        sleep(Duration::from_millis(10));
    }
    Follower::new(&site.path("results/meshgauge.jsonl")).count(60, "mesh.scored", count as usize);
    let names: Vec<_> = (0..count).map(|round| format!("{round}.msh")).collect();
    all_well(&site, names.iter().map(String::as_str));
    let _ = (bindfs.kill(), bindfs.wait());
    done("T13", &format!("{count} files behind a mount that gives no events; all found, once"));
}

#[test]
fn t14_a_file_system_that_tells_late() {
    if !has(true, &["bindfs"]) {
        return;
    }
    let site = Site::new();
    site.write("meshgauge.toml", CONFIG);
    fs::create_dir(site.path("back")).expect("a folder");
    // Attributes are three seconds old at most, so files must stand still for longer.
    let (_mounted, mut bindfs) =
        Mounted::bindfs(&site.path("back"), &site.path("drop"), "attr_timeout=3,entry_timeout=3");
    let _daemon = site.start(&["--config", "meshgauge.toml", "--settle", "5s"]);
    let count = times(3, 50);
    let names: Vec<_> = (0..count).map(|round| format!("{round}.msh")).collect();
    let (first, second) = MESH.split_at(MESH.len() / 2);
    names.iter().for_each(|name| site.write(&format!("back/{name}"), first));
    sleep(Duration::from_secs(2));
    for name in &names {
        let path = site.path(&format!("back/{name}"));
        let mut file = fs::OpenOptions::new().append(true).open(path).expect("a file");
        file.write_all(second.as_bytes()).expect("written");
    }
    Follower::new(&site.path("results/meshgauge.jsonl")).count(60, "mesh.scored", names.len());
    let told = told(&site.path("results/meshgauge.jsonl"));
    assert!(told.failed.is_empty(), "half a mesh was read: {:?}", told.failed);
    all_well(&site, names.iter().map(String::as_str));
    let _ = (bindfs.kill(), bindfs.wait());
    done("T14", &format!("{count} files with attributes up to 3 s old; half a mesh was never read"));
}

#[test]
fn t18_a_drop_that_is_read_only() {
    if !has(true, &["mount", "umount"]) {
        return;
    }
    let count = times(2, 20);
    for _ in 0..count {
        let site = Site::new();
        site.write("back/a.msh", MESH);
        let _mounted = Mounted::read_only(&site.path("back"), &site.path("drop"));
        assert_eq!(site.once(&["--settle", "50ms"]), Some(0));
        all_well(&site, ["a.msh"]);
    }
    done("T18", &format!("{count} times; scored as ever"));
}
