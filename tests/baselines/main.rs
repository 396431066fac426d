//! Baselines of the daemon, the history of scores, and the recipes of docs/LOG.md against the log that tells of them.
#![cfg(feature = "program")]
#![expect(clippy::disallowed_methods, reason = "small files of the project's own, and of this test")]

mod since;
mod snippets;

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Corners 1 to 5: two tetrahedra on one face; the height of the second is 0.7 or, as a sliver, 0.01. The volume of both
/// together stays: a change of it would be told as worse, whichever way.
fn mesh(height: f64) -> String {
    let other = 1.4 - height;
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0.3 0.3 {other}\n5 0.3 0.3 -{height}\n\
         $EndNodes\n$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 3 2 5\n$EndElements\n"
    )
}

fn run(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshgauge"));
    command.args(arguments.split_whitespace()).current_dir(folder).env_remove("MESHGAUGE_CONFIG");
    command.env_remove("STATE_DIRECTORY").stdin(Stdio::null()).output().expect("the program runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// A mesh lands and the daemon scores it.
fn night(folder: &Path, name: &str, content: &str) {
    fs::create_dir_all(folder.join("drop")).expect("a folder");
    fs::write(folder.join("drop").join(name), content).expect("written");
    let output = run(folder, "watch drop --once --settle 50ms --quiet --config c.toml");
    assert!(matches!(output.status.code(), Some(0 | 1 | 3)), "{}", text(&output.stderr));
}

fn events(folder: &Path) -> Vec<(String, String)> {
    let log = fs::read_to_string(folder.join("results/meshgauge.jsonl")).expect("the log");
    let lines = log.lines().map(|line| serde_json::from_str::<Value>(line).expect("JSON"));
    let word = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let found = lines.map(|line| (word(&line["event"]), word(&line["mesh"])));
    found.filter(|(event, _)| event == "mesh.regressed" || event == "mesh.improved").collect()
}

/// Dated meshes of one part: sound, sound but for jitter, a sliver; the sliver is accepted; sound again.
fn nights() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    let pattern = "[baseline]\npattern = '^(.+)-\\d{4}-\\d\\d-\\d\\d$'\n";
    fs::write(here.join("c.toml"), pattern).expect("written");
    night(here, "pit-2026-11-18.msh", &mesh(0.7));
    night(here, "pit-2026-11-19.msh", &mesh(0.702));
    night(here, "pit-2026-11-20.msh", &mesh(0.01));
    night(here, "broken.msh", "$MeshFormat\n2.2 0 8\n");
    folder
}

#[test]
fn a_sliver_is_a_regression_once_the_date_is_stripped_and_accepting_it_moves_the_baseline() {
    let folder = nights();
    let here = folder.path();
    let worse = ("mesh.regressed".to_owned(), "pit-2026-11-20.msh".to_owned());
    assert_eq!(events(here), std::slice::from_ref(&worse));
    let output = run(here, "baseline accept pit --config c.toml");
    assert!(output.status.success(), "{}", text(&output.stderr));
    night(here, "pit-2026-11-21.msh", &mesh(0.01));
    night(here, "pit-2026-11-22.msh", &mesh(0.7));
    let better = ("mesh.improved".to_owned(), "pit-2026-11-22.msh".to_owned());
    assert_eq!(events(here), [worse, better]);
}

#[test]
fn the_facts_of_a_regression_are_flat() {
    let folder = nights();
    let log = fs::read_to_string(folder.path().join("results/meshgauge.jsonl")).expect("the log");
    let line = log.lines().find(|line| line.contains("mesh.regressed")).expect("the event");
    let event: Value = serde_json::from_str(line).expect("JSON");
    assert_eq!(
        (&event["part"], &event["level"], &event["shape"]),
        (&"pit".into(), &"warn".into(), &"tetrahedron".into())
    );
    assert_eq!((&event["statistic"], &event["element"]), (&"min".into(), &2.into()));
    assert!(event["min_M33"].as_f64() < Some(0.1) && event["base_min_M33"].as_f64() > Some(0.3), "{event}");
    assert!(
        event.as_object().expect("an object").values().all(|value| !value.is_object() && !value.is_array())
    );
}

#[test]
fn the_history_has_a_sparkline_csv_and_json() {
    let folder = nights();
    let here = folder.path();
    let table = text(&run(here, "history pit --measure M33 --config c.toml").stdout);
    assert!(table.starts_with("3 scored from 20") && table.lines().count() == 3, "{table}");
    let bars: String = table.chars().filter(|c| ('▁'..='█').contains(c)).collect();
    assert_eq!((bars.chars().count(), bars.chars().last()), (3, Some('▁')), "{table}");
    let csv = text(&run(here, "history pit --format csv --config c.toml").stdout);
    assert!(csv.starts_with("scored,mesh,verdict,") && csv.lines().count() == 1 + 3 * 4, "{csv}");
    let json: Value =
        serde_json::from_slice(&run(here, "history pit --format json --config c.toml").stdout).expect("JSON");
    assert_eq!((json.as_array().map(Vec::len), &json[0]["mesh"]), (Some(12), &"pit-2026-11-18.msh".into()));
    let since: Value =
        serde_json::from_slice(&run(here, "history pit --since 1h --format json --config c.toml").stdout)
            .expect("JSON");
    assert_eq!(since.as_array().map(Vec::len), Some(12));
}

#[test]
fn what_is_not_known_is_told() {
    let folder = nights();
    let rows = [
        ("history pt --config c.toml", "did you mean pit?"),
        ("baseline accept other --config c.toml", "no mesh of a part named other was scored"),
        ("history pit --state elsewhere", "expected the state of a daemon, found none"),
        ("history pit --measure M99 --config c.toml", "M99"),
    ];
    for (arguments, message) in rows {
        let output = run(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", text(&output.stderr));
        assert!(text(&output.stderr).contains(message), "{arguments}: {}", text(&output.stderr));
    }
    fs::write(folder.path().join("wrong.toml"), "[baseline]\npattern = 'job'\n").expect("written");
    let output = run(folder.path(), "history pit --config wrong.toml");
    assert!(
        text(&output.stderr).contains("baseline.pattern: expected a capture"),
        "{}",
        text(&output.stderr)
    );
}

#[test]
fn every_recipe_finds_something_in_a_log_of_the_daemon() {
    if Command::new("jq").arg("--version").output().is_err() {
        eprintln!("skipped: there is no jq");
        return;
    }
    let folder = nights();
    let document = fs::read_to_string(Path::new(ROOT).join("docs/LOG.md")).expect("the document");
    let recipes: Vec<_> = document
        .lines()
        .filter_map(|line| line.strip_prefix("    "))
        .filter(|line| line.starts_with("jq ") || line.contains("| jq "))
        .collect();
    assert!(recipes.len() >= 7, "{recipes:?}");
    for recipe in recipes {
        let results = folder.path().join("results");
        let output = Command::new("sh").args(["-c", recipe]).current_dir(results).output().expect("it runs");
        assert!(output.status.success() && !output.stdout.is_empty(), "{recipe}: {}", text(&output.stderr));
    }
}

#[test]
fn the_dashboard_names_only_metrics_that_there_are() {
    let read = |name: &str| fs::read_to_string(Path::new(ROOT).join("docs").join(name)).expect("a document");
    let (dashboard, metrics) = (read("grafana.json"), read("METRICS.md"));
    let dashboard: Value = serde_json::from_str(&dashboard).expect("JSON");
    let mut known = 0;
    for target in
        dashboard["panels"].as_array().expect("panels").iter().flat_map(|panel| panel["targets"].as_array())
    {
        for expression in target.iter().filter_map(|target| target["expr"].as_str()) {
            let words = expression.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            for name in words.filter(|word| word.starts_with("meshgauge_")) {
                let name = name.trim_end_matches("_bucket");
                assert!(metrics.contains(&format!("| `{name}` |")), "{name}");
                known += 1;
            }
        }
    }
    assert!(known > 9);
}
