// The lit colour of a scene's point: the constant terms, and every light's.
// p the point, n its unit normal, v the unit vector to the viewer, l to the light, all in eye space.

//@ let diffuse_sum = constant | light_ambient | diffuse

// CE + CA. The base is 0 where a surface is lit; the colour itself where it is not.
fn scene_constant() -> vec3f {
    var sum = scene_draw.base;
    //@ slot constant
    return sum;
}

struct SceneSum {
    //@ when diffuse_sum
    diffuse: vec3f,
    //@ end
    //@ when specular
    specular: vec3f,
    //@ end
}

fn scene_lit(
    //@ when vectors_in
    in: SceneVaryings,
    //@ end
    //@ when lit_position
    p: vec3f,
    //@ end
    //@ when normals
    n: vec3f,
    //@ end
) -> vec3f {
    //@ when lights
    var sum: SceneSum;
    //@ if constant
    sum.diffuse = scene_constant();
    //@ end
    //@ when specular
    //@ choose v: vec3f from viewer else vec3f(0.0, 0.0, 1.0)
    //@ end
    //@ slot lights
    //@ when diffuse_sum & specular & !stage_diffuse & !stage_specular
    return sum.diffuse + sum.specular;
    //@ end
    //@ when diffuse_sum & (stage_diffuse | !specular & !stage_specular)
    return sum.diffuse;
    //@ end
    //@ when specular & (stage_specular | !diffuse_sum & !stage_diffuse)
    return sum.specular;
    //@ end
    //@ when stage_diffuse & !diffuse_sum | stage_specular & !specular
    return vec3f(0.0);
    //@ end
    //@ end
    //@ when !lights
    return scene_constant();
    //@ end
}

//@ when vectors_interpolated & (point | spot)
// From p to a light's place: the lights at a point in one row with those within a cone, which come after.
fn scene_toward_at_vertex(number: u32, p: vec3f) -> vec3f {
    //@ when point & spot
    let is_point = number < scene_point.count;
    let spot = select(number - scene_point.count, 0u, is_point);
    let place = select(scene_spot.lights[spot].position, scene_point.lights[number].position, is_point);
    //@ end
    //@ when point & !spot
    let place = scene_point.lights[number].position;
    //@ end
    //@ when spot & !point
    let place = scene_spot.lights[number].position;
    //@ end
    //@ when unit_vectors
    return vector_toward(place, p);
    //@ end
    //@ when !unit_vectors
    return place - p;
    //@ end
}

// The unit vector to a light, from what was interpolated.
fn scene_toward(
    in: SceneVaryings,
    //@ when toward_2
    number: u32,
    //@ end
) -> vec3f {
    var l = in.toward_1;
    //@ when toward_2
    l = select(l, in.toward_2, number == 1u);
    //@ end
    //@ when toward_3
    l = select(l, in.toward_3, number == 2u);
    //@ end
    //@ when toward_4
    l = select(l, in.toward_4, number == 3u);
    //@ end
    return vector_normalize(l);
}
//@ end

// Adds a light's terms.
fn scene_shine(
    sum: ptr<function, SceneSum>,
    colors: SceneColors,
    //@ when normals
    l: vec3f,
    n: vec3f,
    //@ end
    //@ when specular
    v: vec3f,
    //@ end
    //@ when weighted
    weight: f32,
    //@ end
) {
    //@ slot shine_ambient
    //@ when normals
    //@ if spot
    if weight <= 0.0 {
        return;
    }
    //@ end
    //@ when diffuse | gate
    let incidence = lighting_incidence(l, n);
    //@ end
    // Where nothing shines on a face that is turned away.
    //@ if gate | !specular
    if incidence <= 0.0 {
        return;
    }
    //@ end
    //@ slot shine_diffuse
    //@ if specular
    //@ choose highlight: f32 from highlight else 0.0
    //@ choose gated: f32 from gated else highlight
    (*sum).specular += colors.specular * scene_material.specular * gated
        //@ when weighted
        * weight
        //@ end
        ;
    //@ end
    //@ end
}

//@ at shine
scene_shine(
    &sum,
    colors,
    //@ when normals
    l,
    n,
    //@ end
    //@ when specular
    v,
    //@ end
    //@ when weighted
    weight,
    //@ end
);
