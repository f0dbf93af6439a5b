//! A shader as a library of functions in WGSL, whose variables are of the invocation.

use crate::AdaptError;
use crate::ending::ends;
use crate::name::safe;
use crate::place::judged_text;
use crate::unanswered::{Unanswered, unanswered};
use lightmeter_shaders::read::{Language, ShaderSource};
use lightmeter_shaders::read::{Role, shown};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{
    AddressSpace, ArraySize, Binding, BuiltIn, Expression, Function, Handle, Module, Scalar, ScalarKind, ShaderStage,
    Span, Statement, Type, TypeInner, VectorSize,
};
use std::fmt::Write as _;
use std::path::Path;

/// What of a shader is judged.
#[derive(Clone, Debug)]
pub enum Part {
    /// A function of that name.
    Function(String),
    /// The entry point.
    Shader,
}

/// The type of a single variable, or of a member.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leaf {
    /// A number or a truth value.
    Scalar(ScalarKind),
    /// So many numbers of a kind.
    Vector(u8, ScalarKind),
    /// Columns and rows of numbers.
    Matrix(u8, u8),
}

impl std::fmt::Display for Leaf {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Scalar(kind) => f.write_str(word(*kind)),
            Self::Vector(size, kind) => write!(f, "vec{size}<{}>", word(*kind)),
            Self::Matrix(columns, rows) => write!(f, "mat{columns}x{rows}<f32>"),
        }
    }
}

const fn word(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Sint => "i32",
        ScalarKind::Uint => "u32",
        ScalarKind::Bool => "bool",
        ScalarKind::Float | ScalarKind::AbstractInt | ScalarKind::AbstractFloat => "f32",
    }
}

/// Where a variable of a shader has its value from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum From {
    /// A uniform, a storage buffer or a constant of a pipeline.
    Uniform,
    /// The stage before.
    Input,
    /// Whoever calls the function.
    Parameter,
    /// A texture: the value that it gives.
    Texture,
    /// The pipeline.
    BuiltIn(BuiltIn),
}

/// A variable of a shader, or a member of one, that has to have a value.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Its name as it stands in the shader: `material.shininess`, `lights[0].position`.
    pub name: String,
    /// Its place in the function that replaces the formula's.
    pub(crate) place: String,
    /// Its type.
    pub leaf: Leaf,
    /// Where its value comes from.
    pub from: From,
    /// Whether it is of an element of an array other than the first.
    pub is_further: bool,
    /// Whether the shader's text uses it.
    pub is_used: bool,
    /// Whether the shader's text has it with a minus before it.
    pub is_negated: bool,
}

/// A value that a shader gives.
#[derive(Clone, Debug)]
pub struct ShaderOutput {
    /// Its name; empty of a function's result that is no structure.
    pub name: String,
    pub(crate) value: String,
    /// Its type.
    pub leaf: Leaf,
    /// Whether it is at a location other than 0, where a shader has several.
    pub(crate) is_further: bool,
}

/// A shader as functions in WGSL.
#[derive(Debug)]
pub struct ShaderProgram {
    /// The library. All names in it begin with `user_`.
    pub(crate) wgsl: String,
    /// Statements that declare the arguments.
    pub(crate) declared: Vec<String>,
    /// The statement that calls it.
    pub(crate) call: String,
    /// What leaves a case without a value.
    pub(crate) unanswered: Unanswered,
    /// What has to have a value.
    pub slots: Vec<Variable>,
    /// What it gives.
    pub outputs: Vec<ShaderOutput>,
    /// The text of what is judged: the file's, with the lines of other functions empty. Empty of SPIR-V.
    pub text: String,
}

impl ShaderProgram {
    /// What a shader, or a function of it, takes and gives.
    ///
    /// # Errors
    /// Where there is no such function, or it uses what cannot be judged this way.
    pub fn new(path: &Path, source: &ShaderSource, part: &Part) -> Result<Self, AdaptError> {
        let invalid = |message: String| {
            let words =
                NOT_READ.iter().find(|(start, _)| message.starts_with(start)).map_or(&[][..], |(_, words)| words);
            AdaptError::Invalid { path: path.into(), line: source.line_of(words), message }
        };
        let mut module = source.module.clone();
        check(path, source)?;
        let entry = taken(&mut module, source, part).map_err(invalid)?;
        ends(&module, entry, source).map_err(|(line, message)| AdaptError::Invalid {
            path: path.into(),
            line,
            message,
        })?;
        let text = judged_text(&module, entry, source);
        let described = Described::new(&module, source, entry);
        simplified(&mut module).map_err(invalid)?;
        let unanswered = unanswered(&mut module);
        renamed(&mut module, entry);
        let info = validated(&module).map_err(invalid)?;
        let wgsl = naga::back::wgsl::write_string(&module, &info, naga::back::wgsl::WriterFlags::empty())
            .map_err(|error| invalid(format!("it cannot be written as WGSL: {error}")))?;
        let program = described.program(&module, &info, entry, source, (wgsl, unanswered)).map_err(invalid)?;
        Ok(Self { text, ..program })
    }
}

/// What is not read, with the words that it stands in a text by.
const NOT_READ: [(&str, &[&str]); 3] = [
    ("it takes derivatives", &["dFdx", "dFdy", "fwidth", "dpdx", "dpdy"]),
    ("it asks for the size", &["textureSize", "textureDimensions"]),
    ("it gathers", &["textureGather"]),
];

/// Whether it is valid, with the line of what is not.
fn check(path: &Path, source: &ShaderSource) -> Result<(), AdaptError> {
    let capabilities = Capabilities::default() | Capabilities::IMMEDIATES;
    let error = match Validator::new(ValidationFlags::all(), capabilities).validate(&source.module) {
        Ok(_) => return Ok(()),
        Err(error) => error,
    };
    let (text, before) = &source.read;
    let line =
        error.spans().next().filter(|_| !text.is_empty()).map(|(span, _)| span.location(text).line_number as usize);
    let line = line.map(|line| line.saturating_sub(*before).max(1));
    Err(AdaptError::Invalid { path: path.into(), line, message: validated(&source.module).err().unwrap_or_default() })
}

pub(crate) fn validated(module: &Module) -> Result<ModuleInfo, String> {
    let capabilities = Capabilities::default() | Capabilities::IMMEDIATES;
    Validator::new(ValidationFlags::all(), capabilities).validate(module).map_err(|error| {
        let mut words = error.as_inner().to_string();
        let mut source = std::error::Error::source(error.as_inner());
        while let Some(inner) = source {
            let _ = write!(words, ": {inner}");
            source = inner.source();
        }
        words
    })
}

/// The function to call, an entry point made one.
fn taken(module: &mut Module, source: &ShaderSource, part: &Part) -> Result<Handle<Function>, String> {
    let entries: Vec<String> = module.entry_points.iter().map(|entry| entry.name.clone()).collect();
    let place = match part {
        Part::Function(name) => {
            let found = module.functions.iter().find(|(_, function)| function.name.as_deref() == Some(name));
            if let Some((handle, _)) = found {
                module.entry_points.clear();
                return Ok(handle);
            }
            entries.iter().position(|entry| entry == name).ok_or_else(|| {
                let names = functions(module, source);
                let meant = lightmeter_catalogue::nearest::did_you_mean(name, names.iter().map(String::as_str));
                format!("it has no function `{name}`{meant} It has {}", names.join(", "))
            })?
        }
        Part::Shader if source.is_library => {
            let names = functions(module, source).join(", ");
            return Err(if names.is_empty() {
                "it has no function at all".into()
            } else {
                format!("it has no main; name a function by `--function NAME@FILE`: it has {names}")
            });
        }
        Part::Shader => {
            let of_stage =
                |stage| module.entry_points.iter().enumerate().filter(move |(_, entry)| entry.stage == stage);
            let stage = [ShaderStage::Fragment, ShaderStage::Vertex]
                .into_iter()
                .find(|stage| of_stage(*stage).next().is_some());
            let found: Vec<usize> = stage.map_or(vec![], |stage| of_stage(stage).map(|(place, _)| place).collect());
            match found.as_slice() {
                [place] => *place,
                [] => {
                    return Err("it has no fragment or vertex shader; name a function by `--function NAME@FILE`".into());
                }
                _ => {
                    return Err(format!(
                        "it has several entry points: {}; name one by `--function NAME@FILE`",
                        entries.join(", ")
                    ));
                }
            }
        }
    };
    let mut function = module.entry_points.swap_remove(place).function;
    module.entry_points.clear();
    function.name = Some("entry".into());
    Ok(module.functions.append(function, Span::UNDEFINED))
}

/// The functions of a shader by name.
fn functions(module: &Module, source: &ShaderSource) -> Vec<String> {
    let own = module.functions.iter().filter_map(|(_, function)| function.name.clone());
    let entries = module.entry_points.iter().map(|entry| entry.name.clone());
    let is_own = |name: &String| !(name.starts_with("lightmeter_") || source.is_library && name == "main");
    let mut names: Vec<String> = own.chain(entries).filter(is_own).collect();
    names.sort();
    names.dedup();
    names
}

/// Puts all variables into the invocation, and what a texture gives in the place of sampling it.
fn simplified(module: &mut Module) -> Result<(), String> {
    if module.overrides.iter().next().is_some() {
        return Err("it has overrides or specialisation constants; write their values as constants".into());
    }
    let vec4 = Type { name: None, inner: TypeInner::Vector { size: VectorSize::Quad, scalar: Scalar::F32 } };
    let texel = module.types.insert(vec4, Span::UNDEFINED);
    let number = module.types.insert(Type { name: None, inner: TypeInner::Scalar(Scalar::F32) }, Span::UNDEFINED);
    for (_, variable) in module.global_variables.iter_mut() {
        match (&module.types[variable.ty].inner, variable.space) {
            (_, AddressSpace::WorkGroup) => return Err("it shares variables between invocations".into()),
            (TypeInner::Image { class, .. }, _) => {
                variable.ty = match class {
                    naga::ImageClass::Sampled { kind: ScalarKind::Float, .. } => texel,
                    naga::ImageClass::Depth { .. } => number,
                    _ => return Err("it has a texture of integers, or one that it writes".into()),
                };
            }
            (TypeInner::Sampler { .. }, _) => variable.ty = number,
            _ => {}
        }
        variable.space = AddressSpace::Private;
        variable.binding = None;
    }
    let pointers: Vec<(Handle<Type>, Type)> = module.types.iter().map(|(handle, ty)| (handle, ty.clone())).collect();
    for (handle, ty) in pointers {
        if let TypeInner::Pointer { base, space } = ty.inner
            && !matches!(space, AddressSpace::Function | AddressSpace::Private)
        {
            let inner = TypeInner::Pointer { base, space: AddressSpace::Private };
            module.types.replace(handle, Type { name: Some(format!("pointer{}", handle.index())), inner });
        }
    }
    for (_, function) in module.functions.iter_mut() {
        for (_, expression) in function.expressions.iter_mut() {
            match *expression {
                Expression::ImageSample { image, gather: None, .. } | Expression::ImageLoad { image, .. } => {
                    *expression = Expression::Load { pointer: image };
                }
                Expression::ImageSample { .. } => return Err("it gathers texels".into()),
                Expression::ImageQuery { .. } => return Err("it asks for the size of a texture".into()),
                Expression::Derivative { .. } => {
                    return Err("it takes derivatives (dFdx, dFdy, fwidth), which a single case has not".into());
                }
                _ => {}
            }
        }
        let is_handle =
            |ty: Handle<Type>| matches!(module.types[ty].inner, TypeInner::Image { .. } | TypeInner::Sampler { .. });
        if function.arguments.iter().any(|argument| is_handle(argument.ty)) {
            let name = function.name.clone().unwrap_or_default();
            return Err(format!("its function `{name}` takes a texture or a sampler; pass what it gives"));
        }
        for argument in &mut function.arguments {
            argument.binding = None;
        }
        if let Some(result) = &mut function.result {
            result.binding = None;
        }
    }
    Ok(())
}

/// Gives everything a name that nothing else has.
fn renamed(module: &mut Module, entry: Handle<Function>) {
    for (handle, function) in module.functions.iter_mut() {
        function.name = Some(if handle == entry {
            "user_entry".into()
        } else {
            safe("function", function.name.as_deref(), handle.index())
        });
    }
    for (handle, variable) in module.global_variables.iter_mut() {
        variable.name = Some(safe("global", variable.name.as_deref(), handle.index()));
    }
    for (handle, constant) in module.constants.iter_mut() {
        if constant.name.is_some() {
            constant.name = Some(safe("constant", constant.name.as_deref(), handle.index()));
        }
    }
    let types: Vec<(Handle<Type>, Type)> = module.types.iter().map(|(handle, ty)| (handle, ty.clone())).collect();
    for (handle, ty) in types {
        if let TypeInner::Struct { mut members, span } = ty.inner {
            for (k, member) in members.iter_mut().enumerate() {
                member.name = Some(member_name(k));
                member.binding = None;
            }
            let name = Some(safe("type", ty.name.as_deref(), handle.index()));
            module.types.replace(handle, Type { name, inner: TypeInner::Struct { members, span } });
        }
    }
}

fn member_name(k: usize) -> String {
    format!("member_{k}x")
}

/// What a shader says of itself before its names go.
struct Described {
    /// Each global variable's name, and what it is; `None` of one of its own.
    globals: Vec<(String, Option<From>)>,
    /// The variables that it gives, and whether each is at a location other than 0.
    outputs: Vec<(usize, bool)>,
    /// Whether it is a vertex shader's entry point.
    is_vertex: bool,
    /// Each argument's name.
    arguments: Vec<(String, From)>,
    /// The members of structures, by the type's place.
    members: Vec<Vec<Member>>,
}

/// A member of a structure.
struct Member {
    name: String,
    built_in: Option<BuiltIn>,
    /// Whether it is at a location other than 0.
    is_further: bool,
}

impl Described {
    fn new(module: &Module, source: &ShaderSource, entry: Handle<Function>) -> Self {
        let role = |name: &str| source.roles.iter().find(|(own, _)| own == name).map(|(_, role)| *role);
        let (mut globals, mut outputs) = (vec![], vec![]);
        for (handle, variable) in module.global_variables.iter() {
            let name = variable.name.clone().unwrap_or_default();
            let from = match (variable.space, role(&name)) {
                (_, Some(Role::Uniform)) => Some(From::Uniform),
                (_, Some(Role::Input | Role::Varying)) => Some(From::Input),
                (_, Some(Role::Texture)) => Some(From::Texture),
                (_, Some(role @ (Role::Output | Role::FurtherOutput))) => {
                    outputs.push((handle.index(), role == Role::FurtherOutput));
                    None
                }
                (AddressSpace::Handle, None) => match module.types[variable.ty].inner {
                    TypeInner::Sampler { .. } => None,
                    _ => Some(From::Texture),
                },
                (AddressSpace::Uniform | AddressSpace::Storage { .. } | AddressSpace::Immediate, None) => {
                    Some(From::Uniform)
                }
                _ => None,
            };
            globals.push((shown(&name), from));
        }
        let function = &module.functions[entry];
        let is_entry = function.name.as_deref() == Some("entry");
        let from = |binding: &Option<Binding>| match binding {
            Some(Binding::BuiltIn(built_in)) => From::BuiltIn(*built_in),
            _ if is_entry => From::Input,
            _ => From::Parameter,
        };
        let argument = |(k, argument): (usize, &naga::FunctionArgument)| {
            let name = argument.name.clone().filter(|name| !name.is_empty());
            (name.or_else(|| stored_name(module, function, k)).unwrap_or_default(), from(&argument.binding))
        };
        let member = |member: &naga::StructMember| Member {
            name: member.name.clone().unwrap_or_default(),
            built_in: match member.binding {
                Some(Binding::BuiltIn(built_in)) => Some(built_in),
                _ => None,
            },
            is_further: matches!(member.binding, Some(Binding::Location { location: 1.., .. })),
        };
        let members = module.types.iter().map(|(_, ty)| match &ty.inner {
            TypeInner::Struct { members, .. } => members.iter().map(member).collect(),
            _ => vec![],
        });
        Self {
            globals,
            outputs,
            is_vertex: source.language == Language::Glsl(ShaderStage::Vertex) || gives_position(module, function),
            arguments: function.arguments.iter().enumerate().map(argument).collect(),
            members: members.collect(),
        }
    }

    fn program(
        &self,
        module: &Module,
        info: &ModuleInfo,
        entry: Handle<Function>,
        source: &ShaderSource,
        (wgsl, unanswered): (String, Unanswered),
    ) -> Result<ShaderProgram, String> {
        let function = &module.functions[entry];
        let walk = Walk { module, described: self, text: &source.text };
        let (mut slots, mut declared, mut words) = (vec![], vec![], vec![]);
        for (handle, variable) in module.global_variables.iter() {
            let Some((name, Some(from))) = self.globals.get(handle.index()) else { continue };
            if !info[entry][handle].is_empty() {
                let place = variable.name.clone().unwrap_or_default();
                walk.slots(variable.ty, (name.clone(), place), (*from, false), &mut slots)?;
            }
        }
        for (k, (argument, (name, from))) in function.arguments.iter().zip(&self.arguments).enumerate() {
            let place = safe("argument", Some(name), k);
            let shown = if name.is_empty() { format!("argument {k}") } else { name.clone() };
            if matches!(module.types[argument.ty].inner, TypeInner::Pointer { .. }) {
                return Err(format!("its parameter `{shown}` is an output (out or inout); return the value instead"));
            }
            declared.push(format!("var {place}: {};", walk.type_of(argument.ty)?));
            // The members of an entry point's structure are inputs by their own names.
            let is_nameless =
                *from == From::Input && matches!(module.types[argument.ty].inner, TypeInner::Struct { .. });
            walk.slots(
                argument.ty,
                (if is_nameless { String::new() } else { shown }, place.clone()),
                (*from, false),
                &mut slots,
            )?;
            words.push(place);
        }
        // A function that gives a value is judged by it, whatever else the file declares. What an entry point returns may be the pipeline's
        // alone.
        let mut outputs = vec![];
        if let Some(result) = &function.result {
            walk.outputs(result.ty, ("", false), "user_given", &mut outputs);
        }
        let variables = if outputs.is_empty() { self.outputs.as_slice() } else { &[] };
        for &(place, is_further) in variables {
            let Some((_, variable)) = module.global_variables.iter().find(|(handle, _)| handle.index() == place) else {
                continue;
            };
            let value = variable.name.as_deref().unwrap_or_default();
            walk.outputs(variable.ty, (&self.globals[place].0, is_further), value, &mut outputs);
        }
        // What is handed to the next stage has no first place: only a fragment's colours have.
        if self.is_vertex {
            outputs.iter_mut().for_each(|output| output.is_further = false);
        }
        let call = match &function.result {
            None => format!("user_entry({});", words.join(", ")),
            Some(_) => format!("let user_given = user_entry({});", words.join(", ")),
        };
        Ok(ShaderProgram { wgsl, declared, call, unanswered, slots, outputs, text: String::new() })
    }
}

/// Whether a function gives a vertex's position to the pipeline.
fn gives_position(module: &Module, function: &Function) -> bool {
    let is_position = |binding: &Option<Binding>| matches!(binding, Some(Binding::BuiltIn(BuiltIn::Position { .. })));
    function.result.as_ref().is_some_and(|result| match &module.types[result.ty].inner {
        TypeInner::Struct { members, .. } => members.iter().any(|member| is_position(&member.binding)),
        _ => is_position(&result.binding),
    })
}

/// The name of the variable that an argument without one is stored in: of SPIR-V, whose inputs are variables.
fn stored_name(module: &Module, function: &Function, argument: usize) -> Option<String> {
    let is_argument = |value: &Handle<Expression>| matches!(function.expressions[*value], Expression::FunctionArgument(k) if k as usize == argument);
    function.body.iter().find_map(|statement| match statement {
        Statement::Store { pointer, value } if is_argument(value) => match function.expressions[*pointer] {
            Expression::GlobalVariable(variable) => module.global_variables[variable].name.clone(),
            _ => None,
        },
        _ => None,
    })
}

/// Goes through the members of types.
struct Walk<'a> {
    module: &'a Module,
    described: &'a Described,
    text: &'a str,
}

impl Walk<'_> {
    fn slots(
        &self,
        ty: Handle<Type>,
        (name, place): (String, String),
        (from, is_further): (From, bool),
        out: &mut Vec<Variable>,
    ) -> Result<(), String> {
        match &self.module.types[ty].inner {
            TypeInner::Struct { members, .. } => {
                for (k, member) in members.iter().enumerate() {
                    let Member { name: own, built_in, .. } = &self.described.members[ty.index()][k];
                    let from = built_in.map_or(from, From::BuiltIn);
                    let name = if name.is_empty() { own.clone() } else { format!("{name}.{own}") };
                    self.slots(member.ty, (name, format!("{place}.{}", member_name(k))), (from, is_further), out)?;
                }
                Ok(())
            }
            TypeInner::Array { base, size: ArraySize::Constant(size), .. } if size.get() <= MOST_ELEMENTS => {
                for k in 0..size.get() {
                    self.slots(
                        *base,
                        (format!("{name}[{k}]"), format!("{place}[{k}]")),
                        (from, is_further || k > 0),
                        out,
                    )?;
                }
                Ok(())
            }
            _ => {
                let leaf = self.leaf(ty).ok_or_else(|| {
                    format!(
                        "`{name}` is no number, vector, matrix, structure or array of at most {MOST_ELEMENTS} of them"
                    )
                })?;
                let (is_used, is_negated) = (self.is_used(&name), self.is_negated(&name));
                out.push(Variable { name, place, leaf, from, is_further, is_used, is_negated });
                Ok(())
            }
        }
    }

    /// Whether the text has a member's name after a dot. Without a text, and of what is no member, it is taken to be used.
    fn is_used(&self, name: &str) -> bool {
        let Some((_, member)) = name.rsplit_once('.') else { return true };
        let ends = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
        let dotted = format!(".{member}");
        self.text.is_empty()
            || self.text.match_indices(&dotted).any(|(place, found)| ends(&self.text[place + found.len()..]))
    }

    /// Whether the text has a name, or a member's, with a minus before it.
    fn is_negated(&self, name: &str) -> bool {
        let own = name.rsplit('.').next().unwrap_or(name);
        let is_letter = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        self.text.match_indices(own).any(|(place, found)| {
            let (before, after) = (self.text[..place].trim_end_matches(is_letter), &self.text[place + found.len()..]);
            before.trim_end().ends_with('-') && !after.starts_with(|c: char| c.is_alphanumeric() || c == '_')
        })
    }

    fn leaf(&self, ty: Handle<Type>) -> Option<Leaf> {
        match self.module.types[ty].inner {
            TypeInner::Scalar(scalar) if scalar.width <= 4 => Some(Leaf::Scalar(scalar.kind)),
            TypeInner::Vector { size, scalar } if scalar.width <= 4 => Some(Leaf::Vector(size as u8, scalar.kind)),
            TypeInner::Matrix { columns, rows, scalar } if scalar.width == 4 => {
                Some(Leaf::Matrix(columns as u8, rows as u8))
            }
            _ => None,
        }
    }

    fn outputs(&self, ty: Handle<Type>, (name, is_further): (&str, bool), value: &str, out: &mut Vec<ShaderOutput>) {
        if let TypeInner::Struct { members, .. } = &self.module.types[ty].inner {
            for (k, member) in members.iter().enumerate() {
                let Member { name: own, built_in, is_further } = &self.described.members[ty.index()][k];
                if built_in.is_none() {
                    self.outputs(member.ty, (own, *is_further), &format!("{value}.{}", member_name(k)), out);
                }
            }
        } else if let Some(leaf) = self.leaf(ty) {
            out.push(ShaderOutput { name: name.into(), value: value.into(), leaf, is_further });
        }
    }

    fn type_of(&self, ty: Handle<Type>) -> Result<String, String> {
        let own = &self.module.types[ty];
        match (&own.inner, self.leaf(ty)) {
            (_, Some(leaf)) => Ok(leaf.to_string()),
            (TypeInner::Struct { .. }, _) => Ok(own.name.clone().unwrap_or_default()),
            (TypeInner::Array { base, size: ArraySize::Constant(size), .. }, _) => {
                Ok(format!("array<{}, {size}>", self.type_of(*base)?))
            }
            _ => Err("it takes a parameter that is no number, vector, matrix, structure or array of them".into()),
        }
    }
}

/// Elements of an array that can be bound.
const MOST_ELEMENTS: u32 = 64;
