// A light infinitely far away, its vector taken as a unit vector.

@group(0) @binding(10) var<storage, read> scene_directional_unit: SceneDirectionals;

//@ at lights
for (var i = 0u; i < scene_directional_unit.count; i++) {
    let colors = scene_directional_unit.lights[i].colors;
    //@ when normals
    let l = scene_directional_unit.lights[i].toward;
    //@ end
    //@ when weighted
    let weight = 1.0;
    //@ end
    //@ slot shine
}
