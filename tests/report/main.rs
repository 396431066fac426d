//! The summary's schema, and each report of it.

mod data;
mod hostile;
mod samples;
mod schema;
mod table;

use meshgauge::report::{REPORTS, Style, find};
use meshgauge::summary::Summary;

use samples::mixed;

fn render(name: &str, summaries: &[Summary], style: Style) -> String {
    let mut out = Vec::new();
    (find(name).expect("a report of that name").render)(summaries, &style, &mut out)
        .expect("a vector takes it");
    String::from_utf8(out).expect("text")
}

fn plain(name: &str, summaries: &[Summary]) -> String {
    render(name, summaries, Style::default())
}

#[test]
fn reports_have_names_and_titles() {
    let names: Vec<_> = REPORTS.iter().map(|report| report.name).collect();
    assert_eq!(names, ["table", "json", "jsonl", "csv", "markdown"]);
    assert!(REPORTS.iter().all(|report| !report.title.is_empty() && !report.title.contains('\n')));
    assert!(find("html5").is_none());
}

#[test]
fn what_cannot_be_written_is_an_error() {
    struct Full;
    impl std::io::Write for Full {
        fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::StorageFull.into())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    for report in REPORTS {
        assert!((report.render)(&[mixed()], &Style::default(), &mut Full).is_err(), "{}", report.name);
    }
}
