//! What a piece of a shader uses and does not declare: it is stubbed, and said.

use super::lines::Lines;
use super::macros::{Definitions, words};
use std::collections::{BTreeSet, HashMap};

/// Why a text is not read.
#[derive(Debug)]
pub(super) enum Unread {
    /// Nobody declares a variable.
    Variable(String),
    /// Nobody declares a function.
    Function(String),
    /// Something else: the line of the text, and what is wrong.
    Other(usize, String),
}

/// Types that a name may have that nobody declares, the likeliest first.
const TYPES: [&str; 9] = ["float", "vec3", "vec4", "vec2", "mat4", "mat3", "int", "bool", "sampler2D"];
/// Functions of the language, of which only the arguments can be wrong.
const BUILT_IN: [&str; 22] = [
    "mix",
    "dot",
    "pow",
    "max",
    "min",
    "clamp",
    "exp",
    "exp2",
    "length",
    "normalize",
    "reflect",
    "smoothstep",
    "step",
    "abs",
    "cross",
    "distance",
    "texture",
    "texture2D",
    "vec3",
    "vec4",
    "vec2",
    "sqrt",
];
/// Words of other languages that hosts define as GLSL's.
const WORDS: [(&str, &str); 20] = [
    ("float2", "float2 vec2"),
    ("float3", "float3 vec3"),
    ("float4", "float4 vec4"),
    ("half2", "half2 vec2"),
    ("half3", "half3 vec3"),
    ("half4", "half4 vec4"),
    ("float3x3", "float3x3 mat3"),
    ("float4x4", "float4x4 mat4"),
    ("f32vec2", "f32vec2 vec2"),
    ("f32vec3", "f32vec3 vec3"),
    ("f32vec4", "f32vec4 vec4"),
    ("float32_t", "float32_t float"),
    ("M_PI", "M_PI 3.14159265"),
    ("PI", "PI 3.14159265"),
    ("mul", "mul(a, b) ((a) * (b))"),
    ("saturate", "saturate(x) clamp((x), 0.0, 1.0)"),
    ("lerp", "lerp(a, b, t) mix((a), (b), (t))"),
    ("frac", "frac(x) fract(x)"),
    ("rsqrt", "rsqrt(x) inversesqrt(x)"),
    ("TEXTURE", "TEXTURE(a, b) texture(a, b)"),
];

/// What stands in the place of what is missing.
#[derive(Default)]
struct Stubs {
    /// Names with the place of their type.
    variables: Vec<(String, usize)>,
    macros: Vec<String>,
    functions: BTreeSet<String>,
}

impl Stubs {
    /// The text after definitions, words of other languages and stubs.
    fn text(&self, own: &Lines, definitions: &Definitions, is_wrapped: bool) -> Lines {
        let mut found = Lines::default();
        for (name, value) in definitions {
            found.push(&format!("#define {name} {value}"), 0);
        }
        let used: BTreeSet<&str> = words(&own.text).collect();
        for (word, definition) in WORDS {
            if used.contains(word) && !is_declared(&own.text, word) {
                found.push(&format!("#define {definition}"), 0);
            }
        }
        for (name, ty) in &self.variables {
            found.push(&format!("uniform {} {name};", TYPES[*ty]), 0);
        }
        self.macros.iter().for_each(|own| found.push(own, 0));
        if is_wrapped {
            found.push("void statements() {", 0);
        }
        found.append(own);
        if is_wrapped {
            found.push("}", 0);
        }
        found
    }

    fn notes(&self) -> Vec<String> {
        let variable = |(name, ty): &(String, usize)| {
            let ty = TYPES[*ty];
            match name.strip_suffix(RESULT) {
                Some(function) => {
                    format!("the function `{function}` is not there: what it gives is taken as a {ty} from outside")
                }
                None => format!("`{name}` is not declared: taken as a {ty} from outside"),
            }
        };
        let own = self.variables.iter().map(variable);
        let passing = self
            .functions
            .iter()
            .filter(|name| !self.variables.iter().any(|(own, _)| own.strip_suffix(RESULT) == Some(&***name)));
        own.chain(passing.map(|name| format!("the function `{name}` is not there: taken to give its argument")))
            .collect()
    }
}

/// What the name of a missing function's value ends with.
const RESULT: &str = "_result";

/// Whether a text defines or declares a word itself.
fn is_declared(text: &str, word: &str) -> bool {
    let declares = |line: &str| {
        let line = line.trim();
        let own: Vec<&str> = words(line).take(5).collect();
        let at = own.iter().position(|own| *own == word);
        match at {
            Some(1) if line.starts_with('#') => own[0] == "define",
            Some(k @ 1..) => {
                matches!(own[k - 1], "float" | "vec2" | "vec3" | "vec4" | "mat3" | "mat4" | "struct" | "int")
                    && !line.starts_with("return")
            }
            _ => false,
        }
    };
    text.lines().any(declares)
}

/// The arguments of a function's first call.
fn arguments<'a>(text: &'a str, name: &str) -> Option<Vec<&'a str>> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut from = 0;
    while let Some(at) = text[from..].find(name).map(|at| at + from) {
        from = at + name.len();
        let rest = text[from..].trim_start();
        let begins = !text[..at].ends_with(is_word);
        if let Some(inner) = rest.strip_prefix('(').filter(|_| begins) {
            let (mut depth, mut start, mut found) = (0, 0, vec![]);
            for (k, c) in inner.char_indices() {
                match c {
                    ')' | ']' if depth == 0 => {
                        let last = inner[start..k].trim();
                        found.extend((!last.is_empty()).then_some(last));
                        return Some(found);
                    }
                    '(' | '[' => depth += 1,
                    ')' | ']' => depth -= 1,
                    ',' if depth == 0 => {
                        found.push(inner[start..k].trim());
                        start = k + 1;
                    }
                    _ => {}
                }
            }
        }
    }
    None
}

/// Whether a call stands as a statement of its own.
fn is_statement(text: &str, name: &str) -> bool {
    text.lines().any(|line| line.trim_start().strip_prefix(name).is_some_and(|rest| rest.trim_start().starts_with('(')))
}

/// Reads a text with stubs for what is missing.
pub(super) fn repaired<T>(
    own: &Lines,
    definitions: &Definitions,
    is_wrapped: bool,
    turns: usize,
    read: &dyn Fn(&Lines) -> Result<T, Unread>,
) -> Result<(T, Lines, Vec<String>), (u32, String)> {
    let mut stubs = Stubs::default();
    // The last whose type was guessed.
    let mut last: Option<String> = None;
    let mut first: Option<(u32, String)> = None;
    let mut seen: HashMap<String, usize> = HashMap::new();
    for _ in 0..turns {
        let text = stubs.text(own, definitions, is_wrapped);
        let unread = match read(&text) {
            Ok(found) => return Ok((found, text, stubs.notes())),
            Err(unread) => unread,
        };
        let is_known = |name: &str| stubs.variables.iter().any(|(own, _)| own == name);
        match unread {
            Unread::Variable(name) if !name.is_empty() && !is_known(&name) => {
                stubs.variables.push((name.clone(), 0));
                last = Some(name);
            }
            Unread::Function(name) if is_missing(&own.text, &name) && !stubs.functions.contains(&name) => {
                let places: Vec<String> =
                    (0..arguments(&own.text, &name).map_or(0, |all| all.len())).map(|k| format!("a{k}")).collect();
                let places_text = places.join(", ");
                stubs.macros.push(if is_statement(&own.text, &name) {
                    format!("#define {name}({places_text}) {{}}")
                } else if places.len() == 1 {
                    format!("#define {name}(a0) (a0)")
                } else {
                    let value = format!("{name}{RESULT}");
                    stubs.variables.push((value.clone(), 0));
                    last = Some(value.clone());
                    format!("#define {name}({places_text}) {value}")
                });
                stubs.functions.insert(name);
            }
            other => {
                // Perhaps the last guess was wrong.
                let said = match other {
                    Unread::Variable(name) => (0, format!("`{name}` is not declared")),
                    Unread::Function(name) => (0, format!("there is no function `{name}` of these arguments")),
                    Unread::Other(line, words) => (text.line(line), words),
                };
                let said = first.get_or_insert(said).clone();
                let guessed = last.as_ref().and_then(|name| stubs.variables.iter_mut().find(|(own, _)| own == name));
                let Some((name, ty)) = guessed else { return Err(said) };
                let tried = seen.entry(name.clone()).or_insert(0);
                *tried += 1;
                if *tried >= TYPES.len() {
                    return Err(said);
                }
                *ty = *tried;
                continue;
            }
        }
        first = None;
    }
    Err(first.unwrap_or((0, "more is missing than is stubbed".into())))
}

fn is_missing(text: &str, name: &str) -> bool {
    !name.is_empty() && !BUILT_IN.contains(&name) && arguments(text, name).is_some()
}
