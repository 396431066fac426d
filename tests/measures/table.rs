//! The table of measures: complete, in order, and each row with golden data.

use std::collections::HashSet;

use meshgauge::measures::{Family, MOST_MEASURES, Measure, find, measures, subjects};
use meshgauge::mesh::Shape;

use super::golden;

#[test]
fn there_are_twelve_measures_in_code_order() {
    let codes: Vec<_> = measures().map(|measure| measure.code).collect();
    let expected = ["M11", "M12", "M13", "M14", "M15", "M21", "M22", "M23", "M31", "M32", "M33", "M34"];
    assert_eq!(codes, expected);
    assert_eq!(codes.iter().collect::<HashSet<_>>().len(), codes.len());
    let most = Family::ALL.into_iter().map(|family| family.measures().len()).max();
    assert_eq!(most, Some(MOST_MEASURES));
}

#[test]
fn each_row_is_whole_and_found_by_its_code() {
    for measure in measures() {
        assert!(std::ptr::eq(find(measure.code).expect("a row"), measure));
        assert!(std::ptr::eq(&measure.family.measures()[measure.index()], measure));
        for text in [measure.title, measure.definition, measure.watches, measure.source] {
            assert!(!text.is_empty() && text.trim() == text, "{}: {text:?}", measure.code);
        }
        for threshold in measure.thresholds {
            let [low, high] = Measure::RANGE;
            assert!((low..=high).contains(&threshold.value), "{}: {threshold:?}", measure.code);
        }
    }
    assert!(find("M16").is_none() && find("m11").is_none());
}

#[test]
fn each_row_has_golden_values_over_its_range() {
    for measure in measures() {
        let values: Vec<_> = golden::rows().filter_map(|row| row.try_value(measure.code)).collect();
        assert!(values.len() >= 100, "{}: {} golden values", measure.code, values.len());
        assert!(values.iter().all(|value| (0.0..=1.0).contains(value)), "{}", measure.code);
        assert!(values.contains(&0.0), "{}: none is degenerate", measure.code);
        assert!(values.iter().any(|&value| value > 0.9), "{}: none is good", measure.code);
    }
}

#[test]
fn every_shape_is_measured_as_an_element_or_on_all_its_faces() {
    for shape in Shape::ALL {
        let subjects = subjects(shape);
        assert!(!subjects.is_empty(), "{shape}");
        let facts = shape.facts();
        let on = |name| subjects.iter().any(|subject| subject.on == name);
        if shape.dimension() == 2 || shape == Shape::Tetrahedron {
            assert!(on("element") && subjects.len() == 1, "{shape}");
            assert_eq!(subjects[0].family.name(), shape.name());
        } else {
            assert_eq!(on("triangular faces"), !facts.triangles.is_empty(), "{shape}");
            assert_eq!(on("quadrilateral faces"), !facts.quadrilaterals.is_empty(), "{shape}");
        }
    }
}
