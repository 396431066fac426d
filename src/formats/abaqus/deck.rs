//! What a deck says, keyword by keyword: which data are nodes and elements, and whose.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::assembly::{Block, Blocks, ElementBlock, Instance, MOST_INSTANCES, NodeBlock, Part, Place, scope};
use super::elements::{MOST_NODES, cut_at_records};
use super::fields::Fields;
use super::keywords::{Keyword, plain};
use super::make::{Command, Noted, SetHead};
use super::parameters::Parameters;
use super::placement::{Affine, Placement, System};
use super::points::{Row, frame, motion, points};
use super::types::{self, Kind};
use crate::error::{Error, Result, excerpt};
use crate::formats::{Outline, text};
use crate::input::{Input, Source, Spot};

/// Keywords that move nodes, or fetch a mesh from elsewhere.
const UNEXPANDED: [&str; 4] = ["NMAP", "IMPORT", "SYMMETRICMODELGENERATION", "PARAMETERSHAPEVARIATION"];
/// Keywords that the mesh hangs on: their abbreviations are refused rather than skipped.
const SPELLED_OUT: [&str; 6] = ["NODE", "ELEMENT", "INCLUDE", "INSTANCE", "PART", "SYSTEM"];

/// A deck as far as it was read.
pub(super) struct Deck<'a> {
    input: &'a Input,
    out: &'a mut dyn Outline,
    /// Values of `*PARAMETER`.
    pub(super) parameters: Parameters,
    /// Types by name, user elements among them.
    kinds: HashMap<String, Kind>,
    parts: Vec<Part>,
    part_names: HashMap<Vec<u8>, usize>,
    instances: Vec<Instance>,
    scopes: HashMap<Vec<u8>, u64>,
    /// Blocks outside parts and instances that wait for the instances; without parts nothing waits.
    outside: Blocks,
    level: Level,
    assembly: Option<Place>,
    frame: Affine,
    open: Open,
    /// The last keyword.
    place: Option<Place>,
    seen: Seen,
}

/// What a deck must have to be a mesh. One that was cut off among its nodes has no elements.
#[derive(Default)]
struct Seen {
    nodes: bool,
    elements: bool,
}

impl Seen {
    fn note(&mut self, blocks: &Blocks) {
        self.nodes |= !blocks.nodes.is_empty();
        self.elements |= !blocks.elements.is_empty();
    }

    /// The keyword whose data are not there.
    fn missing(&self) -> Option<&'static str> {
        match self {
            Seen { nodes: false, .. } => Some("NODE"),
            Seen { elements: false, .. } => Some("ELEMENT"),
            _ => None,
        }
    }
}

/// Whose the data are.
#[derive(Clone, Copy, PartialEq)]
enum Level {
    /// The whole model's: a flat deck, or the assembly.
    Outside,
    /// Of the last part.
    Part,
    /// Of the last instance.
    Instance,
}

/// What the data lines at hand are.
enum Open {
    /// No keyword yet.
    Nothing,
    /// Data that is no mesh.
    Other,
    Nodes(System, Option<Vec<u8>>),
    Elements(Kind, Option<Vec<u8>>),
    /// Members of a set.
    Set(SetHead),
    /// What a keyword makes others from.
    Make(Command, Vec<Row>),
    /// Points of a `*SYSTEM`.
    Frame(Vec<Row>),
    /// Shift and turn of an `*INSTANCE`.
    Motion(Vec<Row>),
}

impl<'a> Deck<'a> {
    pub(super) fn new(input: &'a Input, out: &'a mut dyn Outline) -> Self {
        Self {
            input,
            out,
            parameters: Parameters::default(),
            kinds: HashMap::new(),
            parts: Vec::new(),
            part_names: HashMap::new(),
            instances: Vec::new(),
            scopes: HashMap::new(),
            outside: Blocks::default(),
            level: Level::Outside,
            assembly: None,
            frame: Affine::IDENTITY,
            open: Open::Nothing,
            place: None,
            seen: Seen::default(),
        }
    }

    /// A file with the values of parameters in place from byte `from` on.
    pub(super) fn put_in_parameters(&mut self, source: &Source, from: u64) -> Result<Arc<Source>> {
        self.parameters.put_in(self.input, source, from)
    }

    /// Takes in a keyword line.
    pub(super) fn keyword(&mut self, keyword: &Keyword, source: &Arc<Source>) -> Result<()> {
        let place = Place { source: Arc::clone(source), at: keyword.at };
        self.close()?;
        self.place = Some(place.clone());
        self.enter(keyword, &place).map_err(|e| place.of(e))
    }

    fn enter(&mut self, keyword: &Keyword, place: &Place) -> Result<()> {
        self.open = Open::Other;
        match keyword.name.as_str() {
            "NODE" => self.open = Open::Nodes(system(keyword)?, keyword.label("NSET").ok().flatten()),
            "ELEMENT" => {
                let set = keyword.label("ELSET").ok().flatten();
                self.open = Open::Elements(self.kind(&keyword.required("TYPE")?)?, set);
            }
            "NSET" | "ELSET" => {
                if let Some(head) = SetHead::of(keyword) {
                    if head.is_unknown() {
                        let nothing = Noted::Set(head.clone(), Arc::clone(&place.source), place.at..place.at);
                        self.blocks().maker.note(nothing);
                    }
                    self.open = Open::Set(head);
                }
            }
            "NGEN" | "NFILL" | "NCOPY" | "ELGEN" | "ELCOPY" => {
                match Command::of(keyword, self.frame != Affine::IDENTITY) {
                    Ok(command) => self.open = Open::Make(command, Vec::new()),
                    Err(error) => self.fail(place.of(error))?,
                }
            }
            "USERELEMENT" => self.user_element(keyword)?,
            "SYSTEM" => self.open = Open::Frame(Vec::new()),
            "PART" => self.part(keyword, place)?,
            "ENDPART" => self.leave(Level::Part, "*PART before *END PART")?,
            "ASSEMBLY" => self.assembly = Some(place.clone()),
            "ENDASSEMBLY" => {
                let begun = self.assembly.take().is_some() && self.level == Level::Outside;
                begun.then_some(()).ok_or_else(|| unbalanced("*ASSEMBLY before *END ASSEMBLY"))?;
            }
            "INSTANCE" => self.instance(keyword, place)?,
            "ENDINSTANCE" => self.leave(Level::Instance, "*INSTANCE before *END INSTANCE")?,
            name if name.ends_with("SECTION") => {
                if let Ok(Some(set)) = keyword.label("ELSET") {
                    self.blocks().listed.section(set);
                }
            }
            name if UNEXPANDED.contains(&name) => {
                let error = Error::unsupported(format!("the keyword *{name} is not expanded"));
                self.fail(place.of(error))?;
            }
            name if name.len() >= 3
                && SPELLED_OUT.iter().any(|k| k.len() > name.len() && k.starts_with(name)) =>
            {
                return Err(Error::unsupported(format!("the abbreviated keyword *{name} is not read")));
            }
            _ => {}
        }
        Ok(())
    }

    /// Takes in data lines of the keyword at hand.
    pub(super) fn data(&mut self, source: &Arc<Source>, range: Range<u64>) -> Result<()> {
        if matches!(self.open, Open::Other) {
            return Ok(());
        }
        let bytes = source.peek(range.clone());
        let mut fields = Fields::new(bytes);
        let found = fields.next_line();
        let first = range.start + fields.at as u64;
        if !found.map_err(|_| source.malformed_text(first, "a data line"))? {
            return Ok(());
        }
        if range.end == source.len()
            && matches!(self.open, Open::Nodes(..) | Open::Elements(..) | Open::Make(..))
        {
            ends_with_its_line(source, range.start, bytes)?;
        }
        // Pieces begin with a line, not with its first field.
        let line =
            memchr::memrchr(b'\n', &bytes[..fields.at]).map_or(range.start, |k| range.start + k as u64 + 1);
        if matches!(self.open, Open::Make(..))
            && let Open::Make(command, rows) = std::mem::replace(&mut self.open, Open::Other)
        {
            return self.make_from(source, line..range.end, command, rows);
        }
        match &mut self.open {
            Open::Other | Open::Make(..) => Ok(()),
            Open::Set(head) => {
                let (head, source) = (head.clone(), Arc::clone(source));
                let blocks = self.blocks();
                blocks.listed.list(head.clone(), Arc::clone(&source), line..range.end);
                blocks.maker.note(Noted::Set(head, source, line..range.end));
                Ok(())
            }
            Open::Nothing => Err(source.malformed_text(first, "a keyword line, as *HEADING or *NODE")),
            Open::Frame(rows) | Open::Motion(rows) => points(source, line..range.end, rows),
            Open::Nodes(system, set) => {
                let what = Placement { system: *system, frame: self.frame, motion: Affine::IDENTITY };
                let set = set.clone();
                let mut spans = Vec::new();
                text::cut_at_lines(self.input, source, line..range.end, |span| {
                    spans.push(span);
                    Ok(())
                })?;
                let block = Arc::new(Block { source: Arc::clone(source), spans, what });
                let blocks = self.blocks();
                blocks.maker.note(Noted::Nodes(Arc::clone(&block), set));
                blocks.nodes.push(NodeBlock::Lines(block));
                self.flush()
            }
            Open::Elements(kind, set) => {
                let (what, set) = (kind.clone(), set.clone());
                let spans = cut_at_records(self.input, source, &what, line..range.end)?;
                let block = Arc::new(Block { source: Arc::clone(source), spans, what });
                let blocks = self.blocks();
                let name = set.as_deref().map(|set| plain(set).into());
                blocks.maker.note(Noted::Elements(Arc::clone(&block), set));
                blocks.elements.push(ElementBlock::Lines(block, name));
                self.flush()
            }
        }
    }

    /// Where blocks go now.
    fn blocks(&mut self) -> &mut Blocks {
        match self.level {
            Level::Part => self.parts.last_mut().map(|part| &mut part.blocks),
            Level::Instance => self.instances.last_mut().map(|instance| &mut instance.own),
            Level::Outside => None,
        }
        .unwrap_or(&mut self.outside)
    }

    /// Yields what need not wait; what later keywords may draw on stays.
    fn flush(&mut self) -> Result<()> {
        if self.parts.is_empty() {
            self.seen.note(&self.outside);
            self.outside.yield_to(self.out, None, 0, Affine::IDENTITY, None)?;
            self.outside.nodes.clear();
            self.outside.elements.clear();
        }
        Ok(())
    }

    /// Takes in data lines of a keyword that makes others: each line makes some, or all are needed first.
    fn make_from(
        &mut self,
        source: &Arc<Source>,
        range: Range<u64>,
        command: Command,
        mut rows: Vec<Row>,
    ) -> Result<()> {
        if command.is_by_line() {
            self.make(&command, (source, range), &[])?;
        } else {
            points(source, range, &mut rows)?;
        }
        self.open = Open::Make(command, rows);
        Ok(())
    }

    /// Makes nodes or elements. A fault counts only where they are used.
    fn make(&mut self, command: &Command, data: (&Arc<Source>, Range<u64>), rows: &[Row]) -> Result<()> {
        let input = self.input;
        let blocks = self.blocks();
        match blocks.maker.run(command, input, data, rows) {
            Ok(made) => {
                blocks.nodes.extend(made.nodes.map(NodeBlock::Made));
                let set = made.set;
                let elements = made.elements.into_iter();
                blocks.elements.extend(elements.map(|made| ElementBlock::Made(made, set.clone())));
                self.flush()
            }
            Err(error) => self.fail(error),
        }
    }

    /// Keeps the first fault of a part, which may have no instance.
    fn fail(&mut self, error: Error) -> Result<()> {
        let fault = self.blocks().fault.get_mut();
        fault.get_or_insert(error);
        self.flush()
    }

    /// Ends the data of the last keyword.
    fn close(&mut self) -> Result<()> {
        let done = match std::mem::replace(&mut self.open, Open::Other) {
            Open::Frame(rows) => frame(&rows).map(|frame| self.frame = frame),
            Open::Make(command, rows) if !command.is_by_line() => {
                if let Some(Place { source, at }) = self.place.clone() {
                    self.make(&command, (&source, at..at), &rows)?;
                }
                Some(())
            }
            Open::Motion(rows) => motion(&rows).map(|motion| {
                if let Some(instance) = self.instances.last_mut() {
                    instance.motion = motion;
                }
            }),
            _ => Some(()),
        };
        match (done, &self.place) {
            (None, Some(place)) => {
                let expected =
                    "points that are apart: *SYSTEM takes six and three numbers, *INSTANCE three and seven";
                Err(place.of(Error::malformed(expected, "others on the lines after this one")))
            }
            _ => Ok(()),
        }
    }

    fn kind(&mut self, name: &[u8]) -> Result<Kind> {
        let name = name.escape_ascii().to_string();
        Ok(self.kinds.entry(name).or_insert_with_key(|name| types::resolve(name)).clone())
    }

    fn user_element(&mut self, keyword: &Keyword) -> Result<()> {
        let name = keyword.required("TYPE")?.escape_ascii().to_string();
        let nodes = match keyword.value("NODES") {
            None => 0,
            Some(value) => {
                let nodes = Fields::new(value).integer("a number of nodes")?;
                if nodes > MOST_NODES as u64 {
                    return Err(Error::limit("number of nodes of an element", MOST_NODES));
                }
                nodes as usize
            }
        };
        let kind = types::user(&name, nodes);
        self.kinds.insert(name, kind);
        Ok(())
    }

    fn part(&mut self, keyword: &Keyword, place: &Place) -> Result<()> {
        if self.level != Level::Outside {
            return Err(unbalanced("*END PART or *END INSTANCE before another *PART"));
        }
        let name = keyword.required("NAME")?;
        if self.part_names.insert(name.clone(), self.parts.len()).is_some() {
            return Err(Error::malformed("a part name of its own", excerpt(&name)));
        }
        let name = plain(&name);
        self.parts.push(Part { name, blocks: Blocks::default(), place: place.clone() });
        self.level = Level::Part;
        self.frame = Affine::IDENTITY;
        Ok(())
    }

    fn instance(&mut self, keyword: &Keyword, place: &Place) -> Result<()> {
        if self.level != Level::Outside {
            return Err(unbalanced("*END PART or *END INSTANCE before another *INSTANCE"));
        }
        if keyword.value("LIBRARY").is_some() || keyword.value("INSTANCE").is_some() {
            return Err(Error::unsupported(
                "an *INSTANCE from another analysis (LIBRARY=, INSTANCE=) is not read",
            ));
        }
        let name = keyword.required("PART")?;
        let Some(&part) = self.part_names.get(&name) else {
            return Err(Error::malformed("the name of a part that is defined before", excerpt(&name)));
        };
        if self.instances.len() >= MOST_INSTANCES {
            return Err(Error::limit("number of instances", MOST_INSTANCES));
        }
        let name = keyword.label("NAME")?;
        if let Some(name) = name.clone() {
            self.scopes.insert(name, scope(self.instances.len()));
        }
        let name = name.map(|name| plain(&name));
        let (own, motion) = (Blocks::default(), Affine::IDENTITY);
        self.instances.push(Instance { part, name, own, motion, place: place.clone() });
        self.level = Level::Instance;
        self.frame = Affine::IDENTITY;
        self.open = Open::Motion(Vec::new());
        Ok(())
    }

    fn leave(&mut self, level: Level, expected: &str) -> Result<()> {
        if self.level != level {
            return Err(unbalanced(expected));
        }
        self.level = Level::Outside;
        self.frame = Affine::IDENTITY;
        Ok(())
    }

    /// The deck has ended: yields what waited for the instances.
    pub(super) fn finish(mut self) -> Result<()> {
        self.close()?;
        let begun = match self.level {
            Level::Part => self.parts.last().map(|part| (&part.place, "*END PART")),
            Level::Instance => self.instances.last().map(|instance| (&instance.place, "*END INSTANCE")),
            Level::Outside => self.assembly.as_ref().map(|place| (place, "*END ASSEMBLY")),
        };
        if let Some((place, end)) = begun {
            return Err(place.of(Error::malformed(format!("{end} after this line"), "the end of the file")));
        }
        let budget = &self.input.memory;
        let instances = self.instances.iter_mut().map(|instance| &mut instance.own);
        let parts = self.parts.iter_mut().map(|part| &mut part.blocks).chain(instances);
        for blocks in parts.chain([&mut self.outside]) {
            blocks.sets.fill(std::mem::take(&mut blocks.listed), budget);
        }
        let nothing = Blocks::default();
        let mut copies = Vec::new();
        if self.instances.is_empty() {
            for part in &self.parts {
                copies.push((Some(part.name.as_str()), &part.blocks, &nothing, Affine::IDENTITY));
            }
        }
        for Instance { part, name, own, motion, .. } in &self.instances {
            let part = &self.parts[*part];
            copies.push((Some(name.as_ref().unwrap_or(&part.name).as_str()), &part.blocks, own, *motion));
        }
        for (number, (owner, blocks, own, motion)) in copies.into_iter().enumerate() {
            self.seen.note(blocks);
            self.seen.note(own);
            blocks.yield_to(self.out, owner, scope(number), motion, None)?;
            own.yield_to(self.out, owner, scope(number), motion, None)?;
        }
        self.seen.note(&self.outside);
        let scopes = Arc::new(self.scopes);
        let instances = Some(&scopes).filter(|scopes| !scopes.is_empty());
        self.outside.yield_to(self.out, None, 0, Affine::IDENTITY, instances)?;
        if let Some(missing) = self.seen.missing() {
            let source = &self.input.source;
            let error = Error::malformed("a mesh", format!("a deck that has no *{missing} data"));
            return Err(source.place(error, Spot::Text(source.len())));
        }
        Ok(())
    }
}

/// Refuses mesh data that stops in the middle of a line: a number cut short is still a number, and a deck has no end
/// mark that would tell.
fn ends_with_its_line(source: &Source, at: u64, data: &[u8]) -> Result<()> {
    let last = memchr::memrchr(b'\n', data).map_or(0, |k| k + 1);
    if data[last..].trim_ascii().is_empty() {
        return Ok(());
    }
    let expected = "an end of line after the last data line (without it the file may have been cut off)";
    Err(source.malformed_text(at + last as u64, expected))
}

fn unbalanced(expected: &str) -> Error {
    Error::malformed(expected, "none")
}

/// The coordinate system of a `*NODE` line.
fn system(keyword: &Keyword) -> Result<System> {
    match keyword.label("SYSTEM")? {
        None => Ok(System::Rectangular),
        Some(name) => System::named(&name).ok_or_else(|| {
            Error::malformed("SYSTEM=R, SYSTEM=C or SYSTEM=S", format!("SYSTEM={}", plain(&name)))
        }),
    }
}
