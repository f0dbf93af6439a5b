//! What a renderer gave to a question, read from a line.

use super::answer::{Hello, Line, clipped};
use lightmeter_catalogue::cases::Spec;
use lightmeter_catalogue::filter::{Filter, FilterError};
use lightmeter_document::by_case::RendererUse;
use lightmeter_document::gate::RendererIdentity;
use lightmeter_document::run::Identity;
use lightmeter_judge::cases::Unanswered;
use lightmeter_scene::frame::Frame;

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

/// What a line gives to a case of a formula, or to a scene, which has no description here.
pub(super) fn given(line: Line<'_>, spec: Option<&Spec>) -> Given {
    let unjudged = |message: String| Given::Nothing(Unanswered::Unjudged(message));
    match (line, spec) {
        (Line::Skip(_, reason), _) => Given::Nothing(Unanswered::Skipped(clipped(&reason))),
        (Line::Error(_, reason), _) => unjudged(clipped(&reason)),
        (Line::Image(_, file), None) => Given::Image(file.into_owned()),
        (Line::Value(_, values), Some(spec)) if values.len() == spec.output_len() => Given::Values(values),
        (Line::Value(_, values), Some(spec)) => {
            let names = spec.outputs.iter().map(|output| output.name).collect::<Vec<_>>().join(", ");
            unjudged(format!("{} numbers; expected {}: {names}", values.len(), spec.output_len()))
        }
        (Line::Value(..), None) => unjudged("a scene is answered by `image`".into()),
        (_, Some(_)) => unjudged("a formula is answered by `value`".into()),
        (Line::Hello(_), None) => unjudged("a hello is no answer".into()),
    }
}

/// Who answers, and what its hello declares.
pub(super) struct Declared {
    pub(super) hello: Hello,
    formulas: Option<Filter>,
    scenes: Option<Filter>,
}

impl Declared {
    /// Reads what a hello declares.
    pub(super) fn new(hello: Hello) -> Result<Self, FilterError> {
        let [formulas, scenes] = hello.filters()?;
        Ok(Self { hello, formulas, scenes })
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
