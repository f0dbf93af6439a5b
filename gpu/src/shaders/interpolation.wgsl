// Interpolation, coverage and the viewport: first as arithmetic, then by the rasteriser itself.
// alpha beta gamma barycentric weights, a b c the attribute at the vertices, w the homogeneous coordinate; y points down.
// requires: elementary

fn interpolation_line(weights: vec2f, a: f32, b: f32) -> f32 {
    return weights.x * a + weights.y * b;
}

fn interpolation_triangle(weights: vec3f, a: f32, b: f32, c: f32) -> f32 {
    let alpha = weights.x;
    let beta = weights.y;
    let gamma = weights.z;
    return alpha * a + beta * b + gamma * c;
}

// Twice the signed area of a b p. Subtracting a vertex first keeps it exact far from the origin.
fn interpolation_edge(a: vec2f, b: vec2f, p: vec2f) -> f32 {
    let ab = b - a;
    let ap = p - a;
    return ab.x * ap.y - ab.y * ap.x;
}

fn interpolation_weights(a: vec2f, b: vec2f, c: vec2f, p: vec2f) -> vec3f {
    let opposite = vec3f(interpolation_edge(b, c, p), interpolation_edge(c, a, p), interpolation_edge(a, b, p));
    return opposite / interpolation_edge(a, b, c);
}

fn interpolation_scanline(v1: vec2f, v2: vec2f, v3: vec2f, i: vec3f, p: vec2f) -> f32 {
    let ia = (i.x * (p.y - v2.y) + i.y * (v1.y - p.y)) / (v1.y - v2.y);
    let xa = (v1.x * (p.y - v2.y) + v2.x * (v1.y - p.y)) / (v1.y - v2.y);
    let ib = (i.x * (p.y - v3.y) + i.z * (v1.y - p.y)) / (v1.y - v3.y);
    let xb = (v1.x * (p.y - v3.y) + v3.x * (v1.y - p.y)) / (v1.y - v3.y);
    return (ia * (xb - p.x) + ib * (p.x - xa)) / (xb - xa);
}

fn interpolation_forward_differences(a: f32, b: f32) -> f32 {
    let step = (b - a) / 16.0;
    var value = a;
    for (var k = 0u; k < 16u; k++) {
        value += step;
    }
    return value;
}

fn interpolation_perspective(lambda: vec3f, w: vec3f, attr: vec3f) -> f32 {
    let q = lambda / w;
    return interpolation_triangle(q, attr.x, attr.y, attr.z) / (q.x + q.y + q.z);
}

fn interpolation_perspective_line(t: f32, w: vec2f, attr: vec2f) -> f32 {
    let qa = (1.0 - t) / w.x;
    let qb = t / w.y;
    return (qa * attr.x + qb * attr.y) / (qa + qb);
}

fn interpolation_flat_first(attr: vec3f) -> f32 {
    return attr.x;
}

fn interpolation_flat_last(attr: vec3f) -> f32 {
    return attr.z;
}

// Whether p is inside of a -> b, of a triangle wound clockwise as seen, or on it and the edge is a top or a left one.
fn interpolation_owns(a: vec2f, b: vec2f, p: vec2f) -> bool {
    let e = interpolation_edge(a, b, p);
    let goes_up = b.y < a.y;
    let goes_right = b.y == a.y && b.x > a.x;
    return e > 0.0 || (e == 0.0 && (goes_up || goes_right));
}

fn interpolation_coverage(a: vec2f, b: vec2f, c: vec2f, p: vec2f) -> f32 {
    let area = interpolation_edge(a, b, c);
    if area == 0.0 {
        return 0.0;
    }
    let second = select(c, b, area > 0.0);
    let third = select(b, c, area > 0.0);
    let inside = interpolation_owns(a, second, p)
        && interpolation_owns(second, third, p)
        && interpolation_owns(third, a, p);
    return select(0.0, 1.0, inside);
}

fn interpolation_viewport(clip: vec4f, origin: vec2f, size: vec2f, depth: vec2f) -> vec3f {
    let ndc = clip.xyz / clip.w;
    return vec3f(
        origin.x + (ndc.x + 1.0) * 0.5 * size.x,
        origin.y + (1.0 - ndc.y) * 0.5 * size.y,
        depth.x + ndc.z * (depth.y - depth.x),
    );
}

fn interpolation_viewport_opengl(clip: vec4f, origin: vec2f, size: vec2f, depth: vec2f) -> vec3f {
    let ndc = clip.xyz / clip.w;
    return vec3f(
        origin + (ndc.xy + 1.0) * 0.5 * size,
        depth.x + (ndc.z + 1.0) * 0.5 * (depth.y - depth.x),
    );
}

fn interpolation_clip_volume(clip: vec4f) -> f32 {
    let inside = all(abs(clip.xy) <= vec2f(clip.w)) && clip.z >= 0.0 && clip.z <= clip.w;
    return select(0.0, 1.0, inside);
}

fn interpolation_clip_volume_opengl(clip: vec4f) -> f32 {
    return select(0.0, 1.0, all(abs(clip.xyz) <= vec3f(clip.w)));
}

fn interpolation_front_facing(a: vec2f, b: vec2f, c: vec2f) -> f32 {
    return select(0.0, 1.0, interpolation_edge(a, b, c) < 0.0);
}

fn interpolation_frag_depth(depth: f32) -> f32 {
    return clamp(depth, 0.0, 1.0);
}

// Other forms of the same: some lose what others keep.

fn interpolation_edge_from_origin(a: vec2f, b: vec2f, p: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x + b.x * p.y - b.y * p.x + p.x * a.y - p.y * a.x;
}

// stable form of: interpolation_edge interpolation_edge_from_origin
fn interpolation_edge_compensated(a: vec2f, b: vec2f, p: vec2f) -> f32 {
    let ab = b - a;
    let ap = p - a;
    return elementary_difference_of_products(ab.x, ap.y, ab.y, ap.x);
}

// stable form of: interpolation_last_weight_by_difference
fn interpolation_last_weight(a: vec2f, b: vec2f, c: vec2f, p: vec2f) -> f32 {
    return interpolation_edge(a, b, p) / interpolation_edge(a, b, c);
}

fn interpolation_last_weight_by_difference(a: vec2f, b: vec2f, c: vec2f, p: vec2f) -> f32 {
    let weights = interpolation_weights(a, b, c, p);
    return 1.0 - weights.x - weights.y;
}

// stable form of: interpolation_mix_incremental
fn interpolation_mix(a: f32, b: f32, t: f32) -> f32 {
    return a * (1.0 - t) + b * t;
}

fn interpolation_mix_incremental(a: f32, b: f32, t: f32) -> f32 {
    return a + t * (b - a);
}

// The weight of a vertex as a w goes to 0: at most lambda, and lambda itself for the least w.
fn interpolation_scaled_weight(lambda: f32, least: f32, w: f32) -> f32 {
    if w <= least {
        return lambda;
    }
    return lambda * (least / w);
}

// stable form of: interpolation_perspective
fn interpolation_perspective_scaled(lambda: vec3f, w: vec3f, attr: vec3f) -> f32 {
    let least = min(min(w.x, w.y), w.z);
    let q = vec3f(
        interpolation_scaled_weight(lambda.x, least, w.x),
        interpolation_scaled_weight(lambda.y, least, w.y),
        interpolation_scaled_weight(lambda.z, least, w.z),
    );
    return interpolation_triangle(q, attr.x, attr.y, attr.z) / (q.x + q.y + q.z);
}
