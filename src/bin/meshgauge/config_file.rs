//! The configuration file: its text, and what is wrong with it in words that name the line and the nearest known key.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::config::Config;
use crate::nearest::nearest;

/// The documented configuration file: every setting with its default.
pub const DOCUMENTED: &str = include_str!("../../../config/meshgauge.toml");

/// Larger files are no configuration.
const LARGEST: u64 = 1 << 20;

/// The text of the file at `path`.
pub fn read(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    io::copy(&mut File::open(path)?.take(LARGEST), &mut bytes)?;
    String::from_utf8(bytes).map_err(|e| io::Error::new(io::ErrorKind::InvalidData, e))
}

/// The configuration in `text`, or what is wrong with it and in which line.
pub fn parse(text: &str) -> Result<Config, String> {
    toml::from_str(text).map_err(|error| {
        let line = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count());
        format!("line {line}: {}", explain(error.message()))
    })
}

/// The parser's message, with the nearest known key where a key is unknown.
fn explain(message: &str) -> String {
    let Some(rest) = message.strip_prefix("unknown field `") else { return message.to_owned() };
    let mut names = rest.split('`').step_by(2);
    let unknown = names.next().unwrap_or_default();
    let here: Vec<&str> = names.filter(|name| !name.is_empty()).collect();
    if let Some(table) = table_of(unknown) {
        return format!("unknown setting `{unknown}` here; it belongs to [{table}]");
    }
    match nearest(unknown, here.iter().copied()) {
        Some(near) => format!("unknown setting `{unknown}`; did you mean `{near}`?"),
        None => format!("unknown setting `{unknown}`; known here are {}", here.join(", ")),
    }
}

/// The table that has a setting of this name.
fn table_of(setting: &str) -> Option<String> {
    let tables: toml::Table = DOCUMENTED.parse().ok()?;
    tables.into_iter().find_map(|(name, table)| table.get(setting).is_some().then_some(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_documented_file_holds_every_setting_and_its_default() {
        assert_eq!(parse(DOCUMENTED), Ok(Config::default()));
        let documented: toml::Table = DOCUMENTED.parse().expect("it parsed above");
        let known = toml::Table::try_from(Config::default()).expect("settings have TOML values");
        for (table, settings) in &known {
            let here: Vec<_> = settings.as_table().expect("tables only").keys().collect();
            let there: Vec<_> = documented[table].as_table().expect("tables only").keys().collect();
            assert_eq!(here, there, "[{table}]");
        }
    }

    #[test]
    fn an_unknown_key_names_its_line_and_the_nearest_known_one() {
        let cases = [
            ("[watch]\nsetle = \"2s\"", "line 2: unknown setting `setle`; did you mean `settle`?"),
            ("[wach]\n", "line 1: unknown setting `wach`; did you mean `watch`?"),
            ("[score]\nsettle = \"2s\"", "line 2: unknown setting `settle` here; it belongs to [watch]"),
        ];
        for (text, expected) in cases {
            assert_eq!(parse(text), Err(expected.to_owned()));
        }
    }

    #[test]
    fn a_wrong_value_says_what_is_expected() {
        let error = parse("[score]\n\nmemory = \"lots\"").expect_err("lots is no size");
        assert_eq!(error, "line 3: expected a size such as 256MiB, found \"lots\"");
    }

    #[test]
    fn settings_that_contradict_each_other_are_refused() {
        let config = parse("[worker]\nmemory = \"100MiB\"").expect("well-formed");
        assert!(config.check().is_err_and(|e| e.0.contains("worker.memory (100.0 MiB)")));
    }
}
