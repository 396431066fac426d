//! The reader against a listing and against damage. No printed mesh is public: `tests/meshes/nag` holds a mesh of Gmsh,
//! laid out as the data files of the library's examples.

use std::path::PathBuf;

use super::Nag;
use crate::formats::Format;
use crate::formats::gmsh::Gmsh;
use crate::formats::testing::{self, Row};
use crate::mesh::Shape::Triangle;

const OWN: Row = ("pit2d.r", 220, &[(Triangle, 382)], &[]);

fn own() -> PathBuf {
    testing::own("nag")
}

fn message(text: &str) -> String {
    testing::message(&Nag, "a.r", text.as_bytes())
}

const LISTING: &str =
    " D06CCF Example Program Results\n\n 4 2\n 0. .0E+00\n 0.1D+01 -.0\n 1. 1.\n 0. 1.\n 1 2 3 0\n 1 3 4 0\n";

#[test]
fn an_own_file_holds_what_gmsh_counts() {
    testing::check(&Nag, &own(), &OWN);
    let gmsh = testing::read_file(&Gmsh, &own().join("../gmsh/pit2d_22_ascii.msh"));
    testing::same_elements(&testing::read_file(&Nag, &own().join(OWN.0)), &gmsh, 5e-5);
}

#[test]
fn a_corpus_file_holds_what_others_count() {
    let Some(corpus) = testing::corpus() else { return };
    const MESH: &str = "nag/synthetic_d06_printed_mesh.r";
    testing::check(&Nag, &corpus, &(MESH, 220, &[(Triangle, 382)], &[]));
    assert_eq!(testing::detected(&Nag, &corpus), [MESH]);
}

#[test]
fn edges_are_counted_references_may_miss_and_rows_may_wrap() {
    let edges = LISTING.replace(" 4 2\n", " 4 2 2\n") + " 1 1 2 5\n 2 2 3 6\n";
    let bare = LISTING.replace("3 0\n", "3\n").replace("4 0\n", "4\n");
    let wrapped =
        LISTING.replace("1 2 3 0\n", "1 2 3 0 1\n").replace("\n 1 3", "\n 3").replace("0. .0", "0.\n.0");
    for (text, lines) in
        [(LISTING, 0), (&edges, 2), (&bare, 0), (&wrapped, 0), (&format!("{LISTING}\n The end.\n"), 0)]
    {
        let mesh =
            testing::read_bytes(&Nag, "a.r", text.as_bytes()).unwrap_or_else(|e| panic!("{e}: {text}"));
        assert_eq!(
            (mesh.nodes.count(), mesh.count(Triangle), testing::counted(&mesh, "line")),
            (4, 2, lines)
        );
        assert_eq!(mesh.elements[1].2, [[0., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
        assert_eq!(mesh.elements[1].0, 2);
    }
}

#[test]
fn what_is_wrong_is_named() {
    let rows = [
        (
            " D06ABF Example Program Results\n\n NV = 2250 to the nearest 250\n".to_owned(),
            "line 4: expected a line with the numbers of vertices and triangles, and of edges perhaps, found the end of the file",
        ),
        (LISTING.replace(" 4 2", " 4 3"), "line 10: expected 3 triangles, found the end of the file"),
        (LISTING.replace(" 4 2", " 4 99999"), "line 10: expected 99999 triangles, found the end of the file"),
        (LISTING.replace("1 3 4", "1 3 5"), "line 9: element 2 names node 5, which the file does not define"),
        (LISTING.replace("1 3 4", "1 3 x"), "line 9: expected the number of a vertex, found \"x\""),
        (format!("{LISTING} 7 8\n"), "line 10: a listing with numbers after its mesh is not read"),
        (
            LISTING.trim_end().to_owned(),
            "line 9: expected the end of the last row's line, found the end of the file",
        ),
    ];
    for (text, expected) in rows {
        assert_eq!(message(&text), expected, "{text}");
    }
}

#[test]
fn titles_of_other_programs_are_not_detected() {
    let titles =
        [&b" nag_mesh2d_inc (d06aac) Example Program Results\n"[..], b"\n\n D06BAF Example Program Results"];
    assert!(titles.iter().all(|title| Nag.detect(title)));
    assert!(!Nag.detect(b"Example Program Results\n d06") && !Nag.detect(b""));
}

#[test]
fn a_cut_file_is_an_error_and_a_flipped_bit_no_panic() {
    testing::damage(&Nag, &own().join(OWN.0), testing::last_word);
}
