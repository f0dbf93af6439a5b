// Shaders to start from: right ones, and ones with the mistakes that people make.

const blinn = (half) => `// Blinn's highlight. Edit it, and see what changes.
precision highp float;

varying vec3 vNormal;
varying vec3 vPosition;
uniform vec3 uAmbient;
uniform vec3 uDiffuse;
uniform vec3 uSpecular;
uniform vec3 uLightDir;
uniform float uShininess;

void main() {
    vec3 n = normalize(vNormal);
    vec3 l = normalize(uLightDir);
    vec3 v = normalize(-vPosition);
    vec3 h = ${half};
    // Some drivers' pow(0.0, x) is not 0 where x is small.
    float c = dot(n, h);
    float highlight = c > 0.0 ? pow(c, uShininess) : 0.0;
    vec3 color = uAmbient + uDiffuse * max(dot(n, l), 0.0) + uSpecular * highlight;
    gl_FragColor = vec4(color, 1.0);
}
`;

export const EXAMPLES = [
  { title: "Blinn, right (GLSL)", language: "glsl", formula: "lighting/blinn", text: blinn("normalize(l + v)") },
  { title: "Blinn, the half vector not normalised (GLSL)", language: "glsl", formula: "lighting/blinn", text: blinn("(l + v) * 0.5") },
  {
    title: "Diffuse light, half Lambert (WGSL)",
    language: "wgsl",
    formula: "lighting/diffuse-toward",
    function: "diffuse",
    text: `// Diffuse light, but wrapped round the surface.
fn diffuse(n: vec3f, l: vec3f, lightColor: vec3f, albedo: vec3f) -> vec3f {
    let wrapped = 0.5 * dot(n, l) + 0.5;
    return lightColor * albedo * wrapped * wrapped;
}
`,
  },
  {
    title: "Exponential fog, right (WGSL)",
    language: "wgsl",
    formula: "fog/exp",
    function: "fogged",
    text: `// The colour of a surface in fog.
fn fogged(color: vec3f, fogColor: vec3f, fogDensity: f32, distance: f32) -> vec3f {
    let f = clamp(exp(-fogDensity * distance), 0.0, 1.0);
    return mix(fogColor, color, f);
}
`,
  },
  {
    title: "Squared exponential fog, the density not squared (GLSL)",
    language: "glsl",
    formula: "fog/exp2-opengl",
    function: "applyFog",
    text: `// OpenGL's EXP2 fog squares the product of density and distance.
vec3 applyFog(vec3 color, vec3 fogColor, float fogDensity, float distance) {
    float f = clamp(exp(-fogDensity * distance * distance), 0.0, 1.0);
    return mix(fogColor, color, f);
}
`,
  },
];
