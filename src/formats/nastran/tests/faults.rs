//! Errors name their place; damage does no harm.

use super::*;

#[test]
fn errors_name_the_line_and_what_stands_there() {
    let four = |rest: &str| format!("{SQUARE}{rest}");
    let rows: Vec<(String, &str)> = vec![
        (
            "GRID,1,,0.,zero,0.\nCONM2,1,1\n".into(),
            "line 1: expected a real number in field 5, found \"zero\"",
        ),
        ("GRID,0,,0.,0.,0.\nCONM2,1,1\n".into(), "line 1: expected a node number in field 2, found \"0\""),
        ("GRID    1              1.5 1.5\nCONM2,1,1\n".into(), "line 1: expected a real number in field 4"),
        ("GRID,1,,1.+999\nCONM2,1,1\n".into(), "line 1: expected finite coordinates"),
        (
            "GRID,1,7\nCONM2,1,1\n".into(),
            "line 1: expected a coordinate system of the deck (CORD1x, CORD2x), found 7",
        ),
        (
            "GRID,1,7\nCONM2,1,1\nCORD2R,7,8\nCORD2R,8,7\n".into(),
            "line 1: expected a sound coordinate system 7, found one that",
        ),
        (
            "GRID,1,7\nCONM2,1,1\nCORD2R,7,0,0.,0.,0.,0.,0.,1.\n".into(),
            "line 1: expected a sound coordinate system 7, found one whose three points stand in a line",
        ),
        (
            "GRID,1,7\nCONM2,1,1\nCORD1R,7,1,1,2\n".into(),
            "line 1: expected a sound coordinate system 7, found one",
        ),
        (
            "CORD2R,7,0,x\nGRID,1\nCONM2,1,1\n".into(),
            "line 1: expected a real number in field 4, found \"x\"",
        ),
        (four(""), "line 5: expected element cards, as CTETRA or CQUAD4, found the end of the file"),
        ("CQUAD4,1,1,1,2,3,4\n".into(), "line 2: expected GRID cards, found the end of the file"),
        (four("CQUAD4,1,1,1,2,3\n"), "line 5: expected a node number in field 7, found a blank field"),
        (four("CQUAD4,1,1,1,2,3,4.\n"), "line 5: expected a node number in field 7, found \"4.\""),
        (four("CQUAD4,x,1,1,2,3,4\n"), "line 5: expected an element number in field 2, found \"x\""),
        (four("CQUAD4,1,1,1,2,3,5\n"), "line 5: element 1 names node 5, which the file does not define"),
        (four("CTRIA6,1,1,1,2,3,,,5\n"), "line 5: element 1 names node 5, which the file does not define"),
        (four("CHEXA,1,1,1,2,3,4,1,2\n"), "line 5: expected a node number in field 10, found a blank field"),
        (four("CHEXA,1,1,1,2,3,4,1,2,3,4\n"), "line 5: expected at most 10 fields in a line, found \"4\""),
        (
            four("CTETRA  1       1       1       2       3       4       1       2       +A\n+B      3\n"),
            "line 5: expected the continuation \"+A\", found \"+B\"",
        ),
        (
            four("=,*(1),=,*(1.),==\nCQUAD4,1,1,1,2,3,4\n"),
            "line 5: the replication (=) of a GRID card is not expanded",
        ),
        (
            four("CHEXA,1,1,1,2,3,4,1,2,\n3,4\n"),
            "line 6: expected a card, a continuation or a comment, found \"3,4\"",
        ),
        (
            format!("BEGIN BULK\n{SQUARE}BEGIN SUPER=1\nCQUAD4,1,1,1,2,3,4\n"),
            "line 6: a second section of bulk data (superelement, auxiliary model) is not read: BEGIN SUPER",
        ),
        ("BEGIN BULK SUPER=2\n".into(), "line 1: a second section of bulk data"),
        (
            "INCLUDE 'OUT:a.bdf'\n".into(),
            "line 1: an include by drive, logical symbol or environment variable",
        ),
        (
            "SOL 101\nINCLUDE '../a.bdf'\n".into(),
            "line 2: expected the name of a file beneath the mesh's own folder",
        ),
        (
            "SOL 101\nINCLUDE 'deck.bdf'\n".into(),
            "line 2: expected an include that does not lead back to itself",
        ),
        (
            four("CTETRA,1,1,1,2,3,4,\n,1"),
            "line 6: expected ENDDATA, or an end of line after the last card, found \",1\"",
        ),
        (
            format!("{SQUARE}CQUAD4,1,1,1,2,3,4\nCQU"),
            "line 6: expected ENDDATA, or an end of line after the last card, found \"CQU\"",
        ),
        ("SOL 101\nCEND\n".into(), "line 3: expected GRID cards, found the end of the file"),
    ];
    for (text, expected) in rows {
        let found = error(&text);
        assert!(found.starts_with(expected), "{text}\nfound    {found}\nexpected {expected}");
    }
}

/// A deck with something of everything.
fn torture() -> String {
    format!(
        "SOL 101\nCEND\nBEGIN BULK\n{SQUARE}GRDSET,,5\nGRID*   11                              1.5-3           2.\n*       3.\n\
         GRID\t12\t0\t1.\t\t4.\nGRID    13      6       1.      90.     45.\nCORD2C  5       0       0.      0.      0.      0.      0.      1.      +A\n\
         +A      1.      0.      1.\nCORD1S,6,1,2,3\nCHEXA   1       1       1       2       3       4       11      12      +B\n\
         +B      13      1\nCTRIAX6,2,1,1,11,2,,3\nRBE2,3,1,123,2,3,4,11,12\n,13,1.-3\nCTETRA*,4,1,1,2\n*,3,11\nINCLUDE 'more.inc'\n\
         CQUAD8,5,1,1,2,3,4,11,12\n+,,13\nCIHEX1,6,1,1,2\nSPC1,1,123,1,THRU,4\nENDDATA\n"
    )
}

#[test]
fn damaged_decks_give_errors_and_no_panic() {
    let text = torture();
    let whole = text.as_bytes();
    let folder = tempfile::tempdir().expect("a scratch folder");
    std::fs::write(folder.path().join("more.inc"), "CBAR,9,1,1,2\n").expect("written");
    let path = folder.path().join("deck.bdf");
    let attempt = |bytes: &[u8]| {
        std::fs::write(&path, bytes).expect("written");
        Nastran.detect(bytes);
        read(&Nastran, &path)
    };
    let found = attempt(whole).expect("sound");
    assert_eq!(types(&found), "CBAR:1 CHEXA:1 CIHEX1:1 CQUAD8:1 CTETRA:1 CTRIAX6:1 RBE2:1");
    for cut in 0..whole.len() {
        let _ = attempt(&whole[..cut]);
    }
    let mut seed = 0x9e37_79b9_7f4a_7c15u64;
    let mut next = |below: usize| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as usize % below
    };
    let bytes = b"*,\n\r\"'<.=-+09 aE\t\x00\xff$";
    for _ in 0..2000 {
        let mut damaged = whole.to_vec();
        for _ in 0..1 + next(4) {
            let at = next(damaged.len());
            match next(3) {
                0 => damaged[at] = bytes[next(bytes.len())],
                1 => damaged.insert(at, bytes[next(bytes.len())]),
                _ => {
                    let end = (at + next(12)).min(damaged.len());
                    damaged.drain(at..end);
                }
            }
        }
        let _ = attempt(&damaged);
    }
}

#[test]
#[expect(clippy::disallowed_methods, reason = "a small mesh of known size is read whole, to be damaged")]
fn a_real_deck_that_was_cut_or_flipped_does_no_harm() {
    let whole = std::fs::read(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/nastran/gmsh_mixed_large.bdf"),
    );
    let whole = whole.expect("a deck");
    let attempt = |bytes: &[u8]| read_files(&[("deck.bdf", bytes)]);
    for k in 0..50 {
        let cut = whole.len() * k / 50;
        // No end mark: a deck that lost elements alone is sound.
        if let Ok(found) = attempt(&whole[..cut]) {
            assert!(found.ledger.types.iter().map(|t| t.count).sum::<u64>() < 100, "cut at {cut}");
        }
    }
    let mut seed = 0x2545_f491_4f6c_dd1du64;
    for _ in 0..200 {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        let mut damaged = whole.clone();
        let at = (seed >> 16) as usize % damaged.len();
        damaged[at] ^= 1 << (seed % 8);
        let _ = attempt(&damaged);
    }
}
