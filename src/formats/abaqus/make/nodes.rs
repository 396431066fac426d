//! Nodes out of others: on lines and arcs, between two sets, and copies that are moved or mirrored.

use super::made::NodeRows;
use super::tables::Tables;
use super::{MadeNodes, Store};
use crate::error::{Error, Result};
use crate::formats::abaqus::fields::Fields;
use crate::formats::abaqus::keywords::Keyword;
use crate::formats::abaqus::placement::Affine;
use crate::formats::abaqus::points::{self, Row};
use crate::formats::axes::{cross, dot, minus, unit};

/// How `*NCOPY` moves its copies.
pub(super) enum Copy {
    /// A shift, and a turn about an axis after it.
    Shift,
    /// Through a line of two points, a plane of three, or one point.
    Line,
    Mirror,
    Point,
}

impl Copy {
    pub(super) fn of(keyword: &Keyword) -> Result<Self> {
        let reflect = keyword.label("REFLECT")?;
        match (keyword.value("SHIFT").is_some(), reflect.as_deref()) {
            (true, None) => Ok(Self::Shift),
            (false, Some(b"LINE")) => Ok(Self::Line),
            (false, Some(b"MIRROR")) => Ok(Self::Mirror),
            (false, Some(b"POINT")) => Ok(Self::Point),
            _ => Err(Error::malformed("SHIFT, or REFLECT=LINE, MIRROR or POINT", "*NCOPY without")),
        }
    }
}

/// Adds scaled vectors.
fn sum<const N: usize>(terms: [(f64, [f64; 3]); N]) -> [f64; 3] {
    [0, 1, 2].map(|axis| terms.iter().map(|(factor, vector)| factor * vector[axis]).sum())
}

/// `*NGEN`: a line of nodes for each data line, between two that are defined.
pub(super) fn lines(
    tables: &mut Tables,
    store: &Store<'_>,
    fields: &mut Fields<'_>,
    set: Option<&[u8]>,
    (arc, framed): (bool, bool),
) -> Result<MadeNodes> {
    let mut made = NodeRows::new(store);
    while fields.next_line()? {
        store.line.set(fields.at);
        let (values, count) = fields.reals()?;
        let whole = |k: usize, absent: u64| whole_number(values[k], k < count, absent);
        let (first, last, step) = (whole(0, 0)?, whole(1, 0)?, whole(2, 1)?);
        let between = first.abs_diff(last);
        if step == 0 || between % step != 0 {
            let expected = "two end nodes whose numbers lie a multiple of the increment apart";
            return Err(Error::malformed(expected, format!("{first}, {last}, {step}")));
        }
        let (a, b) = (tables.node(first)?, tables.node(last)?);
        let arc = match arc {
            false => None,
            true => {
                let centre = match whole(3, 0)? {
                    0 if framed => {
                        return Err(Error::unsupported(
                            "*NGEN with a centre by coordinates within a *SYSTEM is not expanded",
                        ));
                    }
                    0 => [values[4], values[5], values[6]],
                    node => tables.node(node)?,
                };
                let normal = (count > 7).then(|| [values[7], values[8], values[9]]);
                Some(Arc::new(a, b, centre, normal)?)
            }
        };
        let intervals = between / step;
        for k in 1..intervals {
            let share = k as f64 / intervals as f64;
            let id = if first < last { first + k * step } else { first - k * step };
            let point = match &arc {
                Some(arc) => arc.at(share),
                None => sum([(1.0 - share, a), (share, b)]),
            };
            made.push(tables, id, point)?;
        }
        if let Some(set) = set {
            let range = [first.min(last), first.max(last), step];
            tables.node_sets.entry(set.to_vec()).or_default().add(vec![range]);
        }
    }
    made.finish()
}

/// A whole number among reals.
fn whole_number(value: f64, given: bool, absent: u64) -> Result<u64> {
    if !given || value == 0.0 {
        return Ok(absent);
    }
    let most = crate::formats::abaqus::fields::LARGEST_NUMBER as f64;
    if value.fract() != 0.0 || !(1.0..=most).contains(&value) {
        return Err(Error::malformed("a number from 1", value.to_string()));
    }
    Ok(value as u64)
}

/// An arc of a circle: its centre, the radius to the first end, a radius a quarter turn on, and the angle.
struct Arc {
    centre: [f64; 3],
    radius: [f64; 3],
    quarter: [f64; 3],
    angle: f64,
}

impl Arc {
    /// From a to b; without a normal the shorter way.
    fn new(a: [f64; 3], b: [f64; 3], centre: [f64; 3], normal: Option<[f64; 3]>) -> Result<Self> {
        let (from, to) = (minus(a, centre), minus(b, centre));
        let (length, other) = (dot(from, from).sqrt(), dot(to, to).sqrt());
        if (length - other).abs() > 1e-3 * length.max(other) {
            return Err(Error::malformed(
                "a centre that is as far from one end of the arc as from the other",
                format!("{length} and {other}"),
            ));
        }
        let axis = unit(normal.unwrap_or(cross(from, to)));
        let Some(axis) = axis.filter(|axis| dot(*axis, from).abs() <= 1e-3 * length) else {
            return Err(Error::malformed(
                "an arc under 180 degrees, or the normal to its plane",
                "ends that make no plane with the centre",
            ));
        };
        let quarter = cross(axis, from);
        let angle = dot(quarter, to).atan2(dot(from, to));
        let angle = if angle <= 0.0 { angle + std::f64::consts::TAU } else { angle };
        Ok(Self { centre, radius: from, quarter, angle })
    }

    /// The point that lies a share of the arc on.
    fn at(&self, share: f64) -> [f64; 3] {
        let (sin, cos) = (share * self.angle).sin_cos();
        sum([(1.0, self.centre), (cos, self.radius), (sin, self.quarter)])
    }
}

/// `*NFILL`: rows of nodes from each node of one set to the one at the same place of another.
pub(super) fn fill(
    tables: &mut Tables,
    store: &Store<'_>,
    fields: &mut Fields<'_>,
    set: Option<&[u8]>,
) -> Result<MadeNodes> {
    let mut made = NodeRows::new(store);
    while fields.next_line()? {
        store.line.set(fields.at);
        let mut bound = || -> Result<Vec<u64>> {
            let token = fields.token();
            fields.at += token.len();
            if !fields.comma()? {
                return Err(fields.malformed("two sets and a number of intervals"));
            }
            tables.members(true, &crate::formats::abaqus::keywords::label(token))
        };
        let (from, to) = (bound()?, bound()?);
        let [intervals, step] = fields.integers([None, Some(1)])?;
        if from.len() != to.len() || intervals == 0 || step == 0 {
            let expected = "two sets with as many nodes each, a number of intervals and an increment";
            return Err(Error::malformed(
                expected,
                format!("{} and {} nodes, {intervals}, {step}", from.len(), to.len()),
            ));
        }
        for (first, last) in from.into_iter().zip(to) {
            let (a, b) = (tables.node(first)?, tables.node(last)?);
            for k in 1..intervals {
                let share = k as f64 / intervals as f64;
                let id = k.checked_mul(step).and_then(|offset| first.checked_add(offset));
                made.push(tables, id.unwrap_or(u64::MAX), sum([(1.0 - share, a), (share, b)]))?;
            }
            if let Some(set) = set {
                let mut range = vec![[last, last, 1]];
                range.push([first, first + (intervals - 1) * step, step]);
                tables.node_sets.entry(set.to_vec()).or_default().add(range);
            }
        }
    }
    made.finish()
}

/// `*NCOPY`: copies of the nodes of a set, moved or mirrored.
pub(super) fn copy(
    tables: &mut Tables,
    store: &Store<'_>,
    (old, change, set): (&[u8], u64, Option<&[u8]>),
    how: &Copy,
    rows: &[Row],
) -> Result<MadeNodes> {
    let image = image(how, rows).ok_or_else(|| {
        let expected = "points that are apart: SHIFT takes three and seven numbers, LINE six, MIRROR six and three, POINT three";
        Error::malformed(expected, "others on the lines after this one")
    })?;
    let mut made = NodeRows::new(store);
    for id in tables.members(true, old)? {
        let point = image(tables.node(id)?);
        made.push(tables, id.saturating_add(change), point)?;
        if let Some(set) = set {
            tables.node_sets.entry(set.to_vec()).or_default().add(vec![[id + change, id + change, 1]]);
        }
    }
    made.finish()
}

/// Where a copy of a node comes to stand.
type Image = Box<dyn Fn([f64; 3]) -> [f64; 3]>;

fn image(how: &Copy, rows: &[Row]) -> Option<Image> {
    let point = |row: usize, first: usize| rows.get(row)?.point(first);
    Some(match how {
        Copy::Shift => {
            // A turn by nothing may be left out, or stand there as zeros.
            let turned = rows.get(1).is_some_and(|row| row.angle() != 0.0);
            let motion = if turned { points::motion(rows)? } else { Affine::motion(point(0, 0)?, None)? };
            Box::new(move |p| motion.apply(p))
        }
        Copy::Point => {
            let centre = point(0, 0)?;
            Box::new(move |p| sum([(2.0, centre), (-1.0, p)]))
        }
        Copy::Line => {
            let (a, b) = (point(0, 0)?, point(0, 3)?);
            let along = unit(minus(b, a))?;
            Box::new(move |p| {
                let foot = sum([(1.0, a), (dot(minus(p, a), along), along)]);
                sum([(2.0, foot), (-1.0, p)])
            })
        }
        Copy::Mirror => {
            let (a, b, c) = (point(0, 0)?, point(0, 3)?, point(1, 0)?);
            let normal = unit(cross(minus(b, a), minus(c, a)))?;
            Box::new(move |p| sum([(1.0, p), (-2.0 * dot(minus(p, a), normal), normal)]))
        }
    })
}
