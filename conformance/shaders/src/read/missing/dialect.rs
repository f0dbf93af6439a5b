//! How a language writes what a stub needs: types, variables, structures.

/// A language of shaders, of which types are named as GLSL names them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Dialect {
    Glsl,
    Hlsl,
    Wgsl,
}

/// Types that a name may have that nobody declares, the likeliest first.
pub(super) const TYPES: [&str; 10] =
    ["float", "vec3", "vec4", "vec2", "mat4", "mat3", "int", "bool", "sampler2D", "sampler"];
/// The types in the order of [`TYPES`].
const HLSL: [&str; 10] =
    ["float", "float3", "float4", "float2", "float4x4", "float3x3", "int", "bool", "Texture2D", "SamplerState"];
/// The types in the order of [`TYPES`].
const WGSL: [&str; 10] = [
    "f32",
    "vec3<f32>",
    "vec4<f32>",
    "vec2<f32>",
    "mat4x4<f32>",
    "mat3x3<f32>",
    "i32",
    "bool",
    "texture_2d<f32>",
    "sampler",
];
/// How many elements an array has of which nobody says it.
const LENGTH: usize = 8;

impl Dialect {
    /// A type of [`TYPES`] in this language; another is the text's own.
    pub(super) fn type_name(self, ty: &str) -> &str {
        let own = match self {
            Self::Glsl => &TYPES,
            Self::Hlsl => &HLSL,
            Self::Wgsl => &WGSL,
        };
        TYPES.iter().position(|known| *known == ty).map_or(ty, |place| own[place])
    }

    /// What is declared for all invocations.
    pub(super) fn uniform(self, name: &str, ty: &str, is_array: bool) -> String {
        let ty = self.type_name(ty);
        match (self, is_array) {
            (Self::Glsl, false) => format!("uniform {ty} {name};"),
            (Self::Glsl, true) => format!("uniform {ty} {name}[{LENGTH}];"),
            (Self::Hlsl, false) => format!("{ty} {name};"),
            (Self::Hlsl, true) => format!("{ty} {name}[{LENGTH}];"),
            (Self::Wgsl, _) if ty.starts_with("texture_") || ty == "sampler" => format!("var {name}: {ty};"),
            (Self::Wgsl, false) => format!("var<uniform> {name}: {ty};"),
            (Self::Wgsl, true) => format!("var<uniform> {name}: array<{ty}, {LENGTH}>;"),
        }
    }

    /// A structure of fields: their names, their types, and whether each is an array.
    pub(super) fn structure(self, name: &str, fields: &[(String, String, bool)]) -> String {
        let field = |(name, ty, is_array): &(String, String, bool)| {
            let ty = self.type_name(ty);
            match (self, is_array) {
                (Self::Wgsl, false) => format!("{name}: {ty}, "),
                (Self::Wgsl, true) => format!("{name}: array<{ty}, {LENGTH}>, "),
                (_, false) => format!("{ty} {name}; "),
                (_, true) => format!("{ty} {name}[{LENGTH}]; "),
            }
        };
        let fields: String = fields.iter().map(field).collect();
        let end = if self == Self::Wgsl { "" } else { ";" };
        format!("struct {name} {{ {fields}}}{end}")
    }
}

/// Whether a word is a type of the languages, whatever it is of.
pub(super) fn is_type(word: &str) -> bool {
    const NAMES: [&str; 11] =
        ["void", "float", "int", "uint", "bool", "half", "double", "fixed", "matrix", "vector", "string"];
    const STARTS: [&str; 14] = [
        "float",
        "int",
        "uint",
        "bool",
        "half",
        "double",
        "min16float",
        "vec",
        "ivec",
        "uvec",
        "bvec",
        "dvec",
        "mat",
        "dmat",
    ];
    const RESOURCES: [&str; 9] =
        ["sampler", "isampler", "usampler", "texture", "Texture", "Sampler", "image", "RWTexture", "StructuredBuffer"];
    let is_size = |rest: &str| {
        !rest.is_empty() && rest.chars().all(|c| matches!(c, '1'..='4' | 'x')) && rest.starts_with(|c| c != 'x')
    };
    super::super::glsl::is_texture(word)
        || NAMES.contains(&word)
        || STARTS.iter().any(|start| word.strip_prefix(start).is_some_and(is_size))
        || RESOURCES.iter().any(|start| {
            word.strip_prefix(start).is_some_and(|rest| {
                rest.is_empty()
                    || rest.starts_with(|c: char| c.is_ascii_digit())
                    || rest.starts_with("Cube")
                    || matches!(rest, "State" | "Shadow" | "ComparisonState")
            })
        })
}

/// Words that are no names of variables and types.
pub(super) const KEYWORDS: [&str; 69] = [
    "return",
    "else",
    "in",
    "out",
    "inout",
    "const",
    "uniform",
    "varying",
    "attribute",
    "struct",
    "highp",
    "mediump",
    "lowp",
    "flat",
    "smooth",
    "centroid",
    "noperspective",
    "invariant",
    "precise",
    "static",
    "extern",
    "volatile",
    "row_major",
    "column_major",
    "nointerpolation",
    "linear",
    "groupshared",
    "layout",
    "precision",
    "if",
    "for",
    "while",
    "do",
    "switch",
    "case",
    "default",
    "discard",
    "break",
    "continue",
    "typedef",
    "cbuffer",
    "tbuffer",
    "technique",
    "pass",
    "compile",
    "register",
    "packoffset",
    "subroutine",
    "buffer",
    "shared",
    "inline",
    "true",
    "false",
    "fn",
    "let",
    "var",
    "type",
    "alias",
    "enable",
    "override",
    "loop",
    "namespace",
    "using",
    "unsigned",
    "patch",
    "coherent",
    "restrict",
    "readonly",
    "writeonly",
];
