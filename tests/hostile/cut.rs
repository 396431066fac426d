//! Meshes that end too early: at every section and at many places between. Half a mesh is an error, not a summary.

use std::fs;

use meshgauge::error::Kind;
use meshgauge::input::Compression;

use crate::attempt::{assert_line, attempt_in_place, refused};
use crate::packing::pack;
use crate::{Random, own_meshes, places};

/// Whether a cut leaves a whole mesh, by what is kept and what is lost.
type Unseen = fn(&[u8], &[u8]) -> bool;

/// Cuts that nobody can tell: format (none for all), which they are, and why.
const UNSEEN: &[(&str, Unseen, &str)] = &[
    ("", |_, lost| lost.trim_ascii().is_empty(), "blanks at the end say nothing"),
    (
        "vtk",
        |_, lost| starts_with_any(lost, &["CELL_DATA", "POINT_DATA"]),
        "the data of a mesh come after it",
    ),
    ("gmsh", before_ghosts, "which elements are another partition's is said twice"),
    ("vtk", no_data_yet, "point data of no arrays are allowed, and some writers make them"),
    ("vtk", within_last_number, "the last number is still one without its last digits"),
    ("abaqus", after_the_mesh, "sets come after the mesh"),
    ("abaqus", in_elements_at_end_of_line, "a deck has no end mark: it may well end with any element"),
    ("nastran", after_first_element, "a deck may lack ENDDATA: it may well end with any card"),
    ("abaqus", within_last_node, "a node's number is still one without its last digits"),
    ("su2", within_last_number, "the last number is still one without its last digits"),
    ("su2", |_, lost| starts_with_any(lost, &["NMARK"]), "markers are the boundary, which may be left out"),
    ("triangle", in_last_comment, "a comment says who wrote the file"),
    ("tetgen", in_last_comment, "a comment says who wrote the file"),
    (
        "medit",
        |_, lost| lost.len() < 8 && lost.iter().all(|b| *b == 0),
        "after End there is no next keyword: zeros",
    ),
    ("vtk", |kept, _| contains(kept, b"METADATA"), "metadata of data come after the mesh"),
    (
        "comsol",
        |kept, lost| last_line(kept).contains(&b'#') && !lost.trim_ascii().contains(&b'\n'),
        "a comment ends the file",
    ),
    ("vtk", within_data, "the last of the data is still a number without its last digits"),
    ("nastran", |kept, _| last_line(kept).starts_with(b"$"), "a comment says nothing of the mesh"),
    ("medit", between_tables, "End may be missing, and any table may be the last"),
    ("obj", after_first_face, "there are no counts and no end mark: a file may well end with any face"),
    ("ansys", outside_blocks, "an archive may well end after any EBLOCK"),
    ("lsdyna", after_first_card, "a deck may lack *END: it may well end with any card"),
    ("frd", after_elements, "results come after the mesh"),
    ("femgv", after_elements, "results come after the mesh"),
    ("abaqus", after_all_elements, "materials, sets and steps come after the mesh"),
    ("lsdyna", after_all_elements, "sets and materials come after the mesh"),
    ("netgen", |kept, _| contains(kept, b"endmesh"), "the geometry comes after the mesh"),
];

/// Whether nobody can tell that a file was cut here.
pub fn is_unseen(format: &str, kept: &[u8], lost: &[u8]) -> bool {
    UNSEEN.iter().any(|row| (row.0.is_empty() || row.0 == format) && (row.1)(kept, lost))
}

fn starts_with_any(bytes: &[u8], words: &[&str]) -> bool {
    let bytes = bytes.trim_ascii_start();
    words.iter().any(|word| bytes.starts_with(word.as_bytes()))
}

fn contains(bytes: &[u8], word: &[u8]) -> bool {
    memchr::memmem::find(bytes, word).is_some()
}

/// Nothing stands after the number of points that data are for.
fn no_data_yet(kept: &[u8], _: &[u8]) -> bool {
    let last = kept.trim_ascii_end().rsplit(|b| *b == b'\n').next().unwrap_or_default();
    last.starts_with(b"POINT_DATA ") || last.starts_with(b"CELL_DATA ")
}

/// The elements are whole, with those of other partitions in blocks of their own.
fn before_ghosts(kept: &[u8], lost: &[u8]) -> bool {
    contains(kept, b"$EndElements") && starts_with_any(lost, &["$GhostElements"])
}

fn after_the_mesh(kept: &[u8], lost: &[u8]) -> bool {
    memchr::memmem::find(&[kept, lost].concat(), b"*ELSET").is_some_and(|sets| kept.len() >= sets)
}

fn within_last_number(_: &[u8], lost: &[u8]) -> bool {
    lost.iter().filter(|b| b.is_ascii_digit()).count() <= 1 && lost.trim_ascii().len() == 1
}

fn in_elements_at_end_of_line(kept: &[u8], lost: &[u8]) -> bool {
    let elements = memchr::memmem::find(kept, b"*ELEMENT").is_some_and(|at| kept[at..].contains(&b'\n'));
    elements && (ends_line(kept, lost) || lost.starts_with(b"\r"))
}

/// The keyword that the cut is in is no mesh, and none that is lost is.
fn after_all_elements(kept: &[u8], lost: &[u8]) -> bool {
    let names = |text: &[u8]| -> Vec<String> {
        let lines = text.split(|b| *b == b'\n').map(<[u8]>::trim_ascii_start);
        let keywords = lines.filter(|line| line.starts_with(b"*") && !line.starts_with(b"**"));
        let name =
            |line: &[u8]| line.split(|b| matches!(b, b',' | b'\r')).next().unwrap_or_default().to_vec();
        keywords.map(|line| String::from_utf8_lossy(&name(line)).trim_end().to_uppercase()).collect()
    };
    let makes =
        |name: &String| name.starts_with("*ELEMENT") || name == "*NODE" || name.starts_with("*INCLUDE");
    let (kept, lost) = (names(kept), names(lost));
    kept.iter().any(makes) && !kept.last().is_some_and(makes) && !lost.iter().any(makes)
}

/// A table of elements or End would follow.
fn between_tables(kept: &[u8], lost: &[u8]) -> bool {
    kept.is_ascii()
        && contains(kept, b"Vertices")
        && starts_with_any(lost, &["Tetrahedra", "Triangles", "End"])
}

fn in_last_comment(kept: &[u8], lost: &[u8]) -> bool {
    let line = kept.rsplit(|b| *b == b'\n').next().unwrap_or_default();
    line.starts_with(b"#") || (line.is_empty() && lost.starts_with(b"#"))
}

/// Blanks of the next line say no more than its start.
fn ends_line(kept: &[u8], lost: &[u8]) -> bool {
    last_line(kept).trim_ascii().is_empty() || lost.starts_with(b"\n")
}

fn last_line(kept: &[u8]) -> &[u8] {
    kept.rsplit(|b| *b == b'\n').next().unwrap_or_default()
}

/// Among the text of data that come after the mesh, within a number.
fn within_data(kept: &[u8], lost: &[u8]) -> bool {
    let is_of_number = |b: Option<&u8>| b.is_some_and(|b| b.is_ascii_digit() || *b == b'.');
    contains(kept, b"_DATA ") && is_of_number(kept.last()) && is_of_number(lost.first())
}

fn after_first_face(kept: &[u8], lost: &[u8]) -> bool {
    contains(kept, b"\nf ") && ends_line(kept, lost)
}

fn after_first_card(kept: &[u8], lost: &[u8]) -> bool {
    memchr::memmem::find(kept, b"*ELEMENT").is_some_and(|at| kept[at..].contains(&b'\n'))
        && (ends_line(kept, lost) || within_keyword(kept))
}

/// A keyword lost its end, so that it is none that is known, or a comment did.
fn within_keyword(kept: &[u8]) -> bool {
    let line = kept.rsplit(|b| *b == b'\n').next();
    line.is_some_and(|line| line.starts_with(b"*") || line.starts_with(b"$"))
}

/// The last of the blocks has its end mark.
fn outside_blocks(kept: &[u8], _: &[u8]) -> bool {
    let last = |what: &[u8]| memchr::memmem::rfind(kept, what);
    last(b"EBLOCK,").is_some_and(|block| last(b" -1").is_some_and(|mark| block < mark))
}

fn after_elements(kept: &[u8], _: &[u8]) -> bool {
    memchr::memmem::find(kept, b"    3C").is_some_and(|at| contains(&kept[at..], b"\n -3"))
}

/// A card ends here.
fn after_first_element(kept: &[u8], lost: &[u8]) -> bool {
    contains(kept, b"\nC") && ends_line(kept, lost)
}

/// All commas of the line are there, and something of its last number.
fn within_last_node(kept: &[u8], lost: &[u8]) -> bool {
    let rest = lost.split(|b| *b == b'\n').next().unwrap_or_default();
    contains(kept, b"*ELEMENT") && kept.last().is_some_and(u8::is_ascii_digit) && !rest.contains(&b',')
}

/// Where sections begin: marks at the start of a line, as all formats have them.
fn sections(bytes: &[u8]) -> Vec<usize> {
    let is_mark = |byte: &u8| matches!(byte, b'$' | b'*' | b'<') || byte.is_ascii_uppercase();
    let mut found = Vec::new();
    for end in memchr::memchr_iter(b'\n', bytes) {
        let start = end + 1 + bytes[end + 1..].iter().take_while(|b| **b == b' ').count();
        if bytes.get(start).is_some_and(is_mark) {
            found.extend([end, end + 1, start, (start + 4).min(bytes.len() - 1)]);
        }
    }
    // Noise in binary data looks like marks as well.
    let step = found.len().div_ceil(places(60, 200)).max(1);
    found.into_iter().step_by(step).collect()
}

#[test]
fn a_mesh_that_ends_too_early_is_an_error() {
    let mut random = Random(0x2007_0301);
    for (format, path) in own_meshes() {
        let bytes = fs::read(&path).expect("readable");
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let is_text = bytes.is_ascii() && matches!(format, "gmsh" | "abaqus" | "nastran" | "vtk");
        let anywhere = (0..places(12, 50)).map(|_| random.below(bytes.len()));
        for cut in sections(&bytes).into_iter().chain(anywhere.collect::<Vec<_>>()) {
            let what = format!("{format}/{name} cut to {cut} of {} bytes", bytes.len());
            let (kept, lost) = bytes.split_at(cut);
            let result = attempt_in_place(&path, kept, &what);
            if !(result.is_ok() && is_unseen(format, kept, lost)) {
                let error = refused(result, &what);
                assert!(
                    !is_text || matches!(error.kind(), Kind::Empty) || {
                        assert_line(&error, &what);
                        true
                    }
                );
            }
        }
    }
}

#[test]
fn a_packed_mesh_that_ends_too_early_is_an_error() {
    let mut random = Random(0x2007_0302);
    for (format, path) in own_meshes() {
        let bytes = fs::read(&path).expect("readable");
        for compression in Compression::ALL {
            let packed = pack(compression, &bytes);
            let anywhere = (0..places(4, 10)).map(|_| 1 + random.below(packed.len() - 1));
            for cut in anywhere.chain([1, packed.len() - 1]).collect::<Vec<_>>() {
                let what = format!("{format}, {} cut to {cut} of {}", compression.name(), packed.len());
                let error = refused(attempt_in_place(&path, &packed[..cut], &what), &what);
                let fits = match error.kind() {
                    Kind::Malformed { .. } => error.format() == Some(compression.name()),
                    kind => matches!(kind, Kind::UnknownFormat(_)) && cut < Compression::HEAD_BYTES,
                };
                assert!(fits, "{what}: {error}");
            }
        }
    }
}

/// Texts that are sound with the end of their last line and not without it: the last number may have lost digits, the
/// last face corners.
#[test]
fn a_last_line_without_its_end_is_an_error_where_nothing_else_ends_the_mesh() {
    let rows = [
        ("x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("x.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        (
            "x.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        ),
        ("x.k", "*KEYWORD\n*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,0.,1.,0.\n*ELEMENT_SHELL\n1,1,1,2,3,3\n"),
        ("x.ugrid", "4 0 0 1 0 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 2 3 4\n"),
    ];
    for (name, text) in rows {
        let path = std::path::Path::new(name);
        let whole = attempt_in_place(path, text.as_bytes(), name).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(whole.elements.count, 1, "{name}");
        let error = refused(attempt_in_place(path, text.trim_end().as_bytes(), name), name);
        assert!(
            error.to_string().contains("line") && error.to_string().contains("the end of the file"),
            "{error}"
        );
    }
}

#[test]
fn a_marker_of_su2_without_its_elements_is_an_error() {
    let mesh = "NDIME= 2\nNELEM= 1\n5 0 1 2 0\nNPOIN= 3\n0 0 0\n1 0 1\n0 1 2\nNMARK= 1\nMARKER_TAG= wall\n";
    let path = std::path::Path::new("x.su2");
    refused(attempt_in_place(path, mesh.as_bytes(), "no elements"), "no elements");
    let whole = format!("{mesh}MARKER_ELEMS= 1\n3 0 1\n");
    assert!(attempt_in_place(path, whole.as_bytes(), "whole").is_ok());
}

#[test]
fn vertices_of_medit_without_elements_or_end_are_an_error() {
    let mesh = "MeshVersionFormatted 2\nDimension 3\nVertices\n3\n0 0 0 0\n1 0 0 0\n0 1 0 0\n";
    let path = std::path::Path::new("x.mesh");
    let error = refused(attempt_in_place(path, mesh.as_bytes(), "no elements"), "no elements").to_string();
    assert!(error.contains("elements, or the keyword End"), "{error}");
}
