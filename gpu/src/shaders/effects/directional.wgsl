// A light infinitely far away, its vector normalised.

@group(0) @binding(9) var<storage, read> scene_directional: SceneDirectionals;

//@ at lights
for (var i = 0u; i < scene_directional.count; i++) {
    let colors = scene_directional.lights[i].colors;
    //@ when normals
    let l = vector_normalize(scene_directional.lights[i].toward);
    //@ end
    //@ when weighted
    let weight = 1.0;
    //@ end
    //@ slot shine
}
