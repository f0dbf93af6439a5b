// Fog: a factor f from the distance, 1 where the air is clear, then a mix from the fog's colour to the surface's.
// requires: vector

struct Fogged {
    f: f32,
    color: vec3f,
}

fn fog_mix(f: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    return Fogged(f, mix(fog, shaded, f));
}

fn fog_planar_distance(p: vec3f) -> f32 {
    return abs(p.z);
}

fn fog_radial_distance(p: vec3f) -> f32 {
    return length(p);
}

fn fog_linear_factor(distance: f32, dmin: f32, dmax: f32) -> f32 {
    if dmin == dmax {
        return select(1.0, 0.0, distance >= dmax);
    }
    return clamp((dmax - distance) / (dmax - dmin), 0.0, 1.0);
}

fn fog_exp_factor(distance: f32, density: f32) -> f32 {
    return clamp(exp(-(density * distance)), 0.0, 1.0);
}

fn fog_exp2_document_factor(distance: f32, density: f32) -> f32 {
    return clamp(exp(-(density * distance * distance)), 0.0, 1.0);
}

fn fog_exp2_opengl_factor(distance: f32, density: f32) -> f32 {
    let t = density * distance;
    return clamp(exp(-(t * t)), 0.0, 1.0);
}

// stable form of: fog_linear_multiply_add
fn fog_linear(p: vec3f, dmin: f32, dmax: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    return fog_mix(fog_linear_factor(fog_planar_distance(p), dmin, dmax), fog, shaded);
}

fn fog_linear_radial(p: vec3f, dmin: f32, dmax: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    return fog_mix(fog_linear_factor(fog_radial_distance(p), dmin, dmax), fog, shaded);
}

fn fog_exp(p: vec3f, density: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    return fog_mix(fog_exp_factor(fog_planar_distance(p), density), fog, shaded);
}

fn fog_exp_radial(p: vec3f, density: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    return fog_mix(fog_exp_factor(fog_radial_distance(p), density), fog, shaded);
}

// stable form of: fog_exp2_document_square
fn fog_exp2_document(p: vec3f, density: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    return fog_mix(fog_exp2_document_factor(fog_planar_distance(p), density), fog, shaded);
}

fn fog_exp2_document_radial(p: vec3f, density: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    return fog_mix(fog_exp2_document_factor(fog_radial_distance(p), density), fog, shaded);
}

// stable form of: fog_exp2_opengl_squares
fn fog_exp2_opengl(p: vec3f, density: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    return fog_mix(fog_exp2_opengl_factor(fog_planar_distance(p), density), fog, shaded);
}

fn fog_exp2_opengl_radial(p: vec3f, density: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    return fog_mix(fog_exp2_opengl_factor(fog_radial_distance(p), density), fog, shaded);
}

// Other forms of the same: some lose what others keep.

fn fog_linear_multiply_add(p: vec3f, dmin: f32, dmax: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    let scale = -1.0 / (dmax - dmin);
    let offset = dmax / (dmax - dmin);
    return fog_mix(clamp(fog_planar_distance(p) * scale + offset, 0.0, 1.0), fog, shaded);
}

fn fog_exp2_document_square(p: vec3f, density: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    let distance = fog_planar_distance(p);
    return fog_mix(clamp(exp(-(density * (distance * distance))), 0.0, 1.0), fog, shaded);
}

fn fog_exp2_opengl_squares(p: vec3f, density: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    let distance = fog_planar_distance(p);
    return fog_mix(clamp(exp(-((density * density) * (distance * distance))), 0.0, 1.0), fog, shaded);
}

fn fog_opacity(distance: f32, density: f32) -> f32 {
    return 1.0 - exp(-(density * distance));
}

// stable form of: fog_opacity
fn fog_opacity_expm1(distance: f32, density: f32) -> f32 {
    return -elementary_exp_m1(-(density * distance));
}

// stable form of: fog_exp_radial
fn fog_exp_radial_scaled(p: vec3f, density: f32, fog: vec3f, shaded: vec3f) -> Fogged {
    return fog_mix(fog_exp_factor(vector_length_scaled(p), density), fog, shaded);
}
