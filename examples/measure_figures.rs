//! Figures 7 to 10 of the report, computed afresh: how the measures of a triangle vary with its angles.
//!
//!     cargo run --example measure_figures -- docs/figures
//!
//! writes four SVG files and prints what the report's section 3.3 says of them, in numbers.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs, io};

use meshgauge::measures::triangle;

/// Side of a plot, and the margin round it.
const SIDE: f64 = 360.0;
const MARGIN: f64 = 48.0;

/// Colours of M11 to M15 that people who do not see all colours can tell apart.
const COLORS: [&str; 5] = ["#0072b2", "#56b4e9", "#009e73", "#e69f00", "#d55e00"];

/// The scores of the triangle on a side of unit length with these angles at its ends, in degrees.
fn scores(first: f64, second: f64) -> [f64; 5] {
    let (a, b) = (first * PI / 180.0, second * PI / 180.0);
    let third = PI - a - b;
    if third <= 0.0 || a <= 0.0 || b <= 0.0 {
        return [0.0; 5];
    }
    let length = b.sin() / third.sin();
    triangle::score(&[[0.0; 3], [1.0, 0.0, 0.0], [length * a.cos(), length * a.sin(), 0.0]])
}

fn main() -> io::Result<()> {
    let folder = env::args().nth(1).unwrap_or_else(|| "docs/figures".into());
    let folder = Path::new(&folder);
    fs::create_dir_all(folder)?;
    fs::write(
        folder.join("figure-7.svg"),
        curves("Right-angled triangle", 90.0, |angle| scores(90.0, angle)),
    )?;
    fs::write(folder.join("figure-8.svg"), curves("Isosceles triangle", 90.0, |angle| scores(angle, angle)))?;
    fs::write(folder.join("figure-9.svg"), contours("M14", 3))?;
    fs::write(folder.join("figure-10.svg"), contours("M15", 4))?;
    claims();
    Ok(())
}

/// The frame of a plot over angles; `most` is the largest.
fn framed(title: &str, most: f64, labels: (&str, &str), body: &str) -> String {
    let all = SIDE + 2.0 * MARGIN;
    let mut svg = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {all} {all}" font-family="sans-serif" font-size="12">
<title>{title}</title><rect width="{all}" height="{all}" fill="#fff"/>
<text x="{MARGIN}" y="30" font-size="14">{title}</text>
"##
    );
    for k in 0..=6 {
        let (at, value) = (MARGIN + SIDE * f64::from(k) / 6.0, most * f64::from(k) / 6.0);
        let (low, left) = (MARGIN + SIDE, MARGIN);
        let _ = writeln!(
            svg,
            r##"<path d="M{at:.1} {low}v5" stroke="#000"/><text x="{at:.1}" y="{:.1}" text-anchor="middle">{value}</text>"##,
            low + 18.0
        );
        let high = if labels.1.is_empty() { f64::from(k) / 6.0 } else { value };
        let y = low - SIDE * f64::from(k) / 6.0;
        let _ = writeln!(
            svg,
            r##"<path d="M{left} {y:.1}h-5" stroke="#000"/><text x="{:.1}" y="{:.1}" text-anchor="end">{high:.3}</text>"##,
            left - 8.0,
            y + 4.0
        );
    }
    svg = svg.replace(".000<", "<");
    let _ = writeln!(
        svg,
        r#"<text x="{:.1}" y="{:.1}" text-anchor="middle">{}</text>"#,
        MARGIN + SIDE / 2.0,
        all - 10.0,
        labels.0
    );
    let _ = writeln!(
        svg,
        r##"<rect x="{MARGIN}" y="{MARGIN}" width="{SIDE}" height="{SIDE}" fill="none" stroke="#000"/>"##
    );
    svg + body + "</svg>\n"
}

/// Curves of the five measures over one angle.
fn curves(title: &str, most: f64, scores: impl Fn(f64) -> [f64; 5]) -> String {
    let mut body = String::new();
    for (m, color) in COLORS.iter().enumerate() {
        let point = |k: i32| {
            let angle = most * f64::from(k) / 180.0;
            let score = scores(angle)[m];
            format!("{:.1} {:.1}", MARGIN + SIDE * angle / most, MARGIN + SIDE * (1.0 - score))
        };
        let points: Vec<_> = (0..=180).map(point).collect();
        let _ = writeln!(
            body,
            r#"<path d="M{}" fill="none" stroke="{color}" stroke-width="1.5"/>"#,
            points.join("L")
        );
        let y = MARGIN + 18.0 + 16.0 * m as f64;
        let _ = writeln!(body, r#"<text x="{:.1}" y="{y}" fill="{color}">M1{}</text>"#, MARGIN + 8.0, m + 1);
    }
    framed(title, most, ("angle θ in degrees", ""), &body)
}

/// Contour lines of a measure over the two angles at a side, by linear interpolation in small triangles.
fn contours(name: &str, measure: usize) -> String {
    const STEPS: i32 = 90;
    let angle = |k: i32| 180.0 * f64::from(k) / f64::from(STEPS);
    let value = |i: i32, j: i32| scores(angle(i), angle(j))[measure];
    let place =
        |i: f64, j: f64| (MARGIN + SIDE * i / f64::from(STEPS), MARGIN + SIDE * (1.0 - j / f64::from(STEPS)));
    let mut body = String::new();
    for level in 1..10 {
        let level = f64::from(level) / 10.0;
        let mut path = String::new();
        for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (i, j))) {
            for corners in [[(i, j), (i + 1, j), (i, j + 1)], [(i + 1, j + 1), (i, j + 1), (i + 1, j)]] {
                let mut cuts = Vec::new();
                for k in 0..3 {
                    let (p, q) = (corners[k], corners[(k + 1) % 3]);
                    let (a, b) = (value(p.0, p.1), value(q.0, q.1));
                    if (a < level) != (b < level) {
                        let t = (level - a) / (b - a);
                        let along = |p: i32, q: i32| f64::from(p) + t * f64::from(q - p);
                        cuts.push(place(along(p.0, q.0), along(p.1, q.1)));
                    }
                }
                if let [(x0, y0), (x1, y1)] = cuts[..] {
                    let _ = write!(path, "M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}");
                }
            }
        }
        let shade = 200 - (190.0 * level) as u8;
        let _ = writeln!(
            body,
            r#"<path d="{path}" fill="none" stroke="rgb({shade},{shade},255)"><title>{level}</title></path>"#
        );
        // On the line of isosceles triangles, below 60 degrees.
        let at = (0..60).map(f64::from).find(|a| scores(*a, *a)[measure] >= level).unwrap_or(60.0);
        let (x, y) = place(at / 2.0, at / 2.0);
        let _ = writeln!(body, r#"<text x="{x:.1}" y="{y:.1}" font-size="8">{level}</text>"#);
    }
    framed(
        &format!("{name} of a general triangle"),
        180.0,
        ("angles at the two ends of a side, in degrees", "deg"),
        &body,
    )
}

/// What section 3.3 says of the figures, by number, over triangles at every quarter of a degree.
fn claims() {
    let (mut all, mut least, mut most) = (0, 0, [0; 5]);
    let (mut good14, mut good15) = (0, 0);
    for (i, j) in (1..720).flat_map(|i| (1..720 - i).map(move |j| (i, j))) {
        let found = scores(f64::from(i) / 4.0, f64::from(j) / 4.0);
        all += 1;
        least += i32::from(found.iter().all(|score| found[4] <= score + 1e-12));
        let best = found.iter().copied().fold(0.0, f64::max);
        for (count, score) in most.iter_mut().zip(found) {
            *count += i32::from(score >= best - 1e-12);
        }
        good14 += i32::from(found[3] >= 0.9);
        good15 += i32::from(found[4] >= 0.6);
    }
    let share = |count: i32| 100.0 * f64::from(count) / f64::from(all);
    println!("triangles                       {all}");
    println!("M15 is the least of the five    {:.2} %", share(least));
    for (m, count) in most.iter().enumerate() {
        println!("M1{} is the most of the five     {:.2} %", m + 1, share(*count));
    }
    println!("M14 is 0.9 or more              {:.2} %", share(good14));
    println!("M15 is 0.6 or more              {:.2} %", share(good15));
}
