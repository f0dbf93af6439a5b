//! What a renderer gave to a question, read from a line.

use super::answer::{Hello, Line, clipped};
use super::error::ProcessError;
use lightmeter_catalogue::cases::Spec;
use lightmeter_catalogue::filter::Filter;
use lightmeter_document::by_case::RendererUse;
use lightmeter_document::gate::RendererIdentity;
use lightmeter_document::run::Identity;
use lightmeter_engine::rows::Rows;
use lightmeter_judge::blend_unit::pixel::Units;
use lightmeter_judge::cases::{Answers, Unanswered};
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;

/// What was given to a question.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Given {
    /// A formula's outputs.
    Values(Vec<f32>),
    /// The file of a scene's image.
    Image(String),
    /// Neither.
    Nothing(Unanswered),
}

/// What a question asks for.
#[derive(Clone, Copy)]
pub(super) enum Asks<'a> {
    /// The outputs of a formula.
    Outputs(&'a Spec),
    /// What a blend state leaves on a target: red, green, blue and alpha.
    Pixel(&'a Spec),
    /// The image of a scene.
    Image,
}

impl<'a> Asks<'a> {
    /// The formula; `None` of a scene.
    pub(super) const fn spec(self) -> Option<&'a Spec> {
        match self {
            Self::Outputs(spec) | Self::Pixel(spec) => Some(spec),
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
        Asks::Image => (0, vec![]),
    };
    match (line, asks) {
        (Line::Skip(_, reason), _) => Given::Nothing(Unanswered::Skipped(clipped(&reason))),
        (Line::Error(_, reason), _) => unjudged(clipped(&reason)),
        (Line::Image(_, file), Asks::Image) => Given::Image(file.into_owned()),
        (Line::Value(..), Asks::Image) => unjudged("a scene is answered by `image`".into()),
        (Line::Value(_, values), _) if values.len() == outputs => Given::Values(values),
        (Line::Value(_, values), _) => {
            unjudged(format!("{} numbers; expected {outputs}: {}", values.len(), names.join(", ")))
        }
        (Line::Image(..), _) => unjudged("a formula is answered by `value`".into()),
        (Line::Hello(_), _) => unjudged("a hello is no answer".into()),
    }
}

/// What was given to each row, as the engine takes it.
pub(super) fn answers(rows: &Rows<'_>, given: impl IntoIterator<Item = Given>) -> Answers {
    let mut answers = Answers { words: vec![0; rows.of.len() * rows.outputs], ..Answers::default() };
    let each = answers.words.chunks_exact_mut(rows.outputs).zip(given).enumerate();
    for (place, (words, given)) in each {
        match given {
            Given::Values(values) => words.iter_mut().zip(values).for_each(|(word, value)| *word = value.to_bits()),
            Given::Nothing(why) => drop(answers.unanswered.insert(place, why)),
            Given::Image(_) => unreachable!("only a scene is answered by an image"),
        }
    }
    answers
}

/// The pixel that was given, in the target's units.
pub(super) fn pixel(given: Given) -> Result<Units, Unanswered> {
    match given {
        Given::Values(values) => Ok(std::array::from_fn(|k| values.get(k).copied().map_or(f64::NAN, f64::from))),
        Given::Nothing(why) => Err(why),
        Given::Image(_) => unreachable!("only a scene is answered by an image"),
    }
}

/// Who answers, and what its hello declares.
pub(super) struct Declared {
    pub(super) hello: Hello,
    formulas: Option<Filter>,
    scenes: Option<Filter>,
    pub(super) targets: Vec<TargetFormat>,
}

impl Declared {
    /// Reads what a hello declares.
    pub(super) fn new(hello: Hello) -> Result<Self, ProcessError> {
        let [formulas, scenes] = hello.filters()?;
        let format = |name: &String| TargetFormat::by_name(name).ok_or_else(|| ProcessError::Target(name.clone()));
        let targets = hello.targets.iter().map(format).collect::<Result<_, _>>()?;
        Ok(Self { hello, formulas, scenes, targets })
    }

    /// Why a formula or a scene is not asked; `None` where it is.
    pub(super) fn lacks(&self, id: &str) -> Option<String> {
        let (declared, what) =
            if id.starts_with("scene/") { (&self.scenes, "scenes") } else { (&self.formulas, "formulas") };
        let has = declared.as_ref().is_some_and(|filter| filter.selects(id));
        (!has).then(|| format!("not among the {what} that it declares"))
    }

    /// How it is named in reports.
    pub(super) fn identity(&self) -> Identity {
        let (name, version) = (clipped(&self.hello.renderer), clipped(&self.hello.version));
        Identity { device: name.clone(), name, backend: "renderer".into(), driver: version }
    }

    /// What a report says of it, where nothing went wrong.
    pub(super) fn used(&self) -> RendererUse {
        let Identity { name, driver: version, .. } = self.identity();
        RendererUse { identity: RendererIdentity { name, version }, ..RendererUse::default() }
    }

    /// Why a frame is not asked for; `None` where it is.
    pub(super) fn lacks_frame(&self, frame: &Frame) -> Option<String> {
        self.hello.lacks(frame)
    }
}
