//! What a renderer gave to a question, read from a line.

use super::answer::Line;
use super::error::ProcessError;
use super::excludes::Excludes;
use super::hello::{DeclaredSkip, DeclaredSource, Hello};
use super::plan::unmatched;
use super::words::clipped;
use lightmeter_catalogue::cases::Spec;
use lightmeter_catalogue::cases::blend::aliases;
use lightmeter_catalogue::filter::Filter;
use lightmeter_catalogue::nearest::did_you_mean;
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::select::scene_id;
use lightmeter_catalogue::select::catalogue;
use lightmeter_catalogue::special::{Gives, PROBES, Probe};
use lightmeter_document::Number;
use lightmeter_document::by_case::{RendererUse, SourcePlace};
use lightmeter_document::report::Identity;
use lightmeter_judge::blend_unit::pixel::Units;
use lightmeter_judge::cases::{Answers, Unanswered};
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;

/// What was given to a question.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Given {
    /// A formula's outputs.
    Values(Vec<f32>),
    /// The bits of a special value.
    Word(u32),
    /// The file of a scene's image.
    Image(String),
    /// None of these: why there is no usable answer.
    Nothing(Unanswered),
}

/// What a question asks for.
#[derive(Clone, Copy)]
pub(super) enum Asks<'a> {
    /// The outputs of a formula.
    Outputs(&'a Spec),
    /// What a blend state leaves on a target: red, green, blue and alpha.
    Pixel(&'a Spec),
    /// The word that a probe of special values comes to.
    Word(&'static Probe),
    /// The image of a scene.
    Image,
}

impl Asks<'_> {
    /// The id of the formula or of the table; `None` of a scene.
    pub(super) fn group(self) -> Option<String> {
        match self {
            Self::Outputs(spec) | Self::Pixel(spec) => Some(spec.id.clone()),
            Self::Word(probe) => Some(probe.class.table()),
            Self::Image => None,
        }
    }
}

/// What a line gives to a question.
pub(super) fn given(line: Line<'_>, asks: Asks<'_>) -> Given {
    let unjudged = |message: String| Given::Nothing(Unanswered::Unjudged(message));
    let (outputs, names) = match asks {
        Asks::Outputs(spec) => (spec.output_len(), spec.outputs.iter().map(|output| output.name).collect::<Vec<_>>()),
        Asks::Pixel(_) => (4, vec!["red", "green", "blue", "alpha"]),
        Asks::Word(probe) => (1, vec![probe.what]),
        Asks::Image => (0, vec![]),
    };
    match (line, asks) {
        (Line::Skip(_, reason) | Line::SkipRows(_, _, reason), _) => {
            Given::Nothing(Unanswered::Skipped(clipped(&reason)))
        }
        (Line::Error(_, reason), _) => unjudged(clipped(&reason)),
        (Line::Image(_, file), Asks::Image) => Given::Image(file.into_owned()),
        (Line::Value(..) | Line::Hex(..), Asks::Image) => unjudged("a scene is answered by `image`".into()),
        (Line::Hex(_, digits), Asks::Word(_)) => {
            let word = digits.strip_prefix("0x").filter(|digits| !digits.starts_with('+'));
            word.and_then(|digits| u32::from_str_radix(digits, 16).ok()).map_or_else(
                || unjudged(format!("`hex` is `{}`; expected such as \"0x7fc00000\"", clipped(&digits))),
                Given::Word,
            )
        }
        (Line::Value(_, values), Asks::Word(probe)) if values.len() == 1 => {
            word_of(probe.gives, values[0]).map_or_else(unjudged, Given::Word)
        }
        #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is what is asked for")]
        (Line::Value(_, values), _) if values.len() == outputs => {
            Given::Values(values.into_iter().map(|x| x as f32).collect())
        }
        (Line::Value(_, values), _) => {
            unjudged(format!("{} numbers; expected {outputs}: {}", values.len(), names.join(", ")))
        }
        (Line::Hex(..), _) => unjudged("only a special value is answered by `hex`".into()),
        (Line::Image(..), _) => unjudged("a formula is answered by `value`".into()),
        (Line::Hello(_), _) => unjudged("a `hello` line was sent where an answer was expected".into()),
    }
}

/// The cases that a renderer may skip: those that its hello declares, and those that are known of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Skips(Vec<Filter>);

impl Skips {
    /// Those that a hello declares.
    pub(super) fn of(hello: &Hello) -> Result<Self, ProcessError> {
        let read = |skip: &DeclaredSkip| {
            let filter = Filter::new(std::slice::from_ref(&skip.id))?;
            match refused(&filter, &skip.reason) {
                Some(why) => Err(ProcessError::Skip { id: clipped(&skip.id), why }),
                None => Ok(filter),
            }
        };
        let skips = hello.skips.iter().map(read).collect::<Result<_, _>>()?;
        match unmatched(hello.skips.iter().map(|skip| skip.id.as_str())) {
            Some(id) => {
                Err(ProcessError::Skip { id: clipped(id), why: "matches no case: see `lightmeter list`".into() })
            }
            None => Ok(Self(skips)),
        }
    }

    /// Adds those that are known.
    pub(super) fn extend(&mut self, known: impl IntoIterator<Item = Filter>) {
        self.0.extend(known);
    }

    /// What was given to a case: a skip that nobody declared is told apart.
    pub(super) fn settled(&self, id: &str, given: Given) -> Given {
        match given {
            Given::Nothing(Unanswered::Skipped(reason)) => Given::Nothing(self.skipped(id, reason)),
            other => other,
        }
    }

    /// A skip of a case, which was declared or not.
    pub(super) fn skipped(&self, id: &str, reason: String) -> Unanswered {
        let is_declared = self.0.iter().any(|filter| filter.selects(id));
        if is_declared { Unanswered::Skipped(reason) } else { Unanswered::Undeclared(reason) }
    }
}

/// Why something may not be left out; `None` where it may.
pub(super) fn refused(filter: &Filter, reason: &str) -> Option<String> {
    if is_everything(&[filter]) {
        return Some("matches everything; expected the formulas or cases that are meant".into());
    }
    reason.trim().is_empty().then(|| "has no reason".into())
}

/// Whether filters select everything together: a formula or scene of each kind.
pub(super) fn is_everything(filters: &[&Filter]) -> bool {
    let of_each_kind = ["color/sum", "vector/reflect", "lighting/phong", "fog/exp", "blend/max", "scene/phong"];
    of_each_kind.iter().all(|id| filters.iter().any(|filter| filter.selects(id)))
}

/// The bits of a result of this type that is given as a number: of a float the nearest f32, else an integer of 32 bits, which may have a
/// sign.
fn word_of(gives: Gives, x: f64) -> Result<u32, String> {
    const WORDS: std::ops::Range<f64> = -2_147_483_648.0..4_294_967_296.0;
    if gives == Gives::Float {
        #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is what is asked for")]
        return Ok((x as f32).to_bits());
    }
    #[expect(clippy::float_cmp, reason = "an integer is its own whole part")]
    if !WORDS.contains(&x) || x.trunc() != x {
        return Err(format!("{}; expected an integer of 32 bits, or 0 or 1 for whether it holds", Number(x)));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the low 32 bits of an integer")]
    Ok((x as i64) as u32)
}

/// The word that was given to a probe.
pub(super) fn word(given: Given) -> Result<u32, Unanswered> {
    match given {
        Given::Word(bits) => Ok(bits),
        Given::Nothing(why) => Err(why),
        Given::Values(_) | Given::Image(_) => unreachable!("a special value is answered by a word"),
    }
}

/// Stores what was given to the row at a place in the answers. A row has `outputs` numbers.
pub(super) fn put(answers: &mut Answers, outputs: usize, place: usize, given: Given) {
    let words = &mut answers.words[place * outputs..(place + 1) * outputs];
    match given {
        Given::Values(values) => words.iter_mut().zip(values).for_each(|(word, value)| *word = value.to_bits()),
        Given::Nothing(why) => drop(answers.unanswered.insert(place, why)),
        Given::Word(_) | Given::Image(_) => unreachable!("a formula is answered by values"),
    }
}

/// The pixel that was given, in the target's units.
pub(super) fn pixel(given: Given) -> Result<Units, Unanswered> {
    match given {
        Given::Values(values) => Ok(std::array::from_fn(|k| values.get(k).copied().map_or(f64::NAN, f64::from))),
        Given::Nothing(why) => Err(why),
        Given::Word(_) | Given::Image(_) => unreachable!("a pixel is answered by values"),
    }
}

/// Who answers, and what its hello declares.
pub(super) struct Declared {
    pub(super) hello: Hello,
    formulas: Option<Filter>,
    scenes: Option<Filter>,
    excludes: Excludes,
    pub(super) skips: Skips,
    pub(super) targets: Vec<TargetFormat>,
    /// Where its code stands, by filters.
    sources: Vec<(Filter, SourcePlace)>,
}

/// A name that is misspelt would leave out what it was to declare, and nobody would see it.
fn matches_something(hello: &Hello) -> Result<(), ProcessError> {
    let has_none = hello.formulas.is_empty() && hello.scenes.is_empty();
    if has_none && hello.excludes.is_empty() && hello.sources.is_empty() {
        return Ok(());
    }
    let members = catalogue();
    let formulas: Vec<String> = members
        .iter()
        .map(|member| member.spec.id.clone())
        .chain(aliases().map(|(alias, _)| alias))
        .chain(PROBES.iter().map(Probe::id))
        .collect();
    let scenes: Vec<String> = (0..SCENES.len()).map(scene_id).collect();
    let both: Vec<String> = formulas.iter().chain(&scenes).cloned().collect();
    for (what, globs, ids) in [
        ("formula", &hello.formulas, &formulas),
        ("scene", &hello.scenes, &scenes),
        ("formula or scene", &Excludes::globs(&hello.excludes).cloned().collect(), &both),
        ("formula or scene", &hello.sources.iter().map(|source| source.id.clone()).collect(), &both),
    ] {
        for glob in globs {
            let filter = Filter::new(std::slice::from_ref(glob))?;
            if !ids.iter().any(|id| filter.selects(id)) {
                let meant = did_you_mean(glob, ids.iter().map(String::as_str));
                return Err(ProcessError::Unmatched { glob: clipped(glob), what, meant });
            }
        }
    }
    Ok(())
}

/// An entry of a hello's `sources`.
fn source(declared: &DeclaredSource) -> Result<(Filter, SourcePlace), ProcessError> {
    let DeclaredSource { id, file, line } = declared;
    let wrong = |why: &'static str| ProcessError::Source { id: clipped(id), why };
    if file.trim().is_empty() {
        return Err(wrong("`file` is empty; expected such as \"src/fog.glsl\""));
    }
    if *line == Some(0) {
        return Err(wrong("`line` is 0; expected 1 or more"));
    }
    Ok((Filter::new(std::slice::from_ref(id))?, SourcePlace { file: clipped(file), line: *line }))
}

impl Declared {
    /// Reads what a hello declares.
    pub(super) fn new(hello: Hello) -> Result<Self, ProcessError> {
        let [formulas, scenes] = hello.filters()?;
        let excludes = Excludes::new(&hello.excludes)?;
        matches_something(&hello)?;
        let format = |name: &String| TargetFormat::by_name(name).ok_or_else(|| ProcessError::Target(name.clone()));
        let mut targets = hello.targets.iter().map(format).collect::<Result<Vec<_>, _>>()?;
        targets.retain(|&target| !excludes.has_format(target));
        let skips = Skips::of(&hello)?;
        let sources = hello.sources.iter().map(source).collect::<Result<_, _>>()?;
        Ok(Self { hello, formulas, scenes, excludes, skips, targets, sources })
    }

    /// Where its code of a formula or a scene stands: as the first entry says that selects it.
    pub(super) fn source(&self, id: &str) -> Option<SourcePlace> {
        self.sources.iter().find(|(filter, _)| filter.selects(id)).map(|(_, place)| place.clone())
    }

    /// Why a formula or a scene is not asked; `None` where it is.
    pub(super) fn lacks(&self, id: &str) -> Option<String> {
        let (declared, what) =
            if id.starts_with("scene/") { (&self.scenes, "scenes") } else { (&self.formulas, "formulas") };
        let has = declared.as_ref().is_some_and(|filter| filter.selects(id));
        match self.excludes.has(id) {
            _ if !has => Some(format!("not among the {what} that it declares")),
            true => Some("it excludes it".into()),
            false => None,
        }
    }

    /// How it is named in reports.
    pub(super) fn identity(&self) -> Identity {
        (&self.hello.identity()).into()
    }

    /// What a report says of it, where nothing went wrong.
    pub(super) fn used(&self) -> RendererUse {
        RendererUse { identity: self.hello.identity(), declares: self.hello.declares(), ..RendererUse::default() }
    }

    /// Why a frame is not asked for; `None` where it is.
    pub(super) fn lacks_frame(&self, frame: &Frame) -> Option<String> {
        self.hello.lacks(frame).or_else(|| self.excludes.of_frame(frame))
    }
}

#[cfg(test)]
mod tests {
    use super::super::answer::read;
    use super::*;

    /// What an answer gives to a probe.
    fn of(probe: &str, answer: &str) -> Given {
        let line = format!(r#"{{"id": "a", {answer}}}"#);
        let probe = Probe::by_name(probe).expect("the tables have it");
        given(read(line.as_bytes()).expect("it can be read"), Asks::Word(probe))
    }

    #[test]
    fn special_values_are_read_bit_for_bit() {
        for (probe, answer, word) in [
            ("zero-over-zero", r#""value": ["NaN"]"#, 0x7fc0_0000),
            ("zero-over-zero", r#""hex": "0xffc00001""#, 0xffc0_0001),
            ("keep-minus-zero", r#""value": [-0.0]"#, 0x8000_0000),
            ("keep-subnormal", r#""value": [1e-40]"#, 1e-40_f32.to_bits()),
            ("round-half", r#""hex": "0x1""#, 1),
            ("too-large-to-u32", r#""value": [4294967295]"#, u32::MAX),
            ("too-large-to-u32", r#""value": [4294967040.0]"#, 0xffff_ff00),
            ("too-small-to-i32", r#""value": [-2147483648]"#, 0x8000_0000),
            ("number-by-its-bits", r#""value": [1]"#, 1),
        ] {
            assert_eq!(of(probe, answer), Given::Word(word), "{probe}: {answer}");
        }
    }

    #[test]
    fn what_is_no_word_is_not_judged_and_said() {
        for (answer, said) in [
            (r#""value": [4294967296]"#, "expected an integer of 32 bits"),
            (r#""value": [-2147483649]"#, "expected an integer of 32 bits"),
            (r#""value": [0.5]"#, "0.5; expected an integer"),
            (r#""value": ["NaN"]"#, "NaN; expected an integer"),
            (r#""value": [1, 2]"#, "2 numbers; expected 1: u32(1e20)"),
            (r#""value": []"#, "0 numbers; expected 1"),
            (r#""hex": "7fc00000""#, "expected such as \"0x7fc00000\""),
            (r#""hex": "0x""#, "expected such as"),
            (r#""hex": "0x+1""#, "expected such as"),
            (r#""hex": "0x1ffffffff""#, "expected such as"),
            (r#""image": "a.png""#, "answered by `value`"),
            (r#""error": "no unit""#, "no unit"),
        ] {
            let Given::Nothing(Unanswered::Unjudged(why)) = of("too-large-to-u32", answer) else { panic!("{answer}") };
            assert!(why.contains(said), "{answer}: {why}");
        }
        let hex = read(br#"{"id": "a", "hex": "0x1"}"#).expect("it can be read");
        assert!(matches!(given(hex, Asks::Image), Given::Nothing(Unanswered::Unjudged(_))));
    }
}
