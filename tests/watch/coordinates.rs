//! Some meshes of a drop in axes of their own.

use crate::daemon::{MESH, Site};

#[test]
fn a_row_of_the_configuration_measures_the_meshes_that_fit_it_in_other_axes() {
    let site = Site::new();
    site.write(
        "meshgauge.toml",
        "[watch]\nrules = [{ mesh = \"flat/*\", stretch = [1.0, 1.0, 0.01] }, { mesh = \"*\", frame = \"cartesian\" }]\n",
    );
    site.write("drop/flat/a.msh", MESH);
    site.write("drop/a.msh", MESH);
    let status = site.command(&["--once", "--config", "meshgauge.toml"]).status().expect("it runs");
    assert!(status.success());
    let least = |mesh| site.events_of("mesh.scored", mesh)[0]["min_M31"].as_f64().expect("a number");
    assert!(least("flat/a.msh") < 0.1 && least("a.msh") > 0.7, "{} {}", least("flat/a.msh"), least("a.msh"));
    let summary = std::fs::File::open(site.path("results/flat/a.summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_reader(summary).expect("JSON");
    assert_eq!(summary["frame"]["stretch"][2], 0.01, "the summary names the axes");
}

#[test]
fn a_row_that_makes_no_sense_is_refused_with_its_number() {
    let site = Site::new();
    let rows = [
        (
            "{ mesh = \"a\", stretch = [1.0, 0.0, 1.0] }",
            "watch.rules, row 1: stretch must be three numbers over 0",
        ),
        ("{ mesh = \"\" }", "watch.rules, row 1: mesh must be"),
        ("{ mesh = \"a\", frame = \"polar\" }", "cylindrical"),
        ("{ mesh = \"a\", strech = [1.0, 1.0, 1.0] }", "stretch"),
    ];
    for (row, message) in rows {
        site.write("meshgauge.toml", &format!("[watch]\nrules = [{row}]\n"));
        let output = site.command(&["--once", "--config", "meshgauge.toml"]).output().expect("it runs");
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(message), "{row}: {told}");
    }
}
