// Vectors and transforms, in eye space.
// n normal, l surface to light, v surface to eye, i = -l, r mirrored light, h halfway vector.
// requires: elementary

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

// stable form of: vector_halfway_unguarded
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

// Stable forms beside the published ones, and two without their guards.

fn vector_normalize_unguarded(v: vec3f) -> vec3f {
    return normalize(v);
}

fn vector_largest(v: vec3f) -> f32 {
    return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

// Brought near 1 by a power of two first, so that no square overflows or underflows.
// stable form of: vector_normalize vector_normalize_unguarded
fn vector_normalize_scaled(v: vec3f) -> vec3f {
    let largest = vector_largest(v);
    if largest <= 0.0 {
        return vec3f(0.0);
    }
    return normalize(v * elementary_binary_scale(largest));
}

fn vector_length(v: vec3f) -> f32 {
    return length(v);
}

// stable form of: vector_length fog_radial_distance
fn vector_length_scaled(v: vec3f) -> f32 {
    let largest = vector_largest(v);
    if largest <= 0.0 {
        return 0.0;
    }
    let scale = elementary_binary_scale(largest);
    return length(v * scale) * (1.0 / scale);
}

fn vector_halfway_unguarded(v: vec3f, l: vec3f) -> vec3f {
    return normalize(v + l);
}

fn vector_reflect_any_normal(i: vec3f, n: vec3f) -> vec3f {
    return vector_reflect(i, vector_normalize_scaled(n));
}

fn vector_normal_by_determinant(modelview: mat3x3f, n: vec3f) -> vec3f {
    return vector_normalize(vector_normal_inverse_transpose(modelview, n));
}

fn vector_near_one(v: vec3f) -> vec3f {
    return v * elementary_binary_scale(vector_largest(v));
}

// Without the division by the determinant: only its sign is of use, which turns the cofactors round under reflection. Each
// column is brought near 1 first, and so is n, whose components are then scaled as the columns are.
// stable form of: vector_normal_by_determinant
fn vector_normal_by_cofactors(modelview: mat3x3f, n: vec3f) -> vec3f {
    let scales = vec3f(
        elementary_binary_scale(vector_largest(modelview[0])),
        elementary_binary_scale(vector_largest(modelview[1])),
        elementary_binary_scale(vector_largest(modelview[2])),
    );
    let a = modelview[0] * scales.x;
    let b = modelview[1] * scales.y;
    let c = modelview[2] * scales.z;
    let bc = cross(b, c);
    let normal = vector_normalize_scaled(mat3x3f(bc, cross(c, a), cross(a, b)) * vector_near_one(vector_near_one(n) * scales));
    return select(-normal, normal, dot(a, vector_near_one(bc)) >= 0.0);
}

fn vector_cross_compensated(a: vec3f, b: vec3f) -> vec3f {
    return vec3f(
        elementary_difference_of_products(a.y, b.z, a.z, b.y),
        elementary_difference_of_products(a.z, b.x, a.x, b.z),
        elementary_difference_of_products(a.x, b.y, a.y, b.x),
    );
}

// stable form of: vector_face_normal
fn vector_face_normal_compensated(a: vec3f, b: vec3f, c: vec3f) -> vec3f {
    return vector_normalize_scaled(vector_cross_compensated(vector_near_one(b - a), vector_near_one(c - a)));
}

fn vector_interpolated_normal(n0: vec3f, n1: vec3f, face: vec3f, t: f32) -> vec3f {
    return vector_normalize(mix(n0, n1, t));
}

// What is left of opposite normals is their rounding: the face's own normal stands in below 2^-10.
// stable form of: vector_interpolated_normal
fn vector_interpolated_normal_guarded(n0: vec3f, n1: vec3f, face: vec3f, t: f32) -> vec3f {
    let n = mix(n0, n1, t);
    if dot(n, n) >= 0x1p-20 {
        return vector_normalize(n);
    }
    return vector_normalize(face);
}

// max(a.b, 0)^exponent.
fn vector_cosine_power(a: vec3f, b: vec3f, exponent: f32) -> f32 {
    return vector_lobe(dot(a, b), exponent);
}

// The same by q = 1 - cosine from the chord between a and b, of which a cosine near 1 has lost all below 2^-24.
// stable form of: vector_cosine_power
fn vector_cosine_power_by_chord(a: vec3f, b: vec3f, exponent: f32) -> f32 {
    let between = a - b;
    let q = 0.5 * dot(between, between);
    if exponent <= 64.0 || q >= 0.5 {
        return vector_cosine_power(a, b, exponent);
    }
    return exp(exponent * elementary_ln_1p(-q));
}
