// Source colours on their way to the fixed-function blend unit. A point covers the pixel of its case.
//
// The driver compiles both stages anew with every blend state, so they do no more than they must: a vertex hands its colour
// on, a fragment writes it.

struct Source {
    @location(0) color: vec4f,
    @location(1) place: vec2f,
}

// One draw's constant, and what of it is folded into the source.
struct Fold {
    @location(2) constant: vec4f,
    // The factor's code in the scene's table; 1 on targets that clamp.
    @location(3) factor: u32,
    @location(4) clamps: u32,
}

struct Colored {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat, either) color: vec4f,
}

@vertex
fn unit_source(source: Source) -> Colored {
    return Colored(vec4f(source.place, 0.5, 1.0), source.color);
}

// Where the unit cannot hold both sides' constants, the source's factor is multiplied in here.
@vertex
fn unit_folded_source(source: Source, fold: Fold) -> Colored {
    var color = source.color.rgb;
    var factor = select(fold.constant.rgb, fold.constant.aaa, fold.factor >= 12u);
    if fold.clamps == 1u {
        color = saturate(color);
        factor = saturate(factor);
    }
    if (fold.factor & 1u) == 1u {
        factor = 1.0 - factor;
    }
    return Colored(vec4f(source.place, 0.5, 1.0), vec4f(color * factor, source.color.a));
}

@fragment
fn unit_color(colored: Colored) -> @location(0) vec4f {
    return colored.color;
}
