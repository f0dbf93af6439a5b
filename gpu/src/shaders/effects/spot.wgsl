// A light within a cone.

struct SceneSpot {
    colors: SceneColors,
    position: vec3f,
    falloff: vec3f,
    exponent: f32,
    axis: vec3f,
    cutoff_cosine: f32,
}

struct SceneSpots {
    count: u32,
    lights: array<SceneSpot, 64>,
}

@group(0) @binding(12) var<storage, read> scene_spot: SceneSpots;

//@ at lights
for (var i = 0u; i < scene_spot.count; i++) {
    let colors = scene_spot.lights[i].colors;
    //@ when weight_used
    //@ when !vectors_interpolated | attenuation
    let position = scene_spot.lights[i].position;
    //@ end
    //@ when !vectors_interpolated
    let l = vector_toward(position, p);
    //@ end
    //@ when vectors_interpolated
    let l = scene_toward(
        in,
        //@ when toward_2 & point
        scene_point.count + i,
        //@ end
        //@ when toward_2 & !point
        i,
        //@ end
    );
    //@ end
    let axis = vector_normalize(scene_spot.lights[i].axis);
    let cutoff_cosine = scene_spot.lights[i].cutoff_cosine;
    //@ choose cone: f32 from cone else attenuation_spot_cutoff(l, axis, cutoff_cosine)
    //@ when attenuation
    let falloff = scene_spot.lights[i].falloff;
    //@ end
    //@ choose weight: f32 from cone_weight else cone
    //@ end
    //@ slot shine
}
