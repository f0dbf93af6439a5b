// A light at a point.

struct ScenePoint {
    colors: SceneColors,
    position: vec3f,
    falloff: vec3f,
}

struct ScenePoints {
    count: u32,
    lights: array<ScenePoint, 64>,
}

@group(0) @binding(11) var<storage, read> scene_point: ScenePoints;

//@ at lights
for (var i = 0u; i < scene_point.count; i++) {
    let colors = scene_point.lights[i].colors;
    //@ when normals & !vectors_interpolated | attenuation
    let position = scene_point.lights[i].position;
    //@ end
    //@ when normals & !vectors_interpolated
    let l = vector_toward(position, p);
    //@ end
    //@ when normals & vectors_interpolated
    let l = scene_toward(
        in,
        //@ when toward_2
        i,
        //@ end
    );
    //@ end
    //@ when attenuation
    let falloff = scene_point.lights[i].falloff;
    //@ end
    //@ when weighted
    //@ choose weight: f32 from weight else 1.0
    //@ end
    //@ slot shine
}
