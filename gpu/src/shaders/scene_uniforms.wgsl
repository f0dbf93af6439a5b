// What a scene's shader is told, where more than one effect reads it; the others' bindings stand in the effects' own
// files. What decides a branch or ends a loop is in storage: of a uniform Mesa's lavapipe takes the value for a constant and
// compiles the shader anew at each draw.

struct SceneDraw {
    projection: mat4x4f,
    modelview: mat4x4f,
    base: vec3f,
    alpha: f32,
}

struct SceneMaterial {
    emissive: vec3f,
    ambient: vec3f,
    diffuse: vec3f,
    specular: vec3f,
    shininess: f32,
}

struct SceneAmbient {
    color: vec3f,
}

struct SceneFog {
    color: vec3f,
    density: f32,
    dmin: f32,
    dmax: f32,
}

// How a texture is read beyond its edges: 0 as if it were repeated, 1 as at the edge.
struct SceneReading {
    clamps: u32,
}

// One bit an effect.
struct SceneSwitches {
    bits: vec4u,
}

struct SceneColors {
    ambient: vec3f,
    diffuse: vec3f,
    specular: vec3f,
}

struct SceneDirectional {
    colors: SceneColors,
    toward: vec3f,
}

struct SceneDirectionals {
    count: u32,
    lights: array<SceneDirectional, 64>,
}

@group(0) @binding(0) var<uniform> scene_draw: SceneDraw;
@group(0) @binding(1) var<uniform> scene_material: SceneMaterial;
@group(0) @binding(2) var<uniform> scene_ambient: SceneAmbient;
@group(0) @binding(3) var<storage, read> scene_fog: SceneFog;
@group(0) @binding(4) var<storage, read> scene_switches: SceneSwitches;
@group(0) @binding(5) var<storage, read> scene_texture_reading: SceneReading;
@group(0) @binding(6) var scene_texture: texture_2d<f32>;
@group(0) @binding(7) var<storage, read> scene_lightmap_reading: SceneReading;
@group(0) @binding(8) var scene_lightmap: texture_2d<f32>;
