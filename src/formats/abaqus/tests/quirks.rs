//! What decks may look like.

use super::*;

#[test]
fn quirks_of_node_lines() {
    let text = "*Heading\r\n caf\u{e9} * star\r\n*NODE , nset = all\r\n ** note\r\n  1 , 1.D0 ,-2.5E-1,  \r\n\r\n2,.5,,3,\r\n\
                3\r\n999999999, 1, 2, 3, 0., 0., 1.  \r\n*NODE PRINT\r\n9, 9, 9, 9\r\n*NODE OUTPUT\r\nU\r\n*node\r\n1, 7.";
    let mut bytes: Vec<u8> = text.bytes().filter(|b| *b != 0xc3).collect();
    bytes.extend_from_slice(b"\r\n*ELEMENT,TYPE=MASS\r\n1,1\r\n");
    let mesh = read_files(&[("deck.inp", &bytes)]).expect("a deck");
    assert_eq!(mesh.nodes.count(), 4);
    let at = |id| mesh.nodes.rows()[mesh.nodes.row(id).expect("defined") as usize];
    assert_eq!(at(1), [7.0, 0.0, 0.0], "the last definition wins");
    assert_eq!(at(2), [0.5, 0.0, 3.0]);
    assert_eq!(at(3), [0.0; 3]);
    assert_eq!(at(999_999_999), [1.0, 2.0, 3.0]);
}

#[test]
fn element_records_end_by_count_and_by_comma() {
    let nodes: String = (1..=20).map(|id| format!("{id}, {id}.\n")).collect();
    let head = "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15";
    for break_at in [
        format!("{head},\n16,17,18,19,20"),
        format!("{head}\n 16,17,18,19,20,"),
        format!("{head},16,17\n** c\n\n18\n19,20,\n"),
    ] {
        let mesh = mesh(&format!("*NODE\n{nodes}*ELEMENT, TYPE=C3D20R\n7,{break_at}\n8,{break_at}\n"));
        assert_eq!(types(&mesh), "C3D20R:2");
        assert_eq!(mesh.elements.iter().map(|e| e.0).collect::<Vec<_>>(), [7, 8]);
        assert_eq!(mesh.nodes.unused(), 0);
    }
}

#[test]
fn nodes_that_may_be_left_out() {
    let nodes: String = (1..=30).map(|id| format!("{id}, {id}.\n")).collect();
    let list = |n: usize| (1..=n).map(|k| k.to_string()).collect::<Vec<_>>().join(",");
    let text = format!(
        "*NODE\n{nodes}*ELEMENT, TYPE=C3D27\n1,{},\n16,17,18,19,20,21\n2,{}\n3,{},,0,24\n*ELEMENT,TYPE=C3D15V\n4,{}\n5,{}\n",
        list(15),
        list(27),
        list(21),
        list(15),
        list(18)
    );
    assert_eq!(types(&mesh(&text)), "C3D27:3 C3D15V:2");
}

#[test]
fn what_is_not_measured_is_counted() {
    let text = format!(
        "{SQUARE}*ELEMENT, TYPE=B31\n1,1,2,4\n2,2,3,\n*Element, type=SpringA\n3,1,2\n*ELEMENT,TYPE=MASS\n4,1\n\
         *USER ELEMENT, TYPE=U1, NODES=3, COORDINATES=2\n1,2\n*ELEMENT,TYPE=U1\n5,1,2\n3\n6,2,3,4\n\
         *ELEMENT, TYPE=XY77\n7,1,2,\n3,4\n8,1\n*ELEMENT,TYPE=COH2D4\n9,1,2,3,4\n*ELEMENT,TYPE=D\n10,0,1,2\n11,,1,2\n"
    );
    let mesh = mesh(&text);
    let counted: Vec<_> =
        mesh.ledger.types.iter().map(|t| (t.name.as_ref(), t.count, t.class.clone())).collect();
    let class = |name: &'static str| Class::Counted(name.into());
    assert_eq!(
        counted,
        [
            ("B31", 2, class("line")),
            ("SPRINGA", 1, class("spring")),
            ("MASS", 1, class("mass")),
            ("U1", 2, class("U1")),
            ("XY77", 2, class("XY77")),
            ("COH2D4", 1, class("cohesive")),
            ("D", 2, class("fluid network")),
        ]
    );
    assert!(mesh.elements.is_empty());
}

#[test]
fn instances_are_copies_with_numbers_of_their_own() {
    let text = format!(
        "{PART}*PART,NAME=unused\n*NODE\n1,0,0\n*NGEN\n1,5\n*END PART\n*ASSEMBLY,NAME=A\n*INSTANCE,NAME=I-1,PART=q\n*END INSTANCE\n\
         *INSTANCE,NAME=\"I 2\",PART=Q\n0,0,5\n*NODE\n9,0,0,1\n*ELEMENT,TYPE=S3\n2,1,2,9\n*END INSTANCE\n\
         *NODE\n1, 8,8,8\n*ELEMENT,TYPE=CONN3D2\n1, I-1.1, \"I 2\".9\n2, 1, i-1.4\n*ELEMENT,TYPE=S3\n3, I-1.1, I-1.2, 1\n*END ASSEMBLY\n"
    );
    let mesh = mesh(&text);
    assert_eq!((mesh.nodes.count(), types(&mesh).as_str()), (10, "S4:2 S3:2 CONN3D2:2"));
    let heights: Vec<_> = mesh
        .elements
        .iter()
        .map(|(label, _, c)| (*label, c.iter().map(|p| p[2]).collect::<Vec<_>>()))
        .collect();
    assert_eq!(heights[0], (1, vec![0.0; 4]));
    assert_eq!(heights[1], (1, vec![5.0; 4]));
    assert_eq!(heights[2], (2, vec![5.0, 5.0, 6.0]));
    assert_eq!(heights[3], (3, vec![0.0, 0.0, 8.0]));
}

#[test]
fn frames_hold_until_the_next_and_within_their_part() {
    let text = "*SYSTEM\n0,0,1\n*NODE\n1,1,0\n*SYSTEM\n*NODE,SYSTEM=C\n2,2,90,3\n*SYSTEM\n0,0,0,0,1,0\n0,1,1\n*NODE\n3,1,2,3\n\
                *PART,NAME=P\n*NODE\n1,1,1,1\n*ELEMENT,TYPE=MASS\n1,1\n*END PART\n";
    let mesh = mesh(text);
    let at = |id| mesh.nodes.rows()[mesh.nodes.row(id).expect("defined") as usize];
    assert_eq!(at(1), [1.0, 0.0, 1.0]);
    assert_eq!(at(2), [0.0, 2.0, 3.0]);
    assert_eq!(at(3), [3.0, 1.0, 2.0]);
    assert_eq!(at(1 << 40 | 1), [1.0; 3]);
}

#[test]
fn included_files_go_on_where_the_includer_stands() {
    let mesh = read_files(&[
        ("deck.inp", b"*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=S3, INPUT=\"more elements.inp\"\n*ELEMENT,TYPE=S4\n*include,input=list.inp\n2,4,3,2,1\n"),
        ("nodes.inp", b"\xef\xbb\xbf*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n"),
        ("more elements.inp", b"** three\n11,1,2,3\n"),
        ("list.inp", b"1,1,2,3,4\n"),
    ])
    .expect("a deck");
    assert_eq!((mesh.nodes.count(), types(&mesh).as_str()), (4, "S3:1 S4:2"));
}

/// Blocks of several pieces in every layout of records, each cut at a record.
#[test]
fn large_blocks_are_cut_at_records() {
    let count = 60_000u64;
    let mut nodes = String::from("*NODE\n");
    (1..=30).for_each(|id| nodes.push_str(&format!("{id}, {id}.5, {}., {}.25\n", id * 7 % 5, id * 3 % 11)));
    let list = |from: usize, to: usize| (from..=to).map(|k| k.to_string()).collect::<Vec<_>>().join(", ");
    let rows: [(&str, String); 7] = [
        ("C3D8", list(1, 8)),
        ("C3D8", format!("{},\n   {}", list(1, 4), list(5, 8))),
        ("C3D20", format!("{},\n{}", list(1, 15), list(16, 20))),
        ("C3D20", format!("{}\n** c, d\n{},", list(1, 10), list(11, 20))),
        ("C3D27", format!("{},\n{}", list(1, 15), list(16, 21))),
        ("B31", list(1, 3)),
        ("NEW1", format!("{},\n{}", list(1, 15), list(16, 20))),
    ];
    for (name, record) in rows {
        let mut text = format!("{nodes}*ELEMENT, TYPE={name}\n");
        (1..=count).for_each(|id| text.push_str(&format!("{id}, {record}\n")));
        let folder = tempfile::tempdir().expect("a scratch folder");
        let path = folder.path().join("deck.inp");
        std::fs::write(&path, &text).expect("written");
        let mesh = read(&Abaqus, &path).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(types(&mesh), format!("{name}:{count}"));
        let labels = mesh.elements.iter().map(|e| e.0);
        assert!(mesh.elements.is_empty() || labels.eq(1..=count), "{name}");
    }
}
