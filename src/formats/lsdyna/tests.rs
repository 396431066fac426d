//! Whole decks: Gmsh's, those of the corpus, cards of every kind, and damaged ones.

use super::Lsdyna;
use crate::formats::gmsh::Gmsh;
use crate::formats::reading::read;
use crate::formats::testing::{corpus, damage, detected, holds, message, own, read_bytes, same_elements};
use crate::mesh::Shape;

const MIXED: &str =
    "54 nodes, ELEMENT_SHELL (triangle):28 ELEMENT_SHELL:36 ELEMENT_SOLID (wedge):28 ELEMENT_SOLID:8";

const CORPUS: [(&str, &str); 4] = [
    ("lsdyna/gmsh_mixed.key", MIXED),
    ("lsdyna/pydyna_eddy_current_mesh.k", "2205 nodes, ELEMENT_SOLID:1920"),
    ("lsdyna/pydyna_fixed_nokeyword_mesh.k", "1781 nodes, ELEMENT_SHELL:99 ELEMENT_SOLID:729"),
    ("lsdyna/pydyna_shell_elements_first.k", "651 nodes, ELEMENT_SHELL:600"),
];

#[test]
fn corpus_files_hold_what_others_count() {
    let Some(corpus) = corpus() else { return };
    for (name, expected) in CORPUS {
        let mesh = read(&Lsdyna, &corpus.join(name)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(holds(&mesh), expected, "{name}");
    }
    let mut names: Vec<_> = CORPUS.iter().map(|row| row.0).collect();
    names.insert(3, "lsdyna/pydyna_include_bird_B.k");
    assert_eq!(detected(&Lsdyna, &corpus), names);
    let error = read(&Lsdyna, &corpus.join(names[3])).expect_err("its parts are not there").to_string();
    assert!(error.contains("line 5: included file \"control_cards.k\""), "{error}");
}

#[test]
fn gmsh_writes_the_same_mesh_here_as_in_its_own_format() {
    let mesh = read(&Lsdyna, &own("lsdyna").join("gmsh_mixed.key")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(holds(&mesh), MIXED);
    let native = read(&Gmsh, &own("gmsh").join("mixed_hex_prism_41.msh")).unwrap_or_else(|e| panic!("{e}"));
    same_elements(&mesh, &native, 1e-6);
}

/// The corners of the unit brick from 1 on, and two more nodes.
const NODES: &str = "*NODE
       1             0.0             0.0             0.0       0       0
       2             1.0             0.0             0.0
       3             1.0             1.0
$ a comment
       4             0.0         1.00000+0
       5             0.0             0.0             1.0
       6             1.0             0.0             1.0
       7             1.0             1.0             1.0
       8             0.0             1.0             1.0

       9            -1.0            -1.0            -1.0
      10-2.0000000000000-2.0000000000000-2.0000000000000
";

/// Numbers in columns.
fn card(width: usize, values: &[u64]) -> String {
    values.iter().map(|v| format!("{v:>width$}")).collect::<String>() + "\n"
}

fn deck(cards: &str) -> String {
    format!("*KEYWORD\n{cards}{NODES}*END\nnothing after the end is read\n")
}

#[track_caller]
fn mesh(cards: &str) -> crate::formats::reading::Mesh {
    read_bytes(&Lsdyna, "a.k", deck(cards).as_bytes()).unwrap_or_else(|e| panic!("{e}\n{cards}"))
}

#[test]
fn degenerate_solids_are_what_they_are() {
    let mut cards = String::from("*ELEMENT_SOLID\n");
    for nodes in [
        [1, 2, 3, 4, 5, 6, 7, 8],
        [1, 2, 3, 4, 5, 5, 8, 8],
        [1, 2, 3, 4, 5, 5, 5, 5],
        [1, 2, 4, 5, 5, 5, 5, 5],
        [1, 2, 3, 4, 5, 6, 7, 7],
    ] {
        let label = cards.lines().count() as u64;
        cards += &card(8, &[&[label, 1], &nodes[..]].concat());
    }
    let mesh = mesh(&cards);
    let expected = "10 nodes, ELEMENT_SOLID (pyramid):1 ELEMENT_SOLID (tetrahedron):1 ELEMENT_SOLID (wedge):1 \
                    ELEMENT_SOLID:2";
    assert_eq!(holds(&mesh), expected);
    assert_eq!(mesh.ledger.repeated_nodes, 1, "a pattern that is not documented stays what it was");
    let wedge = &mesh.elements.iter().find(|e| e.1 == Shape::Wedge).expect("a wedge").2;
    assert_eq!(wedge[..3], [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
}

#[test]
fn cards_of_one_line_and_of_two() {
    let ten = [1, 2, 3, 5, 6, 7, 8, 9, 10, 4];
    let two_lines = card(8, &[2, 1]) + &card(8, &[1, 2, 3, 4, 5, 6, 7, 8, 0, 0]);
    let tet = card(8, &[3, 1]) + &card(8, &ten);
    let cards = "*ELEMENT_SOLID (ten nodes format)\n".to_owned() + &two_lines + "$ between\n" + &tet;
    assert_eq!(holds(&mesh(&cards)), "10 nodes, ELEMENT_SOLID of 10 nodes:1 ELEMENT_SOLID:1");
    let comma = "*ELEMENT_SOLID\n2, 1, 1, 2, 3, 5, 6, 7, 8, 9, 10, 4\n3,1,1,2,3,5\n";
    let expected = "10 nodes, ELEMENT_SOLID (tetrahedron):1 ELEMENT_SOLID of 10 nodes:1";
    assert_eq!(holds(&mesh(comma)), expected);
    let ortho = "*ELEMENT_SOLID_ORTHO\n".to_owned()
        + &(card(8, &[1, 1, 1, 2, 3, 4, 5, 6, 7, 8]) + "             1.0\n             0.0\n").repeat(2);
    assert_eq!(holds(&mesh(&ortho)), "10 nodes, ELEMENT_SOLID:2");
}

#[test]
fn shells_and_what_follows_them() {
    let quad = card(8, &[1, 1, 1, 2, 3, 4]);
    let [tri, open] = [card(8, &[2, 1, 1, 2, 3, 3]), card(8, &[3, 1, 1, 2, 3, 0])];
    let eight = card(8, &[4, 1, 1, 2, 3, 4, 5, 6, 7, 8]);
    let plain = format!("*ELEMENT_SHELL\n{quad}{tri}{open}{eight}");
    let expected = "10 nodes, ELEMENT_SHELL (triangle):2 ELEMENT_SHELL of 8 nodes:1 ELEMENT_SHELL:1";
    assert_eq!(holds(&mesh(&plain)), expected);
    let more = "             0.1             0.1\n";
    let thick = format!(
        "*ELEMENT_SHELL_THICKNESS_OFFSET\n{quad}{more}{more}{tri}{more}{more}{eight}{more}{more}{more}{open}{more}{more}"
    );
    assert_eq!(holds(&mesh(&thick)), expected);
    let counted = format!(
        "{plain}*ELEMENT_BEAM\n{}*ELEMENT_MASS\n       1       1     2.5E-3\n*ELEMENT_INERTIA\n{}{}",
        card(8, &[1, 1, 1, 2, 3]),
        card(8, &[1, 1]),
        " 0.1\n"
    );
    let text = holds(&mesh(&counted));
    assert!(text.contains("ELEMENT_BEAM:1 ELEMENT_INERTIA:2 ELEMENT_MASS:1"), "{text}");
    let thick = "*ELEMENT_TSHELL\n".to_owned() + &card(8, &[1, 1, 1, 2, 3, 3, 5, 6, 7, 7]);
    assert_eq!(holds(&mesh(&thick)), "10 nodes, ELEMENT_TSHELL (wedge):1");
}

#[test]
fn wide_cards_are_read() {
    for (suffix, width) in [("%", 10), (" +", 20), ("", 8)] {
        let cards = format!("*ELEMENT_SHELL{suffix}\n{}", card(width, &[1, 1, 1, 2, 3, 4]));
        assert_eq!(holds(&mesh(&cards)), "10 nodes, ELEMENT_SHELL:1", "{suffix}");
    }
    let long = "*KEYWORD LONG=Y\n*NODE\n".to_owned()
        + "                   1                -1.5                 0.0                 0.0\n"
        + "                   2                 1.5                 0.0                 0.0\n"
        + "                   3                 0.0                 1.0                 0.0\n"
        + "*ELEMENT_SHELL\n"
        + &card(20, &[1, 1, 1, 2, 3, 3]);
    let mesh = read_bytes(&Lsdyna, "a.k", long.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(holds(&mesh), "3 nodes, ELEMENT_SHELL (triangle):1");
    assert_eq!(mesh.elements[0].2[0], [-1.5, 0.0, 0.0]);
}

#[test]
fn includes_are_read_beneath_the_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write("main.k", "*KEYWORD\n*INCLUDE\nno +\ndes.k\nelements.k\n*END\n");
    write("nodes.k", NODES);
    write("elements.k", &("*ELEMENT_SHELL\n".to_owned() + &card(8, &[1, 1, 1, 2, 3, 4]) + "*END\n"));
    let main = folder.path().join("main.k");
    let mesh = read(&Lsdyna, &main).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(holds(&mesh), "10 nodes, ELEMENT_SHELL:1");
    write("nodes.k", "*INCLUDE\nmain.k\n");
    let error = read(&Lsdyna, &main).expect_err("a circle").to_string();
    assert!(error.contains("lead back to itself"), "{error}");
}

#[test]
fn what_is_wrong_is_named() {
    let shell = "*ELEMENT_SHELL\n".to_owned() + &card(8, &[1, 1, 1, 2, 3, 4]);
    for (cards, expected) in [
        ("*INCLUDE_TRANSFORM\nmesh.k\n".to_owned(), "line 2: the keyword *INCLUDE_TRANSFORM is not read"),
        ("*NODE_TRANSFORM\n".to_owned(), "line 2: the keyword *NODE_TRANSFORM is not read"),
        ("*ELEMENT_SHELL_COMPOSITE\n".to_owned(), "the keyword *ELEMENT_SHELL_COMPOSITE is not read"),
        ("*ELEMENT_SOLID_P21\n".to_owned(), "the keyword *ELEMENT_SOLID_P21 is not read"),
        (shell.replace('4', "x"), "line 3: expected a number, found \"x\""),
        (shell.replace("       4", "      44"), "line 3: element 1 names node 44"),
        (shell.replace("       4", "    &top"), "found \"&top\""),
        (
            "*ELEMENT_SOLID\n".to_owned() + &card(8, &[1, 1, 1, 2, 3]),
            "line 3: expected 4, 8, 10 or 20 nodes of element 1, found 3",
        ),
        ("*ELEMENT_SOLID\n".to_owned() + &card(8, &[1, 1]), "expected another card of the element before"),
        (String::new(), "expected *ELEMENT cards, found the end of the file"),
    ] {
        let error = message(&Lsdyna, "a.k", deck(&cards).as_bytes());
        assert!(error.contains(expected), "{error}\n{cards}");
    }
}

#[test]
fn damaged_decks_are_read_or_refused() {
    // A deck has no end mark that it must have: cuts among the elements show by luck only.
    damage(&Lsdyna, &own("lsdyna").join("gmsh_mixed.key"), |_| 1125);
}

#[test]
fn a_card_that_was_cut_off_between_two_numbers_is_an_error() {
    let node = |id: u32, x: u32, y: u32, z: u32| format!("{id:8}{x:16}{y:16}{z:16}\n");
    let nodes: String = (0..8).map(|k| node(k + 1, ((k >> 1) ^ k) & 1, (k >> 1) & 1, k >> 2)).collect();
    let card = |numbers: [u32; 10]| numbers.map(|number| format!("{number:8}")).concat();
    let element = card([1, 1, 1, 2, 3, 4, 5, 6, 7, 8]);
    let deck = format!("*KEYWORD\n*NODE\n{nodes}*ELEMENT_SOLID\n{element}\n{element}");
    let read = |text: &str| read_bytes(&Lsdyna, "a.k", text.as_bytes());
    assert_eq!(read(&deck).expect("whole").elements.len(), 2);
    let error = read(&deck[..deck.len() - 32]).expect_err("cut off").to_string();
    assert!(error.contains("the end of the line of the last card"), "{error}");
}
