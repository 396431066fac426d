//! Meshes arrive in more ways than one.

use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use crate::daemon::{LONGER, MESH, Site};

#[test]
fn once_scores_what_is_there_and_a_second_run_scores_nothing_again() {
    let site = Site::new();
    site.write("drop/a.msh", MESH);
    site.write("drop/sub/deep/b.msh", LONGER);
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.summaries(), ["a.summary.json", "sub/deep/b.summary.json"]);
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.events("mesh.scored").len(), 2);
    let scored = &site.events_of("mesh.scored", "a.msh")[0];
    let summary = site.summary("a.summary.json");
    assert_eq!(scored["min_M31"], summary["shapes"]["tetrahedron"]["measures"]["M31"]["min"]);
    assert_eq!((&scored["status"], &scored["elements"]), (&"pass".into(), &1.into()));
}

#[test]
fn another_version_under_the_same_name_is_scored_again() {
    let site = Site::new();
    site.write("drop/a.msh", MESH);
    assert_eq!(site.once(&[]), Some(0));
    // The same size, and the old times restored: only inode and change time tell.
    let times = fs::metadata(site.path("drop/a.msh")).and_then(|data| data.modified()).expect("a time");
    site.write("drop/a.msh", LONGER);
    let file = OpenOptions::new().write(true).open(site.path("drop/a.msh")).expect("a file");
    file.set_modified(times).expect("time set back");
    assert_eq!(MESH.len(), LONGER.len());
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.events("mesh.scored").len(), 2);
    let volume = site.summary("a.summary.json")["totals"]["volume"].as_f64().expect("a volume");
    assert!((volume - 1.0 / 3.0).abs() < 1e-12);
}

#[test]
fn a_mesh_that_is_renamed_into_the_drop_is_scored() {
    let site = Site::new();
    let daemon = site.start(&[]);
    site.write("outside.msh", MESH);
    fs::rename(site.path("outside.msh"), site.path("drop/a.msh")).expect("renamed");
    daemon.wait_for("mesh.scored", "a.msh");
    fs::create_dir_all(site.path("made/elsewhere")).expect("folders");
    site.write("made/elsewhere/b.msh", MESH);
    fs::rename(site.path("made"), site.path("drop/made")).expect("a folder renamed");
    daemon.wait_for("mesh.scored", "made/elsewhere/b.msh");
    fs::hard_link(site.path("drop/a.msh"), site.path("drop/linked.msh")).expect("linked");
    daemon.wait_for("mesh.scored", "linked.msh");
}

#[test]
fn a_mesh_is_found_without_events() {
    let site = Site::new();
    site.write("meshgauge.toml", "[watch]\nevents = false\nscan = \"100ms\"");
    let daemon = site.start(&["--config", "meshgauge.toml"]);
    site.write("drop/a.msh", MESH);
    daemon.wait_for("mesh.scored", "a.msh");
}

#[test]
fn a_mesh_that_is_written_with_pauses_is_scored_once_and_whole() {
    let site = Site::new();
    let daemon = site.start(&["--settle", "1500ms"]);
    let mut file = File::create(site.path("drop/slow.msh")).expect("a file");
    for piece in MESH.as_bytes().chunks(MESH.len() / 8) {
        file.write_all(piece).expect("written");
        sleep(Duration::from_millis(150));
    }
    drop(file);
    daemon.wait_for("mesh.scored", "slow.msh");
    assert_eq!(site.events_of("mesh.scored", "slow.msh").len(), 1);
    assert!(site.events("mesh.failed").is_empty());
}

#[test]
fn names_of_files_that_are_still_written_are_left_alone() {
    let site = Site::new();
    for name in ["a.msh.part", ".a.msh.Xy12", "a.msh~", "a.msh.tmp", ".hidden/a.msh"] {
        site.write(&format!("drop/{name}"), MESH);
    }
    let daemon = site.start(&[]);
    sleep(Duration::from_millis(800));
    assert_eq!(site.log().len(), 1, "only the start is logged: {:#?}", site.log());
    fs::rename(site.path("drop/a.msh.part"), site.path("drop/a.msh")).expect("renamed");
    daemon.wait_for("mesh.scored", "a.msh");
    assert_eq!(site.events("mesh.detected").len(), 1);
}

#[test]
fn once_leaves_a_file_that_is_written_for_ever() {
    let site = Site::new();
    site.write("drop/a.msh", MESH);
    site.write("meshgauge.toml", "[watch]\npatience = \"2s\"");
    let growing = site.path("drop/growing.msh");
    site.write("drop/growing.msh", "$");
    let (stop, stopped) = crossbeam_channel::bounded::<()>(0);
    let writer = std::thread::spawn(move || {
        let mut file = OpenOptions::new().append(true).open(growing).expect("a file");
        while stopped.try_recv() == Err(crossbeam_channel::TryRecvError::Empty) {
            file.write_all(b"x").expect("written");
            sleep(Duration::from_millis(20));
        }
    });
    assert_eq!(site.once(&["--config", "meshgauge.toml"]), Some(3));
    drop(stop);
    writer.join().expect("the writer ends");
    assert_eq!(site.summaries(), ["a.summary.json"]);
    assert!(site.events_of("mesh.claimed", "growing.msh").is_empty());
}

#[test]
fn a_name_that_is_not_utf8_is_scored_and_logged_without_loss() {
    use std::os::unix::ffi::OsStrExt;
    let site = Site::new();
    let name = std::ffi::OsStr::from_bytes(b"\xff\n.msh");
    fs::write(site.path("drop").join(name), MESH).expect("written");
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.events("mesh.scored")[0]["mesh_bytes"], serde_json::json!(b"\xff\n.msh"));
    assert!(site.path("results").join(std::ffi::OsStr::from_bytes(b"\xff\n.summary.json")).exists());
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.events("mesh.scored").len(), 1);
}

#[test]
fn a_case_of_openfoam_is_one_mesh_and_each_version_is_scored() {
    let site = Site::new();
    let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/openfoam/mixed_ascii");
    let case = site.path("drop/runs/cavity/constant/polyMesh");
    fs::create_dir_all(&case).expect("a case");
    for name in ["points", "faces", "owner", "neighbour"] {
        fs::copy(mesh.join(name), case.join(name)).expect("copied");
    }
    site.write("drop/runs/cavity/system/controlDict", "FoamFile { class dictionary; }");
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.summaries(), ["runs/cavity.summary.json"]);
    assert_eq!(site.events_of("mesh.scored", "runs/cavity")[0]["elements"], 36);
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.events("mesh.scored").len(), 1);
    fs::copy(mesh.join("points"), site.path("drop/points")).expect("copied");
    fs::rename(site.path("drop/points"), case.join("points")).expect("replaced");
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.events("mesh.scored").len(), 2);
    assert_eq!(site.events("mesh.ignored").len(), 0);
}
