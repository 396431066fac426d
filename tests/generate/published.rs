//! FD1 and FG2 are the report's meshes: every digit of their fourteen rows comes out.

use std::collections::HashMap;
use std::fs;

use meshgauge::generate::Problem;
use meshgauge::measures::{quadrilateral, triangle};
use meshgauge::mesh::Shape;

use crate::{Point, elements, nodes, problem};

/// Max, min, mean and standard deviation by Welford, and every element's own minimum.
#[derive(Default)]
struct Column {
    count: f64,
    max: f64,
    min: f64,
    mean: f64,
    squares: f64,
    least: HashMap<u64, f64>,
}

impl Column {
    fn push(&mut self, element: u64, score: f64) {
        if self.count == 0.0 {
            (self.max, self.min) = (score, score);
        }
        self.count += 1.0;
        self.max = self.max.max(score);
        self.min = self.min.min(score);
        let step = score - self.mean;
        self.mean += step / self.count;
        self.squares += step * (score - self.mean);
        let least = self.least.entry(element).or_insert(score);
        *least = least.min(score);
    }

    /// As the report prints it: max, min, mean, sd.
    fn printed(&self) -> [String; 4] {
        [self.max, self.min, self.mean, (self.squares / self.count).sqrt()].map(|x| format!("{x:.3}"))
    }
}

/// M22 of the report's tables for these meshes: the fourth side of each face is left out.
fn three_sides(face: &[Point; 4]) -> f64 {
    quadrilateral::aspect_three_sides(face)
}

fn four_sides(face: &[Point; 4]) -> f64 {
    quadrilateral::score(face)[1]
}

/// The faces of a hexahedron as the report's three-sided M22 of FD1 tells them: both rings begin at the first corner,
/// so that the side left out is the one nearest to the axis. On rectangles it makes no difference.
const HEXAHEDRON_FACES: [[usize; 4]; 6] =
    [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// The five columns of triangular faces and the three of quadrilateral faces of all elements of `shape`.
fn score(problem: &Problem, shape: Shape, aspect: fn(&[Point; 4]) -> f64) -> Vec<(String, Column)> {
    let mesh = problem.mesh();
    let points = nodes(mesh);
    let blocks = mesh.blocks();
    let before = blocks.iter().take_while(|block| block.shape != shape);
    let first = 1 + before.map(|block| block.elements).sum::<u64>();
    let quadrilaterals =
        if shape == Shape::Hexahedron { &HEXAHEDRON_FACES } else { shape.facts().quadrilaterals };

    let mut columns: Vec<_> = ["M11", "M12", "M13", "M14", "M15", "M21", "M22", "M23"]
        .map(|m| (m.into(), Column::default()))
        .into();
    for (number, corners) in (first..).zip(elements(mesh, shape)) {
        let point = |corner: usize| points[corners[corner] as usize];
        for face in shape.facts().triangles {
            let scores = triangle::score(&face.map(point));
            scores.into_iter().enumerate().for_each(|(m, score)| columns[m].1.push(number, score));
        }
        for face in quadrilaterals {
            let face = face.map(point);
            let [warp, _, taper] = quadrilateral::score(&face);
            let scores = [warp, aspect(&face), taper];
            scores.into_iter().enumerate().for_each(|(m, score)| columns[5 + m].1.push(number, score));
        }
    }
    columns
}

/// Compares with the rows of one table; gives the number of rows that there were.
fn assert_published(table: &str, mesh: &str, columns: &[(String, Column)]) -> usize {
    let file = fs::read_to_string("src/report/page/npl_tables.csv").unwrap();
    let rows = file.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let mut count = 0;
    for row in rows.filter(|row| row[0] == table && row[1] == mesh) {
        let [_, _, measure, max, min, min_element, mean, sd] = row[..] else { panic!("{row:?}") };
        let (_, column) = columns.iter().find(|(name, _)| name == measure).unwrap();
        assert_eq!(column.printed(), [max, min, mean, sd], "{mesh}, table {table}, {measure}");
        count += 1;
        // Where all are perfect there is no worst one: for FD1's wedges the report then names a hexahedron.
        if min == "1.000" {
            continue;
        }
        // Both meshes are symmetric, so that many elements share the minimum and rounding chose the one in print. It
        // has to be one of them.
        let published = column.least[&min_element.parse::<u64>().unwrap()];
        assert!(published - column.min < 1e-12, "{measure} of {min_element}: {published}, {}", column.min);
    }
    count
}

#[test]
fn fd1_is_the_mesh_of_tables_2_4_and_5() {
    let fd1 = problem("fd-cylinder", &[]);
    assert_eq!(fd1.mesh().nodes(), 19811);
    let blocks: Vec<_> = fd1.mesh().blocks().iter().map(|b| (b.shape, b.elements)).collect();
    assert_eq!(blocks, [(Shape::Hexahedron, 17640), (Shape::Wedge, 360)]);

    let hexahedra = score(&fd1, Shape::Hexahedron, three_sides);
    let wedges = score(&fd1, Shape::Wedge, three_sides);
    assert_eq!(assert_published("2", "FD1", &wedges), 5);
    assert_eq!(assert_published("4", "FD1", &hexahedra), 3);
    assert_eq!(assert_published("5", "FD1", &wedges), 3);
}

#[test]
fn fg2_is_the_mesh_of_table_3() {
    let fg2 = problem("mapped-disc", &[]);
    assert_eq!((fg2.mesh().nodes(), fg2.mesh().elements()), (2025, 1936));
    let columns = score(&fg2, Shape::Quadrilateral, three_sides);
    assert_eq!(assert_published("3", "FG2", &columns), 3);
}

#[test]
fn with_all_four_sides_m22_is_what_the_erratum_says() {
    let mean_and_sd = |model, shape| {
        let columns = score(&problem(model, &[]), shape, four_sides);
        let [_, _, mean, sd] = columns[6].1.printed();
        (mean, sd)
    };
    assert_eq!(mean_and_sd("mapped-disc", Shape::Quadrilateral), ("0.968".into(), "0.020".into()));
    assert_eq!(mean_and_sd("fd-cylinder", Shape::Hexahedron), ("0.534".into(), "0.369".into()));
}
