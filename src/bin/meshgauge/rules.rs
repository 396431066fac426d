//! The verdict's rules as users write them: rows of the configuration, and presets by name.

use meshgauge::mesh::Shape;
use meshgauge::summary::{self, Checks, PRESETS, Rule, STATISTICS, Statistic, Status, Subject};
use serde::{Deserialize, Serialize};

use crate::exit::Usage;
use crate::nearest::nearest;
use crate::selection;

/// One row of `verdict.rules`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// What the reason calls the rule; `rule 1` and so on without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// A measure's code, `all`, or a check's name.
    pub measure: String,
    /// A shape; all that have the measure without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<String>,
    /// One of [`STATISTICS`]; `min` without it, `count` for a check.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub statistic: Option<String>,
    /// The limit.
    pub limit: f64,
    /// The share that may be under the limit, or a quantile's probability.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
    /// The number of values that may be under the limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u64>,
    /// `fail`, or `warn`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub status: Option<String>,
}

/// The rules that the rows make.
pub fn rules(rows: &[Row]) -> Result<Vec<Rule>, Usage> {
    let number = |i: usize| format!("rule {}", i + 1);
    rows.iter()
        .enumerate()
        .map(|(i, row)| {
            rule(row, number(i)).map_err(|e| Usage(format!("verdict.rules: {}: {}", number(i), e.0)))
        })
        .collect()
}

fn rule(row: &Row, number: String) -> Result<Rule, Usage> {
    let subject = subject(&row.measure)?;
    let is_check = matches!(subject, Subject::Check(_));
    let statistic = statistic(row, is_check)?;
    let limit = row.limit;
    let largest = if is_check { f64::MAX } else { 1.0 };
    if !(0.0..=largest).contains(&limit) {
        let range = if is_check { "of 0 or more" } else { "from 0 to 1" };
        return Err(Usage(format!("expected a limit {range}, found {limit}")));
    }
    let shape = row.shape.as_deref().map(shape).transpose()?;
    if let (true, Some(shape)) = (is_check, shape) {
        return Err(Usage(format!("a check is of the whole mesh, and has no shape; found {shape}")));
    }
    let status = match row.status.as_deref() {
        None => Status::Fail,
        Some(name) => [Status::Fail, Status::Warn]
            .into_iter()
            .find(|status| status.name() == name)
            .ok_or_else(|| unknown("status", name, &["fail", "warn"]))?,
    };
    let name = row.name.clone().unwrap_or(number);
    Ok(Rule { name: name.into(), subject, shape, statistic, limit, status })
}

fn subject(name: &str) -> Result<Subject, Usage> {
    if name == "all" {
        return Ok(Subject::AllMeasures);
    }
    if let Some(check) = Checks::NAMES.iter().find(|check| **check == name) {
        return Ok(Subject::Check((*check).into()));
    }
    let known = || selection::codes().into_iter().chain(["all"]).chain(Checks::NAMES.iter().copied());
    selection::known(name)
        .map(|code| Subject::Measure(code.into()))
        .map_err(|_| unknown("measure or check", name, &known().collect::<Vec<_>>()))
}

fn statistic(row: &Row, is_check: bool) -> Result<Statistic, Usage> {
    let name = row.statistic.as_deref().unwrap_or(if is_check { "count" } else { "min" });
    let share = || row.share.filter(|share| (0.0..1.0).contains(share));
    let probability = || share().filter(|share| *share > 0.0);
    let wants = |what: &str| Usage(format!("the statistic \"{name}\" wants {what}"));
    let statistic = match name {
        "min" => Statistic::Min,
        "max" => Statistic::Max,
        "mean" => Statistic::Mean,
        "count" => Statistic::Count,
        "quantile" => Statistic::Quantile(
            probability().ok_or_else(|| wants("a share over 0 and under 1: its probability"))?,
        ),
        "share below" => Statistic::ShareBelow(
            share().ok_or_else(|| wants("the share that is allowed, from 0 to under 1"))?,
        ),
        "count below" => Statistic::CountBelow(row.count.ok_or_else(|| wants("the count that is allowed"))?),
        other => return Err(unknown("statistic", other, &STATISTICS)),
    };
    let takes_share = matches!(statistic, Statistic::Quantile(_) | Statistic::ShareBelow(_));
    let takes_count = matches!(statistic, Statistic::CountBelow(_));
    if row.share.is_some() && !takes_share || row.count.is_some() && !takes_count {
        let what = if row.share.is_some() && !takes_share { "share" } else { "count" };
        return Err(Usage(format!("the statistic \"{name}\" has no {what}")));
    }
    match (is_check, statistic) {
        (true, Statistic::Count) => Ok(statistic),
        (true, _) => Err(Usage(format!("of a check there is a count only, found \"{name}\""))),
        (false, Statistic::Count) => Err(wants("a check, not a measure")),
        (false, _) => Ok(statistic),
    }
}

fn shape(name: &str) -> Result<Shape, Usage> {
    let names = Shape::ALL.map(Shape::name);
    Shape::ALL.into_iter().find(|shape| shape.name() == name).ok_or_else(|| unknown("shape", name, &names))
}

/// The presets that `text` names, one or several with commas between them.
pub fn presets(text: &str) -> Result<Vec<&'static str>, Usage> {
    let names: Vec<_> = PRESETS.iter().map(|preset| preset.name).collect();
    let known = |name: &str| summary::preset(name).map(|preset| preset.name);
    text.split(',')
        .map(str::trim)
        .map(|name| known(name).ok_or_else(|| unknown("preset", name, &names)))
        .collect()
}

fn unknown(what: &str, name: &str, known: &[&str]) -> Usage {
    let hint = nearest(name, known.iter().copied()).map(|near| format!("did you mean \"{near}\"? "));
    Usage(format!(
        "no {what} is named \"{name}\"; {}there are {}",
        hint.unwrap_or_default(),
        known.join(", ")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Rule>, String> {
        let config = crate::config_file::parse(text)?;
        rules(&config.verdict.rules).map_err(|e| e.0)
    }

    #[test]
    fn a_row_is_a_rule() {
        let text = r#"[verdict]
            rules = [
                { measure = "M33", shape = "tetrahedron", statistic = "share below", limit = 0.05, share = 0.001 },
                { name = "ours", measure = "all", limit = 0.2, status = "warn" },
                { measure = "m31", statistic = "quantile", share = 0.05, limit = 0.3 },
                { measure = "M22", statistic = "count below", limit = 0.07, count = 3 },
                { measure = "crossed_faces", limit = 0 },
            ]"#;
        let tetrahedra = Some(Shape::Tetrahedron);
        let own = |name: &str, subject, shape, statistic, limit, status| {
            let name = name.to_owned().into();
            Rule { name, subject, shape, statistic, limit, status }
        };
        let measure = |code: &'static str| Subject::Measure(code.into());
        let expected = vec![
            own("rule 1", measure("M33"), tetrahedra, Statistic::ShareBelow(0.001), 0.05, Status::Fail),
            own("ours", Subject::AllMeasures, None, Statistic::Min, 0.2, Status::Warn),
            own("rule 3", measure("M31"), None, Statistic::Quantile(0.05), 0.3, Status::Fail),
            own("rule 4", measure("M22"), None, Statistic::CountBelow(3), 0.07, Status::Fail),
            own("rule 5", Subject::Check("crossed_faces".into()), None, Statistic::Count, 0.0, Status::Fail),
        ];
        assert_eq!(read(text), Ok(expected));
    }

    #[test]
    fn what_makes_no_rule_is_told_with_the_nearest_name() {
        let rows = [
            (
                r#"{ measure = "M41", limit = 0.1 }"#,
                "rule 1: no measure or check is named \"M41\"; did you mean \"M11\"?",
            ),
            (r#"{ measure = "M31", shape = "tetrahedra", limit = 0.1 }"#, "did you mean \"tetrahedron\"?"),
            (r#"{ measure = "M31", statistic = "men", limit = 0.1 }"#, "did you mean \"mean\"?"),
            (r#"{ measure = "M31", limit = 0.1, status = "warning" }"#, "did you mean \"warn\"?"),
            (r#"{ measure = "unused_node", limit = 0 }"#, "did you mean \"unused_nodes\"?"),
            (
                r#"{ measure = "M31", statistic = "share below", limit = 0.1 }"#,
                "wants the share that is allowed",
            ),
            (
                r#"{ measure = "M31", statistic = "quantile", share = 1, limit = 0.1 }"#,
                "wants a share over 0",
            ),
            (r#"{ measure = "M31", limit = 0.1, share = 0.1 }"#, "the statistic \"min\" has no share"),
            (r#"{ measure = "M31", limit = 1.5 }"#, "expected a limit from 0 to 1, found 1.5"),
            (r#"{ measure = "inverted", limit = 0, statistic = "mean" }"#, "there is a count only"),
            (r#"{ measure = "M31", limit = 0.1, statistic = "count" }"#, "wants a check"),
            (r#"{ measure = "M31", limt = 0.1 }"#, "did you mean `limit`?"),
        ];
        for (row, expected) in rows {
            let error = read(&format!("[verdict]\nrules = [{row}]")).expect_err(row);
            assert!(error.contains(expected), "{row}: {error}");
        }
        assert!(presets("npl,consol").is_err_and(|e| e.0.contains("did you mean \"comsol\"?")));
        assert_eq!(presets("comsol, aspect").map_err(|e| e.0), Ok(vec!["comsol", "aspect"]));
    }
}
