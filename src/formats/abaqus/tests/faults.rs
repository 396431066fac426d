//! Errors name their place; damage does no harm.

use super::*;

#[test]
fn a_missing_node_of_an_instance_has_its_plain_number() {
    let text = "*PART,NAME=P\n*NODE\n1,0,0\n*ELEMENT,TYPE=S3\n5,1,2,3\n*END PART\n*ASSEMBLY,NAME=A\n\
                *INSTANCE,NAME=I,PART=P\n*END INSTANCE\n*END ASSEMBLY\n";
    assert_eq!(error(text), "line 5: element 5 names node 2, which the file does not define");
}

#[test]
fn includes_that_are_refused() {
    let cases: [(&[u8], &str); 7] = [
        (
            b"*NODE\n1,0\n*INCLUDE, INPUT=deck.inp",
            "deck.inp: line 3: expected an include that does not lead back",
        ),
        (b"*INCLUDE, INPUT=a.inp", "a.inp: line 1: expected an include that does not lead back"),
        (b"*INCLUDE, INPUT=../deck.inp", "line 1: expected the name of a file beneath the mesh's own folder"),
        (b"*INCLUDE, INPUT=/etc/passwd", "line 1: expected the name of a file beneath the mesh's own folder"),
        (b"*INCLUDE, INPUT=none.inp", "deck.inp: line 1: included file \"none.inp\": No such file"),
        (b"*INCLUDE", "line 1: expected INPUT= with a file's name"),
        (b"*NODE, INPUT=a.inp", "a.inp: line 1: expected a data line, found \"*INCLUDE"),
    ];
    for (text, expected) in cases {
        let error = read_files(&[
            ("deck.inp", text),
            ("a.inp", b"*INCLUDE, INPUT=b.inp"),
            ("b.inp", b"*INCLUDE,INPUT=a.inp"),
        ]);
        let error = error.expect_err(expected).to_string();
        let expected = if expected.starts_with("a.inp: line 1: expected an") {
            "b.inp: line 1: expected an"
        } else {
            expected
        };
        assert!(error.contains(expected), "{error}\n{expected}");
    }
}

#[test]
fn errors_name_the_line_and_what_stands_there() {
    let nodes = |lines: &str| format!("*NODE\n{lines}*ELEMENT,TYPE=MASS\n1,1\n");
    let four = |rest: &str| format!("{SQUARE}{rest}");
    let rows: Vec<(String, &str)> = vec![
        ("1,2,3\n".into(), "line 1: expected a keyword line, as *HEADING or *NODE, found \"1,2,3\""),
        (nodes("1,x\n"), "line 2: expected a number, found \"x\""),
        (nodes("\n-1,0\n"), "line 3: expected a node number up to 1099511627775, found \"-1,0\""),
        (nodes("0,0\n"), "line 2: expected a node number from 1, found \"0,0\""),
        (nodes("1099511627776,0\n"), "line 2: expected a node number up to 1099511627775"),
        (nodes("1 0.0 0.0\n"), "line 2: expected a comma or the end of the line, found \"0.0 0.0\""),
        (nodes("1,0,0,0,0,0,1,5\n"), "line 2: expected at most a number, three coordinates"),
        (nodes("1,<r>\n"), "line 2: the parameter in \"<r>\" is not substituted"),
        (nodes("1,0\n2,1e999\n"), "line 3: expected finite coordinates"),
        ("*NODE,SYSTEM=X\n1,0\n".into(), "line 1: expected SYSTEM=R, SYSTEM=C or SYSTEM=S, found SYSTEM=X"),
        (
            four("*ELEMENT,TYPE=S4\n1,1,2,3\n"),
            "line 7: expected 4 nodes for element 1 of type S4, found 3 before the end",
        ),
        (four("*ELEMENT,TYPE=S4\n1,1,2,3,4,5\n"), "line 7: expected at most 4 nodes of type S4, found \"5\""),
        (
            four("*ELEMENT,TYPE=S4\n1,1,2,3\n2,1,2,3\n"),
            "line 8: expected at most 4 nodes of type S4, found \"1,2,3\"",
        ),
        (
            four("*ELEMENT,TYPE=S4\n1,1,2,,4\n"),
            "line 7: expected a node number up to 1099511627775, found \",4\"",
        ),
        (four("*ELEMENT,TYPE=S4\n1,1,2,0,4\n"), "line 7: expected a node number from 1"),
        (
            four("*ELEMENT,TYPE=S4\n1,1,2,3,4\n2,1,2,3,5\n"),
            "line 8: element 2 names node 5, which the file does not define",
        ),
        (four("*ELEMENT,ELSET=E\n"), "line 6: expected the parameter TYPE=, found *ELEMENT without it"),
        (four("*NMAP\n1,4\n"), "line 6: the keyword *NMAP is not expanded"),
        (four("*ELEM,TYPE=S4\n1,1,2,3,4\n"), "line 6: the abbreviated keyword *ELEM is not read"),
        (
            four("*USER ELEMENT,TYPE=U1,NODES=9999999\n"),
            "line 6: number of nodes of an element is over the limit",
        ),
        (format!("{PART}*END PART\n"), "line 10: expected *PART before *END PART"),
        (format!("{PART}{PART}"), "line 10: expected a part name of its own, found \"Q\""),
        ("*PART,NAME=P\n*NODE\n1,0\n".into(), "line 1: expected *END PART after this line"),
        ("*PART,NAME=P\n*PART,NAME=R\n".into(), "line 2: expected *END PART"),
        (
            format!("{PART}*ASSEMBLY,NAME=A\n*INSTANCE,NAME=I,PART=R\n"),
            "line 11: expected the name of a part that is defined before, found \"R\"",
        ),
        (
            format!("{PART}*ASSEMBLY,NAME=A\n*INSTANCE,NAME=I,PART=Q\n"),
            "line 11: expected *END INSTANCE after this line",
        ),
        (format!("{PART}*ASSEMBLY,NAME=A\n"), "line 10: expected *END ASSEMBLY after this line"),
        (
            format!("{PART}*INSTANCE,NAME=I,PART=Q\n1,2,3\n1,1,1,1,1,1,9\n*END INSTANCE\n"),
            "line 10: expected points that are apart",
        ),
        (format!("{PART}*INSTANCE,NAME=I,PART=Q\n1,2,3\n1,y\n"), "line 12: expected a number, found \"y\""),
        ("*HEADING\nnothing\n*STEP\n".into(), "line 4: expected a mesh, found a deck that has no *NODE data"),
        (
            "*NODE\n** none\n*ELEMENT,TYPE=S4\n".into(),
            "line 4: expected a mesh, found a deck that has no *NODE data",
        ),
        ("*NODE\n1,0\n".into(), "line 3: expected a mesh, found a deck that has no *ELEMENT data"),
        (
            "*NODE\n1,0,0,0\n*ELEMENT,TYPE=MASS\n1,1".into(),
            "line 4: expected an end of line after the last data line",
        ),
        ("".into(), "expected a mesh, found an empty file"),
    ];
    for (text, expected) in rows {
        let found = error(&text);
        assert!(found.starts_with(expected), "{text}\nfound    {found}\nexpected {expected}");
    }
}

#[test]
fn sixteen_bit_text_is_named() {
    let wide: Vec<u8> =
        std::iter::once(0xfeff).chain("*NODE\n1,0\n".encode_utf16()).flat_map(u16::to_le_bytes).collect();
    let error = read_files(&[("deck.inp", &wide)]).expect_err("UTF-16").to_string();
    assert!(error.contains("found UTF-16"), "{error}");
}

#[test]
fn damaged_decks_give_errors_and_no_panic() {
    let torture = format!(
        "*HEADING\nx\n{PART}*PART, NAME=\"P 2\"\n*SYSTEM\n0,0,1,1,0,1\n*NODE, SYSTEM=C\n1,1,0\n2,1,90\n3,2,90\n*ELEMENT,\n TYPE=C3D20\n\
         1,1,2,3,1,2,3,1,2,3,1,2,3,1,2,3,\n1,2,3,1,2\n*USER ELEMENT,TYPE=U1,NODES=4\n*ELEMENT,TYPE=U1\n1,1,2,3,1\n*END PART\n\
         *ASSEMBLY,NAME=A\n*INSTANCE,NAME=I,PART=Q\n1,2,3\n0,0,0,0,0,1,30\n*END INSTANCE\n*INSTANCE,NAME=J,PART=\"P 2\"\n*END INSTANCE\n\
         *ELEMENT,TYPE=CONN3D2\n1,I.1,J.2\n*INCLUDE,INPUT=more.inp\n*END ASSEMBLY\n*STEP\n*NODE PRINT\nU\n"
    );
    let whole = torture.as_bytes();
    let folder = tempfile::tempdir().expect("a scratch folder");
    std::fs::write(folder.path().join("more.inp"), "*NODE\n7,1,1\n").expect("written");
    let path = folder.path().join("deck.inp");
    let attempt = |bytes: &[u8]| {
        std::fs::write(&path, bytes).expect("written");
        Abaqus.detect(bytes);
        read(&Abaqus, &path)
    };
    attempt(whole).expect("sound");
    for cut in (0..whole.len()).step_by(3) {
        let _ = attempt(&whole[..cut]);
    }
    let mut seed = 0x9e37_79b9_7f4a_7c15u64;
    let mut next = |below: usize| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as usize % below
    };
    let bytes = b"*,\n\r\"<.=-09 aE\x00\xff$";
    for _ in 0..1500 {
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
