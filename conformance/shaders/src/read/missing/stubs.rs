//! What stands for what a text uses and nobody declares.

use super::super::lines::Lines;
use super::super::macros::{Definitions, words};
use super::dialect::{Dialect, TYPES, is_type};
use super::scan::{self, Use};
use std::collections::BTreeSet;

/// Words of other languages that hosts define as GLSL's.
const WORDS: [(&str, &str); 25] = [
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
    ("sqr", "sqr(x) ((x) * (x))"),
    ("pow2", "pow2(x) ((x) * (x))"),
    ("pow3", "pow3(x) ((x) * (x) * (x))"),
    ("pow4", "pow4(x) ((x) * (x) * (x) * (x))"),
    ("pow5", "pow5(x) ((x) * (x) * (x) * (x) * (x))"),
];
/// Words of Direct3D's effects that its compilers take in any case.
const EFFECTS: [(&str, &str); 3] =
    [("Matrix", "Matrix float4x4"), ("MATRIX", "MATRIX float4x4"), ("Vector", "Vector float4")];
/// The choice of a function that gives its argument.
const PASSES: &str = "";

const fn host_words(dialect: Dialect) -> &'static [(&'static str, &'static str)] {
    match dialect {
        Dialect::Glsl => &WORDS,
        Dialect::Hlsl => &EFFECTS,
        Dialect::Wgsl => &[],
    }
}

/// A choice among types, the likeliest first.
#[derive(Debug)]
struct Guess {
    /// The word by which a line shows that the choice matters there.
    word: String,
    order: Vec<String>,
    at: usize,
}

impl Guess {
    fn ty(&self) -> &str {
        &self.order[self.at]
    }
}

#[derive(Clone, Debug)]
enum Ty {
    Structure(String),
    Guess(usize),
}

#[derive(Debug)]
struct Field {
    name: String,
    is_array: bool,
    ty: Ty,
}

/// Stands for the value of a function that is not there.
fn result(function: &str) -> String {
    format!("{function}_result")
}

/// What is missing, and what stands in its place.
pub(super) struct Stubs {
    dialect: Dialect,
    own: Lines,
    guesses: Vec<Guess>,
    /// Structures: names and fields, those that others need first.
    structures: Vec<(String, Vec<Field>)>,
    variables: Vec<Field>,
    /// Words that stand for nothing; of WGSL extensions that are enabled.
    qualifiers: BTreeSet<String>,
    /// Functions, with the choice of what they give; none of those that stand as statements.
    functions: Vec<(String, Option<usize>)>,
    /// Types of values that were not read.
    unread: BTreeSet<String>,
    notes: Vec<String>,
    pub(super) cuts: usize,
}

/// A chain of fields that is asked of something, and where.
type Chain<'a, 'u> = (Vec<(&'a str, bool)>, &'u Use<'a>);

/// Whether a field chooses components.
fn is_swizzle(word: &str) -> bool {
    word.len() <= 4 && ["xyzw", "rgba", "stpq"].iter().any(|set| word.chars().all(|c| set.contains(c)))
}

/// Types that a name makes likely.
fn by_name(name: &str, dialect: Dialect) -> &'static [&'static str] {
    let lower = name.to_lowercase();
    let has = |of: &[&str]| of.iter().any(|word| lower.contains(word));
    if has(&["samp"]) && dialect != Dialect::Glsl {
        &["sampler"]
    } else if lower.contains("normal") && has(&["toworld", "toview", "toeye", "mat"]) {
        &["mat3", "mat4"]
    } else if lower.ends_with("tbn") {
        &["mat3", "vec3"]
    } else if has(&["matrix", "matrices", "mvp", "projection", "modelview", "toworld", "toclip", "toview"])
        || lower.ends_with("mat")
    {
        &["mat4"]
    } else if lower.ends_with("vertex") || lower.ends_with("position") {
        &["vec3", "vec4"]
    } else if has(&["texcoord", "uv"]) {
        &["vec2"]
    } else if has(&["color", "colour", "normal", "dir", "pos", "albedo", "diffuse", "ambient", "specular", "eye"]) {
        &["vec3", "float"]
    } else {
        &[]
    }
}

/// Types in the order in which they are tried, of something with a name.
fn order(name: &str, chains: &[Chain<'_, '_>], dialect: Dialect) -> Vec<String> {
    let mut likely: Vec<&str> = vec![];
    for (fields, of) in chains {
        if fields.is_empty() && of.is_matrix {
            likely.push("mat4");
        }
        if fields.is_empty() {
            likely.extend(of.declares.filter(|ty| is_type(ty)));
            let word = of.before[1].strip_suffix("Lod").unwrap_or(of.before[1]);
            let is_alone = matches!(of.after, ")" | ",");
            likely.extend(match (word, of.before[2]) {
                _ if !is_alone => None,
                ("normalize" | "reflect" | "cross" | "refract" | "dot" | "distance", "(") => Some("vec3"),
                ("transpose" | "inverse" | "mat3", "(") => Some("mat4"),
                (own, "(") if own.starts_with("texture") || own.starts_with("tex2D") => Some("sampler2D"),
                _ => None,
            });
        }
        if fields.len() == 1 && of.after == "(" {
            likely.push("sampler2D");
        }
    }
    let is_bare = chains.iter().any(|(fields, _)| fields.is_empty());
    let swizzles =
        chains.iter().filter_map(|(fields, _)| fields.first().map(|(word, _)| *word)).filter(|own| is_swizzle(own));
    let place = |c: char| ["xrs", "ygt", "zbp", "waq"].iter().position(|set| set.contains(c)).unwrap_or(0);
    match swizzles.flat_map(|own| own.chars().map(place)).max() {
        Some(2) if is_bare => likely.extend(["vec3", "vec4"]),
        Some(1) if is_bare => likely.extend(["vec2", "vec3"]),
        Some(_) => likely.extend(["vec4", "vec3", "vec2"]),
        None => likely.extend(by_name(name, dialect)),
    }
    let mut found: Vec<String> = vec![];
    let rest = TYPES.iter().filter(|ty| **ty != "sampler" || dialect != Dialect::Glsl);
    for ty in likely.iter().chain(rest) {
        if !found.iter().any(|own| own == ty) {
            found.push((*ty).to_owned());
        }
    }
    found
}

impl Stubs {
    /// Stubs for the types and qualifiers that a text does not declare. Other names follow as the reader reports them.
    pub(super) fn of(own: &Lines, definitions: &Definitions, dialect: Dialect) -> Self {
        let mut stubs = Self {
            dialect,
            own: own.clone(),
            guesses: vec![],
            structures: vec![],
            variables: vec![],
            qualifiers: BTreeSet::new(),
            functions: vec![],
            unread: BTreeSet::new(),
            notes: vec![],
            cuts: 0,
        };
        let text = own.text.clone();
        let code = scan::code(&text);
        let uses = scan::uses(&code);
        let is_given = |word: &str| {
            definitions.iter().any(|(name, _)| name == word) || host_words(dialect).iter().any(|(own, _)| *own == word)
        };
        for (ty, variables) in scan::unknown_types(&text, &code, dialect) {
            if !is_given(ty) {
                stubs.declare_type(ty, &variables, &uses);
            }
        }
        if dialect != Dialect::Wgsl {
            let qualifiers = scan::unknown_qualifiers(&text, &code);
            stubs.qualifiers = qualifiers.into_iter().filter(|word| !is_given(word)).map(str::to_owned).collect();
        }
        // Who reads HLSL says one name at a time, and is a process each time.
        if dialect == Dialect::Hlsl {
            for name in scan::undeclared(&text, &code, &uses) {
                let is_type = stubs.structures.iter().any(|(own, _)| own == name);
                if !is_given(name) && !stubs.qualifiers.contains(name) && !is_type {
                    stubs.declare(name);
                }
            }
        }
        stubs
    }

    fn declare_type(&mut self, ty: &str, variables: &BTreeSet<&str>, uses: &[Use<'_>]) {
        let of = |own: &&Use<'_>| variables.contains(own.name) || own.declares == Some(ty);
        let chains: Vec<Chain<'_, '_>> = uses
            .iter()
            .filter(of)
            .filter(|own| own.declares != Some(ty))
            .map(|own| (own.fields.clone(), own))
            .collect();
        let names = self.structure(ty, chains);
        self.notes.push(format!("the type `{ty}` is declared nowhere: taken as a structure of {names}"));
    }

    /// Declares a structure, and gives the names of its fields.
    fn structure(&mut self, name: &str, chains: Vec<Chain<'_, '_>>) -> String {
        let mut fields: Vec<(&str, bool, Vec<Chain<'_, '_>>)> = vec![];
        for (chain, of) in chains {
            let Some(((field, is_indexed), rest)) = chain.split_first() else { continue };
            let place = fields.iter().position(|(own, ..)| own == field).unwrap_or_else(|| {
                fields.push((field, false, vec![]));
                fields.len() - 1
            });
            fields[place].1 |= is_indexed;
            fields[place].2.push((rest.to_vec(), of));
        }
        let fields: Vec<Field> = fields
            .into_iter()
            .map(|(field, is_array, chains)| Field {
                name: field.to_owned(),
                is_array,
                ty: self.typed(&format!("{name}_{field}"), field, chains),
            })
            .collect();
        let names: Vec<String> = fields.iter().map(|own| format!("`{}`", own.name)).collect();
        self.structures.push((name.to_owned(), fields));
        if names.is_empty() { "nothing that is asked for".into() } else { names.join(", ") }
    }

    /// The type of something of which these fields are asked.
    fn typed(&mut self, structure: &str, word: &str, chains: Vec<Chain<'_, '_>>) -> Ty {
        let is_field = |(fields, of): &Chain<'_, '_>| match &fields[..] {
            [] => false,
            [(_, _)] if of.after == "(" => false,
            [(first, _), ..] => !is_swizzle(first),
        };
        if chains.iter().any(is_field) {
            self.structure(structure, chains);
            return Ty::Structure(structure.to_owned());
        }
        self.guesses.push(Guess { word: word.to_owned(), order: order(word, &chains, self.dialect), at: 0 });
        Ty::Guess(self.guesses.len() - 1)
    }

    /// Declares a variable; false if it is declared already.
    pub(super) fn declare(&mut self, name: &str) -> bool {
        if name.is_empty() || self.variables.iter().any(|own| own.name == name) {
            return false;
        }
        let text = self.own.text.clone();
        let code = scan::code(&text);
        let uses = scan::uses(&code);
        let own: Vec<&Use<'_>> = uses.iter().filter(|own| own.name == name).collect();
        let is_array = own.iter().any(|own| own.is_indexed);
        let of =
            own.iter().find_map(|own| own.declares).filter(|ty| self.structures.iter().any(|(known, _)| known == ty));
        let ty = match of {
            Some(ty) => Ty::Structure(ty.to_owned()),
            None => {
                let mut chains: Vec<Chain<'_, '_>> = own.iter().map(|own| (own.fields.clone(), *own)).collect();
                // `let x = name.a;` asks what is asked of x.
                for of in own
                    .iter()
                    .filter(|own| matches!(own.before[0], "let" | "var") && own.before[2] == "=" && own.after == ";")
                {
                    let others = uses.iter().filter(|own| own.name == of.before[1] && !own.fields.is_empty());
                    chains.extend(others.map(|own| ([of.fields.clone(), own.fields.clone()].concat(), own)));
                }
                self.typed(&format!("{name}_type"), name, chains)
            }
        };
        // The columns of a matrix are elements too.
        let is_matrix = matches!(&ty, Ty::Guess(guess) if self.guesses[*guess].ty().starts_with("mat"));
        self.variables.push(Field {
            name: name.to_owned(),
            is_array: is_array && (!is_matrix || name.ends_with('s')),
            ty,
        });
        true
    }

    /// Enables an extension of WGSL; false if it is enabled.
    pub(super) fn enable(&mut self, extension: &str) -> bool {
        self.dialect == Dialect::Wgsl && self.qualifiers.insert(extension.to_owned())
    }

    /// Takes a word for nothing that a host defines, where it is no name of anything; false if it is known.
    pub(super) fn declare_qualifier(&mut self, word: &str) -> bool {
        let code = scan::code(&self.own.text);
        let stands_alone = code.windows(2).any(|own| own[0] == word && own[1].starts_with(char::is_alphabetic));
        let is_free =
            self.dialect != Dialect::Wgsl && !scan::is_declared(&self.own.text, &code, word) && !word.is_empty();
        stands_alone && is_free && self.qualifiers.insert(word.to_owned())
    }

    /// Whether functions of several arguments, or of none of their value, are called that are not there.
    pub(super) fn lacks_functions(&self) -> bool {
        self.functions.iter().any(|(_, choice)| choice.is_none_or(|guess| self.guesses[guess].ty() != PASSES))
    }

    /// Stands for a function; false if it stands for it already, or the text has one of this name.
    pub(super) fn declare_function(&mut self, name: &str) -> bool {
        let code = scan::code(&self.own.text);
        let is_declared = code
            .windows(3)
            .any(|own| own[1] == name && own[2] == "(" && (is_type(own[0]) || scan::is_name(own[0]) || own[0] == "fn"));
        if is_declared || BUILT_IN.contains(&name) || self.functions.iter().any(|(own, _)| own == name) {
            return false;
        }
        let Some(call) = scan::call(&self.own.text, name, 0) else { return false };
        if call.is_statement {
            self.functions.push((name.to_owned(), None));
            return true;
        }
        let chains: Vec<Chain<'_, '_>> = vec![];
        let mut order = order(name, &chains, self.dialect);
        let declares = code
            .windows(4)
            .find(|own| own[2] == "=" && own[3] == name)
            .map(|own| own[0])
            .filter(|ty| is_type(ty) || self.structures.iter().any(|(own, _)| own == ty));
        if call.arguments == 1 {
            order.insert(0, PASSES.into());
        }
        order.splice(0..0, declares.map(str::to_owned));
        self.guesses.push(Guess { word: name.to_owned(), order, at: 0 });
        self.functions.push((name.to_owned(), Some(self.guesses.len() - 1)));
        true
    }

    /// Choices that matter on a line of the text, from 1 and without what stands before it.
    pub(super) fn candidates(&self, line: usize) -> Vec<usize> {
        let line = self.own.text.lines().nth(line.saturating_sub(1)).unwrap_or_default();
        let used: BTreeSet<&str> = words(line).collect();
        let mut found: Vec<usize> =
            (0..self.guesses.len()).filter(|&k| used.contains(&*self.guesses[k].word)).collect();
        found.reverse();
        found
    }

    pub(super) fn chosen(&self, guess: usize) -> usize {
        self.guesses[guess].at
    }

    pub(super) fn choices(&self, guess: usize) -> usize {
        self.guesses[guess].order.len()
    }

    pub(super) fn choose(&mut self, guess: usize, at: usize) {
        self.guesses[guess].at = at;
    }

    /// Leaves out what stands on a line, from 1; false if it cannot.
    pub(super) fn cut(&mut self, line: usize, why: &str) -> bool {
        let Some(cut) = super::cut::cut(&self.own.text, line, self.dialect) else { return false };
        let has_function =
            |text: &str| scan::code(text).windows(2).any(|own| own[0] == ")" && matches!(own[1], "{" | "-" | ":"));
        if cut.text == self.own.text || !has_function(&cut.text) {
            return false;
        }
        self.own = self.own.with_text(&cut.text);
        self.unread.extend(cut.ty);
        self.cuts += 1;
        self.notes
            .push(format!("line {} is not read, and what it gives is taken from outside: {why}", self.own.line(line)));
        true
    }

    /// The text with all of this, and how many lines stand before the file's own.
    pub(super) fn text(&self, definitions: &Definitions, is_wrapped: bool) -> (Lines, usize) {
        let mut found = Lines::default();
        if self.dialect != Dialect::Wgsl {
            for (name, value) in definitions {
                found.push(&format!("#define {name} {value}"), 0);
            }
            self.qualifiers.iter().for_each(|word| found.push(&format!("#define {word}"), 0));
        } else {
            self.qualifiers.iter().for_each(|word| found.push(&format!("enable {word};"), 0));
        }
        let mut text = self.own.text.clone();
        for (name, choice) in &self.functions {
            text = without_calls(&text, name, choice.map(|guess| self.guesses[guess].ty()));
        }
        let code = scan::code(&text);
        let used: BTreeSet<&str> = words(&text).collect();
        for (word, definition) in host_words(self.dialect) {
            if used.contains(word) && !scan::is_declared(&text, &code, word) {
                found.push(&format!("#define {definition}"), 0);
            }
        }
        for (name, fields) in &self.structures {
            let none = ("lightmeter_none".to_owned(), "float".to_owned(), false);
            let own = fields.iter().map(|own| (own.name.clone(), self.type_of(&own.ty).to_owned(), own.is_array));
            let own: Vec<_> = own.chain(fields.is_empty().then_some(none)).collect();
            found.push(&self.dialect.structure(name, &own), 0);
        }
        for own in &self.variables {
            found.push(&self.dialect.uniform(&own.name, self.type_of(&own.ty), own.is_array), 0);
        }
        for (name, choice) in &self.functions {
            if let Some(ty) = choice.map(|guess| self.guesses[guess].ty()).filter(|ty| *ty != PASSES) {
                found.push(&self.dialect.uniform(&result(name), ty, false), 0);
            }
        }
        for ty in &self.unread {
            found.push(&self.dialect.uniform(&format!("{}{ty}", super::cut::UNREAD), ty, false), 0);
        }
        if is_wrapped {
            found.push("void statements() {", 0);
        }
        let before = found.text.lines().count();
        found.append(&self.own.with_text(&text));
        if is_wrapped {
            found.push("}", 0);
        }
        (found, before)
    }

    fn type_of<'a>(&'a self, ty: &'a Ty) -> &'a str {
        match ty {
            Ty::Structure(name) => name,
            Ty::Guess(guess) => self.guesses[*guess].ty(),
        }
    }

    /// What was taken for what is not there, in sentences.
    pub(super) fn notes(&self) -> Vec<String> {
        let shown = |ty: &Ty| match ty {
            Ty::Structure(_) => "structure".to_owned(),
            Ty::Guess(_) => self.dialect.type_name(self.type_of(ty)).to_owned(),
        };
        let variables = self
            .variables
            .iter()
            .map(|own| format!("`{}` is not declared: taken as a {} from outside", own.name, shown(&own.ty)));
        let functions =
            self.functions.iter().map(|(name, choice)| match choice.map(|guess| self.guesses[guess].ty()) {
                None => format!("the function `{name}` is not there: its call is left out"),
                Some(PASSES) => format!("the function `{name}` is not there: taken to give its argument"),
                Some(ty) => format!(
                    "the function `{name}` is not there: what it gives is taken as a {} from outside",
                    self.dialect.type_name(ty)
                ),
            });
        self.notes.iter().cloned().chain(variables).chain(functions).collect()
    }
}

/// Functions of the languages, of which only the arguments can be wrong.
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

/// A text in which the calls of a function are what it gives: its argument, or a value from outside; none of statements.
fn without_calls(text: &str, name: &str, ty: Option<&str>) -> String {
    let mut text = text.to_owned();
    let mut from = 0;
    while let Some(call) = scan::call(&text, name, from) {
        let whole = &text[call.start..call.end];
        let lines: String = whole.chars().filter(|c| *c == '\n').collect();
        let by = match ty {
            Some(PASSES) if call.arguments == 1 => whole[name.len()..].to_owned(),
            None => lines,
            Some(_) if call.is_statement => lines,
            Some(_) => result(name) + &lines,
        };
        text.replace_range(call.start..call.end, &by);
        // A call may be among the arguments of another.
        from = call.start;
    }
    text
}
