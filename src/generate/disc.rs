//! Structured meshes of a disc: quadrilaterals round a square core, and triangles in hexagonal rings.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4, SQRT_2};

/// A square core with shells of quadrilaterals round it up to the circle. No quadrilateral has a corner of 180 degrees,
/// as those of one mapped patch have.
///
/// The perimeter of the core is counted counter-clockwise from the corner at -45 degrees: the first quarter of it looks
/// to +x.
#[derive(Debug, Clone, Copy)]
pub(super) struct CoredDisc {
    pub(super) radius: f64,
    /// Quadrilaterals along one side of the core, which are a quarter of those round the disc.
    pub(super) across: u64,
    /// Shells from the core to the circle.
    pub(super) shells: u64,
}

/// Half the side of the core's square over the disc's radius.
const CORE: f64 = 0.42;
/// How far the core's sides bulge from those of a square (0) to a circle (1).
const BULGE: f64 = 0.3;

impl CoredDisc {
    /// A disc of about `divisions` quadrilaterals along a radius.
    pub(super) fn new(radius: f64, divisions: u64) -> Self {
        Self { radius, across: divisions, shells: divisions.div_ceil(2) }
    }

    /// Quadrilaterals round the disc.
    pub(super) fn round(&self) -> u64 {
        4 * self.across
    }

    /// Number of nodes in the core.
    pub(super) fn core_nodes(&self) -> u64 {
        (self.across + 1) * (self.across + 1)
    }

    /// Number of nodes.
    pub(super) fn nodes(&self) -> u64 {
        self.core_nodes() + self.round() * self.shells
    }

    /// Number of quadrilaterals.
    pub(super) fn quadrilaterals(&self) -> u64 {
        self.across * self.across + self.round() * self.shells
    }

    /// The core's column and row at a place of its perimeter.
    pub(super) fn perimeter(&self, place: u64) -> (u64, u64) {
        let n = self.across;
        let (side, along) = ((place / n) % 4, place % n);
        match side {
            0 => (n, along),
            1 => (n - along, n),
            2 => (0, n - along),
            _ => (along, 0),
        }
    }

    /// The core's node in a column (along x) and row (along y).
    pub(super) fn core_node(&self, column: u64, row: u64) -> u64 {
        row * (self.across + 1) + column
    }

    /// The node at a place of the perimeter, `shell` shells outside the core.
    pub(super) fn shell_node(&self, place: u64, shell: u64) -> u64 {
        match shell {
            0 => {
                let (column, row) = self.perimeter(place);
                self.core_node(column, row)
            }
            _ => self.core_nodes() + (shell - 1) * self.round() + place % self.round(),
        }
    }

    /// Whether the node of [`Self::core_node`] is dark.
    pub(super) fn core_is_dark(column: u64, row: u64) -> bool {
        (column + row) % 2 == 1
    }

    /// Whether the node of [`Self::shell_node`] is dark.
    pub(super) fn shell_is_dark(&self, place: u64, shell: u64) -> bool {
        let (column, row) = self.perimeter(place);
        (column + row + shell) % 2 == 1
    }

    /// The point of a core's node.
    pub(super) fn core_point(&self, column: u64, row: u64) -> [f64; 2] {
        let of = |step: u64| (2.0 * step as f64 - self.across as f64) / self.across as f64;
        let (a, b) = (of(column), of(row));
        // The square that the point stands on, and the angle along its side, from -45 to 45 degrees.
        let square = a.abs().max(b.abs());
        if square == 0.0 {
            return [0.0, 0.0];
        }
        let on_circle = if a.abs() >= b.abs() {
            let (sine, cosine) = (FRAC_PI_4 * b / a).sin_cos();
            [a * cosine, a * sine]
        } else {
            let (sine, cosine) = (FRAC_PI_4 * a / b).sin_cos();
            [b * sine, b * cosine]
        };
        let bulge = BULGE * square * square;
        let scale = CORE * self.radius;
        [(a, on_circle[0]), (b, on_circle[1])].map(|(s, c)| scale * ((1.0 - bulge) * s + bulge * SQRT_2 * c))
    }

    /// The point of a shell's node; `shell` may lie between two shells.
    pub(super) fn shell_point(&self, place: u64, shell: f64) -> [f64; 2] {
        let (column, row) = self.perimeter(place);
        let inner = self.core_point(column, row);
        let (sine, cosine) = self.angle(place).sin_cos();
        let t = shell / self.shells as f64;
        [0, 1].map(|k| (1.0 - t) * inner[k] + t * self.radius * [cosine, sine][k])
    }

    /// The angle of a place of the perimeter on the circle.
    pub(super) fn angle(&self, place: u64) -> f64 {
        FRAC_PI_2 * place as f64 / self.across as f64 - FRAC_PI_4
    }

    /// Visits the points of all nodes in order.
    pub(super) fn each_point<E>(&self, mut visit: impl FnMut([f64; 2]) -> Result<(), E>) -> Result<(), E> {
        let core = 0..=self.across;
        core.clone()
            .try_for_each(|row| core.clone().try_for_each(|column| visit(self.core_point(column, row))))?;
        (1..=self.shells).try_for_each(|shell| {
            (0..self.round()).try_for_each(|place| visit(self.shell_point(place, shell as f64)))
        })
    }

    /// Visits all quadrilaterals in order, counter-clockwise, with whether the first corner is dark.
    pub(super) fn each_quadrilateral<E>(
        &self,
        mut visit: impl FnMut([u64; 4], bool) -> Result<(), E>,
    ) -> Result<(), E> {
        self.each_core_quadrilateral(&mut visit)?;
        (0..self.round()).try_for_each(|place| self.each_quadrilateral_outwards(place, &mut visit))
    }

    /// Visits the quadrilaterals of the core.
    pub(super) fn each_core_quadrilateral<E>(
        &self,
        visit: &mut impl FnMut([u64; 4], bool) -> Result<(), E>,
    ) -> Result<(), E> {
        for row in 0..self.across {
            for column in 0..self.across {
                let corners =
                    [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| self.core_node(column + i, row + j));
                visit(corners, Self::core_is_dark(column, row))?;
            }
        }
        Ok(())
    }

    /// Visits the quadrilaterals of the shells between a place of the perimeter and the next.
    pub(super) fn each_quadrilateral_outwards<E>(
        &self,
        place: u64,
        visit: &mut impl FnMut([u64; 4], bool) -> Result<(), E>,
    ) -> Result<(), E> {
        (0..self.shells).try_for_each(|shell| {
            let corners =
                [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(p, s)| self.shell_node(place + p, shell + s));
            visit(corners, self.shell_is_dark(place, shell))
        })
    }
}

/// Triangles in rings round the centre: ring k has 6k nodes, so that all triangles are about as large.
#[derive(Debug, Clone, Copy)]
pub(super) struct HexagonalDisc {
    pub(super) radius: f64,
    pub(super) rings: u64,
}

impl HexagonalDisc {
    /// Number of nodes.
    pub(super) fn nodes(&self) -> u64 {
        1 + 3 * self.rings * (self.rings + 1)
    }

    /// Number of triangles.
    pub(super) fn triangles(&self) -> u64 {
        6 * self.rings * self.rings
    }

    /// The node on a ring (0 is the centre), counted from angle zero.
    fn node(ring: u64, place: u64) -> u64 {
        if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) + place % (6 * ring) }
    }

    /// Visits the points of all nodes in order.
    pub(super) fn each_point<E>(&self, mut visit: impl FnMut([f64; 2]) -> Result<(), E>) -> Result<(), E> {
        visit([0.0, 0.0])?;
        (1..=self.rings).try_for_each(|ring| {
            let r = self.radius * ring as f64 / self.rings as f64;
            (0..6 * ring).try_for_each(|place| {
                let (sine, cosine) = (FRAC_PI_3 * place as f64 / ring as f64).sin_cos();
                visit([r * cosine, r * sine])
            })
        })
    }

    /// Visits all triangles in order, counter-clockwise.
    pub(super) fn each_triangle<E>(&self, mut visit: impl FnMut([u64; 3]) -> Result<(), E>) -> Result<(), E> {
        for ring in 0..self.rings {
            for sextant in 0..6 {
                for step in 0..=ring {
                    let (inner, outer) = (sextant * ring + step, sextant * (ring + 1) + step);
                    let outward = [Self::node(ring + 1, outer), Self::node(ring + 1, outer + 1)];
                    visit([Self::node(ring, inner), outward[0], outward[1]])?;
                    if step < ring {
                        visit([Self::node(ring, inner), outward[1], Self::node(ring, inner + 1)])?;
                    }
                }
            }
        }
        Ok(())
    }
}
