//! What explains a group's failures, as data. Its sentence is made here and nowhere else; nothing reads it.

use crate::thousands;
use crate::{Number, Word, by_case::is_zero, cases};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::{self, Display, Formatter};

/// Explanations beyond the first that are told as equally good.
const MOST_EQUAL: usize = 2;

/// What explains failures, worked out from a sample of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Diagnosis {
    /// The formula that it is of, where its group has others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// What is counted.
    pub counts: Counted,
    /// Those that fail.
    pub failing: u64,
    /// Of them, those that were looked at.
    pub looked_at: u64,
    /// The best first, then others. Empty where nothing explains what was looked at.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub explanations: Vec<Explanation>,
    /// What tells the first explanation from the next that is not as good.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub telling: Option<Telling>,
    /// What failing ones have in common, where nothing explains them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub in_common: Vec<String>,
    /// How many failing ones that were looked at are wrong at each output, by the outputs' names, and how many of these the first explanation
    /// accounts for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outputs: Vec<FailingOutput>,
    /// Where nothing explains whole answers: what explains each output that is wrong by itself, a colour and its alpha apart. Empty where that
    /// explains nothing either.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<PartDiagnosis>,
    /// Of the other formulas of the group that fail and were diagnosed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub others: Option<OtherFormulas>,
    /// Cases that count as failing and were not answered by values.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub unjudged: u64,
}

/// What a diagnosis counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Counted {
    /// Cases of a formula.
    #[default]
    Cases,
    /// Components of pixels of a scene.
    Components,
    /// Pixels that a blend unit left.
    Pixels,
}

/// What may have been done in the right one's place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Explanation {
    /// In words, as the end of a sentence.
    pub says: String,
    /// The mistakes that were made together, as `lightmeter mistakes` lists them. None for a wrong parameter alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mistakes: Vec<Word>,
    /// The parameter that is wrong besides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameter: Option<WrongParameter>,
    /// How many of those that were looked at it accounts for.
    pub explained: u64,
    /// In how many of them whoever makes this mistake may answer anything.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub open: u64,
    /// How good it is beside the first.
    pub standing: Standing,
}

/// A parameter that seems to be a factor times what was asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WrongParameter {
    /// Its name; several where nothing tells which of them it is.
    pub names: Vec<String>,
    /// The factor.
    pub factor: f64,
}

/// How good an explanation is beside the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Standing {
    /// It is the first.
    Best,
    /// As good: nothing tells them apart.
    Equal,
    /// Not as good, but nothing shows it in a number.
    Near,
    /// Not as good.
    Next,
}

/// A case that the first explanation accounts for and another one does not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Telling {
    /// The case, or the pixel as `x,y`.
    pub case: String,
    /// The place of the other explanation.
    pub next: usize,
    /// Of a pixel, what shows it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shown: Option<ToldApart>,
}

/// A component of a pixel by which two explanations are told apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ToldApart {
    /// The component.
    pub component: Word,
    /// What was drawn.
    pub value: Number,
    /// What the first explanation draws.
    pub first: Number,
    /// What the other draws.
    pub next: Number,
}

/// An output at which answers are wrong.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FailingOutput {
    /// Its name: of a vector, the whole one's.
    pub name: Word,
    /// How many of those that were looked at are wrong there.
    pub failing: u64,
    /// How many of these the first explanation accounts for.
    pub explained: u64,
}

/// What explains one output by itself: a colour, its alpha, a factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PartDiagnosis {
    /// The output: `color`, `color.a`.
    pub name: Word,
    /// How many of those that were looked at are wrong there.
    pub failing: u64,
    /// The best first, then others. Empty where nothing explains it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub explanations: Vec<Explanation>,
    /// What those that are wrong there have in common, where nothing explains it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub in_common: Vec<String>,
}

impl PartDiagnosis {
    /// Of an output, by the diagnosis of its numbers alone.
    #[must_use]
    pub fn new(name: String, Diagnosis { failing, explanations, in_common, .. }: Diagnosis) -> Self {
        Self { name: name.into(), failing, explanations, in_common }
    }
}

impl Display for PartDiagnosis {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { name, failing, explanations, in_common } = self;
        let failing = thousands(*failing);
        if let Some(best) = explanations.first() {
            let explained = thousands(best.explained);
            write!(f, "{explained} of {failing} wrong values of {name} are explained by: {}", best.told())?;
            let equal = explanations.iter().filter(|one| one.standing == Standing::Equal).take(MOST_EQUAL);
            equal.into_iter().try_for_each(|one| write!(f, "; or just as well by: {}", one.told()))
        } else {
            write!(f, "nothing in the catalogue explains the {failing} wrong values of {name}")?;
            if in_common.is_empty() { Ok(()) } else { write!(f, ": {}", in_common.join(", ")) }
        }
    }
}

/// Other formulas of a group that fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct OtherFormulas {
    /// Those that the same mistake explains.
    pub explained: u64,
    /// Those that were diagnosed, which fail next most often.
    pub of: u64,
}

impl Diagnosis {
    /// What the first explanation says, and its mistakes' names.
    #[must_use]
    pub fn cause(&self) -> Option<String> {
        let Some(best) = self.explanations.first() else {
            let told = |part: &PartDiagnosis| Some(format!("{}: {}", part.name, part.explanations.first()?.told()));
            let told: Vec<String> = self.parts.iter().filter_map(told).collect();
            return (!told.is_empty()).then(|| told.join(", and "));
        };
        Some(if self.counts == Counted::Pixels { self.alike() } else { best.told() })
    }

    /// The first explanation and those that are as good, in turn.
    fn alike(&self) -> String {
        let alike = self.explanations.iter().filter(|one| matches!(one.standing, Standing::Best | Standing::Equal));
        alike.map(Explanation::told).collect::<Vec<_>>().join(", or ")
    }

    /// The mistakes of the first explanation, or of the first one of each part.
    #[must_use]
    pub fn mistakes(&self) -> Vec<Word> {
        let of_parts = self.parts.iter().filter_map(|part| part.explanations.first());
        self.explanations.first().into_iter().chain(of_parts).flat_map(|best| best.mistakes.iter().cloned()).collect()
    }

    /// Whether everything that fails was looked at, and one of its explanations accounts for all of it, by some of these mistakes and nothing else.
    #[must_use]
    pub fn is_all_by(&self, mistakes: &[String]) -> bool {
        let is_one = |name: &Word| mistakes.iter().any(|known| known == &**name);
        self.explanations.iter().any(|one| {
            let is_by = !one.mistakes.is_empty() && one.mistakes.iter().all(is_one) && one.parameter.is_none();
            is_by && one.explained == self.looked_at && self.looked_at == self.failing
        })
    }

    /// That nothing explains them, and what they have in common.
    fn unexplained(&self) -> String {
        let count = thousands(self.looked_at);
        let told = match (self.counts, self.looked_at) {
            (Counted::Pixels, _) => return "no mistake in the catalogue explains what failed".into(),
            (Counted::Cases, 1) => "nothing in the catalogue explains the failing case".into(),
            (Counted::Cases, _) => format!("nothing in the catalogue explains the {count} failing cases"),
            (Counted::Components, 1) => "nothing in the catalogue explains the failing component of a pixel".into(),
            (Counted::Components, _) => {
                format!("nothing in the catalogue explains the {count} failing components of pixels")
            }
        };
        if self.in_common.is_empty() { told } else { format!("{told}: {}", self.in_common.join(", ")) }
    }

    fn explained(&self, best: &Explanation, f: &mut Formatter<'_>) -> fmt::Result {
        let [explained, looked_at, failing] = [best.explained, self.looked_at, self.failing].map(thousands);
        match self.counts {
            Counted::Pixels => write!(f, "{explained} of {looked_at} failing pixels are {}", self.alike()),
            Counted::Cases => {
                let are = if self.looked_at == 1 { "case is" } else { "cases are" };
                write!(f, "{explained} of {looked_at} failing {are} explained by: {}", best.told())
            }
            Counted::Components => {
                let of =
                    if self.looked_at == self.failing { String::new() } else { format!(" looked at, of {failing},") };
                write!(
                    f,
                    "{explained} of {looked_at} failing components of pixels{of} are explained by: {}",
                    best.told()
                )
            }
        }
    }
}

impl Explanation {
    /// What it says, and its mistakes' names.
    #[must_use]
    pub fn told(&self) -> String {
        let names = self.mistakes.join(" and ");
        if names.is_empty() { self.says.clone() } else { format!("{} ({names})", self.says) }
    }
}

impl Display for Diagnosis {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(formula) = &self.formula {
            write!(f, "{formula}: ")?;
        }
        if self.failing == 0 {
            return f.write_str("nothing fails");
        }
        if self.looked_at < self.failing && self.counts == Counted::Cases {
            let [failing, looked_at] = [self.failing, self.looked_at].map(thousands);
            write!(f, "of {failing} failing cases {looked_at} were looked at: ")?;
        }
        let of_components = self.counts == Counted::Components;
        match self.explanations.first() {
            None if !self.parts.is_empty() => {
                for (place, part) in self.parts.iter().enumerate() {
                    write!(f, "{}{part}", if place == 0 { "" } else { "; " })?;
                }
            }
            None => f.write_str(&self.unexplained())?,
            Some(best) => {
                self.explained(best, f)?;
                let equal = self.explanations.iter().filter(|one| one.standing == Standing::Equal);
                let equal = equal.take(if self.counts == Counted::Pixels { 0 } else { MOST_EQUAL });
                let as_well = if of_components { "or, which draws the same" } else { "or just as well by" };
                equal.into_iter().try_for_each(|one| write!(f, "; {as_well}: {}", one.told()))?;
                for one in self.explanations.iter().filter(|one| one.standing == Standing::Near) {
                    write!(f, "; or, which draws nearly the same: {}", one.told())?;
                }
                if best.open > 0 {
                    write!(f, "; in {} of them whoever makes this mistake may answer anything", thousands(best.open))?;
                }
            }
        }
        if let Some((telling, next)) =
            self.telling.as_ref().and_then(|telling| Some((telling, self.explanations.get(telling.next)?)))
        {
            write!(f, "; {}", telling.told(next))?;
        }
        if let Some(OtherFormulas { explained, of }) = self.others {
            match (explained, of) {
                (0, 1) => f.write_str("; it does not explain the other formula that fails")?,
                (1, 1) => f.write_str("; it also explains the other formula that fails")?,
                _ => write!(f, "; it also explains {explained} of the {of} formulas that fail next most often")?,
            }
        }
        if self.unjudged > 0 {
            write!(f, "; besides, {} were not answered by values", cases(self.unjudged))?;
        }
        Ok(())
    }
}

impl Telling {
    fn told(&self, next: &Explanation) -> String {
        match &self.shown {
            None => format!("{} tells it from the next best: {}", self.case, next.says),
            Some(ToldApart { component, value, first, next: there }) => {
                let shown = |Number(value): &Number| {
                    if value.fract() == 0.0 { format!("{value}") } else { format!("{value:.4}") }
                };
                let [value, first, there] = [value, first, there].map(shown);
                format!(
                    "the next best is: {}, but {component} of pixel {} is {value}, where the first draws {first} and the second {there}",
                    next.told(),
                    self.case
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_mistakes_excuse_what_was_looked_at_whole() {
        let explanation = |mistakes: &[&str], parameter| Explanation {
            says: "it is wrong".into(),
            mistakes: mistakes.iter().map(|&name| name.to_owned().into()).collect(),
            parameter,
            explained: 9,
            open: 0,
            standing: Standing::Best,
        };
        let known = ["half-as-bright".to_owned(), "fog-twice".to_owned()];
        let found = |explanation| Diagnosis {
            failing: 9,
            looked_at: 9,
            explanations: vec![explanation],
            ..Diagnosis::default()
        };
        let whole = found(explanation(&["half-as-bright"], None));
        assert!(whole.is_all_by(&known) && !whole.is_all_by(&known[1..]));
        // Something was not looked at, or is not explained; another mistake, or a parameter, is wrong besides.
        assert!(!Diagnosis { failing: 10, ..whole.clone() }.is_all_by(&known));
        assert!(!Diagnosis { failing: 10, looked_at: 10, ..whole }.is_all_by(&known));
        assert!(!found(explanation(&["half-as-bright", "no-ambient"], None)).is_all_by(&known));
        let parameter = WrongParameter { names: vec!["density".into()], factor: 2.0 };
        assert!(!found(explanation(&["half-as-bright"], Some(parameter))).is_all_by(&known));
        assert!(!found(explanation(&[], None)).is_all_by(&known));
    }
}
