//! A file as people have it, whole or in part.

use super::compiler::{self, Compiler, OF_HLSL, Source};
use super::glsl::{self, Normalised, PRELUDE_LINES};
use super::hosts::{self, mended};
use super::lines::Lines;
use super::macros::{self, Definitions, words};
use super::missing::{Dialect, Missing, Repaired, Unread, repaired};
use super::options::ReadOptions;
use super::source::{HLSL, Language, MOST_BYTES};
use super::{Role, ShaderError, hlsl, spirv, wgsl};
use crate::graph::Origin;
use crate::lower::Declared;
use lightmeter_files::read;
use naga::front::glsl as glsl_in;
use naga::front::glsl::ErrorKind;
use naga::{Module, ShaderStage, Span};
use std::path::Path;

/// How many times naga reads a text, to find what is missing.
const TURNS_OF_NAGA: usize = 400;
/// The same of glslang, which is a process each time.
const TURNS_OF_GLSLANG: usize = 40;

/// A file as somebody read it, under a set of definitions.
#[derive(Debug)]
pub struct ShaderReading {
    pub(crate) module: Module,
    /// The language, with the version that the file names.
    pub language: String,
    /// Who read it.
    pub reader: String,
    /// What was taken for what is not there.
    pub notes: Vec<String>,
    /// The macros that were defined; empty if none were.
    pub configuration: String,
    /// Whether the file has an entry point.
    pub(crate) has_entry: bool,
    roles: Vec<(String, Role)>,
    is_vertex: bool,
    zeroes_locals: bool,
    /// Whether statements that nobody reads are left out.
    pub(crate) is_partial: bool,
    /// Whether functions are called that are not there.
    pub(crate) lacks_functions: bool,
    places: Places,
}

/// Where something stands in the file.
#[derive(Debug)]
enum Places {
    /// The first byte of each line of the text that was read, and how many of them stand before it.
    Text(Vec<usize>, Lines, usize),
    Spirv(spirv::Table, Lines, usize),
}

impl Declared for ShaderReading {
    fn line(&self, span: Span) -> u32 {
        let Some(range) = span.to_range() else { return 0 };
        let (line, lines, before) = match &self.places {
            Places::Text(starts, lines, before) => {
                (starts.partition_point(|start| *start <= range.start), lines, *before)
            }
            Places::Spirv(table, lines, before) => (spirv::line(table, range.start) as usize, lines, *before),
        };
        if line <= before { 0 } else { lines.line(line - before) }
    }

    fn origin(&self, name: &str) -> Option<Origin> {
        let role = self.roles.iter().find(|(own, _)| own == name).map(|(_, role)| *role)?;
        Some(match role {
            Role::Uniform => Origin::Uniform,
            Role::Texture => Origin::Texture,
            Role::Varying if self.is_vertex => Origin::NoValue,
            Role::Input | Role::Varying => Origin::Input,
            Role::Output | Role::FurtherOutput => Origin::NoValue,
        })
    }

    fn is_output(&self, name: &str) -> bool {
        let gives =
            |role: Role| matches!(role, Role::Output | Role::FurtherOutput) || role == Role::Varying && self.is_vertex;
        name == "gl_Position" || self.roles.iter().any(|(own, role)| own == name && gives(*role))
    }

    fn zeroes_locals(&self) -> bool {
        self.zeroes_locals
    }
}

fn starts(text: &str) -> Vec<usize> {
    std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect()
}

/// Reads a file, under each set of definitions that it seems to have.
///
/// # Errors
/// Where nobody reads it: with the line, and what would do.
pub fn readings(path: &Path, options: &ReadOptions) -> Result<Vec<ShaderReading>, ShaderError> {
    let unreadable = |error: std::io::Error| ShaderError::File { path: path.into(), message: error.to_string() };
    let bytes = read::bytes(path, MOST_BYTES).map_err(unreadable)?;
    let by_ending = Language::of(path);
    if matches!(by_ending, Ok(Language::Spirv)) || bytes.starts_with(&SPIRV) {
        return Ok(vec![of_spirv(path, &bytes)?]);
    }
    let invalid = |message: &str| ShaderError::Invalid { path: path.into(), line: None, message: message.into() };
    if bytes.contains(&0) {
        return Err(invalid("it is no text"));
    }
    // Comments of older files are in many encodings.
    let text = Lines::of_file(&String::from_utf8_lossy(&bytes));
    if text.text.trim().is_empty() {
        return Err(invalid("it is empty"));
    }
    if let Some(line) = too_deep(&text.text) {
        let message = format!("it nests more than {MOST_DEPTH} brackets");
        return Err(ShaderError::Invalid { path: path.into(), line: Some(line), message });
    }
    let programs = hosts::of_shader_lab(&text);
    if !programs.is_empty() {
        return of_several(programs.iter().map(|own| of_hlsl(path, own, options)));
    }
    let ending = path.extension().map(|own| own.to_string_lossy().to_lowercase()).unwrap_or_default();
    let is_glsl = text.text.lines().any(|line| line.trim_start().starts_with("#version"));
    if HLSL.contains(&&*ending) && !is_glsl || is_hlsl(&text.text) && !matches!(by_ending, Ok(Language::Wgsl)) {
        return of_hlsl(path, &text, options);
    }
    match by_ending.or_else(|error| language_of(&text.text).ok_or(error))? {
        Language::Glsl(stage) => of_glsl(path, &text, stage, options),
        _ => Ok(vec![of_wgsl(path, text)?]),
    }
}

/// Several shaders of a file: those that are read.
///
/// # Errors
/// Where none is: why the first is not.
fn of_several(
    all: impl Iterator<Item = Result<Vec<ShaderReading>, ShaderError>>,
) -> Result<Vec<ShaderReading>, ShaderError> {
    let (mut found, mut unread) = (vec![], None);
    for own in all {
        match own {
            Ok(read) => found.extend(read),
            Err(error) => drop(unread.get_or_insert(error)),
        }
    }
    match unread {
        Some(error) if found.is_empty() => Err(error),
        _ => Ok(found),
    }
}

/// The first word of SPIR-V.
const SPIRV: [u8; 4] = 0x0723_0203_u32.to_le_bytes();
/// Brackets within each other.
const MOST_DEPTH: usize = 250;

/// The line that nests too deep for what reads it.
fn too_deep(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    for (number, line) in (1..).zip(text.lines()) {
        for c in line.chars() {
            match c {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth = depth.saturating_sub(1),
                _ => {}
            }
            if depth > MOST_DEPTH {
                return Some(number);
            }
        }
    }
    None
}

/// Files of any ending are HLSL that use what only HLSL has.
fn is_hlsl(text: &str) -> bool {
    let has = |of: &[&str]| words(text).any(|own| of.contains(&own));
    let is_glsl = has(&["gl_FragColor", "gl_Position", "gl_FragCoord"]) || text.contains("#version");
    let semantics = words(text).any(|own| own.starts_with("SV_"))
        || has(&["SamplerState", "cbuffer", "Texture2D", "TEXCOORD0", "POSITION"]);
    !is_glsl && semantics && has(&["float4", "float3", "float2"])
}

/// The language of a file whose ending names none.
fn language_of(text: &str) -> Option<Language> {
    let has = |of: &[&str]| words(text).any(|own| of.contains(&own));
    if has(&["vec3", "vec4", "vec2"]) && text.contains('(') && has(&["void", "return", "uniform", "varying"]) {
        return Some(Language::Glsl(ShaderStage::Fragment));
    }
    (has(&["fn"]) && has(&["vec3f", "vec4f", "f32"])).then_some(Language::Wgsl)
}

fn of_spirv(path: &Path, bytes: &[u8]) -> Result<ShaderReading, ShaderError> {
    let (module, table) = spirv::read(path, bytes)?;
    let lines = table.iter().map(|(_, line)| *line).max().unwrap_or(0);
    let mut own = Lines::default();
    (1..=lines.min(1 << 20)).for_each(|number| own.push("", number));
    Ok(ShaderReading::new(module, "SPIR-V".into(), "naga".into(), Places::Spirv(table, own, 0)))
}

fn of_wgsl(path: &Path, own: Lines) -> Result<ShaderReading, ShaderError> {
    let reading = |module: Module, lines: Lines| {
        let places = Places::Text(starts(&lines.text), lines, 0);
        ShaderReading { zeroes_locals: true, ..ShaderReading::new(module, "WGSL".into(), "naga".into(), places) }
    };
    if let Ok(module) = naga::front::wgsl::parse_str(&own.text) {
        return Ok(reading(module, own));
    }
    let given = (&vec![], false);
    let parsed = |lines: &Lines| parsed_wgsl(&lines.text);
    match repaired(&wgsl::plain(&own), given, Dialect::Wgsl, TURNS_OF_NAGA, &parsed) {
        Ok(Repaired { read, lines, notes, is_partial, lacks_functions }) => {
            Ok(ShaderReading { notes, is_partial, lacks_functions, ..reading(read, lines) })
        }
        Err((line, message)) => {
            Err(ShaderError::Invalid { path: path.into(), line: (line > 0).then_some(line as usize), message })
        }
    }
}

fn parsed_wgsl(text: &str) -> Result<Module, Unread> {
    naga::front::wgsl::parse_str(text).map_err(|error| {
        let message = error.message();
        let place = error.location(text);
        let line = place.map_or(0, |place| place.line_number as usize);
        let name =
            message.strip_prefix("no definition in scope for identifier: `").and_then(|own| own.strip_suffix('`'));
        let what = match (name, place) {
            (Some(name), Some(place)) => {
                let end = (place.offset + place.length) as usize;
                let is_called = text.get(end..).is_some_and(|rest| rest.trim_start().starts_with('('));
                if is_called { Missing::Function(name.into()) } else { Missing::Variable(name.into()) }
            }
            _ => Missing::Other(message.to_owned()),
        };
        Unread { line, what }
    })
}

impl ShaderReading {
    fn new(module: Module, language: String, reader: String, places: Places) -> Self {
        let has_entry = !module.entry_points.is_empty();
        Self {
            module,
            language,
            reader,
            notes: vec![],
            configuration: String::new(),
            has_entry,
            roles: vec![],
            is_vertex: false,
            zeroes_locals: false,
            is_partial: false,
            lacks_functions: false,
            places,
        }
    }
}

/// The version that a text names: `GLSL 3.30`, `GLSL ES 1.00`.
fn version(text: &str) -> String {
    let line = text.lines().find_map(|line| line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("version"));
    let mut own = line.unwrap_or_default().split_whitespace();
    let number = own.next().filter(|number| number.len() == 3);
    let is_es = own.next() == Some("es") || number == Some("100");
    let es = if is_es { " ES" } else { "" };
    number.map_or_else(|| "GLSL".to_owned(), |number| format!("GLSL{es} {}.{}", &number[..1], &number[1..]))
}

/// A vertex shader may have any ending.
fn stage_of(text: &str, by_ending: ShaderStage) -> ShaderStage {
    let has = |word: &str| words(text).any(|own| own == word);
    if has("local_size_x") {
        return ShaderStage::Compute;
    }
    let gives_position = has("attribute") || has("gl_Position");
    if by_ending == ShaderStage::Fragment && gives_position && !has("gl_FragColor") && !has("gl_FragData") {
        return ShaderStage::Vertex;
    }
    by_ending
}

/// Whether a text is statements alone, without a function.
fn is_statements(text: &str) -> bool {
    let code: String = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .filter(|line| !line.trim_start().starts_with('#'))
        .collect();
    let declares =
        words(&code).any(|word| matches!(word, "uniform" | "varying" | "attribute" | "main" | "struct" | "layout"));
    let has_function = code.replace(char::is_whitespace, "").contains("){");
    !declares && !has_function && code.contains('=')
}

fn of_glsl(
    path: &Path,
    own: &Lines,
    by_ending: ShaderStage,
    options: &ReadOptions,
) -> Result<Vec<ShaderReading>, ShaderError> {
    let sections = hosts::sections(own);
    if !sections.is_empty() {
        let stage = |section: &hosts::Section| section.stage.unwrap_or(by_ending);
        return of_several(sections.iter().map(|section| of_glsl(path, &section.lines, stage(section), options)));
    }
    let mut notes = vec![];
    let own = mended(&macros::included(own, options, &mut notes), &mut notes);
    if let Some(word) = words(&own.text).find(|word| ["EmitVertex", "gl_TessLevelOuter", "gl_TessCoord"].contains(word))
    {
        let line = own.iter().find(|(line, _)| line.contains(word)).map(|(_, number)| number as usize);
        let message = format!(
            "`{word}`: shaders of geometry and tessellation are not read; their steps are those of the stages around them"
        );
        return Err(ShaderError::Invalid { path: path.into(), line, message });
    }
    let stage = stage_of(&own.text, by_ending);
    let is_wrapped = is_statements(&own.text);
    if is_wrapped {
        notes.push("it is statements alone: taken as a function's".into());
    }
    let mut found: Vec<ShaderReading> = vec![];
    let mut unread = None;
    let mut try_one = |called: String, definitions: &Definitions, found: &mut Vec<ShaderReading>| match of_definitions(
        &own,
        definitions,
        is_wrapped,
        stage,
    ) {
        Ok(mut reading) => {
            reading.notes.splice(0..0, notes.iter().cloned());
            reading.configuration = called;
            found.push(reading);
        }
        Err(error) => {
            unread.get_or_insert(error);
        }
    };
    for (called, definitions) in macros::configurations(&own.text, &options.defines) {
        try_one(called, &definitions, &mut found);
    }
    // Where nothing is left without what is asked for, all of it is defined.
    if !found.iter().any(ShaderReading::has_functions) {
        try_one("all that it asks for".into(), &macros::all_asked(&own.text, &options.defines), &mut found);
    }
    if found.is_empty() {
        let (line, message) = unread.unwrap_or((0, "nobody reads it".into()));
        let line = (line > 0).then_some(line as usize);
        return Err(ShaderError::Invalid { path: path.into(), line, message: glsl::shown(&message) });
    }
    found.iter_mut().for_each(|reading| reading.language = version(&own.text));
    Ok(found)
}

impl ShaderReading {
    pub(crate) fn is_vertex(&self) -> bool {
        self.is_vertex || self.module.entry_points.iter().all(|own| own.stage == ShaderStage::Vertex) && self.has_entry
    }

    fn has_functions(&self) -> bool {
        let is_own = |name: &str| name != "main" && !name.starts_with("lightmeter_");
        self.has_entry || self.module.functions.iter().any(|(_, own)| own.name.as_deref().is_some_and(is_own))
    }
}

fn of_definitions(
    own: &Lines,
    definitions: &Definitions,
    is_wrapped: bool,
    stage: ShaderStage,
) -> Result<ShaderReading, (u32, String)> {
    let given = (definitions, is_wrapped);
    let read = |text: &Lines| parsed(&text.text, stage);
    let said = match repaired(own, given, Dialect::Glsl, TURNS_OF_NAGA, &read) {
        Ok(Repaired {
            read: (module, Normalised { text, roles, has_main }),
            lines,
            notes,
            is_partial,
            lacks_functions,
        }) => {
            let places = Places::Text(starts(&text), lines, PRELUDE_LINES);
            let own = ShaderReading::new(module, String::new(), "naga".into(), places);
            let is_vertex = stage == ShaderStage::Vertex;
            return Ok(ShaderReading {
                notes,
                roles,
                has_entry: has_main,
                is_vertex,
                is_partial,
                lacks_functions,
                ..own
            });
        }
        Err(said) => said,
    };
    if !Compiler::Glslang.is_there() {
        let (line, words) = said;
        return Err((line, format!("{words}; glslangValidator might read it, and is not installed")));
    }
    let read = |text: &Lines| by_glslang(&text.text, stage);
    // What naga says is plainer, as it is of the text itself.
    let own = repaired(own, given, Dialect::Glsl, TURNS_OF_GLSLANG, &read).map_err(|_| said)?;
    let Repaired { read: (module, table, roles, has_main), lines, notes, is_partial, lacks_functions } = own;
    let places = Places::Spirv(table, lines, PRELUDE_LINES + 1);
    let reading = ShaderReading::new(module, String::new(), "glslangValidator, through SPIR-V".into(), places);
    let is_vertex = stage == ShaderStage::Vertex;
    Ok(ShaderReading { notes, roles, has_entry: has_main, is_vertex, is_partial, lacks_functions, ..reading })
}

fn parsed(text: &str, stage: ShaderStage) -> Result<(Module, Normalised), Unread> {
    let normalised = glsl::normalised(text);
    let options = glsl_in::Options::from(stage);
    let parse = || glsl_in::Frontend::default().parse(&options, &normalised.text);
    let parsed = std::panic::catch_unwind(std::panic::AssertUnwindSafe(parse));
    let errors = match parsed {
        Ok(Ok(module)) => return Ok((module, normalised)),
        Ok(Err(errors)) => errors,
        Err(_) => return Err(Unread::other(0, "naga ended while reading it")),
    };
    let Some(error) = errors.errors.first() else { return Err(Unread::other(0, errors.to_string())) };
    let line = (error.meta.location(&normalised.text).line_number as usize).saturating_sub(PRELUDE_LINES);
    let what = match &error.kind {
        ErrorKind::UnknownVariable(name) if !name.starts_with("lightmeter_") => Missing::Variable(name.clone()),
        ErrorKind::SemanticError(words) if words.starts_with("Unknown function") => {
            Missing::Function(words.split('\'').nth(1).unwrap_or_default().to_owned())
        }
        kind => Missing::Other(kind.to_string()),
    };
    Err(Unread { line, what })
}

type ByGlslang = (Module, spirv::Table, Vec<(String, Role)>, bool);

fn by_glslang(text: &str, stage: ShaderStage) -> Result<ByGlslang, Unread> {
    let Normalised { text, roles, has_main } = glsl::normalised(text);
    let main = if has_main { "" } else { "void main() {}\n" };
    let text = format!("#version 450\n{text}\n{main}");
    let stage = if stage == ShaderStage::Vertex { "vert" } else { "frag" };
    let bytes = compiler::compiled(Compiler::Glslang, &Source { text: &text, stage, entry: None })
        .map_err(|said| glslang_said(&said, PRELUDE_LINES + 1))?;
    let (module, table) = spirv::read(Path::new(""), &bytes).map_err(|error| Unread::other(0, error.to_string()))?;
    Ok((module, table, roles, has_main))
}

fn glslang_said(said: &str, before: usize) -> Unread {
    // Where nothing is called an error, what it says first is why it did not begin.
    let first = said.lines().find(|line| line.starts_with("ERROR")).or_else(|| said.lines().next()).unwrap_or_default();
    let name = || first.split('\'').nth(1).unwrap_or_default().to_owned();
    let mut parts = first.splitn(4, ':').skip(2);
    let line = parts.next().and_then(|own| own.trim().parse::<usize>().ok()).unwrap_or(0).saturating_sub(before);
    let words =
        parts.next().filter(|words| !words.trim().is_empty()).unwrap_or("its compiler ended without a word").trim();
    let what = if first.contains("undeclared identifier") || first.contains("unknown variable") {
        Missing::Variable(name())
    } else if first.contains("no matching overloaded function found") {
        Missing::Function(name())
    } else {
        Missing::Other(words.to_owned())
    };
    Unread { line, what }
}

fn of_hlsl(path: &Path, own: &Lines, options: &ReadOptions) -> Result<Vec<ShaderReading>, ShaderError> {
    let invalid = |line: Option<usize>, message: String| ShaderError::Invalid { path: path.into(), line, message };
    let installed: Vec<Compiler> = OF_HLSL.into_iter().filter(|own| own.is_there()).collect();
    if installed.is_empty() {
        let message = "HLSL is read by glslangValidator, dxc or slangc, and none is installed".to_owned();
        return Err(ShaderError::Language { path: path.into(), message });
    }
    let mut notes = vec![];
    let included = mended(&macros::included(own, options, &mut notes), &mut notes);
    let included = hlsl::plain(&included, &mut notes);
    let mut text = Lines::default();
    if words(&included.text).any(|word| word == "UnityCG" || word.starts_with("UNITY_") || word.starts_with("fixed")) {
        text.push_all(hosts::OF_UNITY);
    }
    let mut is_technique = false;
    for (line, number) in included.iter() {
        is_technique |= line.trim_start().starts_with("technique");
        // Names of namespaces are parts of names.
        text.push(&if is_technique { String::new() } else { line.replace("::", "_") }, number);
    }
    let entries = hlsl::entries(&text.text);
    let alone = entries.is_empty();
    let entries = if alone { vec![("lightmeter_main".to_owned(), false)] } else { entries };
    if alone {
        text.push("float4 lightmeter_main() : SV_Target { return 0; }", 0);
    }
    let mut found = vec![];
    let mut unread = None;
    for (entry, is_vertex) in entries {
        let stage = if is_vertex { "vert" } else { "frag" };
        for own in &installed {
            let read = |text: &Lines| {
                let source = Source { text: &text.text, stage, entry: Some(&entry) };
                let bytes = compiler::compiled(*own, &source).map_err(|said| glslang_said(&said, 0))?;
                spirv::read(path, &bytes).map_err(|error| Unread::other(0, error.to_string()))
            };
            match repaired(&text, (&options.defines, false), Dialect::Hlsl, TURNS_OF_GLSLANG, &read) {
                Ok(Repaired { read: (module, table), lines, notes: own_notes, is_partial, lacks_functions }) => {
                    let places = Places::Spirv(table, lines, 0);
                    let reader = format!("{}, through SPIR-V", own.name());
                    let reading = ShaderReading::new(module, "HLSL".into(), reader, places);
                    let notes = [&notes[..], &own_notes].concat();
                    found.push(ShaderReading {
                        notes,
                        has_entry: !alone,
                        is_vertex,
                        is_partial,
                        lacks_functions,
                        ..reading
                    });
                    break;
                }
                Err(error) => drop(unread.get_or_insert(error)),
            }
        }
    }
    if !found.is_empty() {
        return Ok(found);
    }
    let (line, message) = unread.unwrap_or((0, "it has no entry point".into()));
    Err(invalid((line > 0).then_some(line as usize), message))
}
