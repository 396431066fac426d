//! The sizes of meshes on a logarithmic axis: edges from the shortest to the longest, elements from the smallest to
//! the largest, and where the middle nine tenths of them lie.

use super::scale::Scale;
use super::{Scene, Sized};
use crate::report::numbers::significant;

const WIDTH: f64 = 720.0;
/// Space for the names.
const NAMES: f64 = 190.0;
const ROW: f64 = 22.0;
const TOP: f64 = 8.0;
const BOTTOM: f64 = 40.0;
/// Longer names are cut in their middle.
const NAME_LENGTH: usize = 28;

/// One row a mesh. `None` where no mesh has a size over 0.
pub fn sizes(meshes: &[Sized]) -> Option<Scene> {
    let lengths = meshes.iter().flat_map(|mesh| {
        let edges = mesh.sizes.edge_length.map(|edge| [edge.min, edge.max]);
        let elements = mesh.sizes.element_size.as_ref().map(|size| [size.min, size.max]);
        edges.into_iter().chain(elements).flatten()
    });
    let known = lengths.filter(|length| *length > 0.0 && length.is_finite());
    let (least, most) = known.fold((f64::INFINITY, 0.0_f64), |(a, b), length| (a.min(length), b.max(length)));
    if most == 0.0 {
        return None;
    }
    let floor = TOP + ROW * meshes.len() as f64;
    let mut scene = Scene::new(WIDTH, floor + BOTTOM, "Lengths of edges and sizes of elements".to_owned());
    let scale = Scale::logarithmic(least, most, [NAMES, WIDTH - 20.0]);
    for tick in scale.decades() {
        let x = scale.at(tick.value);
        scene.line(if tick.text.is_empty() { "grid faint" } else { "grid" }, [x, TOP], [x, floor], None);
        scene.text("tick middle", [x, floor + 15.0], &tick.text);
    }
    scene.line("axis", [NAMES, floor], [WIDTH - 20.0, floor], None);
    scene.text("code middle", [(NAMES + WIDTH - 20.0) / 2.0, floor + 33.0], "length, in the mesh's own unit");
    for (i, mesh) in meshes.iter().enumerate() {
        row(&mut scene, mesh, TOP + ROW * (i as f64 + 0.5), scale);
    }
    Some(scene)
}

fn row(scene: &mut Scene, mesh: &Sized, y: f64, scale: Scale) {
    let (name, class, index) = (&mesh.series.name, &mesh.series.class, Some(mesh.series.index));
    scene.text("name end", [NAMES - 10.0, y + 4.0], &shortened(name));
    if let Some(edge) = mesh.sizes.edge_length {
        let class = format!("span {class}");
        scene.line(&class, [scale.at(edge.min), y], [scale.at(edge.max), y], index);
        for end in [edge.min, edge.max] {
            scene.line(&class, [scale.at(end), y - 4.0], [scale.at(end), y + 4.0], index);
        }
    }
    let Some(size) = &mesh.sizes.element_size else { return };
    let quantile =
        |probability: &str, otherwise| size.quantiles.get(probability).copied().unwrap_or(otherwise);
    let (low, middle, high) =
        (quantile("0.05", size.min), quantile("0.5", size.mean), quantile("0.95", size.max));
    let text = |length: f64| significant(length, 4);
    let tip = format!(
        "{name}: elements {} to {}, median {}, nine tenths from {} to {}",
        text(size.min),
        text(size.max),
        text(middle),
        text(low),
        text(high)
    );
    let (from, to) = (scale.at(low), scale.at(high).max(scale.at(low) + 1.0));
    scene.rect(&format!("bar {class}"), [from, y - 5.0], [to, y + 5.0], index, &tip);
    scene.line("median", [scale.at(middle), y - 5.0], [scale.at(middle), y + 5.0], None);
}

/// A name without its middle, which seldom tells meshes apart.
fn shortened(name: &str) -> String {
    let length = name.chars().count();
    if length <= NAME_LENGTH {
        return name.to_owned();
    }
    let (start, end) = (NAME_LENGTH / 2 - 1, NAME_LENGTH / 2);
    name.chars().take(start).chain(['…']).chain(name.chars().skip(length - end)).collect()
}
