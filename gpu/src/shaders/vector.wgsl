// Vectors and transforms, in eye space.
// n normal, l surface to light, v surface to eye, i = -l, r mirrored light, h halfway vector.

// max(cosine, 0)^exponent. Drivers differ in pow(0, 0) and pow of a negative base, so neither reaches pow.
fn vector_lobe(cosine: f32, exponent: f32) -> f32 {
    if cosine <= 0.0 {
        return 0.0;
    }
    return pow(cosine, exponent);
}

// The zero vector has no direction: it stays what it is, where drivers would give NaN.
fn vector_normalize(v: vec3f) -> vec3f {
    if dot(v, v) <= 0.0 {
        return vec3f(0.0);
    }
    return normalize(v);
}

fn vector_reflect(i: vec3f, n: vec3f) -> vec3f {
    return i - 2.0 * dot(i, n) * n;
}

fn vector_reflect_toward(l: vec3f, n: vec3f) -> vec3f {
    return -l + 2.0 * dot(l, n) * n;
}

fn vector_halfway(v: vec3f, l: vec3f) -> vec3f {
    return vector_normalize(v + l);
}

fn vector_halfway_unnormalised(v: vec3f, l: vec3f) -> vec3f {
    return v + l;
}

fn vector_normal_modelview(modelview: mat3x3f, n: vec3f) -> vec3f {
    return modelview * n;
}

fn vector_normal_inverse_transpose(modelview: mat3x3f, n: vec3f) -> vec3f {
    let bc = cross(modelview[1], modelview[2]);
    let ca = cross(modelview[2], modelview[0]);
    let ab = cross(modelview[0], modelview[1]);
    return (mat3x3f(bc, ca, ab) * n) / dot(modelview[0], bc);
}

fn vector_light_direction(view: mat4x4f, direction: vec3f) -> vec3f {
    return (view * vec4f(direction, 0.0)).xyz;
}

fn vector_dehomogenise(p: vec4f) -> vec3f {
    if p.w == 0.0 {
        return p.xyz;
    }
    return p.xyz / p.w;
}

fn vector_light_position(modelview: mat4x4f, position: vec4f) -> vec3f {
    return vector_dehomogenise(modelview * position);
}

fn vector_light_with_model(view: mat4x4f, model: mat4x4f, position: vec3f) -> vec3f {
    return (view * (model * vec4f(position, 1.0))).xyz;
}

fn vector_toward(light: vec3f, p: vec3f) -> vec3f {
    return vector_normalize(light - p);
}

fn vector_average_normal(n0: vec3f, n1: vec3f, n2: vec3f) -> vec3f {
    return vector_normalize(n0 + n1 + n2);
}

fn vector_face_normal(a: vec3f, b: vec3f, c: vec3f) -> vec3f {
    return vector_normalize(cross(b - a, c - a));
}
