//! Meshes of programs whose files are not read: what each begins with, so that the error can name it and nobody looks for
//! a fault in a sound file. Extensions tell nothing here: `.inp`, `.mesh`, `.msh` and `.dat` belong to several each.

use super::text;

/// What a file is, and whether its first bytes are such.
type Row = (&'static str, fn(&[u8]) -> bool);

/// The surest signs first.
const ROWS: &[Row] = &[
    ("an MFEM mesh", |head| {
        starts(head, &["MFEM mesh v", "MFEM NC mesh v", "MFEM INLINE mesh", "MFEM NURBS mesh"])
    }),
    ("a CGNS file of the ADF kind: convert it with adf2hdf", |head| {
        starts(head, &["@(#)ADF Database Version"])
    }),
    ("a Tecplot file", is_tecplot),
    ("an ANSYS Fluent mesh or case", is_fluent),
    ("a PANAIR deck", |head| {
        has_line(head, "$panel") || (starts(head, &["$title"]) && has_line(head, "$symmetry"))
    }),
    ("an EnSight geometry", |head| starts(head, &["EnSight", "C Binary", "Fortran Binary"])),
    ("a Gambit neutral file", |head| has_line(head, "CONTROL INFO")),
    ("a FLAC3D grid", |head| {
        starts(head, &["* FLAC3D grid", "*FLAC3D GRID", "* GRIDPOINTS", ";FLAC3D"]) || is_flac3d(head)
    }),
    ("a GiD mesh", |head| starts(head, &["MESH \"", "MESH dimension", "mesh dimension"])),
    ("a mesh of DOLFIN: convert it to XDMF", |head| within(head, "<dolfin")),
    ("an X3D scene", |head| within(head, "<X3D")),
    ("a COLLADA scene", |head| within(head, "<COLLADA")),
    ("a glTF scene", |head| {
        starts(head, &["glTF"])
            || (starts(head, &["{"]) && within(head, "\"asset\"") && within(head, "\"meshes\""))
    }),
    ("a HyperMesh ASCII file", |head| starts(head, &["HMASCII"])),
    ("a GMV file", |head| starts(head, &["gmvinput"])),
    ("a KRATOS model part", |head| has_line(head, "Begin ModelPartData")),
    ("a Code_Aster mesh in text: convert it to MED", |head| {
        starts(head, &["TITRE"]) || has_line(head, "COOR_3D") || has_line(head, "COOR_2D")
    }),
    ("a FEMAP neutral file", |head| starts(head, &["-1\n100\n", "-1\r\n   100", "-1\n   100"])),
    ("geometry of Gmsh (.geo), yet to be meshed", |head| {
        has_start_of_line(head, &["Point(", "Point (", "SetFactory("])
    }),
    ("commands of CalculiX GraphiX, which make a mesh once they are run", is_cgx),
    ("geometry of IGES: a shape that is yet to be meshed", is_iges),
    ("a TIFF picture", |head| head.starts_with(b"II*\0") || head.starts_with(b"MM\0*")),
    ("a Patran neutral file", |head| {
        numbers_of_line(head, 0).is_some_and(|row| row.len() == 9 && row[0] == 25)
    }),
    ("an AVS UCD mesh", is_ucd),
    ("boundaries of Triangle or TetGen (.poly), yet to be meshed", is_poly),
    ("nodes of Triangle or TetGen: score the .ele file beside it", is_node),
    ("a table of whole numbers, as METIS has graphs and meshes", is_table),
];

/// What the file that starts with `head` is, if it is a mesh of another kind; in words that follow "found".
pub fn foreign(head: &[u8]) -> Option<&'static str> {
    ROWS.iter().find(|(_, is)| is(head)).map(|(what, _)| *what)
}

fn starts(head: &[u8], words: &[&str]) -> bool {
    let head = head.trim_ascii_start();
    words.iter().any(|word| head.starts_with(word.as_bytes()))
}

fn within(head: &[u8], word: &str) -> bool {
    memchr::memmem::find(&head[..head.len().min(4096)], word.as_bytes()).is_some()
}

/// The lines that hold something, without comments.
fn lines(head: &[u8]) -> impl Iterator<Item = &[u8]> {
    let lines = text::lines(0, head).map(|line| line.bytes.trim_ascii());
    lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"))
}

fn has_start_of_line(head: &[u8], words: &[&str]) -> bool {
    lines(head).take(200).any(|line| words.iter().any(|word| line.starts_with(word.as_bytes())))
}

fn has_line(head: &[u8], word: &str) -> bool {
    has_start_of_line(head, &[word])
}

fn is_tecplot(head: &[u8]) -> bool {
    let upper = head[..head.len().min(4096)].to_ascii_uppercase();
    upper.starts_with(b"#!TDV")
        || (lines(&upper).next().is_some_and(|first| starts(first, &["TITLE", "VARIABLES", "ZONE"]))
            && within(&upper, "ZONE")
            && (within(&upper, "VARIABLES") || within(&upper, "DATAPACKING")))
}

/// `(0 "comment")`, `(2 3)`, `(10 (0 1 ...`: sections with a number in brackets.
fn is_fluent(head: &[u8]) -> bool {
    let Some(rest) = head.trim_ascii_start().strip_prefix(b"(") else { return false };
    let digits = rest.iter().take_while(|b| b.is_ascii_digit()).count();
    (1..=4).contains(&digits)
        && matches!(rest.get(digits), Some(b' '))
        && (within(head, "\n(") || within(head, " (0"))
}

fn is_flac3d(head: &[u8]) -> bool {
    let mut rows = lines(head).filter(|line| !line.starts_with(b"*"));
    rows.next().is_some_and(|line| line.starts_with(b"G ")) || head.starts_with(&[0x15, 0x46, 0x09, 0x11])
}

/// Commands a line each: a word of four letters or fewer, and names.
fn is_cgx(head: &[u8]) -> bool {
    const COMMANDS: [&str; 12] = [
        "PNT ", "LINE ", "SURF ", "GSUR ", "ELTY ", "READ ", "SEND ", "SETA ", "SETO ", "GBOD ", "VALU ",
        "PLOT ",
    ];
    let is = |line: &&[u8]| COMMANDS.iter().any(|c| line.to_ascii_uppercase().starts_with(c.as_bytes()));
    lines(head).take(60).filter(is).count() >= 3
}

/// Lines of 80 columns, of which the 73rd names the section.
fn is_iges(head: &[u8]) -> bool {
    let mut lines = text::lines(0, head);
    let is = |line: text::Placed<'_>| {
        line.bytes.len() == 80
            && line.bytes[72] == b'S'
            && line.bytes[73..].iter().all(|b| b.is_ascii_digit() || *b == b' ')
    };
    lines.next().is_some_and(is)
}

/// The numbers of a line that holds nothing else.
fn numbers_of_line(head: &[u8], number: usize) -> Option<Vec<u64>> {
    let line = lines(head).nth(number)?;
    text::tokens(0, line).map(|token| text::integer(token.bytes)).collect()
}

/// The reals of a line that holds nothing else.
fn reals_of_line(head: &[u8], number: usize) -> Option<Vec<f64>> {
    let line = lines(head).nth(number)?;
    text::tokens(0, line).map(|token| text::real(token.bytes)).collect()
}

/// Numbers of nodes, cells and three kinds of data; then a node with three coordinates.
fn is_ucd(head: &[u8]) -> bool {
    let counts = numbers_of_line(head, 0).is_some_and(|row| row.len() == 5 && row[0] > 0);
    counts && reals_of_line(head, 1).is_some_and(|row| row.len() == 4)
}

/// Numbers of vertices (none, if another file has them), dimensions, attributes and markers; then a vertex, or a number of
/// segments and one of markers.
fn is_poly(head: &[u8]) -> bool {
    let Some(counts) = header(head) else { return false };
    let columns = reals_of_line(head, 1).map_or(0, |row| row.len() as u64);
    let after = counts[0] as usize + 1;
    let segments = numbers_of_line(head, after).is_some_and(|row| row.len() <= 2);
    match counts[0] {
        0 => columns <= 2 && columns > 0,
        _ => columns == 1 + counts[1] + counts[2] + counts[3] && segments,
    }
}

fn is_node(head: &[u8]) -> bool {
    let Some(counts) = header(head) else { return false };
    let columns = reals_of_line(head, 1).map_or(0, |row| row.len() as u64);
    counts[0] > 0 && columns == 1 + counts[1] + counts[2] + counts[3]
}

fn header(head: &[u8]) -> Option<Vec<u64>> {
    let counts = numbers_of_line(head, 0)?;
    let sound = counts.len() == 4 && (2..=3).contains(&counts[1]) && counts[2] < 100 && counts[3] <= 1;
    (sound && counts[0] < 1 << 40).then_some(counts)
}

/// A count or a few, then rows of whole numbers alone.
fn is_table(head: &[u8]) -> bool {
    let counts = numbers_of_line(head, 0).is_some_and(|row| (1..=3).contains(&row.len()));
    counts && (1..4).all(|k| numbers_of_line(head, k).is_some_and(|row| !row.is_empty()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::testing::{corpus, head};
    use crate::formats::{FORMATS, HEAD_BYTES};

    #[test]
    fn decoys_of_the_corpus_are_named() {
        let Some(corpus) = corpus() else { return };
        for (name, what) in [
            ("decoys/avs_ucd_named_inp_circle-grid.inp", "AVS UCD"),
            ("decoys/avs_ucd_named_inp_grid.inp", "AVS UCD"),
            ("decoys/metis_graph.mesh", "METIS"),
            ("decoys/mfem_fichera-amr.mesh", "MFEM"),
            ("decoys/mfem_star-mixed.mesh", "MFEM"),
            ("decoys/panair_M100.inp", "PANAIR"),
            ("cgns/gmsh_tut21.cgns", "adf2hdf"),
        ] {
            let found = foreign(&head(&corpus.join(name)));
            assert!(found.is_some_and(|found| found.contains(what)), "{name}: {found:?}");
        }
    }

    #[test]
    fn what_others_write_is_named() {
        let iges = format!("{:72}S      1\n", "a part");
        let rows: [(&[u8], &str); 17] = [
            (b"(0 \"GAMBIT to Fluent\")\n(2 3)\n(10 (0 1 4 1 3))\n", "Fluent"),
            (b"(0 grid written by x)\n\n(0 dimension:)\n(2 2)\n", "Fluent"),
            (b"TITLE = \"a\"\nVARIABLES = \"X\", \"Y\"\nZONE N=4, E=1\n", "Tecplot"),
            (b"#!TDV112\x01\0\0\0", "Tecplot"),
            (b"# a\nvariables=x,y\nzone i=2\n", "Tecplot"),
            (b"        CONTROL INFO 2.4.6\n** GAMBIT NEUTRAL FILE\n", "Gambit"),
            (b"* FLAC3D grid produced by x\n* GRIDPOINTS\nG 1 0 0 0\n", "FLAC3D"),
            (b"<?xml version=\"1.0\"?>\n<dolfin xmlns:dolfin=\"x\">\n", "DOLFIN"),
            (b"// a\nlc = 0.1;\nPoint(1) = {0, 0, 0, lc};\n", "geometry of Gmsh"),
            (b"PNT p1 0 0 0\nPNT p2 1 0 0\nLINE l1 p1 p2 4\n", "CalculiX GraphiX"),
            (iges.as_bytes(), "IGES"),
            (b"II*\0\x08\0\0\0", "TIFF"),
            (b"25       0       0       1       0       0       0       0       0\n", "Patran"),
            (b"4 2 0 1\n1 0 0 1\n2 1 0 1\n3 1 1 1\n4 0 1 1\n4 1\n1 1 2 1\n", ".poly"),
            (b"0 2 0 1\n4 1\n1 1 2 1\n", ".poly"),
            (b"2 2 0 0\n1 0.0 0.5\n2 1 0\n", "score the .ele"),
            (b"3 2\n2 3\n1 3\n1 2\n", "METIS"),
        ];
        for (head, what) in rows {
            let found = foreign(head);
            assert!(found.is_some_and(|found| found.contains(what)), "{}: {found:?}", head.escape_ascii());
            let taker = FORMATS.iter().find(|format| format.detect(head)).map(|format| format.name());
            assert_eq!(taker, None, "{}", head.escape_ascii());
        }
    }

    #[test]
    fn nothing_else_is_named() {
        for head in [&b""[..], b"\n\n", b"a text\n", b"1.5 2.5\n", b"{}", b"<?xml?>\n", &[0; HEAD_BYTES]] {
            assert_eq!(foreign(head), None, "{}", head[..head.len().min(20)].escape_ascii());
        }
    }
}
