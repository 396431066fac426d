//! Which mesh gets which colour.

use crate::report::figure::Series;
use crate::report::safe::escaped;
use crate::summary::{Status, Summary};

/// Number of colours that can be told apart.
pub const COLOURS: usize = 8;

/// A series a mesh. Where there are more meshes than colours, those have one that most need a look: those that got
/// worse, those that fail, then those with the lowest minimum.
pub fn series(meshes: &[Summary], got_worse: &[String]) -> Vec<Series> {
    let urgency = |mesh: &Summary| {
        let worse = got_worse.contains(&mesh.mesh.name);
        (!worse, mesh.verdict.status != Status::Fail, lowest(mesh))
    };
    let mut order: Vec<usize> = (0..meshes.len()).collect();
    if meshes.len() > COLOURS {
        order.sort_by(|a, b| {
            let (a, b) = (urgency(&meshes[*a]), urgency(&meshes[*b]));
            (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
        });
    }
    let mut coloured: Vec<usize> = order.into_iter().take(COLOURS).collect();
    coloured.sort_unstable();
    let class = |index: usize| match coloured.iter().position(|coloured| *coloured == index) {
        Some(place) => format!("s{place}"),
        None => "rest".to_owned(),
    };
    let one = |(index, mesh): (usize, &Summary)| Series {
        name: escaped(&mesh.mesh.name),
        index,
        class: class(index),
    };
    meshes.iter().enumerate().map(one).collect()
}

/// The lowest minimum of any measure of the mesh's own dimension.
fn lowest(mesh: &Summary) -> f64 {
    let minima = mesh.main_shapes().flat_map(|(_, shape)| shape.measures.values()).map(|measure| measure.min);
    minima.fold(1.0, f64::min)
}
