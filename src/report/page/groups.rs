//! The figures and tables of the shapes: a group for each shape and what of it was measured, as in the report.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Content, Named, published, series};
use crate::compare::Outcome;
use crate::measures::find;
use crate::report::figure::{
    Bars, Distribution, Legend, Panel, Series, Sized, Value, bars, distribution, sizes,
};
use crate::report::layout::{Row, Table, tables};
use crate::report::numbers::{count, score, spread};
use crate::report::safe::escaped;

/// Bars of more meshes than this are drawn measure by measure, each as wide as the page.
const SIDE_BY_SIDE: usize = 20;

/// One of the report's groups, as the template takes it.
#[derive(Debug, Serialize)]
pub struct Group {
    title: String,
    boundary: bool,
    minimum: Vec<String>,
    mean: Vec<String>,
    distributions: Vec<Distributions>,
    rows: Vec<TableRow>,
}

#[derive(Debug, Serialize)]
struct Distributions {
    code: String,
    title: &'static str,
    frequency: String,
    cumulative: String,
}

/// A row of a table: texts, and the numbers that it is sorted by.
#[derive(Debug, Serialize)]
struct TableRow {
    index: usize,
    class: String,
    name: String,
    code: String,
    count: String,
    numbers: Vec<(String, f64)>,
    low: bool,
}

/// The series of a page's meshes.
pub fn series_of(content: &Content) -> Vec<Series> {
    let worse = content.changes.unwrap_or_default().iter().filter(|mesh| mesh.outcome == Outcome::Worse);
    series::series(content.meshes, &worse.map(|mesh| mesh.name.clone()).collect::<Vec<_>>())
}

/// The series of the rows of 2007.
pub fn published_series(content: &Content) -> Vec<Series> {
    let first = content.meshes.len();
    let one = |(i, label): (usize, &String)| Series {
        name: format!("NPL {} (2007)", escaped(label)),
        index: first + i,
        class: "published".to_owned(),
    };
    content.published.iter().enumerate().map(one).collect()
}

/// Every group of the page.
pub fn groups(content: &Content, series: &[Series], of_2007: &[Series]) -> Vec<Group> {
    tables(content.meshes).iter().map(|table| group(content, table, series, of_2007)).collect()
}

fn group(content: &Content, table: &Table, series: &[Series], of_2007: &[Series]) -> Group {
    let title = table.title();
    let panels = panels(content, table, series, of_2007);
    let draw = |show| figures_of(show, &panels, &title).iter().map(|scene| scene.to_svg()).collect();
    Group {
        boundary: table.boundary,
        minimum: draw(Bars::Minimum),
        mean: draw(Bars::Mean),
        distributions: panels.iter().map(|panel| distributions(panel, &title)).collect(),
        rows: rows(content, table, series, of_2007),
        title: title.clone(),
    }
}

/// One figure for all measures, or one a measure where there are many meshes.
fn figures_of(show: Bars, panels: &[Panel], title: &str) -> Vec<crate::report::figure::Scene> {
    let most = panels.iter().map(|panel| panel.values.len()).max().unwrap_or(0);
    let each = if most > SIDE_BY_SIDE { 1 } else { panels.len().max(1) };
    panels.chunks(each).map(|panels| bars(show, panels, title)).collect()
}

fn distributions(panel: &Panel, title: &str) -> Distributions {
    Distributions {
        code: panel.code.clone(),
        title: find(&panel.code).map_or("", |measure| measure.title),
        frequency: distribution(Distribution::Frequency, panel, title).to_svg(),
        cumulative: distribution(Distribution::Cumulative, panel, title).to_svg(),
    }
}

fn panels<'a>(
    content: &Content,
    table: &Table<'a>,
    series: &'a [Series],
    of_2007: &'a [Series],
) -> Vec<Panel<'a>> {
    let mut by_code: BTreeMap<&str, Vec<Value>> = BTreeMap::new();
    for Row { index, code, found, .. } in &table.rows {
        let value = Value { series: &series[*index], min: found.min, mean: found.mean, found: Some(found) };
        by_code.entry(code).or_default().push(value);
    }
    for (series, label) in of_2007.iter().zip(content.published) {
        for row in published::rows(label, table.shape, table.on) {
            let [_, min, mean, _] = row.values;
            by_code.entry(row.code).or_default().push(Value { series, min, mean, found: None });
        }
    }
    let panel = |(code, values): (&str, _)| {
        let limits = find(code).map(|measure| measure.thresholds.iter().map(|limit| limit.value).collect());
        Panel { code: escaped(code), limits: limits.unwrap_or_default(), values }
    };
    by_code.into_iter().map(panel).collect()
}

fn rows(content: &Content, table: &Table, series: &[Series], of_2007: &[Series]) -> Vec<TableRow> {
    let row =
        |series: &Series, code: &str, number: Option<u64>, [max, min, mean, sd]: [f64; 4], element: u64| {
            TableRow {
                index: series.index,
                class: series.class.clone(),
                name: series.name.clone(),
                code: escaped(code),
                count: number.map(count).unwrap_or_default(),
                numbers: vec![
                    (score(max), max),
                    (score(min), min),
                    (element.to_string(), element as f64),
                    (score(mean), mean),
                    (spread(sd), sd),
                ],
                low: min < crate::report::figure::INVESTIGATE,
            }
        };
    let mut rows: Vec<_> = table
        .rows
        .iter()
        .map(|Row { index, code, found, .. }| {
            let values = [found.max, found.min, found.mean, found.sd];
            row(&series[*index], code, Some(found.count), values, found.min_element)
        })
        .collect();
    for (series, label) in of_2007.iter().zip(content.published) {
        for of_then in published::rows(label, table.shape, table.on) {
            rows.push(row(series, of_then.code, None, of_then.values, of_then.min_element));
        }
    }
    rows
}

/// Every figure of the page, with a name for its file.
pub fn figures(content: &Content) -> Vec<Named> {
    let (series, of_2007) = (series_of(content), published_series(content));
    let mut figures = Vec::new();
    let mut add = |name: String, scene| {
        let legend = Legend::of(series.iter().chain(&of_2007));
        figures.push(Named { name, scene, legend });
    };
    for table in tables(content.meshes) {
        let title = table.title();
        let of = file_name(&title);
        let panels = panels(content, &table, &series, &of_2007);
        for (show, what) in [(Bars::Minimum, "minimum"), (Bars::Mean, "mean")] {
            let scenes = figures_of(show, &panels, &title);
            let one = scenes.len() == 1;
            for (scene, panel) in scenes.into_iter().zip(&panels) {
                let code = if one { String::new() } else { format!("-{}", file_name(&panel.code)) };
                add(format!("{of}{code}-{what}"), scene);
            }
        }
        for panel in &panels {
            let code = file_name(&panel.code);
            add(format!("{of}-{code}-frequency"), distribution(Distribution::Frequency, panel, &title));
            add(format!("{of}-{code}-cumulative"), distribution(Distribution::Cumulative, panel, &title));
        }
    }
    if let Some(scene) = sizes_of(content, &series) {
        add("sizes".to_owned(), scene);
    }
    figures
}

/// The figure of the sizes.
pub fn sizes_of(content: &Content, series: &[Series]) -> Option<crate::report::figure::Scene> {
    let sized: Vec<_> = content
        .meshes
        .iter()
        .zip(series)
        .map(|(mesh, series)| Sized { series, sizes: &mesh.sizes })
        .collect();
    sizes(&sized)
}

/// Letters, digits and hyphens; what stands in brackets is left out.
fn file_name(title: &str) -> String {
    let words = title.split(" (").next().unwrap_or(title).split(|c: char| !c.is_ascii_alphanumeric());
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-")
}
