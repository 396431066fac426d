//! Which shape the faces of a cell make, and its corners in our order: the classes that checkMesh counts.

use std::sync::{Arc, LazyLock};

use crate::mesh::{ElementType, Shape};

/// The shapes under OpenFOAM's names, each with as many faces of three and four corners.
static MODELS: LazyLock<[(Arc<ElementType>, [usize; 2]); 4]> = LazyLock::new(|| {
    let model = |name, shape: Shape| {
        let facts = shape.facts();
        let kind = ElementType::measured(name, shape, 1, shape.corners());
        (Arc::new(kind), [facts.triangles.len(), facts.quadrilaterals.len()])
    };
    [
        model("hex", Shape::Hexahedron),
        model("prism", Shape::Wedge),
        model("pyr", Shape::Pyramid),
        model("tet", Shape::Tetrahedron),
    ]
});

/// Cells that no measure is defined for: a brick with one edge collapsed, a prism with one, and any other.
static OTHERS: LazyLock<[Arc<ElementType>; 3]> = LazyLock::new(|| {
    [("wedge", "collapsed hexahedron"), ("tetWedge", "collapsed wedge"), ("polyhedron", "polyhedron")]
        .map(|(name, what)| Arc::new(ElementType::counted(name, what, 0)))
});

/// Most faces of a cell that may be a shape.
const MOST: usize = 6;

/// The faces of a cell that may be a shape, each with its corners in order round it, as seen from inside the cell.
pub(super) struct Sides {
    rings: [[u32; 4]; MOST],
    sizes: [usize; MOST],
    count: usize,
}

impl Sides {
    /// Faces, and whether each is stored as seen from inside. There must be few of them, and with three or four corners.
    #[inline]
    pub(super) fn of<'f>(faces: impl Iterator<Item = (&'f [u32], bool)>) -> Option<Self> {
        let mut sides = Self { rings: [[0; 4]; MOST], sizes: [0; MOST], count: 0 };
        for (points, from_inside) in faces {
            if sides.count == MOST || !(3..=4).contains(&points.len()) {
                return None;
            }
            let ring = &mut sides.rings[sides.count][..points.len()];
            ring.copy_from_slice(points);
            if !from_inside {
                ring.reverse();
            }
            sides.sizes[sides.count] = points.len();
            sides.count += 1;
        }
        Some(sides)
    }

    fn rings(&self) -> impl Iterator<Item = &[u32]> {
        self.rings.iter().zip(self.sizes).take(self.count).map(|(ring, size)| &ring[..size])
    }

    /// The corner that an edge leads to from `corner`, away from the ring `base`.
    fn above(&self, corner: u32, base: &[u32]) -> Option<u32> {
        let next = |ring: &[u32]| {
            let k = ring.iter().position(|c| *c == corner)?;
            let beside = [ring[(k + 1) % ring.len()], ring[(k + ring.len() - 1) % ring.len()]];
            beside.into_iter().find(|c| !base.contains(c))
        };
        self.rings().find_map(next)
    }
}

/// The shape that the faces make, and its corners.
#[inline]
pub(super) fn shape(sides: &Sides) -> Option<(&'static Arc<ElementType>, [u64; 8])> {
    let of_size = |size| sides.rings().filter(|ring| ring.len() == size).count();
    let found = [of_size(3), of_size(4)];
    let (kind, _) = MODELS.iter().find(|(_, faces)| *faces == found)?;
    let shape = kind.shape()?;
    let base_size = if matches!(shape, Shape::Hexahedron | Shape::Pyramid) { 4 } else { 3 };
    let base = sides.rings().find(|ring| ring.len() == base_size)?;
    let mut corners = [0; 8];
    corners[..base_size].copy_from_slice(base);
    for k in base_size..kind.nodes {
        corners[k] = sides.above(base[k - base_size], base)?;
    }
    let corners_found = &corners[..kind.nodes];
    are_faces_of(shape, corners_found, sides).then(|| (kind, corners.map(u64::from)))
}

/// Whether the faces are those of the shape with these corners, each once.
fn are_faces_of(shape: Shape, corners: &[u32], sides: &Sides) -> bool {
    let facts = shape.facts();
    let mask = |ring: &[usize]| ring.iter().fold(0u8, |mask, corner| mask | 1 << corner);
    let mut expected = [0u8; MOST];
    let faces = facts.triangles.iter().map(|f| mask(f)).chain(facts.quadrilaterals.iter().map(|f| mask(f)));
    faces.zip(&mut expected).for_each(|(face, place)| *place = face);
    let mut joined = [0u8; 8];
    for &[a, b] in facts.edges {
        joined[a] |= 1 << b;
        joined[b] |= 1 << a;
    }
    sides.rings().all(|ring| {
        let mut places = [0; 4];
        for (place, corner) in places.iter_mut().zip(ring) {
            match corners.iter().position(|c| c == corner) {
                Some(k) => *place = k,
                None => return false,
            }
        }
        let places = &places[..ring.len()];
        let is_ring = (0..places.len()).all(|k| joined[places[k]] & 1 << places[(k + 1) % places.len()] != 0);
        // Each face is struck off once it is met.
        let face = expected.iter_mut().find(|face| **face == mask(places));
        is_ring && face.is_some_and(|face| std::mem::take(face) != 0)
    })
}

/// What a cell is that is no shape; its points are sorted, and named once each.
#[cold]
pub(super) fn other(faces: usize, points: &mut Vec<u64>) -> &'static Arc<ElementType> {
    let mentioned = points.len();
    points.sort_unstable();
    points.dedup();
    match (faces, mentioned, points.len()) {
        (6, 22, 7) => &OTHERS[0],
        (4, 14, 5) => &OTHERS[1],
        _ => &OTHERS[2],
    }
}
