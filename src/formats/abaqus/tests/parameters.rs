//! Decks with `*PARAMETER`.

use super::*;

const DECK: &str = "*HEADING\nplate\n*PARAMETER\n# sizes\nwidth = 2.5\nheight = width*2\n** a comment\nlast=4\n*NODE\n1,0,0\n\
                    2,<width>,0\n3,<width>,<height>\n<last>, 0 , < height >\n*ELEMENT,TYPE=S4\n1,1,2,3,<last>\n";

#[test]
fn values_stand_in_the_place_of_names() {
    let mesh = mesh(DECK);
    assert_eq!(types(&mesh), "S4:1");
    assert_eq!(mesh.elements[0].2, [[0.0; 3], [2.5, 0.0, 0.0], [2.5, 5.0, 0.0], [0.0, 5.0, 0.0]]);
}

#[test]
fn errors_still_name_the_lines_of_the_deck() {
    for (from, to, expected) in [
        ("1,1,2,3,<last>", "1,1,2,3,9", "line 15: element 1 names node 9"),
        (
            "3,<width>,<height>",
            "3,<width>,<depth>",
            "line 12: the parameter in \"<depth>\" is not substituted",
        ),
        ("width*2", "width//2", "line 12: the parameter in \"<height>\" is not substituted"),
        (
            "*PARAMETER\n",
            "*PARAMETER, TABLE=T, DEPENDENT\n",
            "line 11: the parameter in \"<width>\" is not substituted",
        ),
        (
            "*NODE\n",
            "*PARAMETER SHAPE VARIATION, PARAMETER=width\n1,1\n*NODE\n",
            "the keyword *PARAMETERSHAPEVARIATION is not",
        ),
    ] {
        let found = error(&DECK.replace(from, to));
        assert!(found.contains(expected), "{to}: {found}");
    }
}

#[test]
fn values_of_an_included_file_are_those_of_the_deck_and_the_other_way_round() {
    let deck = "*PARAMETER\na = 2\n*INCLUDE,INPUT=b.inp\n*NODE\n1,0,0\n2,<a>,0\n3,<b>,1\n*PARAMETER\na = a + 5\n*NODE\n4,0,<a>\n\
                *ELEMENT,TYPE=S4\n1,1,2,3,4\n";
    let included = "*PARAMETER\nb = a*3\n*NODE\n7,<b>,<a>\n";
    let mesh = read_files(&[("deck.inp", deck.as_bytes()), ("b.inp", included.as_bytes())]).expect("sound");
    assert_eq!(mesh.elements[0].2, [[0.0; 3], [2.0, 0.0, 0.0], [6.0, 1.0, 0.0], [0.0, 7.0, 0.0]]);
    let row = mesh.nodes.row(7).expect("node 7");
    assert_eq!(mesh.nodes.rows()[row as usize], [6.0, 2.0, 0.0]);
}
