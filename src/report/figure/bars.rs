//! Bars of the minimum or the mean of measures, as in figures 17, 18, 20 to 23, 28 and 29 of the report: measure by
//! measure, a bar a mesh.

use super::scale::Scale;
use super::{INVESTIGATE, Panel, Scene, Value};
use crate::report::numbers::score;

/// What the bars show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bars {
    /// The smallest value.
    Minimum,
    /// The mean.
    Mean,
}

/// Height of the area that bars stand in.
const PLOT: f64 = 180.0;
/// Space left of the area, for the ticks' texts; above it, for the bars' own; and below it, for the measure's code.
const MARGIN: [f64; 3] = [34.0, 18.0, 26.0];
/// Space between two measures.
const GAP: f64 = 22.0;
/// Bars that are at least this wide carry their value.
const WIDE: f64 = 28.0;

impl Bars {
    /// What the figure is called.
    pub fn title(self) -> &'static str {
        match self {
            Bars::Minimum => "Minimum of each measure",
            Bars::Mean => "Mean of each measure",
        }
    }

    fn value(self, value: &Value) -> f64 {
        match self {
            Bars::Minimum => value.min,
            Bars::Mean => value.mean,
        }
    }
}

/// One figure of several measures, `of` some shapes.
pub fn bars(show: Bars, panels: &[Panel], of: &str) -> Scene {
    let most = panels.iter().map(|panel| panel.values.len()).max().unwrap_or(0);
    let bar = width_of_bar(most);
    let inside: f64 = panels.iter().map(|panel| panel.values.len() as f64 * bar + GAP).sum();
    let [left, top, bottom] = MARGIN;
    let width = left + inside.max(120.0) + 8.0;
    let title = format!("{}, {of}", show.title());
    let mut scene = Scene::new(width, top + PLOT + bottom, title);
    let scale = Scale::linear(0.0, 1.0, [top + PLOT, top]);
    for tenths in [0, 2, 4, 6, 8, 10] {
        let value = f64::from(tenths) / 10.0;
        let y = scale.at(value);
        scene.line(if tenths == 0 { "axis" } else { "grid" }, [left, y], [width - 8.0, y], None);
        scene.text("tick end", [left - 6.0, y + 4.0], &format!("{value:.1}"));
    }
    let mut x = left + GAP / 2.0;
    for panel in panels {
        let end = x + panel.values.len() as f64 * bar;
        for (i, value) in panel.values.iter().enumerate() {
            draw(&mut scene, show, panel, value, x + i as f64 * bar, bar, scale);
        }
        for limit in limits(panel) {
            let y = scale.at(limit);
            scene.line("limit", [x - 6.0, y], [end + 6.0, y], None);
        }
        scene.text("code middle", [(x + end) / 2.0, top + PLOT + 18.0], &panel.code);
        x = end + GAP;
    }
    scene
}

/// Narrower the more there are, so that 200 meshes are a strip that fits a screen.
fn width_of_bar(meshes: usize) -> f64 {
    match meshes {
        0..=4 => 32.0,
        5..=8 => 16.0,
        9..=20 => 9.0,
        21..=60 => 5.0,
        _ => 3.0,
    }
}

/// The limits that are drawn: the measure's own, else the one under which the report would look closer.
fn limits(panel: &Panel) -> Vec<f64> {
    if panel.limits.is_empty() { vec![INVESTIGATE] } else { panel.limits.clone() }
}

fn draw(scene: &mut Scene, show: Bars, panel: &Panel, value: &Value, x: f64, bar: f64, scale: Scale) {
    let number = show.value(value);
    let element = match (show, value.found) {
        (Bars::Minimum, Some(found)) => format!(", element {}", found.min_element),
        _ => String::new(),
    };
    let tip = format!("{}: {} {}{element}", value.series.name, panel.code, score(number));
    let space = if bar > 4.0 { 1.0 } else { 0.25 };
    let (y, floor) = (scale.at(number), scale.at(0.0));
    let class = format!("bar {}", value.series.class);
    let mesh = Some(value.series.index);
    // A bar that cannot be seen is the one that matters.
    let y = y.min(floor - 1.5);
    scene.rect(&class, [x + space, y], [x + bar - space, floor], mesh, &tip);
    let middle = x + bar / 2.0;
    if bar >= WIDE {
        scene.text("value middle", [middle, y - 4.0], &score(number));
    }
    if show == Bars::Minimum && number < INVESTIGATE {
        let half = (bar / 2.0 - 0.5).clamp(1.5, 5.0);
        let above = if bar >= WIDE { y - 18.0 } else { y - 9.0 };
        let corners =
            [[middle - half, above], [middle + half, above], [middle, above + 6.0], [middle - half, above]];
        scene.path("low", &corners, mesh, &tip);
    }
}
