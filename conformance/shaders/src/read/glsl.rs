//! GLSL of any version as the part of it that naga reads.
//!
//! naga knows the core language of 4.50 for Vulkan, without combined samplers and loose uniforms. What older and other versions say
//! differently stands at the global level alone: declarations of uniforms, varyings, attributes and outputs. They become plain global
//! variables, so that only expressions are left, which all versions share. Lines keep their numbers.

mod fixed_function;

/// What a variable was declared as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The same for all invocations.
    Uniform,
    /// From the stage before.
    Input,
    /// `varying` of older versions: an input of a fragment shader, an output of a vertex shader.
    Varying,
    /// For the stage after.
    Output,
    /// The same, at a location other than 0.
    FurtherOutput,
    /// What is sampled: the value that it gives.
    Texture,
}

/// GLSL that naga reads, and what its global variables were.
#[derive(Debug, Default)]
pub(crate) struct Normalised {
    /// The text. Its lines are those of the original, but for [`PRELUDE_LINES`] before them.
    pub(crate) text: String,
    /// Each variable's name and what it was declared as.
    pub(crate) roles: Vec<(String, Role)>,
    /// Whether it has an entry point of its own.
    pub(crate) has_main: bool,
}

/// Lines that stand before the original ones.
pub(crate) const PRELUDE_LINES: usize = 1;

/// What samples a texture: the texture is the value that it gives.
const SAMPLE: &str = "lightmeter_texture";
/// What asks a texture's size.
const SIZE: &str = "lightmeter_size";
/// What combines a texture and a sampler.
const COMBINE: &str = "lightmeter_combined";
/// The output of versions that have no other.
const COLOR: &str = "lightmeter_FragColor";
/// What follows a name that only naga reserves.
const AS_NAME: &str = "_lightmeter_name";
/// Words that naga reserves, and that some version of GLSL, or the place that they stand in, leaves to names.
const RESERVED: [&str; 10] =
    ["sample", "sampler", "buffer", "shared", "patch", "precise", "coherent", "restrict", "volatile", "subroutine"];

/// The names that people wrote, in a message or as a name.
#[must_use]
pub fn shown(text: &str) -> String {
    text.replace(COLOR, "gl_FragColor").replace(AS_NAME, "").replace(SAMPLE, "texture").replace(SIZE, "textureSize")
}
const HELPERS: &str = "vec4 lightmeter_texture(vec4 t, vec2 at) { return t; } vec4 lightmeter_texture(vec4 t, vec3 at) { return t; } \
    vec4 lightmeter_texture(vec4 t, vec2 at, float bias) { return t; } vec4 lightmeter_texture(vec4 t, vec3 at, float bias) { return t; } \
    vec4 lightmeter_texture(vec4 t, float at) { return t; } vec4 lightmeter_texture(vec4 t, vec4 at) { return t; } \
    vec4 lightmeter_texture(vec4 t, ivec2 at) { return t; } vec4 lightmeter_texture(vec4 t, ivec2 at, int level) { return t; } \
    vec4 lightmeter_texture(vec4 t, ivec3 at, int level) { return t; } vec4 lightmeter_texture(vec4 t, int at) { return t; } \
    vec4 lightmeter_texture(vec4 t, vec2 at, ivec2 by) { return t; } vec4 lightmeter_texture(vec4 t, vec2 at, vec2 dx, vec2 dy) { return t; } \
    vec4 lightmeter_texture(vec4 t, vec3 at, vec3 dx, vec3 dy) { return t; } vec4 lightmeter_texture(vec4 t, vec2 at, float level, ivec2 by) { return t; } \
    float lightmeter_texture(float t, vec3 at) { return t; } float lightmeter_texture(float t, vec4 at) { return t; } \
    float lightmeter_texture(float t, vec3 at, float level) { return t; } vec4 lightmeter_combined(vec4 t, float s) { return t; } \
    vec4 lightmeter_combined(vec4 t, vec4 s) { return t; } float lightmeter_combined(float t, float s) { return t; } \
    ivec2 lightmeter_size(vec4 t) { return ivec2(int(t.x), int(t.y)); } ivec2 lightmeter_size(vec4 t, int l) { return ivec2(int(t.x), int(t.y)); } \
    ivec2 lightmeter_size(float t, int l) { return ivec2(int(t)); } ";

/// Built-in functions that sample.
const SAMPLING: [&str; 21] = [
    "texture",
    "texture2D",
    "texture3D",
    "textureCube",
    "textureCubeLod",
    "texture2DLod",
    "textureLod",
    "texture2DProj",
    "textureProj",
    "texture2DLodEXT",
    "texture2DGradEXT",
    "textureCubeLodEXT",
    "textureLodOffset",
    "textureOffset",
    "textureGrad",
    "texelFetch",
    "texture2DRect",
    "texture2DArray",
    "shadow2D",
    "shadow2DProj",
    "imageLoad",
];
const INTERPOLATION: [&str; 15] = [
    "flat",
    "smooth",
    "noperspective",
    "centroid",
    "sample",
    "invariant",
    "highp",
    "mediump",
    "lowp",
    "patch",
    "readonly",
    "writeonly",
    "restrict",
    "coherent",
    "volatile",
];

/// A word, a mark, or what stands between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Token<'a> {
    Word(&'a str),
    Mark(&'a str),
    /// White space, comments, and lines for the preprocessor.
    Space(&'a str),
}

/// Which of them.
enum Kind {
    Word,
    Mark,
    Space,
}

impl<'a> Token<'a> {
    pub(super) const fn text(self) -> &'a str {
        match self {
            Self::Word(text) | Self::Mark(text) | Self::Space(text) => text,
        }
    }
}

pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut found = vec![];
    let mut rest = text;
    let mut begins_line = true;
    while let Some(first) = rest.chars().next() {
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let (length, kind): (usize, Kind) = if rest.starts_with("//") {
            (rest.find('\n').unwrap_or(rest.len()), Kind::Space)
        } else if rest.starts_with("/*") {
            (rest.find("*/").map_or(rest.len(), |end| end + 2), Kind::Space)
        } else if first == '#' && begins_line {
            (directive(rest), Kind::Space)
        } else if first.is_whitespace() {
            (rest.find(|c: char| !c.is_whitespace()).unwrap_or(rest.len()), Kind::Space)
        } else if first.is_ascii_digit() {
            (rest.find(|c| !is_word(c)).unwrap_or(rest.len()), Kind::Mark)
        } else if first.is_alphabetic() || first == '_' {
            (rest.find(|c: char| !is_word(c) || c == '.').unwrap_or(rest.len()), Kind::Word)
        } else {
            (first.len_utf8(), Kind::Mark)
        };
        let (token, after) = rest.split_at(length);
        begins_line = token.trim().is_empty() && (begins_line || token.contains('\n'));
        found.push(match kind {
            Kind::Word => Token::Word(token),
            Kind::Mark => Token::Mark(token),
            Kind::Space => Token::Space(token),
        });
        rest = after;
    }
    found
}

/// The length of a line for the preprocessor, with those that a backslash continues it by.
fn directive(text: &str) -> usize {
    let mut end = 0;
    for line in text.split_inclusive('\n') {
        end += line.len();
        if !line.trim_end_matches(['\n', '\r']).ends_with('\\') {
            return end - usize::from(line.ends_with('\n'));
        }
    }
    end
}

/// Brings GLSL into what naga reads.
pub(crate) fn normalised(text: &str) -> Normalised {
    let tokens = tokens(text);
    let mut out = Normalised::default();
    let is_color = |token: &Token<'_>| match token {
        Token::Word(word) => matches!(*word, "gl_FragColor" | "gl_FragData"),
        // A macro may stand for it.
        Token::Space(space) => space.starts_with('#') && space.contains("gl_FragColor"),
        Token::Mark(_) => false,
    };
    let uses_color = tokens.iter().any(is_color);
    out.text = HELPERS.to_owned();
    if uses_color {
        out.text += &format!("vec4 {COLOR}; ");
        out.roles.push((COLOR.into(), Role::Output));
    }
    if tokens.contains(&Token::Word("gl_FragData")) {
        (1..8).for_each(|place| out.text += &format!("vec4 {}; ", further_color(place)));
    }
    fixed_function::declare(&tokens, &mut out);
    out.text += "\n";
    let mut place = 0;
    while place < tokens.len() {
        let end = statement(&tokens, place);
        declare(&tokens[place..end], &mut out);
        place = end;
    }
    // naga asks for an entry point, which a file of functions has not.
    out.has_main = tokens.contains(&Token::Word("main"));
    if !out.has_main {
        out.text += "\nvoid main() {}\n";
    }
    out
}

/// Where the statement of the global level that begins at a place ends.
fn statement(tokens: &[Token<'_>], from: usize) -> usize {
    let mut depth = 0_usize;
    // Directives and space before it are a statement of their own.
    if let Token::Space(_) = tokens[from] {
        return from + 1;
    }
    for (k, token) in tokens.iter().enumerate().skip(from) {
        match token {
            Token::Mark("{" | "(" | "[") => depth += 1,
            Token::Mark(")" | "]") => depth = depth.saturating_sub(1),
            Token::Mark(";") if depth == 0 => return k + 1,
            Token::Mark("}") => {
                depth = depth.saturating_sub(1);
                let is_function = || {
                    let before = tokens[from..k].iter().take_while(|token| **token != Token::Mark("{"));
                    before.filter(|token| !matches!(token, Token::Space(_))).last() == Some(&Token::Mark(")"))
                };
                if depth == 0 && is_function() {
                    return k + 1;
                }
            }
            _ => {}
        }
    }
    tokens.len()
}

/// Writes a statement of the global level.
fn declare(statement: &[Token<'_>], out: &mut Normalised) {
    let solid: Vec<usize> = (0..statement.len()).filter(|&k| !matches!(statement[k], Token::Space(_))).collect();
    let at = |k: usize| solid.get(k).map_or(Token::Mark(""), |&place| statement[place]);
    let (mut role, mut is_further) = (None, false);
    let mut first = 0;
    // The qualifiers, a layout's brackets among them.
    loop {
        match at(first) {
            Token::Word("layout") => {
                while !matches!(at(first), Token::Mark(")" | "")) {
                    is_further |= at(first) == Token::Word("location")
                        && !matches!((at(first + 1), at(first + 2)), (Token::Mark("="), Token::Mark("0")));
                    first += 1;
                }
            }
            Token::Word("uniform" | "buffer") => role = Some(Role::Uniform),
            Token::Word("in" | "attribute") => role = Some(Role::Input),
            Token::Word("out") => role = Some(Role::Output),
            Token::Word("varying") => role = Some(Role::Varying),
            Token::Word(word) if INTERPOLATION.contains(&word) => {}
            _ => break,
        }
        first += 1;
    }
    if is_further && role == Some(Role::Output) {
        role = Some(Role::FurtherOutput);
    }
    let start = solid.get(first).copied().unwrap_or(statement.len());
    match (at(first), role) {
        (Token::Word("precision"), _) => blank(statement, &mut out.text),
        (Token::Mark(";"), _) => blank(statement, &mut out.text),
        (_, None) => {
            let (qualifiers, rest) = statement.split_at(if first > 0 { start } else { 0 });
            blank(qualifiers, &mut out.text);
            written(rest, &mut out.text);
        }
        (Token::Word(_), Some(role)) => {
            blank(&statement[..start], &mut out.text);
            let is_struct = at(first) == Token::Word("struct");
            let declared = &statement[if is_struct { start + 1 } else { start }..];
            if is_struct || at(first + 1) == Token::Mark("{") {
                block(declared, role, out)
            } else {
                variables(declared, role, out)
            }
        }
        _ => written(statement, &mut out.text),
    }
}

/// Keeps lines and directives, and nothing else.
fn blank(tokens: &[Token<'_>], text: &mut String) {
    for token in tokens {
        match token {
            Token::Space(space) if space.starts_with('#') => directed(space, text),
            Token::Space(space) => text.extend(space.chars().filter(|c| c.is_whitespace())),
            _ => text.push(' '),
        }
    }
}

/// Writes what is left as it is, but for the names of what is sampled.
fn written(tokens: &[Token<'_>], text: &mut String) {
    let mut skipped = 0;
    for (k, token) in tokens.iter().enumerate() {
        if k < skipped {
            continue;
        }
        let mut after =
            (k + 1..tokens.len()).filter(|&place| !matches!(tokens[place], Token::Space(_))).map(|k| (k, &tokens[k]));
        let next = after.next().map(|(_, token)| token);
        let is_called = next == Some(&Token::Mark("("));
        match *token {
            // Those at a constant place are variables of their own.
            Token::Word("gl_FragData") if next == Some(&Token::Mark("[")) => {
                let (number, close) = (after.next(), after.next());
                let place = number.and_then(|(_, token)| token.text().parse().ok());
                match (place, close) {
                    (Some(place @ 0..8), Some((end, Token::Mark("]")))) => {
                        text.push_str(&if place == 0 { COLOR.to_owned() } else { further_color(place) });
                        skipped = end + 1;
                    }
                    _ => text.push_str(COLOR),
                }
            }
            Token::Word(word) if is_own_name(word, next) => {
                text.push_str(word);
                text.push_str(AS_NAME);
            }
            Token::Space(space) if space.starts_with('#') => directed(space, text),
            Token::Space(space) if space.starts_with('/') => text.extend(space.chars().filter(|c| c.is_whitespace())),
            // What is constant and comes in is what comes in.
            Token::Word("const") if next == Some(&Token::Word("in")) => {}
            Token::Word(word) => text.push_str(renamed(word, is_called)),
            other => text.push_str(other.text()),
        }
    }
}

/// The output that is `gl_FragData` at a place other than 0.
fn further_color(place: usize) -> String {
    format!("lightmeter_FragData{place}")
}

/// Whether a word is a name, though naga reserves it: a type and a qualifier stand before a word.
fn is_own_name(word: &str, next: Option<&Token<'_>>) -> bool {
    RESERVED.contains(&word) && !matches!(next, Some(Token::Word(_)))
}

fn renamed(word: &str, is_called: bool) -> &str {
    match word {
        _ if is_called && SAMPLING.contains(&word) => SAMPLE,
        "textureSize" | "imageSize" if is_called => SIZE,
        "sampler2D" | "samplerCube" | "sampler2DShadow" | "samplerCubeShadow" if is_called => COMBINE,
        "gl_FragColor" | "gl_FragData" => COLOR,
        "highp" | "mediump" | "lowp" => "",
        _ if is_texture(word) => sampled(word),
        _ => word,
    }
}

/// A line for the preprocessor. naga's own takes no other version than its own.
fn directed(line: &str, text: &mut String) {
    let words = line.trim_start_matches('#').trim_start();
    if words.starts_with("version") || words.starts_with("extension") || words.starts_with("pragma") {
        text.extend(line.chars().filter(|c| *c == '\n'));
        return;
    }
    let Some(body) = words.strip_prefix("define") else {
        text.push_str(line);
        return;
    };
    text.push_str("#define");
    written(&tokens(body), text);
}

/// Whether a word is the type of a texture, an image or a sampler: `sampler2D`, `texture2DArray`, `isampler3D`.
pub(super) fn is_texture(word: &str) -> bool {
    const SHAPES: [&str; 13] = [
        "1D",
        "2D",
        "3D",
        "Cube",
        "2DRect",
        "1DArray",
        "2DArray",
        "CubeArray",
        "Buffer",
        "2DMS",
        "2DMSArray",
        "ExternalOES",
        "CubeMap",
    ];
    let plain = word.strip_prefix(['i', 'u']).unwrap_or(word);
    let shape = ["sampler", "texture", "image"].iter().find_map(|start| plain.strip_prefix(start));
    matches!(word, "sampler" | "samplerShadow")
        || shape.is_some_and(|shape| SHAPES.contains(&shape.strip_suffix("Shadow").unwrap_or(shape)))
}

/// The type of what a texture gives.
fn sampled(word: &str) -> &'static str {
    if word == "sampler" || word.ends_with("Shadow") { "float" } else { "vec4" }
}

/// `vec3 a, b[4];` after its qualifiers.
fn variables(tokens: &[Token<'_>], role: Role, out: &mut Normalised) {
    let (mut depth, mut is_name, mut ty) = (0_usize, false, "");
    for token in tokens {
        match *token {
            Token::Word(word)
                if depth == 0 && ty.is_empty() && (word == "uniform" || INTERPOLATION.contains(&word)) => {}
            Token::Word(word) if depth == 0 && ty.is_empty() => {
                ty = word;
                is_name = true;
                out.text.push_str(if is_texture(word) { sampled(word) } else { word });
                continue;
            }
            Token::Word(word) if depth == 0 && is_name => {
                is_name = false;
                let role = if is_texture(ty) { Role::Texture } else { role };
                let end = if is_own_name(word, None) { AS_NAME } else { "" };
                out.roles.push((format!("{word}{end}"), role));
            }
            Token::Mark("(" | "[" | "{") => depth += 1,
            Token::Mark(")" | "]" | "}") => depth -= 1,
            Token::Mark(",") if depth == 0 => is_name = true,
            _ => {}
        }
        written(&[*token], &mut out.text);
    }
}

/// `Name { vec3 a; float b; } instance;` after its qualifiers.
fn block(tokens: &[Token<'_>], role: Role, out: &mut Normalised) {
    let open = tokens.iter().position(|token| *token == Token::Mark("{")).unwrap_or(tokens.len());
    let close = tokens.iter().rposition(|token| *token == Token::Mark("}")).unwrap_or(tokens.len());
    let (name, members, instance) =
        (&tokens[..open], &tokens[open + 1..close], &tokens[(close + 1).min(tokens.len())..]);
    let named = instance.iter().find_map(|token| if let Token::Word(word) = token { Some(*word) } else { None });
    let mut own = Normalised::default();
    // Each member is a declaration, whose qualifiers go.
    for member in members.split_inclusive(|token| *token == Token::Mark(";")) {
        let first = member.iter().position(|token| !matches!(token, Token::Space(_))).unwrap_or(0);
        written(&member[..first], &mut own.text);
        let is_layout = member.get(first) == Some(&Token::Word("layout"));
        let skipped = if is_layout {
            member.iter().position(|token| *token == Token::Mark(")")).map_or(0, |k| k + 1)
        } else {
            first
        };
        variables(&member[skipped..], role, &mut own);
    }
    match named {
        None => {
            blank(name, &mut out.text);
            out.text.push_str(&own.text);
            blank(instance, &mut out.text);
            out.roles.extend(own.roles);
        }
        Some(variable) => {
            let block = name.iter().find_map(|token| if let Token::Word(word) = token { Some(*word) } else { None });
            let block = block.unwrap_or("Block");
            out.text += &format!("struct {block} {{{}}}; {block}", own.text);
            written(instance, &mut out.text);
            out.roles.push((variable.into(), role));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<String> {
        let own = normalised(text);
        own.text.lines().skip(PRELUDE_LINES).map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
    }

    #[test]
    fn interfaces_become_plain_variables_on_their_lines() {
        let text = "#version 330 core\n// a comment\nlayout (location = 0) in vec3 Normal;\nuniform Light { vec3 at; float k; } light;\n\
                    uniform Block {\n  vec3 a;\n  layout(offset = 16) vec3 b;\n};\nuniform sampler2D map;\nout vec4 c;\n\
                    uniform lowp vec3 x, y[2];\nvoid main() { c = texture(map, vec2(0)) * texture2D(map, vec2(1)); }\n";
        assert_eq!(
            lines(text),
            [
                "",
                "",
                "vec3 Normal;",
                "struct Light { vec3 at; float k; }; Light light;",
                "",
                "vec3 a;",
                "vec3 b;",
                "",
                "vec4 map;",
                "vec4 c;",
                "vec3 x, y[2];",
                "void main() { c = lightmeter_texture(map, vec2(0)) * lightmeter_texture(map, vec2(1)); }",
            ]
        );
        let roles = normalised(text).roles;
        let role = |name: &str| roles.iter().find(|(own, _)| own == name).map(|(_, role)| *role);
        assert_eq!(role("Normal"), Some(Role::Input));
        assert_eq!([role("light"), role("a"), role("b"), role("x"), role("y")], [Some(Role::Uniform); 5]);
        assert_eq!([role("map"), role("c")], [Some(Role::Texture), Some(Role::Output)]);
    }

    #[test]
    fn names_that_begin_like_types_are_names() {
        let text = "uniform sampler2D samplerColor, texture1;\nvoid main() { vec4 textureColor = texture(texture1, vec2(0)); float image2 = 1.0; }";
        let own = lines(text);
        assert_eq!(own[0], "vec4 samplerColor, texture1;");
        assert_eq!(
            own[1],
            "void main() { vec4 textureColor = lightmeter_texture(texture1, vec2(0)); float image2 = 1.0; }"
        );
    }

    #[test]
    fn names_that_naga_reserves_are_names() {
        let own = lines("uniform sampler2D sampler;\nvoid main() { vec4 sample = texture2D(sampler, vec2(0)); }");
        assert_eq!(shown(&own[0]), "vec4 sampler;");
        assert_eq!(shown(&own[1]), "void main() { vec4 sample = texture(sampler, vec2(0)); }");
        assert!(own.iter().all(|line| line.contains(AS_NAME)), "{own:?}");
        // Where they are types and qualifiers they stay so.
        let own = lines("vec4 f(sampler s, precise float x) { return vec4(x); }");
        assert_eq!(own[0], "vec4 f(float s, precise float x) { return vec4(x); }");
    }

    #[test]
    fn the_fixed_functions_state_is_declared_where_it_is_used() {
        let own = normalised("void main() { gl_Position = ftransform(); gl_FrontColor = gl_LightSource[1].diffuse; }");
        let names: Vec<&str> = own.roles.iter().map(|(name, _)| &**name).collect();
        assert_eq!(names, ["gl_ModelViewProjectionMatrix", "gl_LightSource", "gl_Vertex", "gl_FrontColor"]);
        assert!(own.text.starts_with(HELPERS) && own.text.lines().count() == PRELUDE_LINES + 1, "{}", own.text);
        let own = normalised("uniform float gl_Normal2;\nvoid main() {}");
        assert_eq!(own.roles.len(), 1, "{:?}", own.roles);
    }

    #[test]
    fn outputs_at_places_are_variables_of_their_own() {
        let own = lines("void main() { gl_FragData[0] = vec4(1); gl_FragData[ 3 ] = vec4(0); }");
        assert_eq!(own[0], "void main() { lightmeter_FragColor = vec4(1); lightmeter_FragData3 = vec4(0); }");
        let own = normalised("layout(location = 1) out vec4 b; layout(location=0) out vec4 a; out vec4 c;");
        let roles: Vec<Role> = own.roles.iter().map(|(_, role)| *role).collect();
        assert_eq!(roles, [Role::FurtherOutput, Role::Output, Role::Output]);
    }

    #[test]
    fn older_versions_are_read_too() {
        let text = "#ifdef GL_ES\nprecision mediump float;\n#endif\nvarying vec3 v_normal;\nvoid main() { gl_FragColor = vec4(v_normal, 1.0); }";
        let own = lines(text);
        assert_eq!(own[1..4], ["", "#endif", "vec3 v_normal;"]);
        assert!(own[4].contains("lightmeter_FragColor = vec4(v_normal, 1.0);"), "{own:?}");
    }
}
