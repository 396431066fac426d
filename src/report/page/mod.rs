//! One self-contained HTML page: verdicts and what changed first, then the report's figures and tables.
//!
//! The page asks for nothing: its style, script and figures stand in it, and its policy forbids any request. What comes
//! out of meshes is escaped by the template. Without a script everything can be read; with one, tables sort.

mod groups;
mod model;
pub(super) mod published;
mod series;

use std::io::{self, Write};
use std::sync::LazyLock;

use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, Value};

use super::figure::{Legend, Scene};
use crate::compare::Comparison;
use crate::summary::Summary;

pub use published::labels as published_labels;

/// What a page is made of.
#[derive(Debug, Clone, Copy)]
pub struct Content<'a> {
    /// What stands over the page.
    pub title: &'a str,
    /// The meshes, in the order that they are shown in. Their names must differ.
    pub meshes: &'a [Summary],
    /// What changed; each comparison bears the name of its new mesh.
    pub changes: Option<&'a [Comparison]>,
    /// Labels of meshes of the report of 2007 that are laid beside: see [`published_labels`].
    pub published: &'a [String],
}

/// A figure, and how its colours are called.
#[derive(Debug)]
pub struct Named {
    /// A name for its file, without extension.
    pub name: String,
    /// The drawing.
    pub scene: Scene,
    /// The colours.
    pub legend: Legend,
}

static TEMPLATES: LazyLock<Environment> = LazyLock::new(|| {
    let mut templates = Environment::new();
    let whitespace = SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build();
    templates.set_syntax(whitespace.expect("the usual delimiters"));
    templates.set_auto_escape_callback(|name| match name {
        "page.html" | "table.html" => AutoEscape::Html,
        _ => AutoEscape::None,
    });
    for (name, source) in [
        ("page.html", include_str!("page.html")),
        ("table.html", include_str!("table.html")),
        ("page.css", include_str!("page.css")),
        ("page.js", include_str!("page.js")),
    ] {
        templates.add_template(name, source).expect("the templates are part of the program, and tested");
    }
    templates
});

/// Writes the page.
pub fn render(content: &Content, out: &mut dyn Write) -> io::Result<()> {
    let template = TEMPLATES.get_template("page.html").expect("it was added above");
    let page = template
        .render(Value::from(Serde(model::Model::of(content))))
        .expect("every value that the template names is there");
    out.write_all(page.as_bytes())
}

/// The figures of the page, each to stand alone.
pub fn figures(content: &Content) -> Vec<Named> {
    groups::figures(content)
}
