//! Rules of the verdict, from the configuration to the exit status.
#![cfg(feature = "program")]

use std::process::{Command, Output};

use serde_json::Value;

/// Scores the specimen of the examples under a configuration.
fn score(configuration: &str, arguments: &[&str]) -> (Output, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("meshgauge.toml");
    std::fs::write(&file, configuration).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_meshgauge"))
        .args(["score", "examples/drop/pit-specimen.inp", "--format", "json", "--config"])
        .arg(file)
        .args(arguments)
        .output()
        .expect("the program runs");
    let summary = serde_json::from_slice(&output.stdout).unwrap_or_default();
    (output, summary)
}

fn share_below(limit: f64, share: f64) -> String {
    format!(
        "[verdict]\nrules = [{{ measure = \"M33\", shape = \"tetrahedron\", statistic = \"share below\", \
         limit = {limit:?}, share = {share:?} }}]"
    )
}

/// The limit is no edge of a bin, and one element lies between the two limits of the test.
#[test]
fn a_share_below_a_limit_is_counted_exactly() {
    let (_, summary) = score("", &[]);
    let tetrahedra = &summary["shapes"]["tetrahedron"];
    let (count, worst) =
        (tetrahedra["count"].as_f64().expect("a count"), &tetrahedra["measures"]["M33"]["min"]);
    let worst = worst.as_f64().expect("a minimum");
    let rows = [
        (worst, 0.0, 0, 0),
        (worst.next_up(), 0.0, 1, 1),
        (worst.next_up(), 1.0 / count, 0, 1),
        (worst.next_up(), (1.0 / count).next_down(), 1, 1),
    ];
    for (limit, share, status, below) in rows {
        for threads in ["1", "3"] {
            let (output, summary) = score(&share_below(limit, share), &["--threads", threads]);
            assert_eq!(output.status.code(), Some(status), "{limit} {share}");
            let counted = &summary["shapes"]["tetrahedron"]["measures"]["M33"]["below"];
            assert_eq!(counted, &serde_json::json!({ limit.to_string(): below }), "{limit} {share}");
        }
    }
    let (_, summary) = score(&share_below(0.4, 1e-3), &[]);
    let reason = &summary["verdict"]["reasons"][0];
    let expected = serde_json::json!({
        "rule": "rule 1", "measure": "M33", "shape": "tetrahedron", "value": reason["value"], "limit": 0.001,
        "element": 11746, "statistic": "share below", "threshold": 0.4, "status": "fail",
    });
    assert_eq!(reason, &expected);
    let histogram = tetrahedra["measures"]["M33"]["histogram"].as_array().expect("bins");
    let under: u64 = histogram[..40].iter().filter_map(Value::as_u64).sum();
    assert_eq!(reason["value"].as_f64(), Some(under as f64 / count), "0.4 is an edge of a bin");
}

#[test]
fn a_quantile_of_any_probability_can_be_asked_for() {
    let rule = |limit| {
        format!(
            "[verdict]\nrules = [{{ measure = \"M31\", statistic = \"quantile\", share = 0.25, limit = {limit} }}]"
        )
    };
    let (output, summary) = score(&rule(0.99), &[]);
    let quantiles = &summary["shapes"]["tetrahedron"]["measures"]["M31"]["quantiles"];
    let quarter = quantiles["0.25"].as_f64().expect("it was asked for");
    assert!(quantiles["0.05"].as_f64() < Some(quarter) && Some(quarter) < quantiles["0.5"].as_f64());
    assert_eq!(
        (output.status.code(), &summary["verdict"]["reasons"][0]["value"]),
        (Some(1), &quarter.into())
    );
    assert_eq!(score(&rule(0.5), &[]).0.status.code(), Some(0));
}

#[test]
fn presets_are_chosen_by_name_and_a_wrong_one_is_wrong_usage() {
    let rows = [
        ("--preset", "npl,aspect", "", 0, ""),
        ("--preset", "consol", "", 2, "no preset is named \"consol\"; did you mean \"comsol\"?"),
        ("--threads", "1", "[verdict]\npreset = \"nlp\"", 2, "did you mean \"npl\"?"),
        ("--threads", "1", "[verdict]\nrules = [{ measure = \"M35\", limit = 0.1 }]", 2, "did you mean \"M3"),
        ("--preset", "none", "[verdict]\nrules = [{ measure = \"all\", limit = 0.3 }]", 1, ""),
    ];
    for (option, value, configuration, status, message) in rows {
        let (output, _) = score(configuration, &[option, value]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{value} {configuration}: {said}");
        assert!(said.contains(message), "{value} {configuration}: {said}");
    }
}
