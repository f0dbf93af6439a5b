enable dual_source_blending;
// The blend unit with two source colours: the second holds the blend constant, of which the unit has no alpha factor.

struct Colored {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat, either) color: vec4f,
    @location(1) @interpolate(flat, either) constant: vec4f,
}

struct TwoColors {
    @location(0) @blend_src(0) color: vec4f,
    @location(0) @blend_src(1) constant: vec4f,
}

@vertex
fn unit_dual_source(
    @location(0) color: vec4f,
    @location(1) place: vec2f,
    @location(2) constant: vec4f,
) -> Colored {
    return Colored(vec4f(place, 0.5, 1.0), color, constant);
}

@fragment
fn unit_color(colored: Colored) -> TwoColors {
    return TwoColors(colored.color, colored.constant);
}
