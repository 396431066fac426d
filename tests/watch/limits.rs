//! Each limit has its own reason.

use serde_json::json;

use crate::daemon::{MESH, ONE_WORKER, Site};

/// A limit's setting, its value, and the kind of the failure of a mesh that passes it.
const LIMITS: &[(&str, &str, &str)] = &[
    ("file_bytes", "\"100\"", "limit_file_bytes"),
    ("unpacked_bytes", "\"100\"", "limit_unpacked_bytes"),
    ("unpacked_ratio", "2", "limit_unpacked_ratio"),
    ("line_bytes", "\"1KiB\"", "limit_line_bytes"),
    ("include_depth", "1", "limit_include_depth"),
    ("include_count", "1", "limit_include_count"),
];

/// Bytes packed by gzip.
fn gzip(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    packer.write_all(bytes).and_then(|()| packer.finish()).expect("packed")
}

/// A file that passes the limit, with what it needs beside it.
fn write_mesh(site: &Site, limit: &str) -> &'static str {
    match limit {
        "unpacked_bytes" => {
            std::fs::write(site.path("drop/a.msh.gz"), gzip(MESH.as_bytes())).expect("written");
            "a.msh.gz"
        }
        "unpacked_ratio" => {
            // The ratio counts once 64 MiB have come out.
            let padded = format!("{MESH}$Comments\n{}\n$EndComments\n", "x\n".repeat(40 << 20));
            std::fs::write(site.path("drop/a.msh.gz"), gzip(padded.as_bytes())).expect("written");
            "a.msh.gz"
        }
        "include_depth" | "include_count" => {
            site.write(
                "drop/a.inp",
                "*NODE\n1, 0., 0., 0.\n*INCLUDE, INPUT=b.part\n*INCLUDE, INPUT=c.part\n",
            );
            site.write("drop/b.part", "*INCLUDE, INPUT=d.part\n");
            site.write("drop/c.part", "*NODE\n2, 0., 0., 0.\n");
            site.write("drop/d.part", "*NODE\n3, 0., 0., 0.\n");
            "a.inp"
        }
        "line_bytes" => {
            site.write("drop/a.inp", &format!("*NODE, NSET={}\n1, 0., 0., 0.\n", "N".repeat(3 << 20)));
            "a.inp"
        }
        _ => {
            site.write("drop/a.msh", MESH);
            "a.msh"
        }
    }
}

#[test]
fn each_limit_that_is_passed_is_named() {
    for &(limit, value, kind) in LIMITS {
        let site = Site::new();
        site.write("meshgauge.toml", &format!("[limits]\n{limit} = {value}\n"));
        let mesh = write_mesh(&site, limit);
        assert_eq!(site.once(&ONE_WORKER), Some(3), "{limit}");
        let failed = site.events_of("mesh.failed", mesh).pop().expect("it fails");
        assert_eq!(failed["kind"], json!(kind), "{failed}");
        assert!(
            failed["reason"].as_str().is_some_and(|reason| reason.contains("over the limit")),
            "{failed}"
        );
    }
}

#[test]
fn a_worker_that_is_out_of_memory_ends_though_backtraces_are_asked_for() {
    let site = Site::new();
    site.write("meshgauge.toml", "[score]\nmemory = \"1MiB\"\nthreads = 64\n[worker]\nmemory = \"4MiB\"");
    site.write("drop/a.msh", MESH);
    let mut command = site.command(&ONE_WORKER);
    let status = command.arg("--once").env("RUST_BACKTRACE", "1").status().expect("the program runs");
    assert!(matches!(status.code(), Some(3 | 4)), "{status}");
    let failed = site.events_of("mesh.failed", "a.msh").pop().expect("it fails");
    assert!(matches!(failed["kind"].as_str(), Some("memory" | "resource" | "worker_died")), "{failed}");
}
