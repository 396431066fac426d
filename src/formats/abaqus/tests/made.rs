//! Keywords that make nodes and elements out of others; what they give is worked out by hand.

use super::*;

/// Where a node stands.
#[track_caller]
fn at(mesh: &Mesh, id: u64) -> [f64; 3] {
    let row = mesh.nodes.row(id).unwrap_or_else(|| panic!("node {id}"));
    mesh.nodes.rows()[row as usize]
}

#[track_caller]
fn near(mesh: &Mesh, id: u64, expected: [f64; 3]) {
    let found = at(mesh, id);
    for axis in 0..3 {
        assert!((found[axis] - expected[axis]).abs() < 1e-12, "node {id}: {found:?}, not {expected:?}");
    }
}

const MASS: &str = "*ELEMENT,TYPE=MASS\n1,1\n";

#[test]
fn ngen_puts_nodes_on_a_line() {
    let mesh = mesh(&format!(
        "*NODE\n1,0,0,0\n11,10,0,5\n*NGEN, NSET=a\n1,11,2\n11,5,3\n*NODE\n5,1,1\n21,0\n*NGEN\n 11, 21 , 5,\n{MASS}"
    ));
    // 1, 3, 5, 7, 9, 11; then from 11 down to 5: 8; then 5 anew; then 11, 16, 21.
    assert_eq!(mesh.nodes.count(), 9);
    near(&mesh, 3, [2.0, 0.0, 1.0]);
    near(&mesh, 9, [8.0, 0.0, 4.0]);
    near(&mesh, 8, [7.0, 0.0, 3.5]);
    near(&mesh, 5, [1.0, 1.0, 0.0]);
    near(&mesh, 16, [5.0, 0.0, 2.5]);
}

#[test]
fn ngen_puts_nodes_on_an_arc() {
    let half = 0.5f64.sqrt();
    let deck = "*NODE\n1,2,0,0\n3,0,2,0\n99,0,0,0\n13,-2,0,0\n*NGEN,LINE=C\n1,3,1,,0,0,0\n\
                *NGEN,LINE=C\n3,13,5,99\n*NGEN, LINE=C\n 1, 41, 10, 99, , , , 0, 0, 1\n";
    let deck = deck.replace("13,-2,0,0\n", "13,-2,0,0\n41,0,-2,0\n");
    let mesh = mesh(&format!("{deck}{MASS}"));
    near(&mesh, 2, [2.0 * half, 2.0 * half, 0.0]);
    near(&mesh, 8, [-2.0 * half, 2.0 * half, 0.0]);
    // Three quarters of a circle about z, in four parts.
    let angle = |k: f64| (k * 67.5f64).to_radians();
    for (id, k) in [(11, 1.0), (21, 2.0), (31, 3.0)] {
        near(&mesh, id, [2.0 * angle(k).cos(), 2.0 * angle(k).sin(), 0.0]);
    }
}

#[test]
fn nfill_joins_sets_in_their_order() {
    let deck = "*NODE, NSET=left\n1,0,0\n2,0,1\n*NODE, NSET=right\n31,6,0\n32,6,2\n*NFILL, NSET=all\nleft,right,3,10\n\
                *NSET, NSET=back, UNSORTED\n32,31\n*NFILL\nleft, back, 2, 100\n";
    let mesh = mesh(&format!("{deck}*NCOPY, OLD SET=all, CHANGE NUMBER=500, SHIFT\n0,0,1\n\n{MASS}"));
    near(&mesh, 11, [2.0, 0.0, 0.0]);
    near(&mesh, 22, [4.0, 1.0 + 2.0 / 3.0, 0.0]);
    near(&mesh, 101, [3.0, 1.0, 0.0]);
    near(&mesh, 102, [3.0, 0.5, 0.0]);
    // The set holds both bounds and what is between.
    for id in [1, 2, 11, 12, 21, 22, 31, 32] {
        let [x, y, z] = at(&mesh, id);
        near(&mesh, 500 + id, [x, y, z + 1.0]);
    }
    assert_eq!(mesh.nodes.count(), 4 + 4 + 2 + 8);
}

#[test]
fn ncopy_moves_and_mirrors() {
    let rows = [
        ("SHIFT\n10,0,0\n", [11.0, 2.0, 3.0]),
        ("SHIFT\n10,0,0\n10,0,0,10,0,1,90\n", [8.0, 1.0, 3.0]),
        ("SHIFT\n10,0,0\n0,0,0,0,0,0,0\n", [11.0, 2.0, 3.0]),
        ("REFLECT=POINT\n1,1,1\n", [1.0, 0.0, -1.0]),
        ("REFLECT=LINE\n0,0,0,0,0,7\n", [-1.0, -2.0, 3.0]),
        ("REFLECT=MIRROR\n0,0,0,0,1,0\n0,0,1\n", [-1.0, 2.0, 3.0]),
    ];
    for (how, expected) in rows {
        let mesh = mesh(&format!(
            "*NODE\n1,1,2,3\n*NSET,NSET=S\n1\n*NCOPY,OLD SET=S,CHANGE NUMBER=9,NEW SET=T,{how}{MASS}"
        ));
        near(&mesh, 10, expected);
    }
}

/// A block of 3 x 2 x 2 bricks out of one, in layers of 100 and rows of 10 nodes.
#[test]
fn elgen_makes_rows_of_rows_in_layers() {
    let deck = "*NODE\n1,0,0,0\n4,3,0,0\n21,0,2,0\n24,3,2,0\n*NGEN,NSET=a\n1,4\n*NGEN,NSET=b\n21,24\n*NFILL,NSET=base\na,b,2,10\n\
                *NCOPY,OLD SET=base,CHANGE NUMBER=200,NEW SET=top,SHIFT\n0,0,4\n0,0,0,0,0,0,0\n*NFILL\nbase,top,2,100\n\
                *ELEMENT,TYPE=C3D8R\n1,1,2,12,11,101,102,112,111\n*ELGEN,ELSET=block\n1, 3,1,1, 2,10,10, 2,100,100\n\
                *ELCOPY,OLD SET=block,ELEMENT SHIFT=1000,SHIFT NODES=0,NEW SET=again\n";
    let mesh = mesh(deck);
    assert_eq!((mesh.nodes.count(), types(&mesh).as_str()), (36, "C3D8R:24"));
    let mut labels: Vec<_> = mesh.elements.iter().map(|e| e.0).collect();
    labels.sort_unstable();
    let block = [1, 2, 3, 11, 12, 13, 101, 102, 103, 111, 112, 113];
    assert_eq!(labels[..12], block);
    assert_eq!(labels[12..], block.map(|label| label + 1000));
    for (label, _, corners) in &mesh.elements {
        let place = |unit: u64, of: u64| (label % 1000 / unit % of) as f64;
        let (x, y, z) = (place(1, 10) - 1.0, place(10, 10), 2.0 * place(100, 10));
        let expected = [[x, y, z], [x + 1.0, y, z], [x + 1.0, y + 1.0, z], [x, y + 1.0, z]];
        assert_eq!(corners[..4], expected, "{label}");
        assert_eq!(corners[6], [x + 1.0, y + 1.0, z + 2.0], "{label}");
    }
}

/// In a part, numbers are the part's own and every instance moves its copies.
#[test]
fn a_part_is_made_once_for_each_instance() {
    let deck = "*PART,NAME=P\n*NODE\n1,0,0\n3,2,0\n*NGEN,NSET=low\n1,3\n*NCOPY,OLD SET=low,CHANGE NUMBER=10,SHIFT\n0,1\n\n\
                *ELEMENT,TYPE=S4\n1,1,2,12,11\n*ELGEN\n1,2\n*END PART\n*ASSEMBLY,NAME=A\n*INSTANCE,NAME=I,PART=P\n*END INSTANCE\n\
                *INSTANCE,NAME=J,PART=P\n0,0,5\n*END INSTANCE\n*END ASSEMBLY\n";
    let mesh = mesh(deck);
    assert_eq!((mesh.nodes.count(), types(&mesh).as_str()), (12, "S4:4"));
    let mut lows: Vec<_> = mesh.elements.iter().map(|e| (e.0, e.2[0][0], e.2[0][2])).collect();
    lows.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    assert_eq!(lows, [(1, 0.0, 0.0), (1, 0.0, 5.0), (2, 1.0, 0.0), (2, 1.0, 5.0)]);
}

#[test]
fn sets_hold_numbers_ranges_and_sets() {
    let deck = "*NODE,NSET=A\n5,5,0\n6,6,0\n*NODE\n1,1,0\n2,2,0\n3,3,0\n4,4,0\n*NSET,NSET=B,GENERATE\n1,3,2\n*NSET,NSET=C\nA, B,\n2\n\
                *NCOPY,OLD SET=C,CHANGE NUMBER=100,SHIFT\n0,1\n\n";
    let mesh = mesh(&format!("{deck}{MASS}"));
    assert_eq!(mesh.nodes.count(), 6 + 5);
    for id in [1, 2, 3, 5, 6] {
        near(&mesh, 100 + id, [id as f64, 1.0, 0.0]);
    }
}

#[test]
fn what_is_in_doubt_is_refused_by_name() {
    let start = "*NODE,NSET=A\n1,1,0\n4,0,1\n*ELEMENT,TYPE=T3D2,ELSET=E\n1,1,4\n";
    let rows = [
        ("*NGEN\n1,9\n", "line 7: expected a node that is defined before, found node 9"),
        (
            "*NGEN\n1,4,2\n",
            "line 7: expected two end nodes whose numbers lie a multiple of the increment apart, found 1, 4, 2",
        ),
        ("*NGEN,LINE=P\n1,4,1,,2,2,2\n", "line 6: *NGEN with LINE=P is not expanded"),
        ("*NGEN,LINE=C\n1,4,1,,5,4,1\n", "line 7: expected a centre that is as far"),
        ("*NGEN,LINE=C,SYSTEM=C\n1,4,1,,5,5,1\n", "line 6: *NGEN with SYSTEM is not expanded"),
        ("*NFILL,BIAS=0.5\nA,A,3\n", "line 6: *NFILL with BIAS is not expanded"),
        ("*NFILL\nA,B,3\n", "line 7: expected a set that is defined before, found B"),
        ("*NCOPY,OLD SET=A,CHANGE NUMBER=5,POLE\n1\n", "line 6: *NCOPY with POLE is not expanded"),
        ("*NCOPY,OLD SET=A,CHANGE NUMBER=5\n1\n", "line 6: expected SHIFT, or REFLECT=LINE, MIRROR or POINT"),
        (
            "*NCOPY,OLD SET=A,CHANGE NUMBER=5,REFLECT=MIRROR\n0,0,0,0,0,0\n0,0,1\n",
            "line 6: expected points that are apart",
        ),
        ("*NCOPY,CHANGE NUMBER=5,SHIFT\n0\n", "line 6: expected the parameter OLDSET="),
        (
            "*NSET,NSET=F,ELSET=E\n*NSET,NSET=F\n1,G\n*NCOPY,OLD SET=F,CHANGE NUMBER=5,SHIFT\n1\n",
            "line 9: the members of the set F are not known",
        ),
        ("*ELGEN\n7,3\n", "line 7: expected an element that is defined before, found element 7"),
        (
            "*ELGEN\n1,99999999999,1,1,99999999999\n",
            "number of elements that a line of *ELGEN makes is over the limit",
        ),
        ("*ELEMENT,TYPE=S4\n5,1,4,4,1\n*ELGEN\n5,40000000\n", "line 9: element 6 names node 2"),
        (
            "*ELCOPY,OLD SET=E,ELEMENT SHIFT=5,SHIFT NODES=5,REFLECT\n",
            "line 6: *ELCOPY with REFLECT is not expanded",
        ),
        ("*NGEN\n1,<n>\n", "the parameter in \"<n>\" is not substituted"),
        ("*NMAP,NSET=A\n1,1\n", "line 6: the keyword *NMAP is not expanded"),
        ("*NODE\n900000000000,0\n*NGEN\n1,900000000000\n", "is over the limit of the run's budget"),
    ];
    for (rest, expected) in rows {
        let found = error(&format!("{start}{rest}"));
        assert!(found.contains(expected), "{rest}\nfound    {found}\nexpected {expected}");
    }
}
