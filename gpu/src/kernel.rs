//! A WGSL function as something to evaluate on rows of numbers: its signature read by naga, its entry points written here.

use crate::error::Error;
use crate::shaders::{Shaders, validate};
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
    pub(crate) repeat: String,
    /// The same without the function: what reading the inputs and the loop take by themselves.
    pub(crate) idle: String,
}

/// Words of a pixel of one target.
const WORDS: usize = 4;

impl Kernel {
    /// The function of that name in that file.
    ///
    /// # Errors
    /// Where the file is invalid, has no such function, or one whose types cannot be read from numbers.
    pub fn new(shaders: &Shaders, file: &str, function: &str) -> Result<Self, Error> {
        let module = shaders.parse(file)?;
        let missing = || Error::MissingFunction { file: file.into(), function: function.into() };
        let (_, found) =
            module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(function)).ok_or_else(missing)?;
        let unsupported = |found: String| Error::Signature { file: file.into(), function: function.into(), found };

        let (mut inputs, mut selectors, mut arguments) = (0, 0, vec![]);
        for argument in &found.arguments {
            let before = inputs;
            arguments.push(construct(&module, argument.ty, &mut inputs).map_err(unsupported)?);
            if is_selector(&module, argument.ty) {
                selectors += inputs - before;
            }
        }
        let result = found.result.as_ref().ok_or_else(|| unsupported("nothing is returned".into()))?;
        let mut fields = vec![];
        flatten(&module, result.ty, "result", &mut fields).map_err(unsupported)?;

        let call = format!("let result = {function}({});", arguments.join(", "));
        let source = shaders.source(file);
        let kernel = Self {
            file: file.into(),
            function: function.into(),
            inputs,
            selectors,
            outputs: fields.len(),
            compute: format!("{source}\n{}", compute_entry(&call, inputs, &fields)),
            fragment: format!("{source}\n{}", fragment_entry(&call, inputs, &fields)),
            repeat: format!("{source}\n{}", repeat_entry(&call, inputs, &fields)),
            idle: repeat_entry("", inputs, &(0..inputs).map(moved).collect::<Vec<_>>()),
        };
        // A name of the file's may stand in the way of the entry points', or an operation be out of place in a stage.
        validate(file, &kernel.compute)?;
        validate(file, &kernel.fragment)?;
        Ok(kernel)
    }

    /// Targets of four words that the fragment stage writes.
    pub(crate) fn targets(&self) -> usize {
        self.outputs.div_ceil(WORDS)
    }
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

/// The word of a row's number.
fn place(number: usize) -> String {
    format!("lightmeter_rows[lightmeter_base + {number}u]")
}

/// The word of a row's number, read beforehand, with its last three bits moved from turn to turn.
fn moved(number: usize) -> String {
    format!("(lightmeter_word{number} ^ (lightmeter_turn & 7u))")
}

/// Evaluates a row over and over, each number's last three bits moved from turn to turn, and folds what comes out into a word.
fn repeat_entry(call: &str, inputs: usize, fields: &[String]) -> String {
    let moved = (0..inputs).fold(call.to_owned(), |call, k| call.replace(&place(k), &moved(k)));
    let words = (0..inputs).fold(String::new(), |mut text, k| {
        let _ = writeln!(text, "    let lightmeter_word{k} = {};", place(k));
        text
    });
    format!(
        "{ROWS}@group(0) @binding(1) var<storage, read_write> lightmeter_results: array<u32>;
override lightmeter_times: u32;
@compute @workgroup_size(64)
fn lightmeter_repeat(@builtin(global_invocation_id) lightmeter_id: vec3u) {{
    let lightmeter_base = (lightmeter_id.x % (arrayLength(&lightmeter_rows) / {inputs}u)) * {inputs}u;
{words}    var lightmeter_folded = 0u;
    for (var lightmeter_turn = 0u; lightmeter_turn < lightmeter_times; lightmeter_turn++) {{
        {moved}
        lightmeter_folded ^= {};
    }}
    lightmeter_results[lightmeter_id.x] = lightmeter_folded;
}}
",
        fields.join(" ^ ")
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
        width = crate::arithmetic::FRAGMENT_WIDTH,
        values = values.join(", ")
    )
}

fn is_selector(module: &Module, ty: Handle<Type>) -> bool {
    matches!(module.types[ty].inner, TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Uint)
}

/// An expression that builds a value of the type from the row's next numbers.
fn construct(module: &Module, ty: Handle<Type>, place: &mut usize) -> Result<String, String> {
    let next = |place: &mut usize| {
        *place += 1;
        self::place(*place - 1)
    };
    let number = |place: &mut usize| format!("bitcast<f32>({})", next(place));
    let vector = |size: u8, place: &mut usize| {
        let parts: Vec<String> = (0..size).map(|_| number(place)).collect();
        format!("vec{size}f({})", parts.join(", "))
    };
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Float => Ok(number(place)),
        TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Uint => Ok(next(place)),
        TypeInner::Vector { size, scalar } if scalar.kind == ScalarKind::Float => Ok(vector(*size as u8, place)),
        TypeInner::Matrix { columns, rows, .. } => {
            let (columns, rows) = (*columns as u8, *rows as u8);
            let parts: Vec<String> = (0..columns).map(|_| vector(rows, place)).collect();
            Ok(format!("mat{columns}x{rows}f({})", parts.join(", ")))
        }
        TypeInner::Struct { members, .. } => {
            let parts: Result<Vec<String>, String> = members.iter().map(|m| construct(module, m.ty, place)).collect();
            Ok(format!("{}({})", type_name(module, ty), parts?.join(", ")))
        }
        _ => Err(type_name(module, ty)),
    }
}

/// The expressions of the words of a value's numbers, in order.
fn flatten(module: &Module, ty: Handle<Type>, value: &str, fields: &mut Vec<String>) -> Result<(), String> {
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Float => fields.push(format!("bitcast<u32>({value})")),
        TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Uint => fields.push(value.into()),
        TypeInner::Vector { size, scalar } if scalar.kind == ScalarKind::Float => {
            fields.extend((0..*size as u8).map(|k| format!("bitcast<u32>({value}[{k}])")));
        }
        TypeInner::Struct { members, .. } => {
            for member in members {
                let name = member.name.as_deref().unwrap_or_default();
                flatten(module, member.ty, &format!("{value}.{name}"), fields)?;
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
