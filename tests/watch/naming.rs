//! Where results go.

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use crate::daemon::{LONGER, MESH, Site};

#[test]
fn meshes_of_one_name_keep_their_extensions() {
    let site = Site::new();
    site.write("drop/pit.msh", MESH);
    site.write("drop/pit.inp", LONGER);
    site.write("drop/sub/pit.msh", MESH);
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.summaries(), ["pit.inp.summary.json", "pit.msh.summary.json", "sub/pit.summary.json"]);
}

#[test]
fn names_do_not_depend_on_who_came_first() {
    for (first, second) in [("pit.msh", "pit.inp"), ("pit.inp", "pit.msh")] {
        let site = Site::new();
        site.write(&format!("drop/{first}"), MESH);
        assert_eq!(site.once(&[]), Some(0));
        assert_eq!(site.summaries(), ["pit.summary.json"]);
        site.write(&format!("drop/{second}"), LONGER);
        assert_eq!(site.once(&[]), Some(0));
        assert_eq!(site.summaries(), ["pit.inp.summary.json", "pit.msh.summary.json"]);
        assert_eq!(site.summary(&format!("{first}.summary.json"))["mesh"]["path"], format!("drop/{first}"));
        assert_eq!(site.summary(&format!("{second}.summary.json"))["mesh"]["path"], format!("drop/{second}"));
        assert_eq!(site.events("mesh.scored").len(), 2);
    }
}

#[test]
fn results_within_the_drop_are_not_scanned() {
    let site = Site::new();
    site.write("drop/a.msh", MESH);
    // A mesh that somebody put among the results.
    site.write("drop/results/old.msh", MESH);
    let options = ["--results", "drop/results", "--log", "drop/log.jsonl", "--state", "drop/state"];
    let command = || site.command(&options).arg("--once").status().expect("the program runs").code();
    assert_eq!((command(), command()), (Some(0), Some(0)));
    assert!(site.path("drop/results/a.summary.json").exists());
    assert!(!site.path("drop/results/results").exists());
    fs::create_dir(site.path("results")).expect("a folder");
    fs::rename(site.path("drop/log.jsonl"), site.path("results/meshgauge.jsonl")).expect("the log is there");
    let meshes: Vec<_> =
        site.log().iter().filter_map(|line| line["mesh"].as_str().map(String::from)).collect();
    assert_eq!(meshes, ["a.msh"; 3], "detected, claimed, scored");
}

#[test]
fn a_daemon_at_rest_writes_nothing() {
    let site = Site::new();
    site.write("meshgauge.toml", "[watch]\nscan = \"50ms\"");
    site.write("drop/a.msh", MESH);
    site.write("drop/notes.txt", "no mesh");
    let daemon = site.start(&["--config", "meshgauge.toml"]);
    daemon.wait_for("mesh.scored", "a.msh");
    daemon.wait_for("mesh.ignored", "notes.txt");
    let lines = site.log().len();
    sleep(Duration::from_millis(500));
    assert_eq!(site.log().len(), lines);
}
