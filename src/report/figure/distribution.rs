//! How the values of a measure are distributed, as in figure 30 of the report: a line a mesh, each divided by its own
//! number of values.

use super::scale::{Scale, round_up, steps};
use super::{Panel, Scene};
use crate::report::numbers::percent;

/// What the lines show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distribution {
    /// The share of values in each bin.
    Frequency,
    /// The share of values up to each bin's end, on a logarithmic axis, where single elements can be seen.
    Cumulative,
}

const WIDTH: f64 = 340.0;
const HEIGHT: f64 = 220.0;
/// Space left of, above, right of and below the lines.
const MARGIN: [f64; 4] = [46.0, 10.0, 12.0, 34.0];

/// One figure of one measure, `of` some shapes. Rows without a histogram are left out.
pub fn distribution(show: Distribution, panel: &Panel, of: &str) -> Scene {
    let what = match show {
        Distribution::Frequency => "Frequency distribution",
        Distribution::Cumulative => "Cumulative distribution",
    };
    let mut scene = Scene::new(WIDTH, HEIGHT, format!("{what} of {}, {of}", panel.code));
    let [left, top, right, bottom] = MARGIN;
    let x = Scale::linear(0.0, 1.0, [left, WIDTH - right]);
    let floor = HEIGHT - bottom;
    let mut lines: Vec<_> =
        panel.values.iter().filter_map(|value| Some((value, line(show, value.found?)?))).collect();
    let shares = lines.iter().flat_map(|(_, shares)| shares.iter().map(|(_, share)| *share));
    let (least, most) =
        shares.filter(|share| *share > 0.0).fold((1.0_f64, 0.0_f64), |(a, b), s| (a.min(s), b.max(s)));
    let y = match show {
        Distribution::Frequency => Scale::linear(0.0, round_up(most), [floor, top]),
        Distribution::Cumulative => Scale::logarithmic(least.max(1e-12), 1.0, [floor, top]),
    };
    match show {
        Distribution::Frequency => {
            for value in steps(round_up(most)) {
                across(&mut scene, y.at(value), &percent(value), value == 0.0);
            }
        }
        Distribution::Cumulative => {
            for tick in y.decades().into_iter().filter(|tick| !tick.text.is_empty()) {
                across(&mut scene, y.at(tick.value), &percent(tick.value), tick.value == y.start());
            }
        }
    }
    for tenths in (0..=10).step_by(2) {
        let value = f64::from(tenths) / 10.0;
        scene.line("grid", [x.at(value), top], [x.at(value), floor], None);
        scene.text("tick middle", [x.at(value), floor + 14.0], &format!("{value:.1}"));
    }
    for limit in &panel.limits {
        scene.line("limit", [x.at(*limit), top], [x.at(*limit), floor], None);
    }
    scene.text("code middle", [(left + WIDTH - right) / 2.0, HEIGHT - 5.0], &panel.code);
    // What has a colour lies over what has none, and the first mesh over the others.
    lines.reverse();
    lines.sort_by_key(|(value, _)| value.series.class != "rest");
    for (value, shares) in &lines {
        let points: Vec<_> = shares.iter().map(|(at, share)| [x.at(*at), y.at(*share)]).collect();
        let class = format!("line {}", value.series.class);
        scene.path(&class, &points, Some(value.series.index), &value.series.name);
    }
    scene
}

fn across(scene: &mut Scene, y: f64, text: &str, axis: bool) {
    let [left, _, right, _] = MARGIN;
    scene.line(if axis { "axis" } else { "grid" }, [left, y], [WIDTH - right, y], None);
    scene.text("tick end", [left - 6.0, y + 4.0], text);
}

/// Places and shares. Bins without values at both ends are left out; `None` without values.
fn line(show: Distribution, found: &crate::summary::MeasureSummary) -> Option<Vec<(f64, f64)>> {
    let bins = &found.histogram;
    let all: f64 = bins.iter().map(|&count| count as f64).sum();
    let (first, last) = (bins.iter().position(|&n| n > 0)?, bins.iter().rposition(|&n| n > 0)?);
    let width = 1.0 / bins.len() as f64;
    let mut below = 0.0;
    let mut line = Vec::with_capacity(last - first + 3);
    if show == Distribution::Frequency {
        line.push((first as f64 * width, 0.0));
    }
    for (bin, &count) in bins.iter().enumerate().take(last + 1).skip(first) {
        below += count as f64;
        line.push(match show {
            Distribution::Frequency => ((bin as f64 + 0.5) * width, count as f64 / all),
            Distribution::Cumulative => ((bin as f64 + 1.0) * width, below / all),
        });
    }
    if show == Distribution::Frequency {
        line.push(((last as f64 + 1.0) * width, 0.0));
    }
    Some(line)
}
