//! The description of a formula: what goes in, what comes out, where it is from, and its hard cases.

use super::program::Program;
use super::{meaning, rule};
pub use lightmeter_document::list::Domain;
use lightmeter_scene::depth::DepthTest;
use lightmeter_scene::raster::Raster;

/// Where a formula is evaluated on a renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Arithmetic in a compute shader.
    Compute,
    /// Arithmetic in a fragment shader.
    Fragment,
    /// The blend unit, or the depth test.
    FixedFunction,
    /// The rasteriser.
    Raster,
    /// A renderer that is asked case by case, in whatever way it computes.
    Answer,
}

impl Stage {
    /// Every stage.
    pub const ALL: [Self; 5] = [Self::Compute, Self::Fragment, Self::FixedFunction, Self::Raster, Self::Answer];

    /// The name in ids, JSON and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Compute => "compute",
            Self::Fragment => "fragment",
            Self::FixedFunction => "fixed-function",
            Self::Raster => "raster",
            Self::Answer => "answer",
        }
    }
}

/// How a renderer evaluates a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// As arithmetic, by a function of a shader file, in the compute and the fragment stage.
    Arithmetic,
    /// By the blend unit, and as arithmetic where there is a function for it.
    Blend(Program),
    /// As arithmetic and by the depth test.
    Depth(DepthTest),
    /// By the rasteriser alone.
    Raster(Raster),
}

/// The components of an input or output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueShape {
    /// One number.
    Scalar,
    /// Two.
    Vec2,
    /// Three.
    Vec3,
    /// Four.
    Vec4,
    /// Nine, column by column.
    Mat3,
    /// Sixteen, column by column.
    Mat4,
}

impl ValueShape {
    /// The name in JSON and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Vec2 => "vec2",
            Self::Vec3 => "vec3",
            Self::Vec4 => "vec4",
            Self::Mat3 => "mat3",
            Self::Mat4 => "mat4",
        }
    }

    /// How many numbers it has.
    #[must_use]
    pub const fn components(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 => 4,
            Self::Mat3 => 9,
            Self::Mat4 => 16,
        }
    }
}

/// One input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    /// Its name, the same in Rust, WGSL, JSON and reports.
    pub name: &'static str,
    /// Its components.
    pub shape: ValueShape,
    /// Its unit.
    pub unit: &'static str,
    /// What random cases draw it from.
    pub domain: Domain,
}

/// One output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output {
    /// Its name.
    pub name: &'static str,
    /// Its components.
    pub shape: ValueShape,
    /// Its unit.
    pub unit: &'static str,
}

impl Input {
    /// An input.
    #[must_use]
    pub const fn new(name: &'static str, shape: ValueShape, unit: &'static str, domain: Domain) -> Self {
        Self { name, shape, unit, domain }
    }

    /// A number.
    #[must_use]
    pub const fn scalar(name: &'static str, unit: &'static str, domain: Domain) -> Self {
        Self::new(name, ValueShape::Scalar, unit, domain)
    }

    /// A colour without alpha.
    #[must_use]
    pub const fn rgb(name: &'static str) -> Self {
        Self::new(name, ValueShape::Vec3, "color", Domain::Unit)
    }

    /// A colour with alpha.
    #[must_use]
    pub const fn rgba(name: &'static str) -> Self {
        Self::new(name, ValueShape::Vec4, "color", Domain::Unit)
    }

    /// A unit vector.
    #[must_use]
    pub const fn direction(name: &'static str) -> Self {
        Self::new(name, ValueShape::Vec3, "1", Domain::Direction)
    }

    /// A vector of any length from 1/4 to 4.
    #[must_use]
    pub const fn vector(name: &'static str) -> Self {
        Self::new(name, ValueShape::Vec3, "1", Domain::Vector(0.25, 4.0))
    }

    /// A position in eye space.
    #[must_use]
    pub const fn position(name: &'static str) -> Self {
        Self::new(name, ValueShape::Vec3, "unit", Domain::Uniform(-10.0, 10.0))
    }

    /// Whether it is a colour, drawn from black to white.
    #[must_use]
    pub(super) const fn is_color(&self) -> bool {
        let is_color = matches!(self.unit.as_bytes(), b"color") && matches!(self.domain, Domain::Unit);
        is_color && matches!(self.shape, ValueShape::Vec3 | ValueShape::Vec4)
    }
}

impl Output {
    /// An output.
    #[must_use]
    pub const fn new(name: &'static str, shape: ValueShape, unit: &'static str) -> Self {
        Self { name, shape, unit }
    }
}

/// A named hard case: some inputs given, the others in the middle of their domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hard {
    /// The case's name, the last segment of its id.
    pub name: &'static str,
    /// What it pins.
    pub pins: &'static str,
    /// The inputs that are given.
    pub inputs: Values,
    /// A form that fails here, of a formula that does not.
    pub naive: Option<Naive>,
    /// Whether the formula has no meaning a few ULP away: its inputs are then not moved.
    pub is_at_an_end: bool,
}

/// Inputs by name.
pub type Values = &'static [(&'static str, &'static [f32])];

/// Another formula, which computes the same and loses what a stable form keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Naive {
    /// The id of the formula.
    pub formula: &'static str,
    /// What goes wrong with it, in words.
    pub fails: &'static str,
    /// By how much at least, at the case or within a few ULP of it, in roundings (see [`Stable`]); infinite where what
    /// comes out is no number, or not one of use.
    pub at_least: f64,
}

impl Hard {
    /// A case.
    #[must_use]
    pub const fn new(name: &'static str, pins: &'static str, inputs: Values) -> Self {
        Self { name, pins, inputs, naive: None, is_at_an_end: false }
    }

    /// The same, with the form that fails there.
    #[must_use]
    pub const fn naive(self, formula: &'static str, fails: &'static str, at_least: f64) -> Self {
        Self { naive: Some(Naive { formula, fails, at_least }), ..self }
    }

    /// The same, at an end of what the formula is for: a few ULP away it has no meaning, or its unit vectors are none, which shows.
    #[must_use]
    pub const fn at_an_end(self) -> Self {
        Self { is_at_an_end: true, ..self }
    }
}

/// What a result's error is held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Its own length: a direction, a distance, a factor that may be small.
    Own,
    /// Its own length, or 1 if that is greater: what is seen is a share of 1.
    Unit,
}

impl Size {
    /// The name in JSON.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Unit => "unit",
        }
    }
}

/// The claim of a formula in a stable form: at its hard cases and near them it errs by no more than this.
///
/// Errors are counted in *roundings*: |value − exact| over 2⁻²⁴ of the result's size, all outputs taken together as one
/// vector. A single operation that rounds to nearest errs by at most one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stable {
    /// Roundings.
    pub bound: f64,
    /// What they are relative to.
    pub size: Size,
    /// Why that many, and where the form may be used.
    pub because: &'static str,
}

/// A formula's description.
#[derive(Clone, Debug)]
pub struct Spec {
    /// `family/formula`, and for blend states the two factors too.
    pub id: String,
    /// The formula, on a line.
    pub text: &'static str,
    /// Where it is from.
    pub source: &'static str,
    /// The WGSL function that evaluates it as arithmetic.
    pub function: &'static str,
    /// How a renderer evaluates it.
    pub kind: Kind,
    /// Whole numbers that the function takes before its inputs.
    pub selectors: Vec<u32>,
    /// What goes in.
    pub inputs: &'static [Input],
    /// What comes out.
    pub outputs: &'static [Output],
    /// Makes independently drawn inputs fit each other.
    pub fit: Option<fn(&Spec, &mut [f32])>,
    /// Puts inputs that were moved back to where the formula means anything.
    pub within: Option<fn(&mut [f32])>,
    /// The named hard cases.
    pub hard: &'static [Hard],
    /// What it claims, where it is a stable form.
    pub stable: Option<Stable>,
    /// Whether it normalises a vector, as its text says by ⟨ and ⟩.
    pub is_normalised: bool,
}

impl Spec {
    /// The stages that it is judged in.
    #[must_use]
    pub const fn stages(&self) -> &'static [Stage] {
        match self.kind {
            Kind::Arithmetic => &[Stage::Compute, Stage::Fragment],
            Kind::Blend(_) if self.function.is_empty() => &[Stage::FixedFunction],
            Kind::Blend(_) | Kind::Depth(_) => &[Stage::FixedFunction, Stage::Compute, Stage::Fragment],
            Kind::Raster(_) => &[Stage::Raster],
        }
    }

    /// The stages that evaluate rows of numbers, which all but the blend unit do.
    #[must_use]
    pub fn row_stages(&self) -> &'static [Stage] {
        let stages = self.stages();
        if matches!(self.kind, Kind::Blend(_)) { &stages[1..] } else { stages }
    }

    /// The family: the first segment of the id.
    #[must_use]
    pub fn family(&self) -> &str {
        self.id.split('/').next().unwrap_or_default()
    }

    /// The WGSL file that its function stands in.
    #[must_use]
    pub fn file(&self) -> String {
        format!("{}.wgsl", self.family())
    }

    /// The group that verdicts are counted in: the first two segments of the id.
    #[must_use]
    pub fn group(&self) -> &str {
        let end = self.id.match_indices('/').nth(1).map_or(self.id.len(), |(at, _)| at);
        &self.id[..end]
    }

    /// The rules that its text does not state: divisors of 0, vectors of length 0, edges and ties, what is clamped.
    #[must_use]
    pub fn rules(&self) -> Vec<&'static str> {
        rule::of(&self.id)
    }

    /// What an input means here: which way it points, whether it is normalised, in which space it is.
    #[must_use]
    pub fn input_means(&self, input: &Input) -> &'static str {
        meaning::of_input(&self.id, input.name)
    }

    /// What an output means here, component by component where they are of different kinds.
    #[must_use]
    pub fn output_means(&self, output: &Output) -> &'static str {
        meaning::of_output(&self.id, output.name)
    }

    /// Numbers of an input row.
    #[must_use]
    pub fn input_len(&self) -> usize {
        self.inputs.iter().map(|input| input.shape.components()).sum()
    }

    /// Numbers of an output row.
    #[must_use]
    pub fn output_len(&self) -> usize {
        self.outputs.iter().map(|output| output.shape.components()).sum()
    }

    /// Where an input stands in a row.
    #[must_use]
    pub fn place(&self, name: &str) -> Option<std::ops::Range<usize>> {
        let mut start = 0;
        for input in self.inputs {
            let end = start + input.shape.components();
            if input.name == name {
                return Some(start..end);
            }
            start = end;
        }
        None
    }

    /// The name of one number of the output, such as `color.g`.
    #[must_use]
    pub fn output_name(&self, number: usize) -> String {
        number_name(self.outputs.iter().map(|output| (output.name, output.shape, output.unit)), number)
    }

    /// The name of one number of the input, such as `p.z`.
    #[must_use]
    pub fn input_name(&self, number: usize) -> String {
        number_name(self.inputs.iter().map(|input| (input.name, input.shape, input.unit)), number)
    }
}

/// The name of one number among values of these numbers of components; empty where there are fewer.
fn number_name(values: impl Iterator<Item = (&'static str, ValueShape, &'static str)>, mut number: usize) -> String {
    for (name, shape, unit) in values {
        if number < shape.components() {
            let component = match (shape, unit) {
                (ValueShape::Scalar, _) => return name.into(),
                (_, "color") => ["r", "g", "b", "a"][number].into(),
                (ValueShape::Vec2 | ValueShape::Vec3 | ValueShape::Vec4, _) => ["x", "y", "z", "w"][number].into(),
                _ => number.to_string(),
            };
            return format!("{name}.{component}");
        }
        number -= shape.components();
    }
    String::new()
}
