// The rasteriser's own interpolation, coverage, culling, depth and provoking vertex, one pixel a case.
//
// Case k is instance k; its row of inputs is read by the vertex shader, and a scissor confines it to its pixel. Values
// leave as bits in an integer target, so that no format converts them. The target is 256 pixels square.

@group(0) @binding(0) var<storage, read> rows: array<f32>;
@group(0) @binding(1) var<uniform> stride: vec4u;

fn raster_input(instance: u32, place: u32) -> f32 {
    return rows[instance * stride.x + place];
}

fn raster_input4(instance: u32, place: u32) -> vec4f {
    return vec4f(
        raster_input(instance, place),
        raster_input(instance, place + 1u),
        raster_input(instance, place + 2u),
        raster_input(instance, place + 3u),
    );
}

// Window coordinates of the target, y down, to clip coordinates with w = 1: exact for multiples of 1/16 pixel.
fn raster_clip(window: vec2f) -> vec4f {
    return vec4f(window.x / 128.0 - 1.0, 1.0 - window.y / 128.0, 0.5, 1.0);
}

struct Attributes {
    // The same in every pipeline, so that a triangle drawn again has the depths that it had.
    @builtin(position) @invariant position: vec4f,
    @location(0) @interpolate(perspective) perspective: f32,
    @location(1) @interpolate(linear) linear: f32,
}

// Row: three (or two) vertices in clip coordinates, as many attributes.
@vertex
fn raster_triangle_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> Attributes {
    let value = raster_input(instance, 12u + corner);
    return Attributes(raster_input4(instance, 4u * corner), value, value);
}

@vertex
fn raster_line_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> Attributes {
    let value = raster_input(instance, 8u + corner);
    return Attributes(raster_input4(instance, 4u * corner), value, value);
}

@fragment
fn raster_attributes(in: Attributes) -> @location(0) vec4u {
    return vec4u(bitcast<u32>(in.perspective), bitcast<u32>(in.linear), 0u, 0u);
}

@fragment
fn raster_position(in: Attributes) -> @location(0) vec4u {
    return bitcast<vec4u>(in.position);
}

@fragment
fn raster_facing(in: Attributes, @builtin(front_facing) front: bool) -> @location(0) vec4u {
    return vec4u(bitcast<u32>(select(0.0, 1.0, front)), 0u, 0u, 0u);
}

@fragment
fn raster_covered(in: Attributes) -> @location(0) vec4u {
    return vec4u(bitcast<u32>(1.0), 0u, 0u, 0u);
}

@fragment
fn raster_covered_again(in: Attributes) -> @location(0) vec4u {
    return vec4u(bitcast<u32>(2.0), 0u, 0u, 0u);
}

// Row: four corners of a quadrilateral in window coordinates, drawn as the triangles 0 1 2 and 0 2 3 and counted.
@vertex
fn raster_quad_vertex(
    @builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32,
) -> @builtin(position) vec4f {
    let order = array(0u, 1u, 2u, 0u, 2u, 3u);
    let place = 2u * order[corner];
    return raster_clip(vec2f(raster_input(instance, place), raster_input(instance, place + 1u)));
}

@fragment
fn raster_count() -> @location(0) vec4f {
    return vec4f(1.0);
}

// Row: a depth, then the pixel. The whole target is covered; the scissor picks the pixel.
struct OwnDepth {
    @builtin(position) position: vec4f,
    @location(0) depth: f32,
}

@vertex
fn raster_depth_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> OwnDepth {
    let x = select(-1.0, 3.0, corner == 1u);
    let y = select(-1.0, 3.0, corner == 2u);
    return OwnDepth(vec4f(x, y, 0.5, 1.0), raster_input(instance, 0u));
}

@fragment
fn raster_own_depth(in: OwnDepth) -> @builtin(frag_depth) f32 {
    return in.depth;
}

// Row: six attributes, the number of the primitive that is looked at, the pixel. Every vertex carries its attribute flat;
// the strip or list is laid out so that the primitive's middle falls on the pixel's centre.
struct Flat {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat, first) value: f32,
}

const POINTS = 0u;
const LINE_LIST = 1u;
const LINE_STRIP = 2u;
const TRIANGLE_LIST = 3u;
const TRIANGLE_STRIP = 4u;

// The first source vertex of primitive m.
fn raster_first_vertex(topology: u32, m: u32) -> u32 {
    switch topology {
        case LINE_LIST: { return 2u * m; }
        case TRIANGLE_LIST: { return 3u * m; }
        default: { return m; }
    }
}

// The hardware takes the first vertex it is given. To have it take the last, primitives are drawn as lists whose corners
// begin with the last one and keep the winding, which alternates along a strip.
fn raster_last_first(topology: u32, drawn: u32) -> u32 {
    switch topology {
        case POINTS: { return drawn; }
        case LINE_LIST, LINE_STRIP: {
            let m = drawn / 2u;
            return raster_first_vertex(topology, m) + 1u - drawn % 2u;
        }
        default: {
            let m = drawn / 3u;
            var corner = (drawn + 2u) % 3u;
            if topology == TRIANGLE_STRIP && m % 2u == 1u && corner != 2u {
                corner = 1u - corner;
            }
            return raster_first_vertex(topology, m) + corner;
        }
    }
}

// Where source vertex v lies, in pixels from source vertex 0.
fn raster_layout(topology: u32, v: u32) -> vec2f {
    switch topology {
        case POINTS, LINE_LIST, LINE_STRIP: { return vec2f(f32(v) * 16.0, 0.0); }
        default: { return vec2f(f32(v) * 8.0, f32(v % 2u) * 24.0); }
    }
}

fn raster_middle(topology: u32, m: u32) -> vec2f {
    let v = raster_first_vertex(topology, m);
    switch topology {
        case POINTS: { return raster_layout(topology, v); }
        case LINE_LIST, LINE_STRIP: { return (raster_layout(topology, v) + raster_layout(topology, v + 1u)) / 2.0; }
        default: {
            return vec2f(raster_layout(topology, v + 1u).x, 12.0);
        }
    }
}

fn raster_flat(instance: u32, topology: u32, v: u32) -> Flat {
    let m = u32(raster_input(instance, 6u));
    let pixel = vec2f(raster_input(instance, 7u), raster_input(instance, 8u));
    let offset = raster_layout(topology, v) - raster_middle(topology, m);
    return Flat(raster_clip(pixel + 0.5 + offset), raster_input(instance, v));
}

@vertex
fn raster_flat_first_vertex(@builtin(vertex_index) drawn: u32, @builtin(instance_index) instance: u32) -> Flat {
    return raster_flat(instance, stride.y, drawn);
}

@vertex
fn raster_flat_last_vertex(@builtin(vertex_index) drawn: u32, @builtin(instance_index) instance: u32) -> Flat {
    return raster_flat(instance, stride.y, raster_last_first(stride.y, drawn));
}

@fragment
fn raster_flat_fragment(in: Flat) -> @location(0) vec4u {
    return vec4u(bitcast<u32>(in.value), 0u, 0u, 0u);
}

// Results on float and depth targets are read as bits.

@group(0) @binding(2) var drawn: texture_2d<f32>;

@vertex
fn raster_screen(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(select(-1.0, 3.0, corner == 1u), select(-1.0, 3.0, corner == 2u), 0.5, 1.0);
}

@fragment
fn raster_result(@builtin(position) position: vec4f) -> @location(0) vec4u {
    return bitcast<vec4u>(textureLoad(drawn, vec2i(position.xy), 0));
}
