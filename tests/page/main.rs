//! The HTML page: what it holds, and how a real browser takes it.
//!
//! The browser is Chromium, driven by playwright-core through Node; `MESHGAUGE_CHROMIUM` and `MESHGAUGE_PLAYWRIGHT` say
//! where they are, and the test says aloud when they do not.
#![cfg(feature = "program")]

#[cfg(feature = "png")]
mod png;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;
use tempfile::TempDir;

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/drop");

fn meshgauge(folder: &Path, arguments: &[&str]) -> std::process::Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshgauge"));
    command.args(arguments).current_dir(folder).env_remove("MESHGAUGE_CONFIG").stdin(Stdio::null());
    command.output().expect("the program runs")
}

fn summary(path: &Path) -> Value {
    serde_json::from_reader(fs::File::open(path).expect("a summary")).expect("JSON")
}

/// Two nights of the examples; in the second one element has fallen to a score of 0.01, and names are hostile.
fn nights() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for night in ["monday", "tuesday"] {
        let output = meshgauge(folder.path(), &["score", EXAMPLES, "--out", night, "--quiet"]);
        assert!(output.status.success(), "{output:?}");
    }
    let path = folder.path().join("tuesday/pit-specimen.summary.json");
    let mut worse = summary(&path);
    worse["mesh"]["path"] = "\"><script>alert(1)</script><img src=x onerror=alert(2)>".into();
    let measure = &mut worse["shapes"]["tetrahedron"]["measures"]["M33"];
    measure["min"] = 0.01.into();
    measure["histogram"][1] = 1.into();
    fs::write(&path, worse.to_string()).expect("written");
    let mut hostile = worse;
    hostile["mesh"]["name"] = "</svg></title><script>alert(3)</script>\u{1b}[2J & 'x' {{ version }}".into();
    fs::write(folder.path().join("hostile.json"), hostile.to_string()).expect("written");
    folder
}

#[expect(clippy::disallowed_methods, reason = "the page that was just written")]
fn page(folder: &Path, arguments: &[&str]) -> (PathBuf, String) {
    let output = meshgauge(folder, &[&["report", "-o", "out/page.html"], arguments].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let path = folder.join("out/page.html");
    let text = fs::read_to_string(&path).expect("the page");
    // The template engine writes a slash as a reference; that is the same text.
    (path, text.replace("&#x2f;", "/"))
}

#[test]
fn verdicts_and_changes_come_first_then_figures_and_tables() {
    let folder = nights();
    let (_, page) = page(folder.path(), &["monday", "tuesday", "--published", "6", "--title", "Pits & bars"]);
    assert!(page.contains("<title>Pits &amp; bars</title>"));
    let places: Vec<_> =
        ["id=\"verdicts\"", "id=\"changes\"", "id=\"figures\"", "id=\"sizes\"", "id=\"checks\""]
            .map(|part| page.find(part).unwrap_or_else(|| panic!("no {part}")))
            .into();
    assert!(places.is_sorted(), "{places:?}");
    for expected in [
        "monday/pit-specimen",
        "tuesday/pit-specimen",
        "<b>1</b> got worse",
        "Minimum of each measure",
        "Cumulative distribution of M33, Tetrahedra",
        "NPL 6 (2007)",
        "Hexahedra, quadrilateral faces",
    ] {
        assert!(page.contains(expected), "no {expected}");
    }
}

#[test]
fn the_page_names_nothing_outside_itself() {
    let folder = nights();
    let (_, page) = page(folder.path(), &["monday", "hostile.json"]);
    for forbidden in ["http://", "https://", "src=\"", "@import", "url("] {
        assert!(!page.contains(forbidden), "{forbidden}");
    }
    assert_eq!(page.matches("<script>").count(), 1);
    assert!(page.contains("&lt;script&gt;alert(3)"), "the name is told, escaped");
    assert!(!page.contains('\u{1b}') && page.contains("{{ version }}"));
}

#[test]
fn a_base_takes_the_place_of_the_night_before() {
    let folder = nights();
    let (_, same) = page(folder.path(), &["monday", "--base", "monday"]);
    assert!(same.contains("<b>0</b> got worse") && same.contains("every statistic of every mesh"));
    let (_, worse) = page(folder.path(), &["tuesday", "--base", "monday"]);
    assert!(worse.contains("<b>1</b> got worse"));
    let (_, alone) = page(folder.path(), &["monday"]);
    assert!(!alone.contains("id=\"changes\""));
}

#[test]
fn figures_stand_alone() {
    let folder = nights();
    page(folder.path(), &["monday", "hostile.json", "--figures", "figures"]);
    let mut names: Vec<_> = fs::read_dir(folder.path().join("figures"))
        .expect("the folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    names.sort();
    assert!(names.iter().any(|path| path.ends_with("Tetrahedra-minimum.svg")), "{names:?}");
    assert!(names.iter().any(|path| path.ends_with("sizes.svg")), "{names:?}");
    for path in names.iter().filter(|path| path.extension().is_some_and(|end| end == "svg")) {
        let mut reader = quick_xml::Reader::from_file(path).expect("a file");
        let mut buffer = Vec::new();
        loop {
            match reader.read_event_into(&mut buffer) {
                Ok(quick_xml::events::Event::Eof) => break,
                Ok(_) => buffer.clear(),
                Err(error) => panic!("{}: {error}", path.display()),
            }
        }
    }
}

#[test]
fn an_unknown_mesh_of_2007_is_told() {
    let folder = nights();
    let output = meshgauge(folder.path(), &["report", "monday", "--published", "FD2"]);
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(message.contains("has no mesh \"FD2\"; did you mean FD1?"), "{message}");
}

/// What the browser saw, or `None` where there is no browser.
fn browse(page: &Path) -> Option<Value> {
    let places = ["MESHGAUGE_CHROMIUM", "MESHGAUGE_PLAYWRIGHT"].map(std::env::var_os);
    if places.iter().any(Option::is_none) {
        eprintln!("skipped: MESHGAUGE_CHROMIUM and MESHGAUGE_PLAYWRIGHT name no browser");
        return None;
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/page/browse.mjs");
    let output = Command::new("node").arg(script).arg(page).output().expect("node runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).expect("JSON"))
}

fn numbers(seen: &Value) -> Vec<f64> {
    let texts = seen.as_array().expect("a column").iter();
    texts.map(|text| text.as_str().and_then(|text| text.parse().ok()).expect("a number")).collect()
}

fn holds(seen: &Value) {
    assert_eq!((&seen["errors"], &seen["requests"]), (&serde_json::json!([]), &serde_json::json!([])));
    assert_eq!((&seen["scripts"], &seen["markup"], &seen["unsized"]), (&1.into(), &0.into(), &0.into()));
    let ascending = numbers(&seen["ascending"]);
    assert!(ascending.is_sorted() && ascending.len() > 2, "{ascending:?}");
    assert!(numbers(&seen["descending"]).iter().rev().is_sorted());
    assert_eq!((&seen["cumulativeBefore"], &seen["cumulativeAfter"]), (&false.into(), &true.into()));
    assert!(seen["picked"].as_u64() > Some(0), "pointing at a row brings out its marks");
    assert_ne!(seen["light"], seen["dark"]);
    assert_eq!((&seen["switched"], &seen["printed"]), (&seen["dark"], &seen["light"]));
    assert_eq!(seen["phone"], 0, "nothing but tables and figures scrolls sideways");
    assert_eq!(seen["withoutScript"], true);
}

#[test]
fn a_real_browser_shows_and_sorts_it_and_asks_for_nothing() {
    let folder = nights();
    let (path, _) = page(folder.path(), &["monday", "tuesday", "hostile.json", "--published", "6"]);
    let Some(seen) = browse(&path) else { return };
    holds(&seen);
    assert_eq!(seen["filtered"], 1, "{}", seen["names"]);
}

#[test]
fn two_hundred_meshes_stay_usable() {
    let folder = nights();
    let pit = summary(&folder.path().join("monday/pit-specimen.summary.json"));
    let many: Vec<Value> = (0..200)
        .map(|i| {
            let mut one = pit.clone();
            one["mesh"]["name"] = format!("specimen-{i:03}").into();
            one["shapes"]["tetrahedron"]["measures"]["M33"]["min"] = (0.05 + 0.001 * f64::from(i)).into();
            one
        })
        .collect();
    fs::write(folder.path().join("many.json"), Value::from(many).to_string()).expect("written");
    let (path, page) = page(folder.path(), &["many.json"]);
    assert!(page.len() < 8 << 20, "{} bytes", page.len());
    let Some(seen) = browse(&path) else { return };
    holds(&seen);
    assert_eq!(numbers(&seen["ascending"]).len(), 200);
}
