//! What a deck says, keyword by keyword: which cards are nodes and elements.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::ops::Range;
use std::os::unix::ffi::OsStrExt;
use std::path::PathBuf;
use std::sync::Arc;

use super::cards::{Cards, ElementCards, NodeCards, is_comment};
use super::keyword::{Keyword, Width};
use crate::error::{Error, Result, excerpt};
use crate::formats::columns::{Gathered, cut_off};
use crate::formats::text::LineReader;
use crate::formats::{ElementLayout, NodeLayout, Outline, Piece};
use crate::input::{Input, Sibling, Siblings, Source, Spot};
use crate::mesh::{Class, ElementType};

/// Keywords that move or renumber nodes, or fetch a mesh that is not read.
const REFUSED: [&str; 6] =
    ["NODE_TRANSFORM", "INCLUDE_", "ELEMENT_GENERATE", "ELEMENT_SOLID_NURBS", "ELEMENT_SHELL_NURBS", "IGA_"];

/// Elements that are not measured: keyword, what they are, the fields that name nodes.
static COUNTED: [(&str, &str, Range<usize>); 8] = [
    ("ELEMENT_BEAM", "line", 2..5),
    ("ELEMENT_DISCRETE", "spring", 2..4),
    ("ELEMENT_SEATBELT", "line", 2..4),
    ("ELEMENT_PLOTEL", "line", 1..3),
    ("ELEMENT_MASS", "mass", 1..2),
    ("ELEMENT_SPH", "particle", 0..1),
    ("ELEMENT_DISCRETE_SPHERE", "particle", 0..1),
    ("ELEMENT_BEARING", "line", 2..4),
];

/// A deck as far as it was read.
pub(super) struct Deck<'a> {
    input: &'a Input,
    out: &'a mut dyn Outline,
    /// As `*KEYWORD` says.
    width: Width,
    by_gmsh: bool,
    pub(super) nodes: bool,
    pub(super) elements: bool,
    /// Keywords of elements that are not known.
    unknown: Vec<String>,
}

/// What the lines after a keyword are.
enum Open {
    Other,
    Include,
    Nodes(Arc<dyn NodeLayout>),
    Elements(Arc<ElementCards>),
}

/// Where `*END` is missing, the last card must be whole. In fixed columns it may lack the end of its line, if it is as long
/// as the card before: what was cut off between two numbers may well be an element of fewer nodes.
fn ends_with_whole_card(source: &Source) -> Result<()> {
    let len = source.len();
    let mut lines =
        source.peek(len.saturating_sub(1024)..len).rsplit(|b| *b == b'\n').map(<[u8]>::trim_ascii_end);
    let (card, before) = (lines.next().unwrap_or_default(), lines.next().unwrap_or_default());
    let is_whole = card.len() == before.len() && card.len().is_multiple_of(8) && !card.contains(&b',');
    if is_comment(card) || card.is_empty() || is_whole {
        return Ok(());
    }
    Err(source.malformed_text(len, "the end of the line of the last card, or *END"))
}

impl<'a> Deck<'a> {
    pub(super) fn new(input: &'a Input, out: &'a mut dyn Outline) -> Self {
        let head = input.source.peek(0..80);
        let by_gmsh = memchr::memmem::find(head, b"created by Gmsh").is_some();
        Self {
            input,
            out,
            width: Width::default(),
            by_gmsh,
            nodes: false,
            elements: false,
            unknown: Vec::new(),
        }
    }

    /// Reads a file of the deck.
    pub(super) fn read(&mut self, siblings: &mut Siblings<'_>, file: &Sibling) -> Result<()> {
        let source = &file.source;
        let place = |e: Error, at: u64| source.place(e, Spot::Text(at));
        let mut lines = LineReader::new(source, &self.input.limits, 0);
        let mut gathered = Gathered::default();
        let mut open = Open::Other;
        loop {
            let line = lines.next_line()?;
            let at = line.as_ref().map_or(source.len(), |line| line.at);
            let Some(line) = line.filter(|line| !line.bytes.starts_with(b"*")) else {
                if let Some(span) = gathered.end(at) {
                    self.piece(&open, span)?;
                }
                let Some(line) = line else {
                    return if matches!(open, Open::Other) { Ok(()) } else { ends_with_whole_card(source) };
                };
                let keyword = Keyword::read(line.bytes);
                if keyword.name == "END" {
                    return Ok(());
                }
                open = self.enter(&keyword, source).map_err(|e| place(e, at))?;
                continue;
            };
            if is_comment(line.bytes) || line.bytes.trim_ascii().is_empty() {
                continue;
            }
            match &open {
                Open::Other => continue,
                Open::Include => {
                    let name = include_name(line.bytes.trim_ascii().to_vec(), &mut lines)?;
                    let named = siblings.open(file, &name).map_err(|e| place(e, at))?;
                    self.read(siblings, &named)?;
                    continue;
                }
                Open::Nodes(_) => {}
                Open::Elements(layout) => {
                    let more = layout.cards.more_lines(line.bytes, layout.width).map_err(|e| place(e, at))?;
                    for _ in 0..more {
                        pass_card(source, &mut lines)?;
                    }
                }
            }
            if let Some(span) = gathered.record(at) {
                self.piece(&open, span)?;
            }
        }
    }

    fn piece(&mut self, open: &Open, span: Range<u64>) -> Result<()> {
        match open {
            Open::Nodes(layout) => {
                self.nodes = true;
                self.out.nodes(Piece { layout: Arc::clone(layout), span })
            }
            Open::Elements(layout) => {
                self.elements = true;
                let layout: Arc<dyn ElementLayout> = Arc::clone(layout) as _;
                self.out.elements(Piece { layout, span })
            }
            Open::Other | Open::Include => Ok(()),
        }
    }

    fn enter(&mut self, keyword: &Keyword, source: &Arc<Source>) -> Result<Open> {
        let name = keyword.name.as_str();
        let width = keyword.width.unwrap_or(self.width);
        let source = Arc::clone(source);
        if name == "KEYWORD" {
            self.width = width;
        } else if name == "NODE" {
            return Ok(Open::Nodes(Arc::new(NodeCards { source, width })));
        } else if name == "INCLUDE" {
            return Ok(Open::Include);
        } else if name != "INCLUDE_PATH" && REFUSED.iter().any(|refused| name.starts_with(refused)) {
            return Err(Error::unsupported(format!("the keyword *{name} is not read")));
        } else if name.starts_with("ELEMENT_") {
            let cards = cards(name)?;
            self.note_unknown(name, &cards)?;
            let by_gmsh = self.by_gmsh;
            return Ok(Open::Elements(Arc::new(ElementCards { source, width, cards, by_gmsh })));
        }
        Ok(Open::Other)
    }

    /// Keeps account of keywords that no table holds: a summary names each.
    fn note_unknown(&mut self, name: &str, cards: &Cards) -> Result<()> {
        const MOST: usize = 100;
        let is_unknown = matches!(cards, Cards::Counted { nodes, .. } if nodes.is_empty());
        if is_unknown && !self.unknown.iter().any(|known| known == name) {
            if self.unknown.len() == MOST {
                return Err(Error::limit("number of unknown element keywords", MOST));
            }
            self.unknown.push(name.to_owned());
        }
        Ok(())
    }
}

/// The cards of an element keyword.
fn cards(name: &str) -> Result<Cards> {
    let options =
        |family: &str| name.strip_prefix(family).filter(|rest| rest.is_empty() || rest.starts_with('_'));
    let unknown = || Error::unsupported(format!("the keyword *{name} is not read"));
    if let Some(options) = options("ELEMENT_SOLID") {
        let more = match options {
            "" | "_TET4TOTET10" | "_H8TOH20" | "_H20" => 0,
            "_DOF" => 1,
            "_ORTHO" => 2,
            _ => return Err(unknown()),
        };
        return Ok(Cards::Solid { more, lines: if options == "_H20" { 2 } else { 1 } });
    }
    if let Some(options) = options("ELEMENT_SHELL") {
        let (mut thickness, mut more) = (false, 0);
        for option in options.split('_').skip(1) {
            match option {
                "THICKNESS" | "BETA" | "MCID" => thickness = true,
                "OFFSET" | "DOF" => more += 1,
                _ => return Err(unknown()),
            }
        }
        return Ok(Cards::Shell { more: more + usize::from(thickness), thickness });
    }
    if let Some(options) = options("ELEMENT_TSHELL") {
        return match options {
            "" => Ok(Cards::ThickShell { more: 0 }),
            "_BETA" => Ok(Cards::ThickShell { more: 1 }),
            _ => Err(unknown()),
        };
    }
    let counted = |what: Option<&'static str>| {
        let class = Class::Counted(what.map_or_else(|| Cow::Owned(format!("{name} cards")), Cow::Borrowed));
        Arc::new(ElementType { name: Cow::Owned(name.to_owned()), nodes: 0, class })
    };
    if let Some((_, what, nodes)) = COUNTED.iter().find(|(known, ..)| *known == name) {
        return Ok(Cards::Counted { kind: counted(Some(what)), more: 0, nodes: nodes.clone() });
    }
    if let Some(options) = options("ELEMENT_BEAM") {
        let known = ["THICKNESS", "SCALAR", "SCALR", "SECTION", "PID", "OFFSET", "ORIENTATION", "WARPAGE"];
        if options.split('_').skip(1).all(|option| known.contains(&option)) {
            let more = options.split('_').skip(1).count();
            return Ok(Cards::Counted { kind: counted(Some("line")), more, nodes: 2..5 });
        }
    }
    if ["ELEMENT_SOLID", "ELEMENT_SHELL", "ELEMENT_TSHELL"].iter().any(|solid| name.starts_with(solid)) {
        return Err(unknown());
    }
    Ok(Cards::Counted { kind: counted(None), more: 0, nodes: 0..0 })
}

/// Passes a card that belongs to the element before it.
fn pass_card(source: &Source, lines: &mut LineReader<'_>) -> Result<()> {
    loop {
        let Some(line) = lines.next_line()? else {
            return Err(cut_off(source, "another card of an element"));
        };
        if line.bytes.starts_with(b"*") {
            return Err(source.malformed_text(line.at, "another card of the element before"));
        }
        if !is_comment(line.bytes) {
            return Ok(());
        }
    }
}

/// The name of an included file: ` +` at a line's end says that it goes on.
fn include_name(mut name: Vec<u8>, lines: &mut LineReader<'_>) -> Result<PathBuf> {
    const LONGEST: usize = 4096;
    while let Some(part) = name.strip_suffix(b" +") {
        let kept = part.trim_ascii_end().len();
        name.truncate(kept);
        let Some(line) = lines.next_line()? else { break };
        name.extend_from_slice(line.bytes.trim_ascii());
        if name.len() > LONGEST {
            return Err(Error::malformed("the name of an included file", excerpt(&name)));
        }
    }
    Ok(PathBuf::from(OsStr::from_bytes(&name)))
}
