// The sides of the fixed-function blend unit that are drawn: destinations, sources, and the result read back.
//
// A case is a point that covers one pixel. The driver compiles both stages anew with every blend state, so they do no more
// than they must: a vertex hands its colours on, a fragment writes them.

@group(0) @binding(1) var blended: texture_2d<f32>;

struct Point {
    @location(0) place: vec2f,
    @location(1) source: vec4f,
    @location(2) destination: vec4f,
    @location(3) constant: vec4f,
}

struct Colored {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat, either) color: vec4f,
}

fn unit_point(point: Point, color: vec4f) -> Colored {
    return Colored(vec4f(point.place, 0.5, 1.0), color);
}

@vertex
fn unit_destination(point: Point) -> Colored {
    return unit_point(point, point.destination);
}

@vertex
fn unit_source(point: Point) -> Colored {
    return unit_point(point, point.source);
}

// Where the unit cannot hold both sides' constants, the source's factor is multiplied in here.

@vertex
fn unit_source_constant_color(point: Point) -> Colored {
    return unit_point(point, point.source * point.constant);
}

@vertex
fn unit_source_one_minus_constant_color(point: Point) -> Colored {
    return unit_point(point, point.source * (1.0 - point.constant));
}

@vertex
fn unit_source_constant_alpha(point: Point) -> Colored {
    return unit_point(point, point.source * point.constant.a);
}

@vertex
fn unit_source_one_minus_constant_alpha(point: Point) -> Colored {
    return unit_point(point, point.source * (1.0 - point.constant.a));
}

@fragment
fn unit_color(colored: Colored) -> @location(0) vec4f {
    return colored.color;
}

@vertex
fn unit_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(select(-1.0, 3.0, corner == 1u), select(-1.0, 3.0, corner == 2u), 0.5, 1.0);
}

@fragment
fn unit_result(@builtin(position) position: vec4f) -> @location(0) vec4u {
    return bitcast<vec4u>(textureLoad(blended, vec2i(position.xy), 0));
}
