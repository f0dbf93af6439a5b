//! What is swept, worked out from what was asked for: every number of the row, the free one, its range, the output.

use super::preset::{Free, PRESETS, Preset};
use super::span::Span;
use super::telling::{Chosen, Swept};
use lightmeter_catalogue::cases::{Domain, Input, Kind, Spec, Stage};
use lightmeter_catalogue::nearest::did_you_mean;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::sweep::ExactFloat;
use lightmeter_scene::along::key_of;
use std::ops::Range;

/// What was asked for; what is missing is the preset's, or follows from the formula.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Asked {
    /// The free number.
    pub over: Option<String>,
    /// The least …
    pub from: Option<f32>,
    /// … and the greatest.
    pub to: Option<f32>,
    /// Inputs that are given: a number's name or an input's, with one value or as many as it has numbers.
    pub set: Vec<(String, Vec<f32>)>,
    /// The output.
    pub output: Option<String>,
    /// The stage.
    pub stage: Option<Stage>,
}

/// What is swept.
pub struct SweepPlan<'a> {
    /// The formula.
    pub member: &'a Member,
    /// Where it is evaluated.
    pub stage: Stage,
    /// Over what.
    pub over: Over,
}

/// Over what a formula is swept.
#[derive(Clone, Debug, PartialEq)]
pub enum Over {
    /// Every float of a range.
    Number {
        /// The free number's place in the row.
        free: usize,
        /// The row; the free number holds the least of the range.
        row: Vec<f32>,
        /// The least.
        from: f32,
        /// The greatest.
        to: f32,
        /// The output's place.
        output: usize,
        /// Whether the row was drawn, since the output hardly depends on the free number where the others are in the middle.
        is_drawn: bool,
    },
    /// 256 × 256 × 256 bytes through the blend unit.
    Bytes,
}

/// Why nothing can be swept, and what would be right.
#[derive(Debug, thiserror::Error)]
pub enum Refused {
    /// What was asked for is no sweep.
    #[error("{0}")]
    Wrong(String),
    /// No output that may be chosen depends on the free number, so that there is nothing to judge.
    #[error("{0}")]
    Independent(String),
}

fn refuse<T>(message: String) -> Result<T, Refused> {
    Err(Refused::Wrong(message))
}

impl<'a> SweepPlan<'a> {
    /// What is swept of a formula.
    ///
    /// # Errors
    /// Where the formula or a name is unknown, or the range has no float.
    pub fn new(catalogue: &'a [Member], formula: &str, asked: &Asked) -> Result<Self, Refused> {
        let Some(member) = catalogue.iter().find(|member| member.spec.id == formula) else {
            let meant = did_you_mean(formula, catalogue.iter().map(|member| member.spec.id.as_str()));
            return refuse(format!(
                "no formula `{formula}`{meant} `lightmeter sweep` lists ready-made sweeps, `lightmeter list --formulas` every formula"
            ));
        };
        let preset = Preset::of(formula).map(|preset| preset.free);
        let of_unit = asked.stage == Some(Stage::FixedFunction) || (asked.stage.is_none() && asked.over.is_none());
        if let Some(Free::Bytes) = preset
            && of_unit
        {
            return Self::of_unit(member, asked);
        }
        if asked.stage == Some(Stage::FixedFunction) {
            let modes = PRESETS.iter().filter(|preset| matches!(preset.free, Free::Bytes));
            let modes: Vec<&str> = modes.map(|preset| preset.formula).collect();
            return refuse(format!(
                "{formula} is not swept by the blend unit; that sweeps {}; for others expected --stage compute or fragment",
                modes.join(", ")
            ));
        }
        let is_arithmetic = match member.spec.kind {
            Kind::Arithmetic => true,
            Kind::Blend(_) => !member.spec.function.is_empty(),
            Kind::Raster(_) | Kind::Depth(_) => false,
        };
        if !is_arithmetic {
            return refuse(format!(
                "{formula} is evaluated by fixed hardware, which takes no float after the other; expected a formula of \
                 arithmetic, as fog/exp"
            ));
        }
        Ok(Self { member, stage: asked.stage.unwrap_or(Stage::Compute), over: number(member, preset, asked)? })
    }

    fn of_unit(member: &'a Member, asked: &Asked) -> Result<Self, Refused> {
        let given = [
            ("--from", asked.from.is_some()),
            ("--to", asked.to.is_some()),
            ("--set", !asked.set.is_empty()),
            ("--output", asked.output.is_some()),
            ("--over", asked.over.is_some()),
        ];
        if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
            return refuse(format!(
                "{} sweeps all 256 × 256 × 256 bytes through the blend unit, which {option} has no say in; for its \
                 arithmetic give --over {} and --stage compute",
                member.spec.id,
                names(&member.spec).join(" or ")
            ));
        }
        Ok(Self { member, stage: Stage::FixedFunction, over: Over::Bytes })
    }

    /// The inputs in blocks.
    #[must_use]
    pub fn span(&self) -> Span {
        Span::of(match self.over {
            Over::Number { from, to, .. } => u64::from(key_of(to) - key_of(from)) + 1,
            Over::Bytes => 1 << 24,
        })
    }

    /// The name of what is free.
    #[must_use]
    pub fn over_name(&self) -> String {
        match self.over {
            Over::Number { free, .. } => self.member.spec.input_name(free),
            Over::Bytes => "source, destination, alpha".into(),
        }
    }

    /// What `--set` is given so that the same row is swept again: nothing where it follows from what was asked for.
    #[must_use]
    pub fn drawn(&self) -> Vec<(String, Vec<f32>)> {
        let Over::Number { free, row, is_drawn: true, .. } = &self.over else { return vec![] };
        let spec = &self.member.spec;
        let of_input = |input: &Input| {
            let place = spec.place(input.name)?;
            let each = |k: usize| (spec.input_name(k), vec![row[k]]);
            Some(match place.contains(free) {
                true => place.filter(|k| k != free).map(each).collect::<Vec<_>>(),
                false => vec![(input.name.to_owned(), row[place].to_vec())],
            })
        };
        spec.inputs.iter().filter_map(of_input).flatten().collect()
    }

    /// The numbers that are fixed, by name.
    #[must_use]
    pub fn fixed(&self) -> Vec<(String, ExactFloat)> {
        let Over::Number { free, row, .. } = &self.over else { return vec![] };
        let fixed = row.iter().enumerate().filter(|(k, _)| k != free);
        fixed.map(|(k, &x)| (self.member.spec.input_name(k), ExactFloat(x))).collect()
    }

    /// The name of the output.
    #[must_use]
    pub fn output_name(&self) -> String {
        match self.over {
            Over::Number { output, .. } => self.member.spec.output_name(output),
            Over::Bytes => "color".into(),
        }
    }
}

/// The names of a formula's numbers.
fn names(spec: &Spec) -> Vec<String> {
    (0..spec.input_len()).map(|k| spec.input_name(k)).collect()
}

fn number(member: &Member, preset: Option<Free>, asked: &Asked) -> Result<Over, Refused> {
    let spec = &member.spec;
    let preset = preset.and_then(|free| match free {
        Free::Number { over, from, to, set, output } => Some((over, from, to, set, output)),
        Free::Bytes => None,
    });
    let names = names(spec);
    let Some(over) = asked.over.as_deref().or(preset.map(|(over, ..)| over)) else {
        return refuse(format!("{} has no ready-made sweep; expected --over with one of {}", spec.id, names.join(" ")));
    };
    let Some(free) = names.iter().position(|name| name == over) else {
        return refuse(format!("--over `{over}`: {} has no such number; expected one of {}", spec.id, names.join(" ")));
    };
    let ready = preset.filter(|(name, ..)| *name == over);
    let (from, to) = range(member, free, ready.map(|(_, from, to, ..)| (from, to)), asked)?;

    let mut row = vec![];
    spec.inputs.iter().for_each(|input| input.middle(&mut row));
    if let Some((_, _, _, set, _)) = preset {
        for (name, values) in set {
            fill(&mut row[spec.place(name).unwrap_or_default()], values);
        }
    }
    for (name, values) in &asked.set {
        fill(&mut row[set_place(spec, &names, name, values, free)?], values);
    }
    row[free] = from;

    let outputs: Vec<String> = (0..spec.output_len()).map(|k| spec.output_name(k)).collect();
    let named = asked.output.as_deref().or(ready.and(preset).map(|(.., output)| output));
    let outputs = match named {
        None => (0..outputs.len()).collect(),
        Some(named) => {
            let Some(output) = outputs.iter().position(|name| name == named) else {
                return refuse(format!(
                    "--output `{named}`: {} has no such output; expected one of {}",
                    spec.id,
                    outputs.join(" ")
                ));
            };
            vec![output]
        }
    };
    let swept = Swept { member, free, from, to, outputs, is_ready: ready.is_some() };
    let chosen = swept.choose(row, |row| {
        for (name, values) in &asked.set {
            if let Ok(place) = set_place(spec, &names, name, values, free) {
                fill(&mut row[place], values);
            }
        }
    });
    let Chosen { row, output, is_drawn } = chosen.map_err(Refused::Independent)?;
    Ok(Over::Number { free, row, from, to, output, is_drawn })
}

/// Where a number or an input that is given stands in the row.
fn set_place(spec: &Spec, names: &[String], name: &str, values: &[f32], free: usize) -> Result<Range<usize>, Refused> {
    let place = spec.place(name).or_else(|| names.iter().position(|other| other == name).map(|k| k..k + 1));
    let Some(place) = place else {
        return refuse(format!("--set `{name}`: {} has no such input; expected one of {}", spec.id, names.join(" ")));
    };
    if place.contains(&free) && place.len() == 1 {
        let over = &names[free];
        return refuse(format!("--set `{name}`: the sweep is over {over}, which --from and --to bound"));
    }
    if values.len() != 1 && values.len() != place.len() {
        let (given, expected) = (values.len(), place.len());
        return refuse(format!("--set `{name}`: {given} values; expected one or {expected}"));
    }
    Ok(place)
}

fn fill(numbers: &mut [f32], values: &[f32]) {
    for (number, value) in numbers.iter_mut().zip(values.iter().cycle()) {
        *number = *value;
    }
}

fn range(member: &Member, free: usize, ready: Option<(f32, f32)>, asked: &Asked) -> Result<(f32, f32), Refused> {
    let spec = &member.spec;
    let input = spec.inputs.iter().find(|input| spec.place(input.name).is_some_and(|place| place.contains(&free)));
    let usual = ready.or(match input.map(|input| input.domain) {
        Some(Domain::Uniform(low, high) | Domain::LogUniform(low, high) | Domain::Halves(low, high)) => {
            Some((low, high))
        }
        Some(Domain::Unit | Domain::Weights) => Some((0.0, 1.0)),
        Some(Domain::Direction) => Some((-1.0, 1.0)),
        _ => drawn_range(member, free),
    });
    let end = |given: Option<f32>, usual: Option<f32>, option: &str| {
        let end = given.or(usual);
        end.ok_or_else(|| Refused::Wrong(format!("{} has no usual range; expected {option}", spec.input_name(free))))
    };
    let from = end(asked.from, usual.map(|(from, _)| from), "--from")?;
    let to = end(asked.to, usual.map(|(_, to)| to), "--to")?;
    if from > to {
        return refuse(format!(
            "the range from {from} to {to} is the wrong way round; expected --from {to} --to {from}"
        ));
    }
    // −0 comes before 0: a range that begins or ends there has both, and one of 0 alone has 0.
    let from = if from.to_bits() == 0 && to != 0.0 { -0.0 } else { from };
    Ok(if key_of(from) > key_of(to) { (to, from) } else { (from, to) })
}

/// From where to where a number is drawn.
fn drawn_range(member: &Member, free: usize) -> Option<(f32, f32)> {
    let drawn = |k: u64| {
        let mut row = vec![];
        member.inputs(CaseRef::Random(k), 1, &mut row);
        row[free]
    };
    let all = (0..256).map(drawn).filter(|x| x.is_finite());
    let (low, high) = all.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    (low < high).then_some((low, high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::select::catalogue;

    fn refusal(formula: &str, asked: &Asked) -> String {
        SweepPlan::new(&catalogue(), formula, asked).err().map(|refused| refused.to_string()).unwrap_or_default()
    }

    #[test]
    fn every_preset_is_a_plan() {
        let catalogue = catalogue();
        for preset in PRESETS {
            let plan = SweepPlan::new(&catalogue, preset.formula, &Asked::default());
            let plan = plan.unwrap_or_else(|error| panic!("{}: {error}", preset.formula));
            if let (Free::Number { set, .. }, Over::Number { row, .. }) = (preset.free, &plan.over) {
                for (name, values) in set {
                    let place = plan.member.spec.place(name).unwrap_or_else(|| panic!("{}: {name}", preset.formula));
                    assert_eq!(&row[place], *values, "{}: {name}", preset.formula);
                }
            }
        }
    }

    #[test]
    fn both_zeros_are_in_a_range_that_begins_or_ends_there() {
        let catalogue = catalogue();
        let member = catalogue.iter().find(|member| member.spec.id == "fog/exp").expect("it is there");
        let count = |from: f32, to: f32| {
            let asked = Asked { from: Some(from), to: Some(to), ..Asked::default() };
            let (from, to) = range(member, 2, None, &asked).expect("a range");
            key_of(to) - key_of(from) + 1
        };
        assert_eq!(count(0.0, f32::from_bits(1)), 3);
        assert_eq!(count(-f32::from_bits(1), 0.0), 3);
        assert_eq!(count(0.0, 0.0), 1);
        assert_eq!(count(-0.0, -0.0), 1);
        assert_eq!(count(1.0, 1.0_f32.next_up()), 2);
    }

    #[test]
    fn what_cannot_be_swept_is_refused_with_what_can() {
        let asked = Asked::default;
        assert!(refusal("fog/exq", &asked()).contains("no formula `fog/exq`; did you mean `fog/exp`"));
        assert!(refusal("vector/reflect", &asked()).contains("expected --over with one of i.x"));
        let over = |over: &str| Asked { over: Some(over.into()), ..asked() };
        assert!(refusal("fog/exp", &over("z")).contains("expected one of p.x p.y p.z density"));
        let reversed = Asked { from: Some(2.0), to: Some(1.0), ..asked() };
        assert!(refusal("fog/exp", &reversed).contains("expected --from 1 --to 2"));
        let set = |name: &str, values: &[f32]| Asked { set: vec![(name.into(), values.into())], ..asked() };
        assert!(refusal("fog/exp", &set("p.z", &[1.0])).contains("the sweep is over p.z"));
        assert!(refusal("fog/exp", &set("haze", &[1.0])).contains("no such input"));
        assert!(refusal("fog/exp", &set("fog", &[1.0, 2.0])).contains("expected one or 3"));
        let output = Asked { output: Some("g".into()), ..asked() };
        assert!(refusal("fog/exp", &output).contains("expected one of f color.r"));
        assert!(refusal("blend/mode-alpha", &set("src", &[1.0])).contains("--set has no say"));
        let unit = Asked { stage: Some(Stage::FixedFunction), ..asked() };
        assert!(refusal("fog/exp", &unit).contains("blend/mode-solid"));
    }
}
