//! Measures as users name them: by code, or a set by its name.

use crate::exit::Usage;
use crate::nearest::nearest;

/// Sets of measures that have a name. Both are the report's twelve until there are others.
const SETS: [&str; 2] = ["npl", "all"];

/// The codes of all measures, in the order of their table.
pub fn codes() -> Vec<&'static str> {
    meshgauge::measures::measures().map(|measure| measure.code).collect()
}

/// The codes that `text` selects, as the library takes them: none stands for all.
pub fn measures(text: &str) -> Result<Vec<String>, Usage> {
    if SETS.contains(&text) {
        return Ok(Vec::new());
    }
    text.split(',').map(|code| known(code.trim()).map(String::from)).collect()
}

/// The code of the measure that `name` names.
pub fn known(name: &str) -> Result<&'static str, Usage> {
    let codes = codes();
    if let Some(code) = codes.iter().find(|code| code.eq_ignore_ascii_case(name)) {
        return Ok(code);
    }
    let hint = nearest(name, codes.iter().copied()).map(|near| format!("did you mean {near}? "));
    let hint = hint.unwrap_or_default();
    let (all, sets) = (codes.join(", "), SETS.join(", "));
    Err(Usage(format!("no measure is named \"{name}\"; {hint}there are {all}, and the sets {sets}")))
}
