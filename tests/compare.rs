//! `meshgauge compare`: what it reads, prints and exits with.
#![cfg(feature = "program")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

const EXAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/drop/pit-specimen.inp");

fn meshgauge(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshgauge"));
    command.args(arguments).current_dir(folder).env_remove("MESHGAUGE_CONFIG").stdin(Stdio::null());
    command.output().expect("the program runs")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// The specimen with one node moved to just above a face of the element that it belongs to.
#[expect(clippy::disallowed_methods, reason = "the project's own small file")]
fn with_a_sliver() -> String {
    let deck = fs::read_to_string(EXAMPLE).expect("the example");
    let rows = |keyword: &str| {
        let block =
            deck.split("*").find(|block| block.to_lowercase().starts_with(keyword)).expect("the block");
        let lines =
            block.lines().skip(1).map(|line| line.split(',').map(|field| field.trim().to_owned()).collect());
        lines.filter(|row: &Vec<String>| row.len() > 3).collect::<Vec<_>>()
    };
    let (nodes, elements) = (rows("node"), rows("element"));
    let at = |number: &str| {
        let row = nodes.iter().find(|row| row[0] == number).expect("the node");
        [1, 2, 3].map(|i| row[i].parse::<f64>().expect("a coordinate"))
    };
    let corners = &elements[elements.len() / 2][1..5];
    let face = [at(&corners[0]), at(&corners[1]), at(&corners[2])];
    let apex = at(&corners[3]);
    let moved = [0, 1, 2].map(|axis| {
        let middle = (face[0][axis] + face[1][axis] + face[2][axis]) / 3.0;
        middle + 0.02 * (apex[axis] - middle)
    });
    let mut changed = String::new();
    let mut in_nodes = false;
    for line in deck.lines() {
        if line.starts_with('*') {
            in_nodes = line.to_lowercase().starts_with("*node");
        }
        match line.split(',').next() {
            Some(number) if in_nodes && number.trim() == corners[3] => {
                writeln!(changed, "{number}, {}, {}, {}", moved[0], moved[1], moved[2]).expect("text");
            }
            _ => writeln!(changed, "{line}").expect("text"),
        }
    }
    changed
}

/// Two result folders: `mon` and `tue`, in whose `pit` one element has become a sliver.
fn nights() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    for night in ["mon", "tue"] {
        fs::create_dir_all(here.join("drop").join(night)).expect("a folder");
        fs::copy(EXAMPLE, here.join(format!("drop/{night}/other.inp"))).expect("copied");
    }
    fs::copy(EXAMPLE, here.join("drop/mon/pit.inp")).expect("copied");
    fs::write(here.join("drop/tue/pit.inp"), with_a_sliver()).expect("written");
    for night in ["mon", "tue"] {
        let output = meshgauge(here, &["score", &format!("drop/{night}"), "--out", night, "--quiet"]);
        assert!(matches!(output.status.code(), Some(0 | 1)), "{}", text(&output.stderr));
    }
    folder
}

#[test]
fn one_new_sliver_is_a_regression_in_every_format() {
    let folder = nights();
    let run = |arguments: &[&str]| {
        let output = meshgauge(folder.path(), &[&["compare", "mon", "tue"], arguments].concat());
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", text(&output.stderr));
        text(&output.stdout).to_owned()
    };
    let table = run(&[]);
    assert!(table.starts_with("pit  worse\n"), "{table}");
    assert!(table.contains("worse  tetrahedra  M31      min"), "{table}");
    assert!(
        table.contains("other  same  ") && table.ends_with("2 meshes compared: 1 worse, 1 same\n"),
        "{table}"
    );
    let markdown = run(&["--format", "markdown"]);
    assert!(
        markdown.starts_with("### Mesh quality: worse\n")
            && markdown.contains("| worse | tetrahedra | M31 | min |")
    );
    let json: Value = serde_json::from_str(&run(&["--format", "json"])).expect("JSON");
    assert_eq!((&json["schema"], &json["outcome"]), (&"meshgauge.comparison/1".into(), &"worse".into()));
    assert_eq!(json["meshes"][0]["name"], "pit");
    let findings = json["meshes"][0]["findings"].as_array().expect("findings");
    let minimum =
        findings.iter().find(|f| f["measure"] == "M33" && f["statistic"] == "min").expect("a minimum");
    assert_eq!(minimum["outcome"], "worse");
    assert!(minimum["new"].as_f64() < Some(0.1) && minimum["base"].as_f64() > Some(0.2), "{minimum}");
    assert!(minimum["element"].is_u64(), "{minimum}");
    assert_eq!(run(&["--quiet"]), "");
}

#[test]
fn what_got_better_is_no_regression() {
    let folder = nights();
    let output = meshgauge(folder.path(), &["compare", "tue", "mon"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stdout).starts_with("pit  better\n"), "{}", text(&output.stdout));
}

#[test]
fn files_folders_meshes_and_standard_input_go_together() {
    let folder = nights();
    let rows = [
        (["compare", "mon/pit.summary.json", "tue/other.summary.json"], 0),
        (["compare", "mon/pit.summary.json", "tue/pit.summary.json"], 1),
        (["compare", "mon/pit.summary.json", "drop/tue/pit.inp"], 1),
        (["compare", "drop/mon", "drop/tue"], 1),
        (["compare", "mon", "tue/pit.summary.json"], 1),
        (["compare", "mon", "tue/other.summary.json"], 0),
        (["compare", "mon", "mon"], 0),
    ];
    for (arguments, expected) in rows {
        let output = meshgauge(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(expected), "{arguments:?}: {}", text(&output.stderr));
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshgauge"));
    let summary = fs::File::open(folder.path().join("tue/pit.summary.json")).expect("a file");
    command.args(["compare", "mon/pit.summary.json", "-"]).current_dir(folder.path()).stdin(summary);
    assert_eq!(command.output().expect("it runs").status.code(), Some(1));
}

#[test]
fn a_mesh_that_is_gone_is_a_regression_unless_the_set_is_partial() {
    let folder = nights();
    fs::remove_file(folder.path().join("mon/pit.summary.json")).expect("removed");
    let gone = meshgauge(folder.path(), &["compare", "tue", "mon"]);
    assert_eq!(gone.status.code(), Some(1));
    assert!(text(&gone.stdout).contains("pit  gone: only the base has it"), "{}", text(&gone.stdout));
    assert_eq!(meshgauge(folder.path(), &["compare", "tue", "mon", "--partial"]).status.code(), Some(0));
    let added = meshgauge(folder.path(), &["compare", "mon", "tue"]);
    assert_eq!(added.status.code(), Some(0));
    assert!(text(&added.stdout).ends_with("1 mesh compared: 1 same, 1 new\n"), "{}", text(&added.stdout));
}

#[test]
fn the_tolerances_are_those_of_the_configuration() {
    let folder = nights();
    let lenient = "[compare]\nminimum = { absolute = 1 }\nunder = 1e9\nvolume = 1\ndistance = 1\n\
        quantile = { absolute = 1 }\nmean = { absolute = 1 }\nchecks = 1\n";
    fs::write(folder.path().join("lenient.toml"), lenient).expect("written");
    let output = meshgauge(folder.path(), &["compare", "mon", "tue", "--config", "lenient.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stdout));
    fs::write(folder.path().join("wrong.toml"), "[compare]\ndistance = -1\n").expect("written");
    let output = meshgauge(folder.path(), &["compare", "mon", "tue", "--config", "wrong.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("tolerances are numbers from 0 up"), "{}", text(&output.stderr));
}

#[test]
fn what_cannot_be_compared_is_told() {
    let folder = nights();
    fs::create_dir(folder.path().join("empty")).expect("a folder");
    let rows = [
        ("absent.json", "", 3, "meshgauge: absent.json: "),
        ("other.json", "{\"schema\": \"meshgauge.summary/9\"}", 3, "this version reads meshgauge.summary/1"),
        ("cut.json", "{\"schema\": \"meshgauge.summary/1\", ", 3, "cut.json: line 1: expected a summary"),
        ("bytes.json", "{\u{0}", 3, "bytes.json: line 1: expected a summary"),
        ("notes.txt", "remember the milk", 3, "looked for"),
        ("empty", "", 3, "expected summaries or meshes in the folder, found none"),
        ("twice.json", "[]", 2, "no mesh of"),
    ];
    for (name, content, expected, message) in rows {
        if !content.is_empty() {
            fs::write(folder.path().join(name), content).expect("written");
        }
        let output = meshgauge(folder.path(), &["compare", name, "mon"]);
        assert_eq!(output.status.code(), Some(expected), "{name}: {}", text(&output.stderr));
        assert!(text(&output.stderr).contains(message), "{name}: {}", text(&output.stderr));
        assert!(output.stdout.is_empty(), "{name}");
    }
}

#[test]
fn names_out_of_meshes_make_no_structure() {
    let folder = nights();
    for night in ["mon", "tue"] {
        let path = folder.path().join(night).join("pit.summary.json");
        let mut summary: Value =
            serde_json::from_reader(fs::File::open(&path).expect("a file")).expect("a summary");
        summary["mesh"]["name"] = "a|b\u{1b}[2J@all".into();
        summary["mesh"]["path"] = "<script>\n".into();
        fs::write(&path, summary.to_string()).expect("written");
    }
    let (base, new) = ("mon/pit.summary.json", "tue/pit.summary.json");
    for format in ["table", "markdown"] {
        let output = meshgauge(folder.path(), &["compare", base, new, "--format", format]);
        let found = text(&output.stdout);
        assert!(!found.contains('\u{1b}') && !found.contains("<script>\n"), "{found}");
        assert!(format == "table" || !found.contains("a|b") && !found.contains("<script>"), "{found}");
    }
}
