//! Files of single elements.
#![cfg(feature = "program")]
#![expect(clippy::disallowed_methods, reason = "small files of the test's own are read whole")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshgauge"));
    command.arg("score").args(arguments).current_dir(folder).output().expect("the program runs")
}

/// The rows of a CSV file without quotes, each by the name of its column.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(path).expect("it was written");
    let mut lines = text.lines();
    let names: Vec<_> = lines.next().expect("a header").split(',').map(String::from).collect();
    lines.map(|line| names.iter().cloned().zip(line.split(',').map(String::from)).collect()).collect()
}

fn meshes() -> Vec<PathBuf> {
    let names = [
        "examples/drop/pit-specimen.inp",
        "examples/drop/cylinder-hex.vtu",
        "tests/meshes/gmsh/mixed_hex_prism_41.msh",
        "tests/meshes/gmsh/pit2d_41_bin.msh",
        "tests/meshes/vtk/all_51_binary.vtk",
    ];
    names.map(|name| root().join(name)).to_vec()
}

#[test]
fn elements_add_up_to_the_summary_for_any_number_of_threads() {
    let folder = tempfile::tempdir().expect("a folder");
    for mesh in meshes() {
        let mesh = mesh.to_str().expect("UTF-8");
        let (file, again) = (folder.path().join("a.csv"), folder.path().join("b.csv"));
        let output =
            run(folder.path(), &[mesh, "--format", "json", "--per-element", "a.csv", "--threads", "1"]);
        let summary: Value =
            serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}: {output:?}"));
        run(folder.path(), &[mesh, "--quiet", "--per-element", "b.csv", "--threads", "5", "--memory", "0B"]);
        assert_eq!(fs::read(&file).expect("written"), fs::read(&again).expect("written"), "{mesh}");
        let rows = rows(&file);
        for (shape, found) in summary["shapes"].as_object().expect("shapes") {
            let rows: Vec<_> = rows.iter().filter(|row| row["shape"] == *shape).collect();
            assert_eq!(rows.len() as u64, found["count"].as_u64().expect("a count"), "{mesh}");
            for (code, measure) in found["measures"].as_object().expect("measures") {
                let values = || rows.iter().map(|row| row[code].parse::<f64>().expect("a number"));
                let least = values().fold(f64::INFINITY, f64::min);
                assert_eq!(Some(least), measure["min"].as_f64(), "{mesh} {code}");
                let first = values().position(|value| value == least).expect("it is there");
                assert_eq!(rows[first]["element"], measure["min_element"].to_string(), "{mesh} {code}");
                if measure["on"] == "element" {
                    let mean = values().sum::<f64>() / rows.len() as f64;
                    assert!(
                        (mean - measure["mean"].as_f64().expect("a mean")).abs() < 1e-12,
                        "{mesh} {code}"
                    );
                }
            }
        }
    }
}

#[test]
fn elements_of_several_shapes_stand_in_the_order_of_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = root().join("tests/meshes/vtk/all_51_binary.vtk");
    run(folder.path(), &[mesh.to_str().expect("UTF-8"), "--quiet", "--per-element", "a.csv"]);
    let rows = rows(&folder.path().join("a.csv"));
    let numbers: Vec<u64> = rows.iter().map(|row| row["element"].parse().expect("a number")).collect();
    assert!(numbers.is_sorted(), "{numbers:?}");
    let shapes: Vec<_> = rows.iter().map(|row| row["shape"].as_str()).collect();
    assert!(shapes.windows(2).filter(|pair| pair[0] != pair[1]).count() > 1, "{shapes:?}");
    assert!(rows.iter().filter(|row| row["shape"] == "triangle").all(|row| row["M31"].is_empty()));
}

#[test]
fn only_elements_under_a_limit_are_written_if_so_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = root().join("examples/drop/pit-specimen.inp");
    let mesh = mesh.to_str().expect("UTF-8");
    run(folder.path(), &[mesh, "--quiet", "--per-element", "all.csv", "--measures", "M33"]);
    run(folder.path(), &[mesh, "--quiet", "--per-element", "bad.csv", "--measures", "M33", "--below", "0.4"]);
    let all = rows(&folder.path().join("all.csv"));
    let under = |row: &&BTreeMap<String, String>| row["M33"].parse::<f64>().expect("a number") < 0.4;
    let expected: Vec<_> = all.iter().filter(under).cloned().collect();
    assert_eq!(rows(&folder.path().join("bad.csv")), expected);
    assert!(!expected.is_empty() && expected.len() < all.len() && !all[0].contains_key("M31"));
}

#[test]
fn wrong_usage_and_a_bad_mesh_leave_no_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = root().join("examples/drop/pit-specimen.inp");
    let mesh = mesh.to_str().expect("UTF-8");
    let text = fs::read_to_string(mesh).expect("a deck");
    fs::write(folder.path().join("cut.inp"), &text[..text.len() / 2 + 3]).expect("written");
    let rows: [(&[&str], i32, &str); 6] = [
        (&[mesh, "--per-element", "a.txt"], 2, "expected a file of single elements (.csv"),
        (&[mesh, mesh, "--per-element", "a.csv"], 2, "of one mesh"),
        (&[mesh, "--below", "0.1"], 2, "--per-element"),
        (&[mesh, "--per-element", "absent/a.vtu"], 4, "absent/a.vtu"),
        (&["cut.inp", "--per-element", "a.csv"], 3, "cut.inp"),
        (&["cut.inp", "--per-element", "a.vtu"], 3, "cut.inp"),
    ];
    for (arguments, status, message) in rows {
        let output = run(folder.path(), arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {said}");
        assert!(said.contains(message), "{arguments:?}: {said}");
    }
    let left: Vec<_> =
        fs::read_dir(folder.path()).expect("a folder").flatten().map(|e| e.file_name()).collect();
    assert_eq!(left, ["cut.inp"]);
}

/// It needs a Python with the packages of `bench/requirements.txt`, which `MESHGAUGE_PYTHON` names.
#[test]
fn vtk_pyarrow_and_duckdb_read_what_was_written() {
    let Some(python) = std::env::var_os("MESHGAUGE_PYTHON") else {
        eprintln!("SKIPPED: MESHGAUGE_PYTHON names no Python with the packages of bench/requirements.txt");
        return;
    };
    let has = Command::new(&python).args(["-c", "import vtk, pyarrow, duckdb"]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: the Python that MESHGAUGE_PYTHON names has not vtk, pyarrow and duckdb");
        return;
    }
    let mut command = Command::new(&python);
    command.arg(root().join("tests/peers/elements.py")).arg(env!("CARGO_BIN_EXE_meshgauge")).args(meshes());
    let output = command.output().expect("Python runs");
    let said = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{}\n{}", said.0, said.1);
    assert_eq!(said.0.lines().filter(|line| line.starts_with("ok ")).count(), 3 * meshes().len());
}
