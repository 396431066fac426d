//! The costly checks: duplicate elements and coincident nodes.

use meshgauge::summary::Checks;
use meshgauge::{Options, score};

/// Four tetrahedra: the second has the corners of the first in another order, the third stands on nodes of its own at
/// the same places, the fourth shares three corners. A triangle has the corners of a face.
const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n9\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n\
    5 -0 0 0\n6 1 0 0\n7 0 1 0\n8 0 0 1\n9 0 0 2\n$EndNodes\n$Elements\n5\n1 4 2 1 1 1 2 3 4\n\
    2 4 2 1 1 3 1 2 4\n3 4 2 1 1 5 6 7 8\n4 4 2 1 1 1 2 3 9\n5 2 2 1 1 1 2 3\n$EndElements\n";

fn checks(all_checks: bool, threads: usize) -> Checks {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.msh");
    std::fs::write(&path, MESH).expect("written");
    score(&path, &Options { all_checks, threads, ..Options::default() })
        .unwrap_or_else(|e| panic!("{e}"))
        .checks
}

#[test]
fn duplicate_elements_and_coincident_nodes_are_counted_if_so_asked() {
    for threads in [1, 4] {
        let found = checks(true, threads);
        assert_eq!((found.duplicate_elements, found.coincident_nodes), (Some(1), Some(4)));
    }
    let found = checks(false, 2);
    assert_eq!((found.duplicate_elements, found.coincident_nodes), (None, None));
    assert!(!serde_json::to_string(&found).expect("JSON").contains("duplicate"));
}
