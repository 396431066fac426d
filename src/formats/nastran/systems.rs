//! Coordinate systems: collected from CORD1R to CORD2S wherever they stand, then resolved into the basic system. A
//! system may stand in another one (CORD2x) or on three nodes that have systems of their own (CORD1x).

use std::collections::{HashMap, HashSet};

use super::fields::Fields;
use super::frame::{Axes, Frame};
use super::grids::{GRID, Grid};
use super::lines::{Cards, Name};
use super::walk::Stretch;
use crate::error::{Error, Result};
use crate::input::Spot;

/// The most coordinate systems.
const MOST: usize = 1 << 20;

/// Whether a card defines coordinate systems or the defaults of nodes.
pub(super) fn is_known(name: &Name) -> bool {
    name == b"GRDSET  " || axes(name).is_some()
}

/// The axes of a card, and whether it stands on nodes.
fn axes(name: &Name) -> Option<(Axes, bool)> {
    match name {
        b"CORD1R  " => Some((Axes::Rectangular, true)),
        b"CORD1C  " => Some((Axes::Cylindrical, true)),
        b"CORD1S  " => Some((Axes::Spherical, true)),
        b"CORD2R  " => Some((Axes::Rectangular, false)),
        b"CORD2C  " => Some((Axes::Cylindrical, false)),
        b"CORD2S  " => Some((Axes::Spherical, false)),
        _ => None,
    }
}

/// All coordinate systems of a deck, by number.
#[derive(Debug, Default)]
pub(super) struct Systems {
    /// That of nodes that name none.
    default: u64,
    /// Why a system is none is told once a node asks for it.
    known: HashMap<u64, std::result::Result<Frame, &'static str>>,
}

/// A system as its card says it.
struct Definition {
    axes: Axes,
    points: Points,
}

/// The three points that span a system.
enum Points {
    /// Points in the system of that number.
    In(u64, [[f64; 3]; 3]),
    /// Nodes.
    Nodes([u64; 3]),
}

/// What the cards say.
#[derive(Default)]
struct Definitions {
    systems: HashMap<u64, Definition>,
    default: u64,
    /// The nodes that systems stand on.
    nodes: HashMap<u64, Grid>,
}

impl Systems {
    /// Reads and resolves the systems of all stretches.
    pub(super) fn collect(stretches: &[Stretch]) -> Result<Systems> {
        let mut found = Definitions::default();
        for stretch in stretches.iter().filter(|s| s.holds.systems) {
            each_card(stretch, |name, line, cards| found.card(name, line, cards))?;
        }
        let wanted: HashSet<u64> = found.systems.values().flat_map(Definition::nodes).copied().collect();
        if !wanted.is_empty() {
            for stretch in stretches.iter().filter(|s| s.holds.nodes) {
                each_card(stretch, |name, line, cards| {
                    if name == GRID {
                        let grid = Grid::read(line, cards, &mut Fields::new())?;
                        if wanted.contains(&grid.id) {
                            found.nodes.insert(grid.id, grid);
                        }
                    }
                    Ok(())
                })?;
            }
        }
        Ok(found.resolve())
    }

    /// A point of a system in the basic one.
    #[inline]
    pub(super) fn to_basic(&self, system: Option<u64>, point: [f64; 3]) -> Result<[f64; 3]> {
        match system.unwrap_or(self.default) {
            0 => Ok(point),
            number => self.moved(number, point),
        }
    }

    fn moved(&self, number: u64, point: [f64; 3]) -> Result<[f64; 3]> {
        match self.known.get(&number) {
            Some(Ok(frame)) => Ok(frame.to_basic(point)),
            Some(Err(why)) => Err(Error::malformed(format!("a sound coordinate system {number}"), *why)),
            None => {
                Err(Error::malformed("a coordinate system of the deck (CORD1x, CORD2x)", number.to_string()))
            }
        }
    }
}

/// Shows each card of a stretch.
fn each_card(
    stretch: &Stretch,
    mut see: impl for<'w> FnMut(&Name, &'w [u8], &mut Cards<'w>) -> Result<()>,
) -> Result<()> {
    let window = stretch.source.window(stretch.span.clone());
    let mut cards = Cards::new(&window);
    while let Some((name, line)) = cards.next_card() {
        let at = stretch.span.start + cards.at as u64;
        see(&name, line, &mut cards).map_err(|e| stretch.source.place(e, Spot::Text(at)))?;
    }
    Ok(())
}

impl Definition {
    fn nodes(&self) -> &[u64] {
        match &self.points {
            Points::Nodes(nodes) => nodes,
            Points::In(..) => &[],
        }
    }
}

impl Definitions {
    fn card<'w>(&mut self, name: &Name, line: &'w [u8], cards: &mut Cards<'w>) -> Result<()> {
        let mut fields = Fields::new();
        if name == b"GRDSET  " {
            fields.read(line, cards, 2)?;
            self.default = fields.optional(1, "the number of a coordinate system")?.unwrap_or(0);
            return Ok(());
        }
        let Some((axes, on_nodes)) = axes(name) else { return Ok(()) };
        if on_nodes {
            fields.read(line, cards, 8)?;
            self.on_nodes(axes, &fields, 0)?;
            // One card may define two.
            return if fields.get(4).is_empty() { Ok(()) } else { self.on_nodes(axes, &fields, 4) };
        }
        fields.read(line, cards, 11)?;
        let number = fields.positive(0, "the number of a coordinate system")?;
        let within = fields.optional(1, "the number of a coordinate system")?.unwrap_or(0);
        let points = [fields.point(2)?, fields.point(5)?, fields.point(8)?];
        self.add(number, Definition { axes, points: Points::In(within, points) })
    }

    fn on_nodes(&mut self, axes: Axes, fields: &Fields<'_>, first: usize) -> Result<()> {
        let number = fields.positive(first, "the number of a coordinate system")?;
        let mut nodes = [0; 3];
        for (k, node) in nodes.iter_mut().enumerate() {
            *node = fields.positive(first + 1 + k, "a node number")?;
        }
        self.add(number, Definition { axes, points: Points::Nodes(nodes) })
    }

    fn add(&mut self, number: u64, system: Definition) -> Result<()> {
        if self.systems.len() >= MOST {
            return Err(Error::limit("number of coordinate systems", MOST));
        }
        self.systems.insert(number, system);
        Ok(())
    }

    /// Resolves every system after those that it stands in, without recursion: chains may be long.
    fn resolve(self) -> Systems {
        let mut done = Systems { default: self.default, known: HashMap::new() };
        for &number in self.systems.keys() {
            let mut stack = vec![number];
            let mut open = HashSet::from([number]);
            while let Some(&top) = stack.last() {
                let waits_for = self.bases(top).find(|base| !done.known.contains_key(base));
                let resolved = match waits_for {
                    _ if done.known.contains_key(&top) => None,
                    Some(base) if open.insert(base) => {
                        stack.push(base);
                        continue;
                    }
                    Some(_) => Some(Err("one that is defined in terms of itself")),
                    None => Some(self.frame(top, &done)),
                };
                if let Some(resolved) = resolved {
                    done.known.insert(top, resolved);
                }
                open.remove(&top);
                stack.pop();
            }
        }
        done
    }

    /// The systems that one stands in.
    fn bases(&self, number: u64) -> impl Iterator<Item = u64> {
        let (within, nodes): (_, &[u64]) = match self.systems.get(&number).map(|s| &s.points) {
            Some(Points::In(within, _)) => (Some(*within), &[]),
            Some(Points::Nodes(nodes)) => (None, nodes),
            None => (None, &[]),
        };
        let of_nodes = nodes.iter().filter_map(|node| self.nodes.get(node));
        of_nodes.map(|grid| grid.system.unwrap_or(self.default)).chain(within).filter(|base| *base != 0)
    }

    fn frame(&self, number: u64, done: &Systems) -> std::result::Result<Frame, &'static str> {
        let system = self.systems.get(&number).ok_or("one that the deck does not define")?;
        let basic = |within: u64, point| {
            done.to_basic(Some(within), point).map_err(|_| "one that stands in another that is not sound")
        };
        let [a, b, c] = match &system.points {
            Points::In(within, [a, b, c]) => [basic(*within, *a)?, basic(*within, *b)?, basic(*within, *c)?],
            Points::Nodes(nodes) => {
                let mut points = [[0.0; 3]; 3];
                for (point, node) in points.iter_mut().zip(nodes) {
                    let grid = self.nodes.get(node).ok_or("one on a node that the deck does not define")?;
                    *point = basic(grid.system.unwrap_or(self.default), grid.point)?;
                }
                points
            }
        };
        Frame::through(system.axes, a, b, c).ok_or("one whose three points stand in a line")
    }
}
