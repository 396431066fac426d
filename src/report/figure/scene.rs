//! What is drawn: marks at places, with classes for their colours.

use std::sync::LazyLock;

use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, Value, context};
use serde::Serialize;

use super::Series;

/// A drawing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scene {
    /// Width in pixels.
    pub width: f64,
    /// Height in pixels.
    pub height: f64,
    /// What it shows, in words.
    pub title: String,
    marks: Vec<Mark>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Mark {
    Rect { class: String, x: f64, y: f64, width: f64, height: f64, mesh: Option<usize>, tip: String },
    Line { class: String, x1: f64, y1: f64, x2: f64, y2: f64, mesh: Option<usize> },
    Path { class: String, d: String, mesh: Option<usize>, tip: String },
    Text { class: String, x: f64, y: f64, text: String },
}

/// The colours of a figure that stands alone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Legend {
    entries: Vec<Entry>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct Entry {
    class: String,
    name: String,
}

/// Width that a title needs.
const NARROWEST: f64 = 420.0;
/// Width of a letter of a legend.
const LETTER: f64 = 6.6;

static TEMPLATES: LazyLock<Environment> = LazyLock::new(|| {
    let mut templates = Environment::new();
    templates.set_auto_escape_callback(|_| AutoEscape::Html);
    let whitespace = SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build();
    templates.set_syntax(whitespace.expect("the usual delimiters"));
    for (name, source) in [
        ("scene.svg", include_str!("scene.svg")),
        ("marks.svg", include_str!("marks.svg")),
        ("alone.svg", include_str!("alone.svg")),
        ("alone.css", include_str!("alone.css")),
    ] {
        templates.add_template(name, source).expect("the templates are part of the program, and tested");
    }
    templates
});

impl Legend {
    /// The series that have a colour of their own, and one entry for all others.
    pub fn of<'a>(series: impl IntoIterator<Item = &'a Series>) -> Self {
        let mut entries: Vec<Entry> = Vec::new();
        for Series { name, class, .. } in series {
            let name = if class == "rest" { "others" } else { name };
            if class != "rest" || entries.iter().all(|entry| entry.class != "rest") {
                entries.push(Entry { class: class.clone(), name: name.to_owned() });
            }
        }
        Self { entries }
    }

    /// The entries in rows that begin at `y`, and where the last row ends.
    fn placed(&self, width: f64, mut y: f64) -> (Vec<Value>, f64) {
        let (mut x, mut placed) = (10.0, Vec::new());
        for Entry { class, name } in &self.entries {
            let wide = 30.0 + name.chars().count() as f64 * LETTER;
            if x > 10.0 && x + wide > width {
                (x, y) = (10.0, y + 16.0);
            }
            placed.push(context! { x, y, class, name });
            x += wide;
        }
        (placed, y + 14.0)
    }
}

impl Scene {
    /// An empty drawing.
    pub fn new(width: f64, height: f64, title: String) -> Self {
        Self { width, height, title, marks: Vec::new() }
    }

    /// An upright rectangle between two corners.
    pub fn rect(
        &mut self,
        class: &str,
        [x, y]: [f64; 2],
        [to_x, to_y]: [f64; 2],
        mesh: Option<usize>,
        tip: &str,
    ) {
        let (class, tip) = (class.to_owned(), tip.to_owned());
        let (width, height) = (round(to_x - x), round(to_y - y));
        self.marks.push(Mark::Rect { class, x: round(x), y: round(y), width, height, mesh, tip });
    }

    /// A straight line.
    pub fn line(&mut self, class: &str, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], mesh: Option<usize>) {
        let class = class.to_owned();
        self.marks.push(Mark::Line {
            class,
            x1: round(x1),
            y1: round(y1),
            x2: round(x2),
            y2: round(y2),
            mesh,
        });
    }

    /// A line through points.
    pub fn path(&mut self, class: &str, points: &[[f64; 2]], mesh: Option<usize>, tip: &str) {
        let mut d = String::new();
        for (i, [x, y]) in points.iter().enumerate() {
            d += if i == 0 { "M" } else { "L" };
            d += &format!("{} {}", round(*x), round(*y));
        }
        self.marks.push(Mark::Path { class: class.to_owned(), d, mesh, tip: tip.to_owned() });
    }

    /// A text; its class says where it is anchored.
    pub fn text(&mut self, class: &str, [x, y]: [f64; 2], text: &str) {
        self.marks.push(Mark::Text {
            class: class.to_owned(),
            x: round(x),
            y: round(y),
            text: text.to_owned(),
        });
    }

    /// An `<svg>` element for a page, which brings the colours.
    pub fn to_svg(&self) -> String {
        render("scene.svg", context! { scene => Value::from(Serde(self)) })
    }

    /// A whole SVG file, with its own colours, and a legend under the drawing.
    pub fn to_file(&self, legend: &Legend) -> String {
        let width = self.width.max(NARROWEST) + 8.0;
        let (entries, below) = legend.placed(width, self.height + 46.0);
        render(
            "alone.svg",
            context! { scene => Value::from(Serde(self)), entries, width, height => below + 6.0 },
        )
    }
}

fn render(template: &str, values: Value) -> String {
    let template = TEMPLATES.get_template(template).expect("it was added above");
    template.render(values).expect("every value that the template names is there")
}

/// To a twentieth of a pixel: enough for the eye, and short.
fn round(pixels: f64) -> f64 {
    (pixels * 20.0).round() / 20.0
}
