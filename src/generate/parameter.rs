//! The parameters of a model problem and the values that users give them.

use std::fmt;

use crate::error::{Error, Result};

/// A parameter of a model problem.
#[derive(Debug)]
pub struct Parameter {
    /// The name that users type.
    pub name: &'static str,
    /// What it sets.
    pub meaning: &'static str,
    /// Its value where none is given; of a choice the place.
    pub default: f64,
    /// The values that make sense.
    pub range: Range,
}

/// The values that a parameter may have, ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// Any number from the first to the last, such as a length.
    Real(f64, f64),
    /// A whole number from the first to the last, such as a number of divisions.
    Whole(u32, u32),
    /// One of these words.
    Choice(&'static [&'static str]),
}

/// A length in any unit: from an atom's to a planet's, whatever the unit.
pub(super) const LENGTH: Range = Range::Real(1e-12, 1e12);

/// The most divisions along one side. Three such sides make 10¹⁵ elements, whose bytes still count in 64 bits.
pub(super) const MAX_DIVISIONS: u32 = 100_000;

impl Range {
    /// The value that a text stands for, if it is one of these.
    fn parse(self, text: &str) -> Option<f64> {
        match self {
            Range::Real(first, last) => text.parse().ok().filter(|value| (first..=last).contains(value)),
            Range::Whole(first, last) => text
                .parse()
                .ok()
                .filter(|value: &f64| value.fract() == 0.0)
                .filter(|value| (f64::from(first)..=f64::from(last)).contains(value)),
            Range::Choice(words) => words.iter().position(|word| *word == text).map(|place| place as f64),
        }
    }

    /// A value as it is typed.
    fn show(self, value: f64) -> String {
        match self {
            Range::Choice(words) => words[value as usize].to_owned(),
            _ => value.to_string(),
        }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Range::Real(first, last) => write!(f, "a number from {first:e} to {last:e}"),
            Range::Whole(first, last) => write!(f, "a whole number from {first} to {last}"),
            Range::Choice(words) => write!(f, "one of {}", words.join(", ")),
        }
    }
}

impl Parameter {
    /// The default as it is typed.
    pub fn default_text(&self) -> String {
        self.range.show(self.default)
    }
}

/// A value within its range for every parameter of a model.
#[derive(Debug, Clone)]
pub struct Values {
    parameters: &'static [Parameter],
    values: Vec<f64>,
    /// Whether the user has set it.
    given: Vec<bool>,
}

impl Values {
    /// The defaults, changed by `settings`, each `name=value`. `model` is named in errors.
    pub(super) fn parse<'a>(
        model: &str,
        parameters: &'static [Parameter],
        settings: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self> {
        let mut given: Vec<Option<f64>> = vec![None; parameters.len()];
        for setting in settings {
            let (name, text) = setting.split_once('=').ok_or_else(|| {
                Error::usage(format!("{model}: expected a setting as name=value, found \"{setting}\""))
            })?;
            let (name, text) = (name.trim(), text.trim());
            let place = parameters.iter().position(|p| p.name == name).ok_or_else(|| {
                let known: Vec<_> = parameters.iter().map(|p| p.name).collect();
                Error::usage(format!("{model} has no parameter \"{name}\"; it has {}", known.join(", ")))
            })?;
            let range = parameters[place].range;
            let value = range
                .parse(text)
                .ok_or_else(|| Error::usage(format!("{model}: {name} must be {range}, found \"{text}\"")))?;
            if given[place].replace(value).is_some() {
                return Err(Error::usage(format!("{model}: {name} is set twice")));
            }
        }
        let given_ones = given.iter().map(Option::is_some).collect();
        let values = parameters.iter().zip(given).map(|(p, value)| value.unwrap_or(p.default)).collect();
        Ok(Self { parameters, values, given: given_ones })
    }

    /// Whether the user has set the parameter `name`.
    pub(super) fn is_given(&self, name: &str) -> bool {
        self.given[self.place(name)]
    }

    /// The same with the whole numbers `names` multiplied by `factor`, as far as their ranges go.
    pub(super) fn grown(&self, names: &[&str], factor: f64) -> Self {
        let mut grown = self.clone();
        for name in names {
            let place = self.place(name);
            if let Range::Whole(first, last) = self.parameters[place].range {
                let value = (self.values[place] * factor).round();
                grown.values[place] = value.clamp(f64::from(first), f64::from(last));
            }
        }
        grown
    }

    fn place(&self, name: &str) -> usize {
        let place = self.parameters.iter().position(|p| p.name == name);
        place.expect("a model asks for its own parameters")
    }

    /// The value of the parameter `name`, which the model has.
    pub(super) fn real(&self, name: &str) -> f64 {
        self.values[self.place(name)]
    }

    /// The word of the parameter `name`, whose range is a choice.
    pub(super) fn choice(&self, name: &str) -> String {
        let place = self.place(name);
        self.parameters[place].range.show(self.values[place])
    }

    /// The value of the parameter `name`, whose range is of whole numbers.
    pub(super) fn whole(&self, name: &str) -> u64 {
        self.real(name) as u64
    }
}

/// ` name=value` for every parameter.
impl fmt::Display for Values {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut both = self.parameters.iter().zip(&self.values);
        both.try_for_each(|(p, &value)| write!(f, " {}={}", p.name, p.range.show(value)))
    }
}
