//! A renderer that is asked case by case: a process, files of answers, code in this process. It need not have stages, shaders or
//! devices, may skip what it does not do, and may end at any case.

use crate::device::DeviceError;
use crate::rows::Rows;
use lightmeter_catalogue::cases::blend::Program;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_catalogue::special::Probe;
use lightmeter_document::by_case::{RendererUse, SourcePlace};
use lightmeter_judge::blend_unit::pixel::Units;
use lightmeter_judge::cases::{Answers, Unanswered};
use lightmeter_judge::image::file::StoredImage;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;

/// A scene that a renderer is asked to draw.
#[derive(Clone, Copy)]
pub struct AskedScene<'a> {
    /// Its id.
    pub id: &'a str,
    /// What it shows, in words.
    pub title: &'a str,
    /// All of it.
    pub frame: &'a Frame,
}

/// Cases of a blend state on a target, of which a renderer is asked what is left there.
#[derive(Clone, Copy)]
pub struct AskedPixels<'a> {
    /// The state.
    pub member: &'a Member,
    /// How it is drawn.
    pub program: Program,
    /// On what.
    pub target: TargetFormat,
    /// The cases.
    pub cases: &'a [CaseRef],
    /// Their inputs, row after row.
    pub inputs: &'a [f32],
}

/// The id of a blend state's case on a target, which no other target's case has: `blend/add/src-alpha/one/0003@rgba8unorm`.
#[must_use]
pub fn pixel_id(member: &Member, case: CaseRef, target: TargetFormat) -> String {
    format!("{}@{}", member.case_id(case), target.name())
}

impl AskedPixels<'_> {
    /// The id of a case.
    #[must_use]
    pub fn id(&self, case: CaseRef) -> String {
        pixel_id(self.member, case, self.target)
    }

    /// Each case with its inputs.
    pub fn rows(&self) -> impl Iterator<Item = (CaseRef, &[f32])> {
        self.cases.iter().copied().zip(self.inputs.chunks_exact(self.member.spec.input_len()))
    }
}

/// A renderer under test.
///
/// # Errors
/// Each function fails only where the suite itself cannot ask, as where a file cannot be written. What the renderer does wrong is part of
/// its answers and of [`AskedRenderer::used`].
#[expect(clippy::missing_errors_doc, reason = "said once for all of them")]
pub trait AskedRenderer: Send + Sync {
    /// Why it is not asked the formula or the scene of this id; `None` where it is.
    fn lacks(&self, id: &str) -> Option<String>;

    /// Why it cannot draw a frame; `None` where it can.
    fn lacks_frame(&self, frame: &Frame) -> Option<String>;

    /// Where its code of the formula or the scene of this id stands; `None` where it does not say so.
    fn source(&self, id: &str) -> Option<SourcePlace> {
        let _ = id;
        None
    }

    /// What it gives to cases of formulas. `advanced` hears of each number of cases that are done.
    fn values(&mut self, rows: &Rows<'_>, advanced: &mut dyn FnMut(u64)) -> Result<Answers, DeviceError>;

    /// The formats of targets that it blends on as drivers do; none where it is asked for blending as arithmetic alone.
    fn targets(&self) -> Vec<TargetFormat>;

    /// The pixels that it leaves on a target: in steps of 8 bits as they are stored, in numbers of float formats.
    fn pixels(&mut self, asked: &AskedPixels<'_>) -> Result<Vec<Result<Units, Unanswered>>, DeviceError>;

    /// Whether it is asked for special values.
    fn asks_special(&self) -> bool;

    /// The word that it gives to each of some probes, all of which are functions.
    fn probes(&mut self, probes: &[&'static Probe]) -> Result<Vec<Result<u32, Unanswered>>, DeviceError>;

    /// The image that it draws of a scene.
    fn image(&mut self, scene: AskedScene<'_>) -> Result<Result<StoredImage, Unanswered>, DeviceError>;

    /// All of it is asked once more. What the renderer remembers of the first time must not matter.
    fn begin_again(&mut self) -> Result<(), DeviceError>;

    /// Whether what fails is asked once more at the end.
    fn asks_failing_again(&self) -> bool;

    /// Whether no more answers come.
    fn is_over(&self) -> bool;

    /// Ends it, and tells who it was and what went wrong apart from its answers.
    fn used(&mut self) -> RendererUse;
}
