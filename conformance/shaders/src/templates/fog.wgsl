// Fog, and ramps, which are fog where their variable is a distance.

//@ ramp right: a straight ramp between two limits, held within 0 and 1
fn ramp(x: f32, start: f32, to: f32) -> f32 { return clamp((x - start) / (to - start), 0.0, 1.0); }
//@ ramp mistake not-clamped weak: a straight ramp between two limits, not held within 0 and 1
fn ramp_open(x: f32, start: f32, to: f32) -> f32 { return (x - start) / (to - start); }
//@ ramp mistake clamped-above-only: a straight ramp, limited to 1 and not held above 0
fn ramp_above(x: f32, start: f32, to: f32) -> f32 { return min((x - start) / (to - start), 1.0); }
//@ ramp mistake clamped-below-only: a straight ramp, held above 0 and not limited to 1
fn ramp_below(x: f32, start: f32, to: f32) -> f32 { return max((x - start) / (to - start), 0.0); }
//@ ramp dialect smoothstep: a ramp by smoothstep
fn ramp_smooth(x: f32, start: f32, to: f32) -> f32 { let t = clamp((x - start) / (to - start), 0.0, 1.0); return t * t * (3.0 - 2.0 * t); }
//@ ramp dialect squared: a ramp, squared
fn ramp_squared(x: f32, start: f32, to: f32) -> f32 { let t = clamp((x - start) / (to - start), 0.0, 1.0); return t * t; }
//@ ramp dialect power: a ramp to a power
fn ramp_power(x: f32, start: f32, to: f32, exponent: f32) -> f32 { return pow(clamp((x - start) / (to - start), 0.0, 1.0), exponent); }
//@ ramp right: a straight ramp between two limits by branches
fn ramp_branches(x: f32, start: f32, to: f32) -> f32 { if (x <= start) { return 0.0; } if (x >= to) { return 1.0; } return (x - start) / (to - start); }
//@ ramp dialect smoothstep falling: a ramp by smoothstep and branches
fn ramp_smooth_branches(x: f32, start: f32, to: f32) -> f32 { if (x <= start) { return 1.0; } if (x >= to) { return 0.0; } let t = clamp((x - to) / (start - to), 0.0, 1.0); return t * t * (3.0 - 2.0 * t); }
//@ ramp dialect smoothstep: a ramp by smoothstep and a branch
fn ramp_smooth_branch(x: f32, start: f32, to: f32) -> f32 { if (x < to) { let t = clamp((x - start) / (to - start), 0.0, 1.0); return t * t * (3.0 - 2.0 * t); } return 1.0; }
//@ ramp right: a straight ramp from a limit on, over a width
fn ramp_width(x: f32, start: f32, width: f32) -> f32 { return clamp((x - start) / width, 0.0, 1.0); }
//@ ramp right falling: one less a straight ramp from a limit on, over a width
fn ramp_width_falling(x: f32, start: f32, width: f32) -> f32 { return 1.0 - clamp((x - start) / width, 0.0, 1.0); }
//@ ramp mistake not-clamped weak: a straight ramp from a limit on, over a width, not held within 0 and 1
fn ramp_width_open(x: f32, start: f32, width: f32) -> f32 { return (x - start) / width; }
//@ ramp right weak: a straight ramp to a limit, held within 0 and 1
fn ramp_to_limit(x: f32, to: f32) -> f32 { return clamp(x / to, 0.0, 1.0); }
//@ ramp right falling: k − k·d/D, held within 0 and 1: a ramp that begins at a share of its end
fn ramp_share(x: f32, k: f32, to: f32) -> f32 { return clamp(k - k * x / to, 0.0, 1.0); }
//@ ramp right falling: (end − d)·scale, held within 0 and 1
fn ramp_scale(x: f32, to: f32, scale: f32) -> f32 { return clamp((to - x) * scale, 0.0, 1.0); }
//@ ramp right: (d − start)·scale, held within 0 and 1
fn ramp_scale_rising(x: f32, start: f32, scale: f32) -> f32 { return clamp((x - start) * scale, 0.0, 1.0); }
//@ ramp right: d·scale + shift, held within 0 and 1
fn ramp_linear(x: f32, scale: f32, k: f32) -> f32 { return clamp(x * scale + k, 0.0, 1.0); }

//@ fog right exp: exp(−density·d)
fn fog_exp(d: f32, density: f32) -> f32 { return exp(-d * density); }
//@ fog right exp-amount: 1 − exp(−density·d), the amount of fog
fn fog_exp_amount(d: f32, density: f32) -> f32 { return 1.0 - exp(-d * density); }
//@ fog right exp: exp(−d/D)
fn fog_exp_range(d: f32, radius: f32) -> f32 { return exp(-d / radius); }
//@ fog right exp-amount: 1 − exp(−d/D), the amount of fog
fn fog_exp_range_amount(d: f32, radius: f32) -> f32 { return 1.0 - exp(-d / radius); }
//@ fog dialect exp-from-a-start: exp(−density·(d − start))
fn fog_exp_start(d: f32, start: f32, density: f32) -> f32 { return exp(-(d - start) * density); }
//@ fog dialect exp-from-a-start: 1 − exp(−density·(d − start)), the amount of fog
fn fog_exp_start_amount(d: f32, start: f32, density: f32) -> f32 { return 1.0 - exp(-(d - start) * density); }
//@ fog dialect exp-from-a-start: exp(−density·max(d − start, 0))
fn fog_exp_start_held(d: f32, start: f32, density: f32) -> f32 { return exp(-max(d - start, 0.0) * density); }
//@ fog dialect exp-from-a-start: 1 − exp(−density·max(d − start, 0)), the amount of fog
fn fog_exp_start_held_amount(d: f32, start: f32, density: f32) -> f32 { return 1.0 - exp(-max(d - start, 0.0) * density); }
//@ fog right exp2-opengl: exp(−(density·d)²)
fn fog_exp2(d: f32, density: f32) -> f32 { return exp(-d * density * d * density); }
//@ fog right exp2-opengl-amount: 1 − exp(−(density·d)²), the amount of fog
fn fog_exp2_amount(d: f32, density: f32) -> f32 { return 1.0 - exp(-d * density * d * density); }
//@ fog dialect exp2-document: exp(−density·d²)
fn fog_exp2_document(d: f32, density: f32) -> f32 { return exp(-d * d * density); }
//@ fog dialect exp2-document-amount: 1 − exp(−density·d²), the amount of fog
fn fog_exp2_document_amount(d: f32, density: f32) -> f32 { return 1.0 - exp(-d * d * density); }
//@ fog dialect exp-power: exp(−(density·d)^k)
fn fog_exp_power(d: f32, density: f32, exponent: f32) -> f32 { return exp(-pow(d * density, exponent)); }
//@ fog dialect exp-power: 1 − exp(−(density·d)^k), the amount of fog
fn fog_exp_power_amount(d: f32, density: f32, exponent: f32) -> f32 { return 1.0 - exp(-pow(d * density, exponent)); }
//@ fog mistake fog-base-two: 2^(−density·d): a power of 2 where one of e is due
fn fog_base_two(d: f32, density: f32) -> f32 { return exp2(-d * density); }
//@ fog mistake fog-base-two: 2^(−(density·d)²): a power of 2 where one of e is due
fn fog_base_two_square(d: f32, density: f32) -> f32 { return exp2(-d * d * density * density); }
//@ fog mistake difference-squared: exp(−(density − d)²): the difference is squared, not the product
fn fog_difference(d: f32, density: f32) -> f32 { return exp(-(density - d) * (density - d)); }
//@ fog mistake fog-exponent-positive: exp(+density·d): the sign is lost
fn fog_positive(d: f32, density: f32) -> f32 { return exp(d * density); }
//@ fog mistake fog-exponent-positive: exp(+(density·d)²): the sign is lost
fn fog_positive_square(d: f32, density: f32) -> f32 { return exp(d * density * d * density); }
//@ fog-distance dialect cylindrical (Minecraft): the distance of a cylinder, max(|p.xz|, |p.y|)
fn distance_cylindrical(offset: vec3f) -> f32 { return max(length(offset.xz), abs(offset.y)); }

//@ mix right weak <f32 vec3f vec4f>: a mix of two colours
fn mixed(color: T, other: T, amount: f32) -> T { return color * (1.0 - amount) + other * amount; }
//@ mix right weak: a mix of two colours, by the fog's alpha too
fn mixed_alpha(color: vec3f, other: vec3f, amount: f32, alpha: f32) -> vec3f { return color * (1.0 - amount * alpha) + other * amount * alpha; }
//@ mix right weak: a mix of a colour and grey
fn mixed_grey(color: vec3f, share: f32, amount: f32) -> vec3f { return color * (1.0 - amount) + vec3f(share) * amount; }
