//! What decks may look like.

use super::*;

#[test]
fn what_stands_before_begin_bulk_is_no_mesh() {
    let text = format!(
        "ID a,b\nSOL 101\nCEND\nTITLE = CHEXA,1,2\nGRID,9,,9.,9.,9.\n=,==\nSET 1 = 1,2,\n3,4\nCOMMENT\n7\nBEGIN BULK $\n\
         {SQUARE}CQUAD4,1,1,1,2,3,4\nENDDATA a015b074\nGRID,8,,8.,8.,8.\n"
    );
    let found = mesh(&text);
    assert_eq!((found.nodes.count(), types(&found).as_str()), (4, "CQUAD4:1"));
}

#[test]
fn nodes_in_every_notation() {
    let large =
        format!("GRID*   {:<16}{:>16}{:>16}{:<16}*XY\n*XY     {:>16}\n", 3, "", "1.705+7", "-1.D+3", ".5");
    let text = format!(
        "$ note\r\nGRID           1        -.375018-.07100212.025\r\ngrid*,2,,1.5-3,-7.-1,*\r\n*,2.3+2\r\n{large}\
         GRID\t4\t\t5.\t\t+6.\r\nGRID    5\r\n  GRID,6,0,1,2,3,,123456 $ note\r\nCONM2,1,6,,1.\r\nEND BULK\r\n"
    );
    let found = mesh(&text);
    let expected = [
        (1, [-0.375018, -0.071002, 12.025]),
        (2, [0.0015, -0.7, 230.0]),
        (3, [1.705e7, -1000.0, 0.5]),
        (4, [5.0, 0.0, 6.0]),
        (5, [0.0; 3]),
        (6, [1.0, 2.0, 3.0]),
    ];
    for (id, point) in expected {
        assert_eq!(node(&found, id), point, "node {id}");
    }
    assert_eq!((found.nodes.count(), found.nodes.unused()), (6, 5));
}

#[test]
fn blank_nodes_between_and_after_the_corners() {
    let mut text = String::from("CQUAD8,1,1,1,2,3,4,,6,\n+,,8\nCTRIA6,2,1,1,2,3,,,6\nCTRIA6,3,1,1,2,3\n");
    text += "CTRIAX6,4,1,1,5,2,,3,\nCTRIAX6,5,1,1,,2,,3,\nCTETRA,6,1,1,2,3,4,0,0,\n,0,0\nCTETRA,7,1,1,2,3,4,,,\n,,8\n";
    text += "CPYRAM,8,1,1,2,3,4,5\nCPENTA,9,1,1,2,3,5,6,7\nCHEXA,10,1,1,2,3,4,5,6\n,7,8\nCQUADX,11,1,1,2,3,4\nCQUAD,12,1,1,2,3,4,5,6,\n,7,8,9\n";
    for id in 1..=9 {
        text += &format!("GRID,{id},,{}.,{}.,{}.\n", id % 2, id % 3, id);
    }
    let found = mesh(&text);
    let counts = "CHEXA:1 CPENTA:1 CPYRAM:1 CQUAD:1 CQUAD8:1 CQUADX:1 CTETRA:2 CTRIA6:2 CTRIAX6:2";
    assert_eq!(types(&found), counts);
    // CQUAD8, CTRIA6 twice, CTRIAX6 twice, the second CTETRA, CQUAD.
    assert_eq!((of_order(&found, 2), of_order(&found, 1)), (7, 5));
    let ring = found.elements.iter().find(|e| e.0 == 4).expect("the CTRIAX6");
    assert_eq!(ring.2, [node(&found, 1), node(&found, 2), node(&found, 3)]);
    assert_eq!((found.nodes.unused(), found.ledger.repeated_nodes), (0, 0));
}

#[test]
fn systems_after_their_nodes_in_chains_and_on_nodes() {
    let text = "GRDSET,,5\nGRID,1,,1.,90.,2.\nGRID,2,0,1.,2.,3.\nGRID,3,7,1.,2.,3.\nGRID,4,9,1.,0.,0.\n\
                GRID,11,0,0.,0.,5.\nGRID,12,0,0.,0.,6.\nGRID,13,5,1.,0.,0.\nCTRIA3,1,1,1,2,3\nCTRIA3,2,1,4,2,3\n\
                $ cylindrical, its origin in (10, 0, 0)\nCORD2C,5,6,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n\
                CORD2R,6,0,10.,0.,0.,10.,0.,1.,\n,11.,0.,0.\n\
                $ z along x, x along y\nCORD2R*,7,0,0.,0.\n*,0.,1.,0.,0.\n*,0.,1.,0.\n\
                CORD1R,8,11,12,13,9,11,12,13\n";
    let found = mesh(text);
    assert_near(node(&found, 1), [10.0, 1.0, 2.0]);
    assert_near(node(&found, 2), [1.0, 2.0, 3.0]);
    assert_near(node(&found, 3), [3.0, 1.0, 2.0]);
    // From (0, 0, 5), x towards (11, 0, 0), which stands off z by that much.
    assert_near(node(&found, 4), [1.0, 0.0, 5.0]);
}

#[test]
fn a_long_chain_of_systems() {
    let mut text = String::from("GRID,1,20000,0.,0.,0.\nCONM2,1,1\n");
    for number in 1..=20000 {
        text += &format!("CORD2R,{number},{},1.,0.,0.,1.,0.,1.\n,2.,0.,0.\n", number - 1);
    }
    assert_near(node(&mesh(&text), 1), [20000.0, 0.0, 0.0]);
}

#[test]
fn a_system_that_no_node_asks_for_may_be_unsound() {
    let text =
        format!("CORD1R,5,77,78,79\nCORD2R,6,6,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n{SQUARE}CQUAD4,1,1,1,2,3,4\n");
    assert_eq!(mesh(&text).elements.len(), 1);
}

#[test]
fn lines_scalars_and_rigid_elements_are_counted_and_use_their_nodes() {
    let text = format!(
        "{SQUARE}GRID,5\nGRID,6\nGRID,7\nGRID,8\nGRID,9\nSPOINT,20\nCBAR,1,1,1,2,0.,0.,1.\nCELAS2,2,1.+3,3,1,20\nCONM2,3,4,,1.\n\
         RBE2,4,5,123456,6,7,1.-5\nRBE2*,5,5,123456,8\n*,9\nCORD2R,1,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCREEP,1,2,3,4\n\
         CIHEX1,7,1,1,2,3,4,5,6\nCUNKNOWN,word\nCBAROR,,,,,0.,0.,1.\nCROD,8,1,1,2\n"
    );
    let found = mesh(&text);
    assert_eq!(types(&found), "CBAR:1 CELAS2:1 CIHEX1:1 CONM2:1 CROD:1 RBE2:2");
    assert_eq!((found.nodes.unused(), found.elements.len()), (0, 0));
    let class = |name: &str| found.ledger.types.iter().find(|t| t.name == name).map(|t| t.class.clone());
    for (name, expected) in [("CBAR", "line"), ("CELAS2", "spring"), ("RBE2", "rigid"), ("CIHEX1", "CIHEX1")]
    {
        assert_eq!(class(name), Some(Class::Counted(expected.into())));
    }
}

#[test]
fn nodes_that_repeat_are_one_node() {
    let text = format!("{SQUARE}{SQUARE}CQUAD4,1,1,1,2,3,4\n");
    assert_eq!(mesh(&text).nodes.count(), 4);
}

#[test]
fn includes_within_includes() {
    let main = b"SOL 101\nINCLUDE 'case.inc'\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nINCLUDE 'sub/\n   bulk.inc' $ note\n\
                 GRID,3,,1.,1.,0.\nENDDATA\nGRID,5\n";
    let folder = tempfile::tempdir().expect("a scratch folder");
    std::fs::create_dir(folder.path().join("sub")).expect("a folder");
    for (name, text) in [
        ("main.bdf", &main[..]),
        ("case.inc", b"CEND\nGRID,99\nBEGIN BULK\n"),
        ("sub/bulk.inc", b"INCLUDE more.inc\n+stray\nGRID,4,,0.,1.,0.\n"),
        ("sub/more.inc", b"CQUAD4,1,1,1,2,3,\n,\n$ the last node is missing here\n"),
    ] {
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    let error = read(&Nastran, &folder.path().join("main.bdf")).expect_err("a node is missing").to_string();
    assert!(
        error.contains("sub/more.inc: line 1: expected a node number in field 7, found a blank field"),
        "{error}"
    );
    std::fs::write(folder.path().join("sub/more.inc"), "CQUAD4,1,1,1,2,3,4\n").expect("written");
    let found = read(&Nastran, &folder.path().join("main.bdf")).expect("a deck");
    assert_eq!((found.nodes.count(), types(&found).as_str()), (4, "CQUAD4:1"));
}

#[test]
fn alternating_cards_and_long_loads_make_few_pieces() {
    use crate::formats::{ElementLayout, NodeLayout, Outline, Piece};
    use crate::mesh::ElementType;
    #[derive(Default)]
    struct Spans(Vec<std::ops::Range<u64>>, Vec<std::ops::Range<u64>>);
    impl Outline for Spans {
        fn nodes(&mut self, piece: Piece<dyn NodeLayout>) -> Result<()> {
            self.0.push(piece.span);
            Ok(())
        }
        fn elements(&mut self, piece: Piece<dyn ElementLayout>) -> Result<()> {
            self.1.push(piece.span);
            Ok(())
        }
        fn count(&mut self, _: &ElementType, _: u64) -> Result<()> {
            Ok(())
        }
    }
    let mut text = String::from("BEGIN BULK\nTEMP,1,1,0.\n");
    while text.len() < 5 << 20 {
        text += ",5,6,7,8\n";
    }
    let loads = text.len() as u64;
    let mut count = 0;
    while (text.len() as u64) < loads + (4 << 20) {
        count += 1;
        text +=
            &format!("GRID,{count},,{count}.,0.,0.\nCTETRA,{count},1,{count},{count},1,1,1,1\n,1,1,1,1\n");
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path().join("deck.bdf");
    std::fs::write(&path, &text).expect("written");
    let scratch = Scratch::new(folder.path(), 1 << 30);
    let input = Input::open(&path, &Limits::default(), &scratch).expect("a file");
    let mut spans = Spans::default();
    Nastran.outline(&input, &mut spans).expect("a deck");
    assert_eq!(spans.0, spans.1);
    assert!((4..=5).contains(&spans.0.len()), "{:?}", spans.0);
    assert!(spans.0[0].start > 4 << 20, "{:?}", spans.0);
    let found = read(&Nastran, &path).expect("a deck");
    assert_eq!((found.nodes.count(), found.count(Tetrahedron)), (count, count as usize));
    assert_eq!(of_order(&found, 2), count);
}
