//! The snippets of docs/LOG.md for programs that carry logs: they are sound, and name what the log has.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;
use yaml_rust2::{Yaml, YamlLoader};

use super::{ROOT, nights};

/// The indented block below a heading of docs/LOG.md.
fn snippet(heading: &str) -> String {
    let document = fs::read_to_string(Path::new(ROOT).join("docs/LOG.md")).expect("the document");
    let (_, section) = document.split_once(&format!("\n## {heading}\n")).expect("the heading");
    let lines = section.lines().skip_while(|line| !line.starts_with("    "));
    let block = lines.take_while(|line| line.is_empty() || line.starts_with("    "));
    block.map(|line| line.strip_prefix("    ").unwrap_or_default().to_owned() + "\n").collect()
}

/// A log that a daemon wrote, line by line.
fn log() -> Vec<Value> {
    let folder = nights();
    let log = fs::read_to_string(folder.path().join("results/meshgauge.jsonl")).expect("the log");
    log.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

/// The value of a condition such as `.event == "mesh.regressed"`: field and text.
fn compared(condition: &str) -> (&str, &str) {
    let (field, text) = condition.split_once(" == ").expect("a comparison");
    (field.strip_prefix('.').expect("a field"), text.trim_matches('"'))
}

#[test]
fn the_snippet_for_vector_is_a_chain_from_the_log_to_the_regressions() {
    let snippet: toml::Table = snippet("Vector").parse().expect("TOML");
    let source = &snippet["sources"]["meshgauge"];
    assert_eq!(source["type"].as_str(), Some("file"));
    let file = source["include"][0].as_str().expect("a path");
    assert!(file.ends_with("/meshgauge.jsonl"), "{file}");
    let transforms = snippet["transforms"].as_table().expect("transforms");
    let known: BTreeSet<_> = transforms.keys().map(String::as_str).chain(["meshgauge"]).collect();
    for (name, transform) in transforms {
        let inputs = transform["inputs"].as_array().expect("inputs");
        assert!(inputs.iter().all(|input| known.contains(input.as_str().expect("a name"))), "{name}");
    }
    // A line of a file is the event's `message`, and JSON in itself.
    assert_eq!(transforms["events"]["source"].as_str(), Some(". = parse_json!(string!(.message))"));
    let (field, text) = compared(transforms["regressions"]["condition"].as_str().expect("a condition"));
    let found = log().iter().filter(|line| line[field] == text).count();
    assert_eq!(found, 1, "{field} {text}");
}

#[test]
fn the_snippet_for_promtail_names_fields_that_every_line_has() {
    let documents = YamlLoader::load_from_str(&snippet("Promtail and Alloy")).expect("YAML");
    let job = &documents[0]["scrape_configs"][0];
    let path = job["static_configs"][0]["labels"]["__path__"].as_str().expect("a path");
    assert!(path.ends_with("/meshgauge.jsonl"), "{path}");
    let stages = job["pipeline_stages"].as_vec().expect("stages");
    let stage = |name: &str| {
        stages.iter().map(|stage| &stage[name]).find(|stage| !stage.is_badvalue()).expect("a stage")
    };
    let expressions = stage("json")["expressions"].as_hash().expect("expressions");
    let extracted: BTreeSet<_> = expressions.keys().filter_map(Yaml::as_str).collect();
    let lines = log();
    for field in expressions.values().filter_map(Yaml::as_str) {
        assert!(lines.iter().all(|line| line[field].is_string()), "{field}");
    }
    for label in stage("labels").as_hash().expect("labels").keys().filter_map(Yaml::as_str) {
        assert!(extracted.contains(label), "{label}");
    }
    let time = stage("timestamp");
    assert_eq!(time["format"].as_str(), Some("RFC3339Nano"));
    let field = time["source"].as_str().expect("a field");
    assert!(
        lines.iter().all(|line| humantime::parse_rfc3339(line[field].as_str().unwrap_or_default()).is_ok())
    );
}
