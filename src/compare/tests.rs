//! What must be called worse, what better, and what must not.

use serde_json::json;

use super::*;
use crate::summary::{Checks, Expected, Range, Verdict};

/// A mesh of tetrahedra whose M31 has these values.
fn mesh(values: &[f64]) -> Summary {
    let count = values.len() as u64;
    let min = values.iter().copied().fold(1.0, f64::min);
    let mean = values.iter().sum::<f64>() / count as f64;
    let mut histogram = vec![0_u64; 100];
    for value in values {
        histogram[((value * 100.0) as usize).min(99)] += 1;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let quantile = |p: f64| sorted[((p * count as f64) as usize).min(sorted.len() - 1)];
    let min_element = values.iter().position(|value| *value == min).map(|i| i + 1);
    let summary = json!({
        "schema": crate::summary::SCHEMA,
        "mesh": {"name": "pit", "path": "pit.inp", "format": "abaqus", "compression": null, "bytes": 1, "xxh3": "0"},
        "nodes": {"count": count / 5, "unused": 0, "bounds": null},
        "elements": {"count": count, "by_type": {"C3D4": count}, "not_measured": {}},
        "shapes": {"tetrahedron": {
            "count": count, "order": {"1": count}, "volume": 810.0, "inverted": 0, "degenerate": 0,
            "measures": {"M31": {
                "on": "element", "count": count, "max": 1.0, "min": min, "min_element": min_element, "mean": mean,
                "sd": 0.1, "quantiles": {"0.001": quantile(0.001), "0.05": quantile(0.05), "0.5": quantile(0.5)},
                "histogram": histogram,
            }},
            "correlation": {},
        }},
        "totals": {"area": null, "volume": 810.0},
        "sizes": {"edge_length": {"min": 0.1, "max": 1.0}, "element_size": null},
        "checks": Checks::default(),
        "expected": null,
        "verdict": {"status": "pass", "reasons": []},
    });
    serde_json::from_value(summary).expect("a summary")
}

/// Values from 0.3 to 0.9.
fn sound(count: usize) -> Vec<f64> {
    (0..count).map(|i| 0.3 + 0.6 * (i as f64 / count as f64)).collect()
}

/// Statistics of one outcome.
fn those(outcome: Outcome, base: &Summary, new: &Summary) -> Vec<String> {
    let found = compare("pit", base, new, &Tolerances::default());
    found.findings_that_are(outcome).map(|finding| finding.statistic.to_string()).collect()
}

#[test]
fn a_mesh_is_the_same_as_itself() {
    let found = compare("pit", &mesh(&sound(5000)), &mesh(&sound(5000)), &Tolerances::default());
    assert_eq!(found.outcome, Outcome::Same);
    assert!(found.findings.iter().all(|finding| finding.outcome == Outcome::Same));
    assert!(found.findings.len() > 20, "{}", found.findings.len());
}

#[test]
fn one_new_sliver_is_worse_however_large_the_mesh() {
    for count in [100, 5000, 500_000] {
        let mut values = sound(count);
        values[count / 2] = 0.02;
        let (base, new) = (mesh(&sound(count)), mesh(&values));
        let worse = those(Outcome::Worse, &base, &new);
        assert!(
            worse.contains(&"min".to_owned()) && worse.contains(&"share under 0.1".to_owned()),
            "{worse:?}"
        );
        let found = compare("pit", &base, &new, &Tolerances::default());
        let minimum = found.findings_that_are(Outcome::Worse).find(|finding| finding.statistic == "min");
        assert_eq!(minimum.and_then(|finding| finding.element), Some(count as u64 / 2 + 1));
        assert!(those(Outcome::Better, &new, &base).contains(&"share under 0.1".to_owned()));
    }
}

#[test]
fn a_second_sliver_no_worse_than_the_first_is_worse() {
    let mut one = sound(5000);
    one[0] = 0.02;
    let mut two = one.clone();
    two[1] = 0.03;
    assert_eq!(those(Outcome::Worse, &mesh(&one), &mesh(&two)), ["share under 0.1"]);
    assert_eq!(those(Outcome::Better, &mesh(&two), &mesh(&one)), ["share under 0.1"]);
}

#[test]
fn jitter_across_a_limit_is_neither() {
    let with = |low: f64| mesh(&[sound(5000), vec![low]].concat());
    for (base, new) in [(0.101, 0.099), (0.099, 0.101), (0.25, 0.22), (0.22, 0.25)] {
        let found = compare("pit", &with(base), &with(new), &Tolerances::default());
        assert_eq!(found.outcome, Outcome::Same, "{base} {new}");
    }
}

#[test]
fn a_finer_mesh_may_have_as_many_low_values_as_it_has_elements() {
    let low = |count: usize, low: usize| mesh(&[sound(count), vec![0.02; low]].concat());
    let rows = [
        (low(5000, 4), low(20_000, 16), Outcome::Same),
        (low(5000, 4), low(20_000, 40), Outcome::Worse),
        (low(20_000, 4), low(5000, 4), Outcome::Same),
        (low(20_000, 16), low(5000, 4), Outcome::Same),
    ];
    for (base, new, outcome) in rows {
        let found = compare("pit", &base, &new, &Tolerances::default());
        let share = found.findings.iter().find(|finding| finding.statistic == "share under 0.1");
        assert_eq!(share.map(|finding| finding.outcome), Some(outcome));
        assert!(found.findings_that_are(Outcome::Changed).any(|finding| finding.statistic == "elements"));
    }
}

#[test]
fn a_distribution_that_slid_is_told_by_direction() {
    let lower: Vec<f64> = sound(5000).iter().map(|value| value - 0.07).collect();
    let (base, new) = (mesh(&sound(5000)), mesh(&lower));
    let worse = those(Outcome::Worse, &base, &new);
    for statistic in ["mean", "quantile 0.5", "wasserstein-1"] {
        assert!(worse.contains(&statistic.to_owned()), "{statistic}: {worse:?}");
        assert!(those(Outcome::Better, &new, &base).contains(&statistic.to_owned()), "{statistic}");
    }
    let found = compare("pit", &base, &new, &Tolerances::default());
    let distance = found.findings.iter().find(|finding| finding.statistic == "wasserstein-1");
    let distance = distance.and_then(|finding| finding.new).expect("a distance");
    assert!((distance - 0.07).abs() < 1e-3, "{distance}");
}

#[test]
fn the_mesh_as_a_whole() {
    type Change = fn(&mut Summary);
    let rows: [(&str, Outcome, Change); 10] = [
        ("volume", Outcome::Worse, |new| new.totals.volume = Some(800.0)),
        ("volume", Outcome::Worse, |new| new.totals.volume = None),
        ("volume", Outcome::Same, |new| new.totals.volume = Some(810.5)),
        ("inverted elements", Outcome::Worse, |new| new.checks.inverted = 1),
        ("unused nodes", Outcome::Changed, |new| new.checks.unused_nodes = 3),
        ("verdict fails", Outcome::Worse, |new| {
            new.verdict = Verdict { status: Status::Fail, reasons: vec![] };
        }),
        ("verdict fails", Outcome::Same, |new| {
            new.verdict = Verdict { status: Status::Warn, reasons: vec![] };
        }),
        ("elements measured", Outcome::Worse, |new| new.shapes.clear()),
        ("nodes", Outcome::Changed, |new| new.nodes.count *= 2),
        ("shortest edge", Outcome::Changed, |new| {
            new.sizes.edge_length = new.sizes.edge_length.map(|range| Range { min: 0.01, ..range });
        }),
    ];
    for (statistic, outcome, change) in rows {
        let base = mesh(&sound(1000));
        let mut new = base.clone();
        change(&mut new);
        let found = compare("pit", &base, &new, &Tolerances::default());
        let finding = found.findings.iter().find(|finding| finding.statistic == statistic);
        assert_eq!(finding.map(|finding| finding.outcome), Some(outcome), "{statistic}");
    }
}

#[test]
fn an_expected_volume_goes_before_the_one_of_the_base() {
    let with = |volume: f64| {
        let mut summary = mesh(&sound(1000));
        summary.totals.volume = Some(volume);
        let relative_error = volume / 810.0 - 1.0;
        summary.expected = Some(Expected { volume: Some(810.0), area: None, relative_error, within: true });
        summary
    };
    assert_eq!(those(Outcome::Better, &with(780.0), &with(809.0)), ["error against what is expected"]);
    assert_eq!(those(Outcome::Worse, &with(809.0), &with(780.0)), ["error against what is expected"]);
    assert_eq!(compare("pit", &with(808.0), &with(812.0), &Tolerances::default()).outcome, Outcome::Same);
}

#[test]
fn sets_are_paired_by_name() {
    let set = |names: &[&str]| names.iter().map(|name| ((*name).to_owned(), mesh(&sound(100)))).collect();
    let tolerances = Tolerances::default();
    let found = compare_sets(&set(&["a", "b"]), &set(&["b", "c"]), &tolerances);
    assert_eq!((found.gone, found.added, found.meshes.len()), (vec!["a".into()], vec!["c".into()], 1));
    assert_eq!(found.outcome, Outcome::Worse);
    assert_eq!(compare_sets(&set(&["a"]), &set(&["a", "b"]), &tolerances).outcome, Outcome::Changed);
    assert_eq!(compare_sets(&set(&["a"]), &set(&["a"]), &tolerances).outcome, Outcome::Same);
}

#[test]
fn the_worst_mesh_stands_first() {
    let base = [("a", sound(100)), ("b", sound(100)), ("c", sound(100))];
    let set = |values: [Vec<f64>; 3]| {
        base.iter().zip(values).map(|((name, _), values)| ((*name).to_owned(), mesh(&values))).collect()
    };
    let low = [vec![0.01], sound(99)].concat();
    let found = compare_sets(
        &set([sound(100), sound(100), low.clone()]),
        &set([sound(100), low, sound(100)]),
        &Tolerances::default(),
    );
    let order: Vec<_> = found.meshes.iter().map(|mesh| (mesh.name.as_str(), mesh.outcome)).collect();
    assert_eq!(order, [("b", Outcome::Worse), ("c", Outcome::Better), ("a", Outcome::Same)]);
}

#[test]
fn a_comparison_reads_back() {
    let found = compare("pit", &mesh(&sound(100)), &mesh(&sound(50)), &Tolerances::default());
    let found = Comparisons::new(vec![found], vec![], vec![]);
    let json = serde_json::to_string(&found).expect("finite numbers");
    assert_eq!(serde_json::from_str::<Comparisons>(&json).expect("its own schema"), found);
}

#[test]
fn histograms_of_another_make_have_no_distance_but_no_panic() {
    let base = mesh(&sound(100));
    let mut new = base.clone();
    for measure in new.shapes.values_mut().flat_map(|shape| shape.measures.values_mut()) {
        measure.histogram = vec![1, 2, 3];
        measure.count = 0;
    }
    let found = compare("pit", &base, &new, &Tolerances::default());
    assert!(found.findings.iter().all(|finding| finding.statistic != "wasserstein-1"));
}
