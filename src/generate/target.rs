//! A mesh of a wanted size: the divisions of a model grow together until there are about as many nodes or elements.

use super::{Model, Problem, Values};
use crate::error::{Error, Result};

/// The size that a mesh shall have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Number of nodes.
    Nodes(u64),
    /// Number of elements.
    Elements(u64),
}

impl Target {
    fn wanted(self) -> u64 {
        match self {
            Target::Nodes(count) | Target::Elements(count) => count,
        }
    }

    fn of(self, problem: &Problem) -> u64 {
        match self {
            Target::Nodes(_) => problem.mesh().nodes(),
            Target::Elements(_) => problem.mesh().elements(),
        }
    }
}

/// Halvings of the factor's range: finer than the steps of any whole number of divisions.
const HALVINGS: usize = 64;

/// The model's problem with the values given, its other divisions such that the mesh comes nearest to the target.
pub(super) fn nearest(model: &'static Model, values: Values, target: Target) -> Result<Problem> {
    let grows: Vec<_> = model.grows.iter().copied().filter(|name| !values.is_given(name)).collect();
    if grows.is_empty() {
        let (name, all) = (model.name, model.grows.join(", "));
        return Err(Error::usage(format!(
            "{name}: a wanted size leaves nothing to choose where {all} are set"
        )));
    }
    let grown = |factor: f64| model.set_up(values.grown(&grows, factor));
    // Counts grow with the factor, so halve its logarithm's range between the finest mesh below and the next one.
    let (mut below, mut above) = (-20.0_f64, 20.0_f64);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(below, above);
        let small = target.of(&grown(middle.exp())?) < target.wanted();
        *(if small { &mut below } else { &mut above }) = middle;
    }
    let (below, above) = (grown(below.exp())?, grown(above.exp())?);
    let far = |problem: &Problem| target.of(problem).abs_diff(target.wanted());
    Ok(if far(&below) < far(&above) { below } else { above })
}
