//! What OpenGL's fixed function and its shaders up to 1.20 have in common: state and attributes that are there without a declaration.

use super::{Normalised, Role, Token};

/// A variable, its type, what it is for, and the structure that it needs.
type BuiltIn = (&'static str, &'static str, Role, &'static str);

const LIGHT: &str = "struct gl_LightSourceParameters { vec4 ambient; vec4 diffuse; vec4 specular; vec4 position; vec4 halfVector; \
    vec3 spotDirection; float spotExponent; float spotCutoff; float spotCosCutoff; float constantAttenuation; \
    float linearAttenuation; float quadraticAttenuation; };";
const MATERIAL: &str =
    "struct gl_MaterialParameters { vec4 emission; vec4 ambient; vec4 diffuse; vec4 specular; float shininess; };";
const PRODUCT: &str = "struct gl_LightProducts { vec4 ambient; vec4 diffuse; vec4 specular; };";
const MODEL: &str = "struct gl_LightModelParameters { vec4 ambient; };";
const SCENE: &str = "struct gl_LightModelProducts { vec4 sceneColor; };";
const FOG: &str = "struct gl_FogParameters { vec4 color; float density; float start; float end; float scale; };";

/// Section 7.4 to 7.6 of the specification of GLSL 1.20.
const BUILT_IN: [BuiltIn; 31] = [
    ("gl_ModelViewMatrix", "mat4", Role::Uniform, ""),
    ("gl_ProjectionMatrix", "mat4", Role::Uniform, ""),
    ("gl_ModelViewProjectionMatrix", "mat4", Role::Uniform, ""),
    ("gl_ModelViewMatrixInverse", "mat4", Role::Uniform, ""),
    ("gl_ModelViewMatrixTranspose", "mat4", Role::Uniform, ""),
    ("gl_ModelViewMatrixInverseTranspose", "mat4", Role::Uniform, ""),
    ("gl_NormalMatrix", "mat3", Role::Uniform, ""),
    ("gl_NormalScale", "float", Role::Uniform, ""),
    ("gl_LightSource", "gl_LightSourceParameters [8]", Role::Uniform, LIGHT),
    ("gl_FrontMaterial", "gl_MaterialParameters", Role::Uniform, MATERIAL),
    ("gl_BackMaterial", "gl_MaterialParameters", Role::Uniform, MATERIAL),
    ("gl_FrontLightProduct", "gl_LightProducts [8]", Role::Uniform, PRODUCT),
    ("gl_BackLightProduct", "gl_LightProducts [8]", Role::Uniform, PRODUCT),
    ("gl_LightModel", "gl_LightModelParameters", Role::Uniform, MODEL),
    ("gl_FrontLightModelProduct", "gl_LightModelProducts", Role::Uniform, SCENE),
    ("gl_BackLightModelProduct", "gl_LightModelProducts", Role::Uniform, SCENE),
    ("gl_Fog", "gl_FogParameters", Role::Uniform, FOG),
    ("gl_Vertex", "vec4", Role::Input, ""),
    ("gl_Normal", "vec3", Role::Input, ""),
    ("gl_Color", "vec4", Role::Input, ""),
    ("gl_SecondaryColor", "vec4", Role::Input, ""),
    ("gl_FogCoord", "float", Role::Input, ""),
    ("gl_FogFragCoord", "float", Role::Varying, ""),
    ("gl_TexCoord", "vec4 [8]", Role::Varying, ""),
    ("gl_MultiTexCoord0", "vec4", Role::Input, ""),
    ("gl_MultiTexCoord1", "vec4", Role::Input, ""),
    ("gl_MultiTexCoord2", "vec4", Role::Input, ""),
    ("gl_MultiTexCoord3", "vec4", Role::Input, ""),
    ("gl_FrontColor", "vec4", Role::Output, ""),
    ("gl_BackColor", "vec4", Role::FurtherOutput, ""),
    ("gl_FrontSecondaryColor", "vec4", Role::FurtherOutput, ""),
];

/// Declares those that a text uses and does not declare itself.
pub(super) fn declare(tokens: &[Token<'_>], out: &mut Normalised) {
    let uses = |name: &str| tokens.contains(&Token::Word(name));
    let transforms = uses("ftransform");
    let of_transform = |name: &str| transforms && matches!(name, "gl_ModelViewProjectionMatrix" | "gl_Vertex");
    let mut structures = vec![];
    for (name, ty, role, structure) in BUILT_IN {
        if !(uses(name) || of_transform(name)) || out.roles.iter().any(|(own, _)| own == name) {
            continue;
        }
        if !structure.is_empty() && !structures.contains(&structure) {
            structures.push(structure);
            out.text += structure;
        }
        let (ty, size) = ty.split_once(' ').unwrap_or((ty, ""));
        out.text += &format!(" {ty} {name}{size}; ");
        out.roles.push((name.into(), role));
    }
    if transforms {
        out.text += "vec4 ftransform() { return gl_ModelViewProjectionMatrix * gl_Vertex; } ";
    }
}
