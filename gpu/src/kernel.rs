//! A WGSL function as something to evaluate on rows of numbers: its signature read by naga, its entry points written here.

use crate::error::GpuError;
use crate::rung::{Asked, Dialect, Lowered, Rung, Shape, lower, rung_struct};
use crate::shaders::{Shaders, validate, validate_lowered};
use lightmeter_scene::target::SENTINEL;
use naga::{Handle, Module, ScalarKind, Type, TypeInner};
use std::fmt::Write as _;

/// A function of a shader file with the entry points that evaluate it.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// The file that it is in.
    pub file: String,
    /// The function's name.
    pub function: String,
    /// Numbers that it takes, flattened, selectors included.
    pub inputs: usize,
    /// How many of them, at the start, are u32 selectors.
    pub selectors: usize,
    /// Numbers that it gives, flattened.
    pub outputs: usize,
    pub(crate) compute: String,
    pub(crate) fragment: String,
}

/// Pixels of a row of the fragment stage's target.
pub(crate) const FRAGMENT_WIDTH: u32 = 256;
/// Inputs of a workgroup of a sweep.
pub(crate) const SWEEP_GROUP: u32 = 64;
/// Pixels of a row of the fragment stage's target in a sweep.
pub(crate) const SWEEP_WIDTH: u32 = 2048;
/// Words of a pixel of one target.
const WORDS: usize = 4;

impl Kernel {
    /// The function of that name in that file.
    ///
    /// # Errors
    /// Where the file is invalid, has no such function, or one whose types cannot be read from numbers.
    pub fn new(shaders: &Shaders, file: &str, function: &str) -> Result<Self, GpuError> {
        let signature = Signature::read(shaders, file, function, row_word, Rung::F32)?;
        let (fields, call) = (signature.words(), &signature.call);
        let Signature { inputs, selectors, .. } = signature;
        let source = shaders.source(file);
        let kernel = Self {
            file: file.into(),
            function: function.into(),
            inputs,
            selectors,
            outputs: fields.len(),
            compute: format!("{source}\n{}", compute_entry(call, inputs, &fields)),
            fragment: format!("{source}\n{}", fragment_entry(call, inputs, &fields)),
        };
        // A name of the file's may stand in the way of the entry points', or an operation be out of place in a stage.
        validate(file, &kernel.compute)?;
        validate(file, &kernel.fragment)?;
        Ok(kernel)
    }

    /// The function with entry points that evaluate one of its outputs along one of its inputs: see [`crate::Sweep`].
    pub(crate) fn sweep(&self, shaders: &Shaders, free: usize, output: usize) -> Result<String, GpuError> {
        let word = |k: usize| if k == free { "lightmeter_free".into() } else { format!("lightmeter_row[{k}u]") };
        let signature = Signature::read(shaders, &self.file, &self.function, word, Rung::F32)?;
        let entries = sweep_entries(&signature.call, self.inputs, &signature.words()[output]);
        let source = format!("{}\n{entries}", shaders.source(&self.file));
        validate(&self.file, &source)?;
        Ok(source)
    }

    /// The function with an entry point that evaluates it many times over, in a rung's arithmetic: see
    /// [`crate::RepeatPipeline`]. Inputs are numbers of f32; an output is handed back in [`Rung::parts`] words. `Ok(Err(reason))`
    /// where it is unavailable there.
    pub(crate) fn repeat(&self, shaders: &Shaders, rung: Rung) -> Result<Result<String, String>, GpuError> {
        let source = shaders.source(&self.file);
        let lowered = if rung == Rung::F32 {
            Ok(Lowered { source, root: self.function.clone() })
        } else {
            lower(&source, rung, &shaders.stable_forms(), Asked::Function(&self.function))
        };
        let Lowered { source, root } = match lowered {
            Ok(lowered) => lowered,
            Err(reason) => return Ok(Err(reason)),
        };
        let word = |k: usize| self.moved_word(k);
        let mut signature = Signature::read(shaders, &self.file, &self.function, word, rung)?;
        if rung != Rung::F32 && signature.fields.iter().any(|field| field.is_word) {
            return Ok(Err("it gives whole numbers, which are the same at every rung".into()));
        }
        signature.call = signature.call.replacen(&format!("= {}(", self.function), &format!("= {root}("), 1);
        let source = format!("{source}\n{}", self.repeat_entry(&signature.call, &signature.fields, rung));
        validate_lowered(&self.file, &source)?;
        Ok(Ok(source))
    }

    /// The same without the function: what reading the inputs and the loop take by themselves.
    pub(crate) fn idle(&self) -> String {
        self.repeat_entry("", &[], Rung::F32)
    }

    /// Evaluates a row over and over, each number's last three bits moved from turn to turn, and folds what comes out and what
    /// goes in into a word. The first rows' results of the first turn, whose numbers are as they were given, are written, and
    /// what was folded after them; other invocations write nothing.
    ///
    /// Zeros stay zeros: next to them are subnormals, which take some processors a hundred times as long.
    fn repeat_entry(&self, call: &str, fields: &[Field], rung: Rung) -> String {
        let inputs = self.inputs;
        let parts: Vec<String> = fields.iter().flat_map(|field| field.words(rung)).collect();
        let words = (0..inputs).map(|k| self.moved_word(k));
        let folded: Vec<String> = fields.iter().map(|field| field.folded(rung)).chain(words).collect();
        let read = (0..inputs).fold(String::new(), |mut text, k| {
            let _ = writeln!(text, "    let lightmeter_word{k} = {};", row_word(k));
            let _ = writeln!(
                text,
                "    let lightmeter_moved{k} = select(0u, 7u, (lightmeter_word{k} & 0x7f800000u) != 0u);"
            );
            text
        });
        let stores = parts.iter().enumerate().fold(String::new(), |mut text, (k, field)| {
            let _ = writeln!(text, "            lightmeter_results[lightmeter_place + {k}u] = {field};");
            text
        });
        format!(
            "{ROWS}@group(0) @binding(1) var<storage, read_write> lightmeter_results: array<u32>;
override lightmeter_times: u32;
@compute @workgroup_size(64)
fn lightmeter_repeat(@builtin(global_invocation_id) lightmeter_id: vec3u) {{
{zero}    let lightmeter_base = (lightmeter_id.x % (arrayLength(&lightmeter_rows) / {inputs}u)) * {inputs}u;
    let lightmeter_place = lightmeter_id.x * {stride}u;
    let lightmeter_writes = lightmeter_place < arrayLength(&lightmeter_results);
{read}    var lightmeter_folded = 0u;
    for (var lightmeter_turn = 0u; lightmeter_turn < lightmeter_times; lightmeter_turn++) {{
        {call}
        if lightmeter_turn == 0u && lightmeter_writes {{
{stores}        }}
        lightmeter_folded ^= {folded};
    }}
    if lightmeter_writes {{
        lightmeter_results[lightmeter_place + {last}u] = lightmeter_folded;
    }} else if lightmeter_folded == {SENTINEL}u {{
        lightmeter_results[0] = 0u;
    }}
}}
",
            // Workgroups stand in one row, which no compiler knows; an array's length it takes for short.
            zero = if rung == Rung::DoubleFloat { "    rung_zero = lightmeter_id.y;\n" } else { "" },
            stride = parts.len() + 1,
            last = parts.len(),
            folded = folded.join(" ^ ")
        )
    }

    /// The k-th word of an invocation's row, read beforehand, with a number's last three bits moved from turn to turn.
    fn moved_word(&self, k: usize) -> String {
        if k < self.selectors {
            format!("lightmeter_word{k}")
        } else {
            format!("(lightmeter_word{k} ^ (lightmeter_turn & lightmeter_moved{k}))")
        }
    }

    /// Targets of four words that the fragment stage writes.
    pub(crate) fn targets(&self) -> usize {
        self.outputs.div_ceil(WORDS)
    }
}

/// What a function takes and gives, and a call of it.
struct Signature {
    inputs: usize,
    selectors: usize,
    /// The numbers of `result`.
    fields: Vec<Field>,
    /// A statement that calls it with the words that a row has for its inputs.
    call: String,
}

/// A number of a result.
struct Field {
    /// Its expression.
    value: String,
    /// Whether it is a word already.
    is_word: bool,
}

impl Signature {
    /// A function of f32, or its counterpart in another arithmetic.
    fn read(
        shaders: &Shaders,
        file: &str,
        function: &str,
        word: impl Fn(usize) -> String,
        rung: Rung,
    ) -> Result<Self, GpuError> {
        let module = shaders.parse(file)?;
        let missing = || GpuError::MissingFunction { file: file.into(), function: function.into() };
        let (_, found) =
            module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(function)).ok_or_else(missing)?;
        let unsupported = |found: String| GpuError::Signature { file: file.into(), function: function.into(), found };

        let (mut inputs, mut selectors, mut arguments) = (0, 0, vec![]);
        for argument in &found.arguments {
            let before = inputs;
            arguments.push(construct(&module, argument.ty, &word, &mut inputs, rung).map_err(unsupported)?);
            if is_selector(&module, argument.ty) {
                selectors += inputs - before;
            }
        }
        let result = found.result.as_ref().ok_or_else(|| unsupported("nothing is returned".into()))?;
        let mut fields = vec![];
        flatten(&module, result.ty, "result", &mut fields, rung).map_err(unsupported)?;
        let call = format!("let result = {function}({});", arguments.join(", "));
        Ok(Self { inputs, selectors, fields, call })
    }

    /// Expressions of the words of a result of f32.
    fn words(&self) -> Vec<String> {
        self.fields.iter().map(|field| field.words(Rung::F32).remove(0)).collect()
    }
}

impl Field {
    /// Expressions of the words that it is handed back in, the greatest part first.
    fn words(&self, rung: Rung) -> Vec<String> {
        let Self { value, is_word } = self;
        match Dialect::of(rung) {
            _ if *is_word => vec![value.clone()],
            Dialect::Pair | Dialect::Double => {
                (0..rung.parts()).map(|part| format!("bitcast<u32>(rung_parts({value})[{part}])")).collect()
            }
            single => vec![format!("bitcast<u32>({})", single.down(Shape::Scalar, value))],
        }
    }

    /// A word that nothing can be left out of.
    fn folded(&self, rung: Rung) -> String {
        let Self { value, is_word } = self;
        match Dialect::of(rung) {
            _ if *is_word => value.clone(),
            Dialect::Pair => format!("bitcast<u32>({value}.hi) ^ bitcast<u32>({value}.lo)"),
            dialect => format!("bitcast<u32>({})", dialect.down(Shape::Scalar, value)),
        }
    }
}

/// The k-th word of a case's row.
fn row_word(k: usize) -> String {
    format!("lightmeter_rows[lightmeter_base + {k}u]")
}

const ROWS: &str = "@group(0) @binding(0) var<storage, read> lightmeter_rows: array<u32>;\n";

fn compute_entry(call: &str, inputs: usize, fields: &[String]) -> String {
    let stores = fields.iter().enumerate().fold(String::new(), |mut text, (k, field)| {
        let _ = writeln!(text, "    lightmeter_results[lightmeter_case * {}u + {k}u] = {field};", fields.len());
        text
    });
    format!(
        "{ROWS}@group(0) @binding(1) var<storage, read_write> lightmeter_results: array<u32>;
@compute @workgroup_size(64)
fn lightmeter_compute(@builtin(global_invocation_id) lightmeter_id: vec3u) {{
    let lightmeter_case = lightmeter_id.x;
    if lightmeter_case >= arrayLength(&lightmeter_results) / {}u {{ return; }}
    let lightmeter_base = lightmeter_case * {inputs}u;
    {call}
{stores}}}
",
        fields.len()
    )
}

fn fragment_entry(call: &str, inputs: usize, fields: &[String]) -> String {
    let (mut targets, mut values) = (String::new(), vec![]);
    for (k, chunk) in fields.chunks(WORDS).enumerate() {
        let _ = writeln!(targets, "    @location({k}) target{k}: vec4u,");
        let words: Vec<&str> = (0..WORDS).map(|w| chunk.get(w).map_or("0u", String::as_str)).collect();
        values.push(format!("vec4u({})", words.join(", ")));
    }
    format!(
        "{ROWS}struct LightmeterTargets {{
{targets}}}
@vertex
fn lightmeter_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {{
    return vec4f(select(-1.0, 3.0, corner == 1u), select(-1.0, 3.0, corner == 2u), 0.5, 1.0);
}}
@fragment
fn lightmeter_fragment(@builtin(position) lightmeter_position: vec4f) -> LightmeterTargets {{
    let lightmeter_case = u32(lightmeter_position.y) * {width}u + u32(lightmeter_position.x);
    if lightmeter_case >= arrayLength(&lightmeter_rows) / {inputs}u {{ discard; }}
    let lightmeter_base = lightmeter_case * {inputs}u;
    {call}
    return LightmeterTargets({values});
}}
",
        width = FRAGMENT_WIDTH,
        values = values.join(", ")
    )
}

/// Entry points that evaluate along one input: the row is fixed but for `lightmeter_free`, the bits of a float, and the floats
/// follow each other in their order from the key `lightmeter_span.x` on, as many as `lightmeter_span.y`.
fn sweep_entries(call: &str, inputs: usize, field: &str) -> String {
    format!(
        "@group(0) @binding(0) var<storage, read> lightmeter_row: array<u32, {inputs}u>;
@group(0) @binding(1) var<uniform> lightmeter_span: vec2u;
@group(0) @binding(2) var<storage, read_write> lightmeter_results: array<u32>;
fn lightmeter_along(lightmeter_case: u32) -> u32 {{
    // A function of one number reads nothing of the row, which is bound all the same.
    _ = &lightmeter_row;
    let lightmeter_key = lightmeter_span.x + lightmeter_case;
    let lightmeter_free = select(~lightmeter_key, lightmeter_key & 0x7fffffffu, lightmeter_key >= 0x80000000u);
    {call}
    return {field};
}}
@compute @workgroup_size({SWEEP_GROUP})
fn lightmeter_sweep(
    @builtin(global_invocation_id) lightmeter_id: vec3u,
    @builtin(num_workgroups) lightmeter_groups: vec3u,
) {{
    let lightmeter_case = lightmeter_id.y * lightmeter_groups.x * {SWEEP_GROUP}u + lightmeter_id.x;
    if lightmeter_case >= lightmeter_span.y {{ return; }}
    lightmeter_results[lightmeter_case] = lightmeter_along(lightmeter_case);
}}
@vertex
fn lightmeter_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {{
    return vec4f(select(-1.0, 3.0, corner == 1u), select(-1.0, 3.0, corner == 2u), 0.5, 1.0);
}}
@fragment
fn lightmeter_fragment(@builtin(position) lightmeter_position: vec4f) -> @location(0) u32 {{
    let lightmeter_case = u32(lightmeter_position.y) * {SWEEP_WIDTH}u + u32(lightmeter_position.x);
    if lightmeter_case >= lightmeter_span.y {{ discard; }}
    return lightmeter_along(lightmeter_case);
}}
"
    )
}

fn is_selector(module: &Module, ty: Handle<Type>) -> bool {
    matches!(module.types[ty].inner, TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Uint)
}

/// An expression that builds a value of the type from the row's next numbers.
fn construct(
    module: &Module,
    ty: Handle<Type>,
    word: &impl Fn(usize) -> String,
    place: &mut usize,
    rung: Rung,
) -> Result<String, String> {
    let dialect = Dialect::of(rung);
    let next = |place: &mut usize| {
        *place += 1;
        word(*place - 1)
    };
    let number = |place: &mut usize| format!("bitcast<f32>({})", next(place));
    let vector = |size: u8, place: &mut usize| {
        let parts: Vec<String> = (0..size).map(|_| number(place)).collect();
        dialect.up(Shape::Vector(size), &format!("vec{size}f({})", parts.join(", ")))
    };
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Float => Ok(dialect.up(Shape::Scalar, &number(place))),
        TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Uint => Ok(next(place)),
        TypeInner::Vector { size, scalar } if scalar.kind == ScalarKind::Float => Ok(vector(*size as u8, place)),
        TypeInner::Matrix { columns, rows, .. } => {
            let (columns, rows) = (*columns as u8, *rows as u8);
            let parts: Vec<String> = (0..columns).map(|_| vector(rows, place)).collect();
            Ok(format!("{}({})", dialect.type_of(Shape::Matrix(columns, rows)), parts.join(", ")))
        }
        TypeInner::Struct { members, .. } => {
            let parts: Result<Vec<String>, String> =
                members.iter().map(|m| construct(module, m.ty, word, place, rung)).collect();
            Ok(format!("{}({})", rung_struct(rung, &type_name(module, ty)), parts?.join(", ")))
        }
        _ => Err(type_name(module, ty)),
    }
}

/// The numbers of a value, in order.
fn flatten(module: &Module, ty: Handle<Type>, value: &str, fields: &mut Vec<Field>, rung: Rung) -> Result<(), String> {
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Float => {
            fields.push(Field { value: value.into(), is_word: false });
        }
        TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Uint => {
            fields.push(Field { value: value.into(), is_word: true });
        }
        TypeInner::Vector { size, scalar } if scalar.kind == ScalarKind::Float => {
            let component = |k: u8| Dialect::of(rung).component(value, &k.to_string());
            fields.extend((0..*size as u8).map(|k| Field { value: component(k), is_word: false }));
        }
        TypeInner::Struct { members, .. } => {
            for member in members {
                let name = member.name.as_deref().unwrap_or_default();
                flatten(module, member.ty, &format!("{value}.{name}"), fields, rung)?;
            }
        }
        _ => return Err(type_name(module, ty)),
    }
    Ok(())
}

fn type_name(module: &Module, ty: Handle<Type>) -> String {
    let ty = &module.types[ty];
    ty.name.clone().unwrap_or_else(|| format!("{:?}", ty.inner))
}
