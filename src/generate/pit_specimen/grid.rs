//! The specimen as blocks of bricks.
//!
//! The cross-section is a [`CoredDisc`]. Swept along the axis it fills the specimen but for a box under the middle of the
//! surface, where the first quarter of the shells is left out. In the box, layers that have the shape of a cup lead from
//! the pit to the box's walls, each a little thicker than the one before: what is small near the pit grows in proportion
//! to its distance. A cup has the topology of the disc too: its bottom is the core, its sides are the shells, its rim is
//! on the specimen's surface.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::io;

use super::pit::Pit;
use crate::generate::VisitNode;
use crate::generate::bricks::{BrickGrid, VisitBrick};
use crate::generate::disc::CoredDisc;

/// Half the length of the box over the specimen's radius.
const BOX_LENGTH: f64 = 0.65;
/// How much longer than at the box the elements are at the specimen's ends.
const END_GROWTH: f64 = 2.0;

pub(super) struct SpecimenGrid {
    pit: Pit,
    length: f64,
    disc: CoredDisc,
    /// Half the length of the box.
    reach: f64,
    /// Layers from either end of the specimen to the box. The box itself has as many as the disc has elements across.
    end_layers: u64,
    /// Cups from the pit to the box's walls.
    cups: u64,
    /// How much thicker each cup is than the one within.
    growth: f64,
}

impl SpecimenGrid {
    pub(super) fn new(pit: Pit, length: f64, divisions: u64) -> Self {
        let disc = CoredDisc::new(pit.specimen, divisions);
        let reach = (BOX_LENGTH * pit.specimen).min(0.4 * length);
        let step = 2.0 * reach / divisions as f64;
        let mean_step = step * (END_GROWTH - 1.0) / END_GROWTH.ln();
        let end_layers = ((length / 2.0 - reach) / mean_step).round().max(1.0) as u64;
        // A cup as thick as its elements are wide: the angle that one takes, times the distance from the pit's centre.
        let angle = FRAC_PI_2 / divisions as f64;
        let growth = 1.0 + angle;
        let cups = ((reach / pit.radius).max(1.0).ln() / growth.ln()).round().max(1.0) as u64;
        Self { pit, length, disc, reach, end_layers, cups, growth }
    }

    /// Layers of the box along the axis.
    fn box_layers(&self) -> u64 {
        self.disc.across
    }

    /// Layers along the whole specimen.
    fn layers(&self) -> u64 {
        2 * self.end_layers + self.box_layers()
    }

    /// Whether the disc in this plane lacks the nodes within the box.
    fn cuts_box(&self, plane: u64) -> bool {
        plane > self.end_layers && plane < self.end_layers + self.box_layers()
    }

    /// Nodes that a plane lacks which cuts the box.
    fn lacking(&self) -> u64 {
        (self.disc.across - 1) * self.disc.shells
    }

    /// Number of the first node in a plane.
    fn plane_start(&self, plane: u64) -> u64 {
        let cutting =
            plane.clamp(self.end_layers + 1, self.end_layers + self.box_layers()) - self.end_layers - 1;
        plane * self.disc.nodes() - cutting * self.lacking()
    }

    /// Number of the disc's node in a plane, which has it.
    fn slice_node(&self, plane: u64, node: u64) -> u64 {
        let start = self.plane_start(plane);
        let core = self.disc.core_nodes();
        if !self.cuts_box(plane) || node < core {
            return start + node;
        }
        // Each shell so far lacks as many nodes, and this one does too after its first.
        let (shell, place) = ((node - core) / self.disc.round(), (node - core) % self.disc.round());
        let before = shell + u64::from(place != 0);
        start + node - before * (self.disc.across - 1)
    }

    /// The disc's node and the plane at which the cup's node lies on the box's walls.
    fn wall(&self, cup_node: u64) -> Wall {
        let (across, core) = (self.disc.across, self.disc.core_nodes());
        if cup_node < core {
            let (place, row) = (cup_node % (across + 1), cup_node / (across + 1));
            return Wall { place, shell: 0, plane: self.end_layers + row };
        }
        let (shell, along) =
            ((cup_node - core) / self.disc.round() + 1, (cup_node - core) % self.disc.round());
        let (place, row) = self.disc.perimeter(along);
        Wall { place, shell, plane: self.end_layers + row }
    }

    /// Number of a node of a cup. The last cup is the box's walls, which belong to the slices.
    fn cup_node(&self, cup: u64, node: u64) -> u64 {
        if cup == self.cups {
            let wall = self.wall(node);
            return self.slice_node(wall.plane, self.disc.shell_node(wall.place, wall.shell));
        }
        self.plane_start(self.layers() + 1) + cup * self.disc.nodes() + node
    }

    /// Height of a plane above the specimen's base.
    fn z(&self, plane: u64) -> f64 {
        let middle = self.length / 2.0;
        let end = middle - self.reach;
        let graded = |layers: u64| end * geometric(layers, self.end_layers, self.end_growth());
        let first = self.end_layers;
        let last = first + self.box_layers();
        if plane <= first {
            end - graded(first - plane)
        } else if plane >= last {
            middle + self.reach + graded(plane - last)
        } else {
            end + 2.0 * self.reach * (plane - first) as f64 / self.box_layers() as f64
        }
    }

    fn end_growth(&self) -> f64 {
        END_GROWTH.powf(1.0 / (self.end_layers.max(2) - 1) as f64)
    }

    /// The point of the pit's surface from which the cup's node sets out: radius, angle, height.
    fn pit_point(&self, node: u64) -> [f64; 3] {
        let (across, core) = (self.disc.across, self.disc.core_nodes());
        let tangent = |step: u64| (FRAC_PI_4 * (2.0 * step as f64 - across as f64) / across as f64).tan();
        // The half cube round the hemisphere, cut at equal angles: its bottom, then its sides from below.
        let direction = |column, row, up: f64| {
            let (a, b): (f64, f64) = (tangent(column), tangent(row));
            (b.atan2(a), a.hypot(b).atan2(up))
        };
        let (azimuth, angle) = if node < core {
            direction(node % (across + 1), node / (across + 1), 1.0)
        } else {
            let (shell, place) = ((node - core) / self.disc.round() + 1, (node - core) % self.disc.round());
            let (column, row) = self.disc.perimeter(place);
            let left = (self.disc.shells - shell) as f64 / self.disc.shells as f64;
            direction(column, row, (FRAC_PI_4 * left).tan())
        };
        let [x, y, z] = self.pit.point(azimuth, angle / FRAC_PI_2);
        [x.hypot(y), y.atan2(x), self.length / 2.0 + z]
    }

    /// The point of the box's walls at which the cup's node arrives: radius, angle, height.
    fn wall_point(&self, node: u64) -> [f64; 3] {
        let wall = self.wall(node);
        let [x, y] = self.disc.shell_point(wall.place, wall.shell as f64);
        [x.hypot(y), y.atan2(x), self.z(wall.plane)]
    }

    fn each_slice_node(&self, visit: VisitNode<'_>) -> io::Result<()> {
        let core = self.disc.core_nodes();
        for plane in 0..=self.layers() {
            let (z, cuts_box) = (self.z(plane), self.cuts_box(plane));
            let mut node = 0;
            self.disc.each_point(|[x, y]| {
                let place = u64::saturating_sub(node, core) % self.disc.round();
                let in_box = (1..self.disc.across).contains(&place);
                node += 1;
                if cuts_box && in_box { Ok(()) } else { visit([x, y, z]) }
            })?;
        }
        Ok(())
    }

    /// Between the pit and the walls in polar coordinates, so that the rim stays on the specimen's surface.
    fn each_cup_node(&self, visit: VisitNode<'_>) -> io::Result<()> {
        // As many as one cup has, which is little beside the whole mesh.
        let ends: Vec<_> = (0..self.disc.nodes()).map(|n| (self.pit_point(n), self.wall_point(n))).collect();
        for cup in 0..self.cups {
            let t = geometric(cup, self.cups, self.growth);
            for (pit, wall) in &ends {
                let [r, angle, z] = [0, 1, 2].map(|k| (1.0 - t) * pit[k] + t * wall[k]);
                let (sine, cosine) = angle.sin_cos();
                visit([r * cosine, r * sine, z])?;
            }
        }
        Ok(())
    }

    fn each_slice_brick(&self, visit: VisitBrick<'_>) -> io::Result<()> {
        for layer in 0..self.layers() {
            let in_box = (self.end_layers..self.end_layers + self.box_layers()).contains(&layer);
            let odd = layer % 2 == 1;
            let mut sweep = |quadrilateral: [u64; 4], dark: bool| {
                let mut corners = [0; 8];
                for (k, node) in quadrilateral.into_iter().enumerate() {
                    corners[k] = self.slice_node(layer, node);
                    corners[4 + k] = self.slice_node(layer + 1, node);
                }
                visit(&corners, dark ^ odd)
            };
            self.disc.each_core_quadrilateral(&mut sweep)?;
            let first = if in_box { self.disc.across } else { 0 };
            (first..self.disc.round())
                .try_for_each(|place| self.disc.each_quadrilateral_outwards(place, &mut sweep))?;
        }
        Ok(())
    }

    fn each_cup_brick(&self, visit: VisitBrick<'_>) -> io::Result<()> {
        for cup in 0..self.cups {
            // The chessboard goes on from the walls, where slices and cups share nodes.
            let odd = (self.disc.across + self.end_layers + self.cups - cup - 1) % 2 == 1;
            self.disc.each_quadrilateral(|quadrilateral, dark| {
                // Seen from outside a cup's faces are counter-clockwise, so the outer cup is the base.
                let mut corners = [0; 8];
                for (k, node) in quadrilateral.into_iter().enumerate() {
                    corners[k] = self.cup_node(cup + 1, node);
                    corners[4 + k] = self.cup_node(cup, node);
                }
                visit(&corners, dark ^ odd)
            })?;
        }
        Ok(())
    }
}

/// Where a node of the last cup lies in the slices.
struct Wall {
    place: u64,
    shell: u64,
    plane: u64,
}

/// The part of the way that `done` of `all` steps make when each is `growth` times the one before.
fn geometric(done: u64, all: u64, growth: f64) -> f64 {
    let sum = |steps: u64| (steps as f64 * growth.ln()).exp_m1();
    sum(done) / sum(all)
}

impl BrickGrid for SpecimenGrid {
    fn nodes(&self) -> u64 {
        self.plane_start(self.layers() + 1) + self.cups * self.disc.nodes()
    }

    fn bricks(&self) -> u64 {
        let section = self.disc.quadrilaterals();
        let left_out = self.disc.across * self.disc.shells * self.box_layers();
        section * (self.layers() + self.cups) - left_out
    }

    fn each_node(&self, visit: VisitNode<'_>) -> io::Result<()> {
        self.each_slice_node(visit)?;
        self.each_cup_node(visit)
    }

    fn each_brick(&self, visit: VisitBrick<'_>) -> io::Result<()> {
        self.each_slice_brick(visit)?;
        self.each_cup_brick(visit)
    }
}
