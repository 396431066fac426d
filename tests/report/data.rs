//! CSV, JSON, JSON lines and Markdown.

use meshgauge::summary::Summary;

use crate::plain;
use crate::samples::{mixed, tetrahedra};

const CSV_HEADER: &str = "mesh,path,format,shape,on,measure,count,max,min,min_element,mean,sd,\
                          q0.001,q0.01,q0.05,q0.5,q0.95,inverted,degenerate,verdict";

#[test]
fn csv_rows() {
    let mut summary = mixed();
    summary.mesh.name = "a \"b\", c".to_owned();
    let found = plain("csv", &[tetrahedra(), summary]);
    let lines: Vec<_> = found.lines().collect();
    assert_eq!((lines[0], lines.len()), (CSV_HEADER, 1 + 5 + 4));
    assert_eq!(
        lines[2],
        "pit-1,drop/pit-1.inp.gz,abaqus,tetrahedron,element,M31,82916,0.999,0.173,17260,0.771,0.108,\
         0.183,0.4,0.55,0.771,0.999,0,0,warn"
    );
    assert_eq!(
        lines[9],
        "\"a \"\"b\"\", c\",drop/fd-cylinder.inp.gz,abaqus,hexahedron,quadrilateral faces,M22,105840,1.0,3.2e-5,\
         1733,0.54,0.37,0.010032000000000001,0.4,0.55,0.54,1.0,1,1200,fail"
    );
}

#[test]
fn json_is_an_object_or_an_array() {
    assert_eq!(plain("json", &[mixed()]), mixed().to_json());
    let back: Vec<Summary> =
        serde_json::from_str(&plain("json", &[mixed(), tetrahedra()])).expect("an array");
    assert_eq!(back, [mixed(), tetrahedra()]);
    assert_eq!(plain("json", &[]), "[]\n");
}

#[test]
fn jsonl_is_one_object_a_line() {
    let found = plain("jsonl", &[mixed(), tetrahedra()]);
    let back: Vec<Summary> =
        found.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    assert_eq!(back, [mixed(), tetrahedra()]);
    assert_eq!(plain("jsonl", &[]), "");
}

#[test]
fn markdown_tables() {
    let found = plain("markdown", &[tetrahedra()]);
    let expected = "\
### pit-1: warn

| file | drop/pit-1.inp.gz (abaqus, gzip, 5.12 MB) |
|---|---|
| nodes | 15,989 |
";
    assert!(found.starts_with(expected), "{found}");
    assert!(found.contains("| pit-1 | M33 | 0.9997 | 0.097 | 17260 | 0.580 | 0.119 |\n"), "{found}");
}
