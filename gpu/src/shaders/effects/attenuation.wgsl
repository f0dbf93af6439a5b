// Light that weakens with distance.

// Outside of the cone there is no light, however near: 0 times infinity would not be 0.
fn scene_cone_weight(cone: f32, falloff: vec3f, position: vec3f, p: vec3f) -> f32 {
    if cone <= 0.0 {
        return 0.0;
    }
    return attenuation_point(falloff.x, falloff.y, falloff.z, position, p) * cone;
}

//@ at weight
attenuation_point(falloff.x, falloff.y, falloff.z, position, p)

//@ at cone_weight
scene_cone_weight(cone, falloff, position, p)
