//! Hand-written files of every odd kind, and the errors of those that are wrong.

use super::{counted, message, read_bytes};
use crate::formats::Format;
use crate::formats::gmsh::Gmsh;
use crate::mesh::Shape::{Pyramid, Tetrahedron, Triangle};

/// A tetrahedron in MSH 2.2 text, with what stands in the braces of each section.
fn v2(nodes: &str, elements: &str) -> String {
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}\n$EndNodes\n$Elements\n{elements}\n$EndElements\n"
    )
}

fn v4(version: &str, nodes: &str, elements: &str) -> String {
    v2(nodes, elements).replace("2.2 0 8", version)
}

const NODES: &str = "4\n1 0 0 0\n2 1 0 0\n30 0 1 0\n4 0 0 1";

#[test]
fn rows_of_version_2_have_any_number_of_tags_and_mixed_types() {
    let elements = "7\n1 15 2 0 1 1\n2 1 0 1 2\n3 4 2 -1 -2 1 2 30 4\n10 2 6 1 1 3 1 -2 -3 1 2 30\n\
                    11 34 2 0 0 3 1 2 4\n12 2 2 0 0 1 2 4 \n13 11 2 0 0 1 2 30 4 1 1 1 1 1 1";
    let mesh = read_bytes(v2(NODES, elements).as_bytes()).expect("readable");
    assert_eq!((mesh.count(Tetrahedron), mesh.count(Triangle)), (2, 2));
    assert_eq!([counted(&mesh, "point"), counted(&mesh, "line"), counted(&mesh, "polygon")], [1, 1, 1]);
    assert_eq!(mesh.elements.iter().map(|e| e.0).collect::<Vec<_>>(), [10, 12, 3, 13]);
    assert_eq!(mesh.elements[2].2, [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]]);
}

#[test]
fn nodes_of_version_2_may_be_parametric_or_numbered_from_0() {
    let parametric = "4\n0 0 0 0 0 1\n1 1 0 0 1 1 0.5\n2 0 1 0 2 -1 0.5 0.5\n3 0 0 1 3 1";
    let text = v2(parametric, "1\n1 4 0 0 1 2 3").replace("Nodes", "ParametricNodes");
    let mesh = read_bytes(text.as_bytes()).expect("readable");
    assert_eq!((mesh.nodes.count(), mesh.count(Tetrahedron)), (4, 1));
}

#[test]
fn records_of_parametric_nodes_in_binary_version_2_differ_in_length() {
    let mut bytes = b"$MeshFormat\n2.2 1 8\n\x00\x00\x00\x01\n$EndMeshFormat\n$ParametricNodes\n3\n".to_vec();
    for (id, parameters) in [(1i32, 0), (2, 1), (3, 2)] {
        bytes.extend(id.to_be_bytes());
        [f64::from(id), f64::from(id * id), 0.0].iter().for_each(|x| bytes.extend(x.to_be_bytes()));
        [parameters, 5].iter().for_each(|x: &i32| bytes.extend(x.to_be_bytes()));
        (0..parameters).for_each(|_| bytes.extend(0.5f64.to_be_bytes()));
    }
    bytes.extend(b"\n$EndParametricNodes\n$Elements\n1\n");
    [2i32, 1, 0, 77, 1, 2, 3].iter().for_each(|x| bytes.extend(x.to_be_bytes()));
    bytes.extend(b"$EndElements");
    let mesh = read_bytes(&bytes).expect("readable");
    assert_eq!(mesh.elements, [(77, Triangle, vec![[1., 1., 0.], [2., 4., 0.], [3., 9., 0.]])]);
}

#[test]
fn version_1_is_read() {
    let text = "$NOD\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n$ENDNOD\n$ELM\n1\n8 7 1 1 5 1 2 3 4 5\n$ENDELM\n";
    let mesh = read_bytes(text.as_bytes()).expect("readable");
    assert_eq!((mesh.elements[0].0, mesh.count(Pyramid)), (8, 1));
    assert!(message(text.replace(" 1 5 1 2", " 1 4 1 2").as_bytes()).contains("5 nodes of a Pyramid 5"));
}

#[test]
fn blocks_of_version_4_may_be_empty_parametric_and_of_negative_entities() {
    let nodes = "4 4 1 40\n0 -1 0 1\n1\n0 0 0\n1 2 1 1\n2\n1 0 0 0.25\n2 5 1 0\n3 1 1 2\n30\n40\n0 1 0 1 2 3\n0 0 1 4 5 6";
    let elements = "2 2 9 11\n3 -1 4 2\n9 1 2 30 40\n11 1 2 40 30 \n2 1 2 0";
    let mesh = read_bytes(v4("4.1 0 8", nodes, elements).as_bytes()).expect("readable");
    assert_eq!((mesh.nodes.count(), mesh.count(Tetrahedron)), (4, 2));
    let nodes = "2 4\n-1 0 0 2\n1 0 0 0\n2 1 0 0\n5 2 1 2\n30 0 1 0 0.5 0.5\n40 0 0 1 0 0";
    let mesh = read_bytes(v4("4 0 8", nodes, "1 1\n-1 3 4 1\n9 1 2 30 40").as_bytes()).expect("readable");
    assert_eq!((mesh.nodes.count(), mesh.count(Tetrahedron)), (4, 1));
}

#[test]
fn other_sections_comments_and_blank_lines_are_passed_over() {
    let text = v2(NODES, "1\n1 4 0 1 2 30 4");
    let odd = "\n$Comments\n$MeshFormat of old\n $EndComments\nnot the end: $EndCommentsX\n$EndComments\n\n$Mine\n$EndMine\n";
    let mixed = format!("{odd}{}", text.replace("$Elements\n", &format!("{odd}$Elements\n")));
    assert!(Gmsh.detect(mixed.as_bytes()));
    assert_eq!(read_bytes(mixed.as_bytes()).expect("readable").count(Tetrahedron), 1);
    assert_eq!(read_bytes(mixed.replace('\n', "\r\n").as_bytes()).expect("readable").count(Tetrahedron), 1);
}

#[test]
fn long_blocks_are_cut_into_pieces_that_join_to_the_same_mesh() {
    let count = 60_000u64;
    let mut tags: Vec<u64> = (0..count).map(|k| 1 + (k * 7919) % count).collect();
    tags.swap(5, 50_000);
    let point = |tag: u64| [tag as f64, (tag * tag % 1000) as f64 / 8.0, 0.5];
    let row = |p: [f64; 3]| format!("{} {} {}", p[0], p[1], p[2]);
    let joined = |rows: &mut dyn Iterator<Item = String>| rows.collect::<Vec<_>>().join("\n");
    let triangles = (1..=count - 2).map(|k| (k + 100, [k, k + 1, k + 2]));
    let tagged = joined(&mut tags.iter().map(|&t| format!("{t} {}", row(point(t)))));
    let alone = joined(&mut tags.iter().map(u64::to_string));
    let points = joined(&mut tags.iter().map(|&t| row(point(t))));
    let rows = |middle: &str| {
        joined(&mut triangles.clone().map(|(l, [a, b, c])| format!("{l} {middle}{a} {b} {c}")))
    };
    let elements = count - 2;
    let texts = [
        v2(&format!("{count}\n{tagged}"), &format!("{elements}\n{}", rows("2 2 1 1 "))),
        v4(
            "4.0 0 8",
            &format!("1 {count}\n1 2 0 {count}\n{tagged}"),
            &format!("1 {elements}\n1 2 2 {elements}\n{}", rows("")),
        ),
        v4(
            "4.1 0 8",
            &format!("1 {count} 1 {count}\n2 1 0 {count}\n{alone}\n{points}"),
            &format!("1 {elements} 101 9\n2 1 2 {elements}\n{}", rows("")),
        ),
    ];
    for text in texts {
        let mesh = read_bytes(text.as_bytes()).expect("readable");
        assert_eq!((mesh.nodes.count(), mesh.count(Triangle) as u64), (count, elements));
        for ((label, _, corners), (expected, nodes)) in mesh.elements.iter().zip(triangles.clone()) {
            assert_eq!((*label, &corners[..]), (expected, &nodes.map(point)[..]));
        }
    }
}

#[test]
fn errors_name_the_line_and_what_stood_there() {
    let tet = "1\n1 4 0 1 2 30 4";
    let rows = [
        (
            v2(NODES, "2\n1 4 0 1 2 30 4"),
            "line 14: expected rows of elements, 2 in all, and not only 1, found \"$EndElements\"",
        ),
        (v2(NODES, "0\n1 4 0 1 2 30 4"), "line 13: expected $EndElements, found \"1 4 0 1 2 30 4\""),
        (
            v2(NODES, "1\n1 4 0 1 2 30"),
            "line 13: expected the tag of an element's node, found the end of the row",
        ),
        (v2(NODES, "1\n1 4 0 1 2 30 4 5"), "line 13: expected the end of the row, found \"5\""),
        (v2(NODES, "1\n1 4 0 1 2 30 -4"), "line 13: expected the tag of an element's node, found \"-4\""),
        (v2(NODES, "1\n1 4 0 1 2 30 5"), "line 13: element 1 names node 5, which the file does not define"),
        (
            v2(NODES, "1\n1 141 0 1"),
            "line 13: expected the number of an element type of Gmsh (1 to 140), found 141",
        ),
        (v2("1\n-1 0 0 0", tet), "line 6: expected a node's tag, found \"-1 0 0 0\""),
        (v2("1\n1 0 0", tet), "line 6: expected a node's z, found the end of the row"),
        (v2("1\n1 0 0 nan", tet), "line 6: expected finite coordinates, found [0.0, 0.0, NaN]"),
        (v2("1\n1 0 0 0x", tet), "line 6: expected a node's z, found \"0x\""),
        (v2("x\n1 0 0 0", tet), "line 5: expected the number of nodes, found \"x\""),
        (
            v2("1000000000000000000\n1 0 0 0", tet),
            "line 7: expected rows of nodes, 1000000000000000000 in all, and not only 1, found \"$EndNodes\"",
        ),
        (
            v4("4.1 0 8", "1 1 1 1\n3 1 0 1\n0\n0 0 0", "0 0 0 0"),
            "line 7: expected a node's tag, which is positive, found 0",
        ),
        (
            v4("4.1 0 8", "1 2 1 1\n3 1 0 1\n1\n0 0 0", "0 0 0 0"),
            "line 8: expected 2 nodes, as the head of the section says, found 1 in its blocks",
        ),
        (
            v4("4.1 0 8", "1 1 1 1\n4 1 0 1\n1\n0 0 0", "0 0 0 0"),
            "line 6: expected the dimension of an entity, 0 to 3, found 4",
        ),
        (
            v4("4.1 0 8", "1 1 1 1\n3 1 2 1\n1\n0 0 0", "0 0 0 0"),
            "line 6: expected 0 or 1, whether nodes are parametric, found 2",
        ),
        (
            v4("4.1 0 8", "9000000000000000000 1 1 1", "0 0 0 0"),
            "line 6: expected the dimension of an entity, found \"$EndNodes\"",
        ),
        (v4("3 0 8", NODES, tet), "line 2: Gmsh MSH version 3 is not read (1, 2.0 to 2.2, 4.0 and 4.1 are)"),
        (v4("4 1 8", NODES, tet), "line 2: binary Gmsh MSH 4.0 is not read"),
        (v4("2.2 1 4", NODES, tet), "line 2: binary Gmsh MSH of data size 4 is not read"),
        (v4("2.2 2 8", NODES, tet), "line 2: expected a file type, 0 for text or 1 for binary, found 2"),
        (v4("2.2 0", NODES, tet), "line 2: expected a data size, found the end of the row"),
        (v4("2.2 1 8", NODES, tet), "byte 20: expected the number 1 of four bytes, found \"$EndMeshFormat\""),
        (
            "$Nodes\n1\n$EndNodes\n".into(),
            "line 1: expected a section $MeshFormat before nodes and elements, found none",
        ),
        (
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$NodeData\n".into(),
            "line 5: expected $EndNodeData, found the end of the file",
        ),
        (
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n".into(),
            "line 4: expected a section $Nodes, found the end of the file",
        ),
    ];
    for (text, expected) in rows {
        assert_eq!(message(text.as_bytes()), expected);
    }
}

#[test]
fn counts_in_binary_heads_are_not_believed() {
    let head =
        |version: &str| format!("$MeshFormat\n{version} 1 8\n\x01\0\0\0\n$EndMeshFormat\n").into_bytes();
    let words = |words: &[u64]| words.iter().flat_map(|w| w.to_le_bytes()).collect::<Vec<u8>>();
    let huge = i64::MAX as u64;
    let nodes = [&head("4.1")[..], b"$Nodes\n", &words(&[1, huge, 1, huge, 3, 0]), &[0; 4]].concat();
    let rows = [
        (
            [&nodes[..nodes.len() - 8], &words(&[huge])].concat(),
            "nodes of a block, found the end of the file",
        ),
        (
            [&head("4.1")[..], b"$Nodes\n", &words(&[huge, 0, 0, 0])].concat(),
            "expected the head of a block of nodes",
        ),
        (
            [&head("4.1")[..], b"$Nodes\n", &words(&[u64::MAX, 0, 0, 0])].concat(),
            "expected a count, found -1",
        ),
        ([&head("2.2")[..], b"$Nodes\n2147483647\n"].concat(), "2147483647 nodes, found the end of the file"),
        (
            [&head("2.2")[..], b"$Nodes\n0\n$EndNodes\n$Elements\n9\n\x04\0\0\0\xff\xff\xff\x7f\0\0\0\0"]
                .concat(),
            "2147483647 elements of a block, found the end of the file",
        ),
        (
            [&head("2.2")[..], b"$Nodes\n0\n$EndNodes\n$Elements\n9\n\x22\0\0\0\x01\0\0\0\0\0\0\0"].concat(),
            "does not store the nodes of a Polygon",
        ),
    ];
    for (bytes, expected) in rows {
        let found = message(&bytes);
        assert!(found.starts_with("byte ") && found.contains(expected), "{found}");
    }
}
