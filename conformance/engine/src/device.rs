//! What stands behind a subject that is not embedded: a device, which draws and computes what it is handed.

use crate::piece::{Piece, Pixels};
use crate::rows::Rows;
use lightmeter_catalogue::cases::Stage;
use lightmeter_catalogue::select::Member;
use lightmeter_catalogue::special::Probe;
use lightmeter_document::report::{Cost, EffectsCost};
use lightmeter_scene::along::Along;
use lightmeter_scene::blend::Route;
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What can go wrong on a device.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DeviceError {
    /// The device was lost, or reported an error.
    #[error("{0}")]
    Failed(String),
    /// The device does not answer.
    #[error("{0}")]
    Hangs(String),
    /// The driver gave no device.
    #[error("{0}")]
    NoDevice(String),
    /// What it was handed is invalid: a shader, a scene.
    #[error(transparent)]
    Refused(Box<dyn std::error::Error + Send + Sync>),
}

impl DeviceError {
    /// Whether the device itself failed, rather than what it was handed.
    #[must_use]
    pub const fn is_of_device(&self) -> bool {
        matches!(self, Self::Failed(_) | Self::Hangs(_))
    }
}

/// The code under test, as its device understands it: of an adapter, a set of shader files.
#[derive(Clone, Default)]
pub struct Code(Option<Arc<dyn Any + Send + Sync>>);

impl Code {
    /// The code of a kind of devices.
    #[must_use]
    pub fn of<T: Any + Send + Sync>(code: T) -> Self {
        Self(Some(Arc::new(code)))
    }

    /// The code, where it is of that kind.
    #[must_use]
    pub fn get<T: Any>(&self) -> Option<&T> {
        self.0.as_ref()?.downcast_ref()
    }
}

impl std::fmt::Debug for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if self.0.is_some() { "Code(..)" } else { "Code(none)" })
    }
}

/// Something that a device keeps for itself: work that it has compiled, or a job under way.
pub type Own = Box<dyn Any>;

/// Reads the code of a formula.
pub type ReadAhead = Box<dyn Fn(&Member) + Send + Sync>;

/// Each stage with what the device made of it, or why it is skipped.
pub type Stages<T> = Vec<(Stage, Result<T, &'static str>)>;

/// What an image shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    /// The colours, by shaders composed of the effects that are called for.
    Composed,
    /// The colours, by the shader with all effects behind switches.
    Full,
    /// An intermediate result.
    Intermediate(lightmeter_scene::stage::Intermediate),
}

/// What the probes of special values gave on a device.
#[derive(Default)]
pub struct Probed {
    /// Each probe with its stage's name and the bits that came out.
    pub words: Vec<(&'static Probe, &'static str, u32)>,
    /// Stages that the device lacks, and why.
    pub skipped: Vec<(&'static str, &'static str)>,
}

/// A sweep under way on a device, block after block, the first that began the first that ends.
pub trait Blocks {
    /// Begins a block: the place of its first float in the order of all floats, and how many there are.
    fn start(&mut self, key: u32, count: usize);

    /// Waits for the block that began first, and hands all of its words to `read`, once.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    fn finish(&mut self, read: &mut dyn FnMut(&[u32])) -> Result<(), DeviceError>;
}

/// A device under test. It is handed cases and gives back bits. Of a formula it uses the description and never the evaluation.
///
/// # Errors
/// Each function fails where the code is invalid, where the device refuses it, and where the device fails or is lost.
#[expect(clippy::missing_errors_doc, reason = "said once for all of them")]
pub trait Device: Send + Sync {
    /// The device as what it is.
    fn as_any(&self) -> &dyn Any;

    /// The device's own code, which is right: drivers are asked for their deviations by it.
    fn built_in(&self) -> Result<Code, DeviceError>;

    /// The text of a file of the code.
    fn source(&self, code: &Code, file: &str) -> String;

    /// What reads the code of a formula ahead of its compilation, on another thread; `None` where there is nothing to gain.
    fn read_ahead(&self, code: &Code) -> Option<ReadAhead> {
        let _ = code;
        None
    }

    /// Compiles what the formulas of a group need, each of which the first stands for.
    fn compile(&mut self, code: &Code, member: &Member) -> Result<Stages<Own>, DeviceError>;

    /// Starts the evaluation of rows by a stage.
    fn submit(&mut self, work: &Own, rows: &Rows<'_>) -> Result<Own, DeviceError>;

    /// The outputs of rows, bit for bit, once they are there.
    fn finish(&self, work: &Own, job: Own, rows: &Rows<'_>) -> Result<Vec<u32>, DeviceError>;

    /// A built-in function alone at one argument; `None` where the device has no compute stage.
    fn probe(&self, code: &Code, function: &str, x: f32) -> Result<Option<u32>, DeviceError>;

    /// The probes of special values.
    fn special(&self, code: &Code, probes: &[&'static Probe]) -> Result<Probed, DeviceError>;

    /// Why a target cannot be blended on; `None` where it can.
    fn lacks_blending(&self, target: TargetFormat) -> Option<&'static str>;

    /// Why a route to the blend unit is not open; `None` where it is.
    fn lacks_route(&mut self, code: &Code, route: Route) -> Result<Option<&'static str>, DeviceError>;

    /// Draws pieces by the blend unit, and once more where the time of that is asked for.
    fn blend(
        &mut self,
        code: &Code,
        target: TargetFormat,
        pieces: &[&Piece],
        again: bool,
    ) -> Result<Pixels, DeviceError>;

    /// Lets go of the blend unit's pipelines.
    fn forget_pipelines(&mut self);

    /// Gives up the blend unit, which may be lost: the next one is a fresh one.
    fn renew_blend_unit(&mut self);

    /// Why a format cannot be drawn on; `None` where it can.
    fn lacks_target(&self, target: TargetFormat) -> Option<&'static str>;

    /// Why a frame cannot be drawn; `None` where it can.
    fn lacks_frame(&self, frame: &Frame) -> Option<&'static str>;

    /// Starts to draw a frame with these effects.
    fn draw(&self, code: &Code, frame: &Frame, sets: &[Called], picture: Picture) -> Result<Own, DeviceError>;

    /// The bytes of an image in its target's format, once they are there.
    fn pixels(&self, job: Own) -> Result<Vec<u8>, DeviceError>;

    /// What effects cost that a frame does not call for.
    fn effects_cost(&self, code: &Code, frame: &Frame, called: &[Called]) -> Result<EffectsCost, DeviceError>;

    /// What a stable form takes beside naive ones, over random cases of a seed.
    fn stable_costs(
        &self,
        code: &Code,
        member: &Member,
        rivals: &BTreeMap<&'static str, Member>,
        seed: u64,
    ) -> Result<Vec<Cost>, DeviceError>;

    /// Prepares a sweep of a formula in a stage, of blocks of at most `capacity` floats; or why it cannot be.
    fn sweep<'a>(
        &'a self,
        code: &Code,
        member: &Member,
        stage: Stage,
        along: Along<'_>,
        capacity: usize,
    ) -> Result<Result<Box<dyn Blocks + 'a>, &'static str>, DeviceError>;
}
