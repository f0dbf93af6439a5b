// Fragments on their way to the depth test. A point covers the pixel of its case and writes its own depth.

struct Fragment {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat, either) depth: f32,
}

struct Written {
    @location(0) number: u32,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn unit_old(@location(0) place: vec2f, @location(1) depths: vec2f) -> Fragment {
    return Fragment(vec4f(place, 0.5, 1.0), depths.y);
}

@vertex
fn unit_new(@location(0) place: vec2f, @location(1) depths: vec2f) -> Fragment {
    return Fragment(vec4f(place, 0.5, 1.0), depths.x);
}

@fragment
fn unit_first(in: Fragment) -> Written {
    return Written(1u, in.depth);
}

@fragment
fn unit_second(in: Fragment) -> Written {
    return Written(2u, in.depth);
}

// What is left: the number of the fragment that is seen, and the depth's bits.

@group(0) @binding(0) var numbers: texture_2d<u32>;
@group(0) @binding(1) var depths: texture_2d<f32>;

@vertex
fn unit_screen(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(select(-1.0, 3.0, corner == 1u), select(-1.0, 3.0, corner == 2u), 0.5, 1.0);
}

@fragment
fn unit_left(@builtin(position) position: vec4f) -> @location(0) vec4u {
    let pixel = vec2i(position.xy);
    let number = textureLoad(numbers, pixel, 0).r;
    return vec4u(bitcast<u32>(f32(number)), bitcast<u32>(textureLoad(depths, pixel, 0).r), 0u, 0u);
}
