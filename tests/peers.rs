//! Peers: meshes from the writers of Gmsh, VTK and meshio are scored as an independent implementation scores them.
//!
//! It needs a Python with the packages of `bench/requirements.txt`, which `MESHGAUGE_PYTHON` names.
#![cfg(feature = "program")]

use std::path::Path;
use std::process::Command;

#[test]
fn meshes_of_gmsh_vtk_and_meshio_are_scored_as_the_reference_scores_them() {
    let Some(python) = std::env::var_os("MESHGAUGE_PYTHON") else {
        eprintln!("SKIPPED: MESHGAUGE_PYTHON names no Python with the packages of bench/requirements.txt");
        return;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/check.py");
    let output = Command::new(&python)
        .arg(script)
        .arg(env!("CARGO_BIN_EXE_meshgauge"))
        .output()
        .unwrap_or_else(|e| panic!("MESHGAUGE_PYTHON, {}: {e}", python.display()));
    let said = String::from_utf8_lossy(&output.stdout);
    let failures: Vec<_> = said.lines().filter(|line| !line.starts_with("ok ")).collect();
    let complaints = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}\n{complaints}", failures.join("\n"));
    eprintln!("{}", failures.join("\n"));
}
