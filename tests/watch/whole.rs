//! When a file is whole: by its producer's word, or when it stands still.

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use crate::daemon::{LONGER, MESH, ONE_WORKER, Site};

/// Longer than any test waits: what is scored before is scored by its producer's word.
const NEVER: [&str; 4] = ["--config", "meshgauge.toml", "--settle", "1h"];

#[test]
fn with_sidecars_a_mesh_waits_for_its_own() {
    let site = Site::new();
    site.write("meshgauge.toml", "[watch]\ndone = \"sidecar\"\nscan = \"100ms\"\n");
    let daemon = site.start(&NEVER);
    site.write("drop/a.msh", MESH);
    site.write("drop/b.msh", MESH);
    daemon.wait_for("mesh.detected", "b.msh");
    sleep(Duration::from_millis(500));
    assert!(site.events("mesh.claimed").is_empty());
    site.write("drop/b.msh.ok", "");
    daemon.wait_for("mesh.scored", "b.msh");
    site.write("drop/a.msh.done", "");
    daemon.wait_for("mesh.scored", "a.msh");
    assert_eq!(site.events("mesh.ignored").len(), 0, "sidecars are no meshes");
    // The sidecar is about the version before.
    site.write("drop/a.msh", LONGER);
    daemon.wait("the new version", || site.events_of("mesh.detected", "a.msh").len() == 2);
    sleep(Duration::from_millis(500));
    assert_eq!(site.events_of("mesh.claimed", "a.msh").len(), 1);
    site.write("drop/a.msh.done", "");
    daemon.wait("its score", || site.events_of("mesh.scored", "a.msh").len() == 2);
}

#[test]
fn with_sidecars_once_leaves_what_has_none() {
    let site = Site::new();
    site.write("meshgauge.toml", "[watch]\ndone = \"sidecar\"\n");
    site.write("drop/a.msh", MESH);
    site.write("drop/b.msh", MESH);
    site.write("drop/b.msh.done", "");
    assert_eq!(site.once(&ONE_WORKER), Some(0));
    assert_eq!(site.summaries(), ["b.summary.json"]);
}

#[test]
fn a_mesh_that_arrives_by_rename_is_whole_where_that_is_agreed() {
    let site = Site::new();
    site.write("meshgauge.toml", "[watch]\ndone = \"rename\"\n[telemetry]\ninterval = \"100ms\"\n");
    let daemon = site.start(&NEVER);
    // Only after its first scan does it hear of what is renamed.
    daemon.wait("the first scan", || {
        let status = site.text("results/.meshgauge/status.json").unwrap_or_default();
        let status: serde_json::Value = serde_json::from_str(&status).unwrap_or_default();
        status["watches"][0]["scans"].as_u64() > Some(0)
    });
    site.write("drop/.a.msh.part", MESH);
    site.write("drop/written.msh", MESH);
    daemon.wait_for("mesh.detected", "written.msh");
    fs::rename(site.path("drop/.a.msh.part"), site.path("drop/a.msh")).expect("renamed");
    daemon.wait_for("mesh.scored", "a.msh");
    assert!(site.events_of("mesh.claimed", "written.msh").is_empty(), "it was not renamed");
}
