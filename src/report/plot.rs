//! Histograms as bars, in the width of the terminal.

use std::io::{self, Write};

use super::Style;
use super::layout::{self, ON_ELEMENT, plural};
use super::numbers::{count, percent};
use super::safe::escaped;
use super::table::{ansi, bold};
use crate::summary::{GOOD, INVESTIGATE, Summary};

/// Lines of the tallest bar.
const HEIGHT: usize = 8;
/// Eighths of a character.
const EIGHTHS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
/// Columns of the scale at the left.
const SCALE: usize = 10;
/// Without a terminal bars are as wide as this.
const WIDTH: u16 = 80;

/// One chart for each mesh, shape and measure.
pub fn render(summaries: &[Summary], style: &Style, out: &mut dyn Write) -> io::Result<()> {
    for table in layout::tables(summaries) {
        for row in &table.rows {
            let what =
                if table.on == ON_ELEMENT { plural(table.shape).to_owned() } else { table.on.to_owned() };
            let (mesh, code) = (escaped(row.mesh), escaped(row.code));
            let title = format!("{code} of {} {}", count(row.found.count), escaped(&what));
            writeln!(out, "{}  {mesh}", bold(&title, style))?;
            chart(&row.found.histogram, style, out)?;
            writeln!(out)?;
        }
    }
    Ok(())
}

fn chart(histogram: &[u64], style: &Style, out: &mut dyn Write) -> io::Result<()> {
    let room = usize::from(style.width.unwrap_or(WIDTH)).saturating_sub(SCALE);
    let Some((bins, wide)) = layout_of(histogram.len(), room) else { return Ok(()) };
    let bars: Vec<u64> = histogram.chunks(histogram.len() / bins).map(|bins| bins.iter().sum()).collect();
    let total = bars.iter().sum::<u64>().max(1) as f64;
    let most = bars.iter().copied().max().unwrap_or(0).max(1);
    for line in (0..HEIGHT).rev() {
        let scale = if line + 1 == HEIGHT { percent(most as f64 / total) } else { String::new() };
        let mut text = String::new();
        for (k, bar) in bars.iter().enumerate() {
            let cell = String::from(EIGHTHS[eighths(*bar, most, line)]).repeat(wide);
            let low = k as f64 / bins as f64;
            let color = if low < INVESTIGATE {
                "31"
            } else if low >= GOOD {
                "32"
            } else {
                "36"
            };
            text += &if cell.trim().is_empty() { cell } else { ansi(color, &cell, style) };
        }
        writeln!(out, "{scale:>8} │{}", text.trim_end())?;
    }
    let width = bins * wide;
    writeln!(out, "{:>8} └{}", 0, "─".repeat(width))?;
    writeln!(out, "{:SCALE$}0{:^middle$}1", "", "0.5", middle = width.saturating_sub(2))
}

/// How many bars there are, and how many columns each is wide: all bins if they have room, else some joined.
fn layout_of(bins: usize, room: usize) -> Option<(usize, usize)> {
    let fits = |bars: &usize| *bars > 0 && bins.is_multiple_of(*bars) && *bars <= room;
    let bars = [bins, bins / 2, bins / 5].into_iter().find(fits)?;
    Some((bars, (room / bars).clamp(1, 4)))
}

/// How much of a line's height a bar fills. What is there is seen, however little.
fn eighths(bar: u64, most: u64, line: usize) -> usize {
    let height = (bar as f64 / most as f64 * (8 * HEIGHT) as f64).round() as usize;
    let height = if bar > 0 { height.max(1) } else { 0 };
    height.saturating_sub(8 * line).min(8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_value_among_millions_is_seen_and_the_most_fill_the_height() {
        assert_eq!(eighths(1, 10_000_000, 0), 1);
        assert_eq!(eighths(0, 10_000_000, 0), 0);
        assert_eq!((eighths(7, 7, 0), eighths(7, 7, HEIGHT - 1)), (8, 8));
        assert_eq!((eighths(1, 2, HEIGHT / 2 - 1), eighths(1, 2, HEIGHT / 2)), (8, 0));
    }

    #[test]
    fn bars_fit_the_room() {
        for (room, expected) in [
            (70, Some((50, 1))),
            (110, Some((100, 1))),
            (200, Some((100, 2))),
            (30, Some((20, 1))),
            (5, None),
        ] {
            assert_eq!(layout_of(100, room), expected, "{room}");
        }
    }
}
