//! What a mesh is judged by: rules as rows, and sets of them that have a name.

use std::borrow::Cow;

use super::Status;
use crate::mesh::Shape;

/// A rule: it is broken where a statistic of a measure is on the wrong side of a limit.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Its name, as it stands in a reason: that of its preset, `fail under`, or one of the user's own.
    pub name: Cow<'static, str>,
    /// What it looks at.
    pub subject: Subject,
    /// The shape; all that have the measure where there is none.
    pub shape: Option<Shape>,
    /// What of the measure is held against the limit.
    pub statistic: Statistic,
    /// The limit: a value of the measure, or for [`Statistic::Count`] a number of findings.
    pub limit: f64,
    /// How bad it is to break it.
    pub status: Status,
}

/// What a rule looks at.
#[derive(Debug, Clone, PartialEq)]
pub enum Subject {
    /// Every measure of the report.
    AllMeasures,
    /// The measure of this code.
    Measure(Cow<'static, str>),
    /// The check of this name, as the summary has it.
    Check(Cow<'static, str>),
}

/// What is held against the limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Statistic {
    /// The smallest value is under the limit.
    Min,
    /// The largest value is under the limit.
    Max,
    /// The mean is under the limit.
    Mean,
    /// The quantile of this probability, in (0, 1), is under the limit.
    Quantile(f64),
    /// More than this share of the values, in \[0, 1), is under the limit. Counted exactly.
    ShareBelow(f64),
    /// More than so many values are under the limit. Counted exactly.
    CountBelow(u64),
    /// A check has more findings than the limit.
    Count,
}

/// The names of the statistics, as users write them.
pub const STATISTICS: [&str; 7] = ["min", "max", "mean", "quantile", "share below", "count below", "count"];

impl Statistic {
    /// The name, one of [`STATISTICS`].
    pub const fn name(self) -> &'static str {
        match self {
            Statistic::Min => "min",
            Statistic::Max => "max",
            Statistic::Mean => "mean",
            Statistic::Quantile(_) => "quantile",
            Statistic::ShareBelow(_) => "share below",
            Statistic::CountBelow(_) => "count below",
            Statistic::Count => "count",
        }
    }

    /// The name with its probability, where it has one; nothing for the minimum, which most rules are about.
    pub(super) fn described(self) -> Option<Cow<'static, str>> {
        match self {
            Statistic::Min => None,
            Statistic::Quantile(probability) => Some(format!("quantile {probability}").into()),
            _ => Some(self.name().into()),
        }
    }
}

impl Rule {
    /// Fails where the minimum of a measure is under a limit.
    pub fn fail_under(measure: impl Into<Cow<'static, str>>, limit: f64) -> Self {
        Self {
            name: Cow::Borrowed(super::rules::FAIL_UNDER),
            subject: Subject::Measure(measure.into()),
            shape: None,
            statistic: Statistic::Min,
            limit,
            status: Status::Fail,
        }
    }

    /// Whether the rule is about this measure on this shape.
    pub fn is_about(&self, measure: &str, shape: Shape) -> bool {
        let measured = match &self.subject {
            Subject::AllMeasures => true,
            Subject::Measure(code) => code == measure,
            Subject::Check(_) => false,
        };
        measured && self.shape.is_none_or(|its| its == shape)
    }
}

/// Rules that have a name.
#[derive(Debug)]
pub struct Preset {
    /// The name that users choose it by, and that its reasons carry.
    pub name: &'static str,
    /// What it holds, in one line.
    pub title: &'static str,
    /// Who says so.
    pub source: &'static str,
    /// Its rules.
    pub rules: &'static [Rule],
}

/// Under this a measure is 'bad enough to warrant further investigation'; over [`GOOD`] it is good.
pub const INVESTIGATE: f64 = 0.1;
/// Over this the report calls an element good enough to be accepted.
pub const GOOD: f64 = 0.9;

const fn minimum(
    preset: &'static str,
    subject: Subject,
    shape: Option<Shape>,
    limit: f64,
    status: Status,
) -> Rule {
    Rule { name: Cow::Borrowed(preset), subject, shape, statistic: Statistic::Min, limit, status }
}

const fn measure(code: &'static str) -> Subject {
    Subject::Measure(Cow::Borrowed(code))
}

/// Every preset; the first holds unless another is chosen.
pub static PRESETS: &[Preset] = &[
    Preset {
        name: super::rules::NPL,
        title: "warns where the minimum of a measure is under 0.1, which warrants a look; over 0.9 is good",
        source: "L. Wright, Testing Automatic Mesh Generation Software, NPL 2007, section 3.3",
        rules: &[minimum(super::rules::NPL, Subject::AllMeasures, None, INVESTIGATE, Status::Warn)],
    },
    Preset {
        name: "comsol",
        title: "warns where M13 of a triangle is under 0.3 or M31 under 0.1; above, accuracy does not suffer",
        source: "Comsol Multiphysics manual, as the NPL report cites it",
        rules: &[
            minimum("comsol", measure("M13"), Some(Shape::Triangle), 0.3, Status::Warn),
            minimum("comsol", measure("M31"), None, 0.1, Status::Warn),
        ],
    },
    Preset {
        name: "aspect",
        title: "warns where M22 is under 0.2, fails under 0.07",
        source: "NPL report, section 5.3: where packages warn and report an error",
        rules: &[
            minimum("aspect", measure("M22"), None, 0.07, Status::Fail),
            minimum("aspect", measure("M22"), None, 0.2, Status::Warn),
        ],
    },
    Preset {
        name: "none",
        title: "no rules but the user's own; inverted and degenerate elements still fail",
        source: "meshgauge",
        rules: &[],
    },
];

/// The preset of that name.
pub fn preset(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}
