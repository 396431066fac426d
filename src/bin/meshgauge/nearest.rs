//! "Did you mean": the known name that a mistyped one is nearest to.

use std::cmp::Reverse;

/// The name with the fewest edits (insert, delete, replace, swap of neighbours; upper or lower case is free), if that is
/// near enough to be what was meant. Of several it is the one that begins alike for longest.
pub fn nearest<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let near_enough = 1 + typed.chars().count() / 3;
    let typed = typed.to_lowercase();
    let rate = |name: &str| {
        let name = name.to_lowercase();
        let alike = typed.chars().zip(name.chars()).take_while(|(a, b)| a == b).count();
        (distance(&typed, &name), Reverse(alike))
    };
    known
        .into_iter()
        .map(|name| (rate(name), name))
        .filter(|((edits, _), _)| *edits <= near_enough)
        .min_by_key(|(rating, _)| *rating)
        .map(|(_, name)| name)
}

/// Number of edits between two words (optimal string alignment).
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for (i, row) in rows.iter_mut().enumerate() {
        row[0] = i;
    }
    for (j, cell) in rows[0].iter_mut().enumerate() {
        *cell = j;
    }
    for i in 1..=a.len() {
        for j in 1..=b.len() {
            let replace = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replace.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = best;
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_finds_what_was_meant() {
        let known = ["settle", "scan", "symlinks", "M31"];
        assert_eq!(nearest("setle", known), Some("settle"));
        assert_eq!(nearest("scna", known), Some("scan"));
        assert_eq!(nearest("m31", known), Some("M31"));
        assert_eq!(nearest("M3", ["M13", "M31"]), Some("M31"));
    }

    #[test]
    fn what_is_far_from_all_finds_nothing() {
        assert_eq!(nearest("colour", ["settle", "scan"]), None);
    }
}
