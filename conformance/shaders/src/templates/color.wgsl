// Transfer functions, tone curves, blend modes.

//@ gamma right weak <f32 vec3f vec4f>: a power of the colour
fn gamma(color: T, power: f32) -> T { return pow(color, T(power)); }
//@ gamma right weak <vec3f vec4f>: the root of the colour, a power of 1/2
fn gamma_root(color: T) -> T { return sqrt(color); }
//@ srgb right encode <f32 vec3f>: sRGB's encoding
fn srgb_encode(color: T) -> T { return select(1.055 * pow(color, T(1.0 / 2.4)) - 0.055, 12.92 * color, color <= T(0.0031308)); }
//@ srgb right decode <f32 vec3f>: sRGB's decoding
fn srgb_decode(color: T) -> T { return select(pow((color + 0.055) / 1.055, T(2.4)), color / 12.92, color <= T(0.04045)); }
//@ srgb mistake threshold <f32 vec3f>: sRGB's decoding with 0.4045 for 0.04045
fn srgb_decode_late(color: T) -> T { return select(pow((color + 0.055) / 1.055, T(2.4)), color / 12.92, color <= T(0.4045)); }
//@ srgb mistake threshold <f32 vec3f>: sRGB's encoding with decoding's threshold 0.04045
fn srgb_encode_late(color: T) -> T { return select(1.055 * pow(color, T(1.0 / 2.4)) - 0.055, 12.92 * color, color <= T(0.04045)); }
//@ srgb right decode (Chilliant 2012) <f32 vec3f>: sRGB's decoding by a polynomial
fn srgb_decode_polynomial(color: T) -> T { return color * (color * (color * 0.305306011 + 0.682171111) + 0.012522878); }

//@ tone dialect reinhard (Reinhard 2002) <f32 vec3f>: Reinhard's curve c/(c + 1)
fn reinhard(color: T) -> T { return color / (color + T(1.0)); }
//@ tone dialect reinhard (Reinhard 2002) <f32 vec3f>: Reinhard's curve of an exposed colour
fn reinhard_exposed(color: T, k: f32) -> T { return color * k / (color * k + T(1.0)); }
//@ tone dialect reinhard-extended (Reinhard 2002) <f32 vec3f>: Reinhard's curve with a white point
fn reinhard_extended(color: T, k: f32) -> T { return color * (T(1.0) + color / (k * k)) / (color + T(1.0)); }
//@ tone dialect reinhard-extended (Reinhard 2002) <f32 vec3f>: Reinhard's curve with a white point that is squared already
fn reinhard_extended_square(color: T, k: f32) -> T { return color * (T(1.0) + color / k) / (color + T(1.0)); }
//@ tone dialect aces (Hill) <f32 vec3f>: the fit of ACES's reference and output transforms
fn aces_hill(color: T) -> T { return (color * (color + 0.0245786) - 0.000090537) / (color * (0.983729 * color + 0.4329510) + 0.238081); }
//@ tone dialect exposure <vec3f>: 1 − exp(−k·c)
fn exposure(color: T, k: f32) -> T { return T(1.0) - exp(-color * k); }
//@ tone dialect aces (Narkowicz 2015) <f32 vec3f>: the fit of ACES's curve
fn aces(color: T) -> T { return (color * (2.51 * color + 0.03)) / (color * (2.43 * color + 0.59) + 0.14); }
//@ tone dialect aces (Narkowicz 2015) <f32 vec3f>: the fit of ACES's curve, held within 0 and 1
fn aces_held(color: T) -> T { return clamp((color * (2.51 * color + 0.03)) / (color * (2.43 * color + 0.59) + 0.14), T(0.0), T(1.0)); }
//@ tone dialect uncharted (Hable 2010) <f32 vec3f>: Hable's curve
fn uncharted(color: T) -> T { return (color * (0.15 * color + 0.05) + 0.004) / (color * (0.15 * color + 0.5) + 0.06) - 0.02 / 0.3; }
//@ tone dialect filmic (Hejl and Burgess-Dawson 2010) <f32 vec3f>: Hejl's curve, encoded already
fn filmic(color: T) -> T { let x = max(color - 0.004, T(0.0)); return (x * (6.2 * x + 0.5)) / (x * (6.2 * x + 1.7) + 0.06); }

//@ blend right screen <f32 vec3f vec4f>: screen, 1 − (1 − a)(1 − b)
fn screen(color: T, other: T) -> T { return T(1.0) - (T(1.0) - color) * (T(1.0) - other); }
//@ blend right add <vec3f vec4f>: add, held below 1
fn linear_dodge(color: T, other: T) -> T { return clamp(color + other, T(0.0), T(1.0)); }
//@ blend right overlay <f32 vec3f vec4f>: overlay
fn overlay(color: T, other: T) -> T { return select(T(1.0) - 2.0 * (T(1.0) - color) * (T(1.0) - other), 2.0 * color * other, color < T(0.5)); }
//@ blend right color-dodge <f32 vec3f vec4f>: colour dodge
fn dodge(color: T, other: T) -> T { return min(color / (T(1.0) - other), T(1.0)); }
//@ blend right color-burn <f32 vec3f vec4f>: colour burn
fn burn(color: T, other: T) -> T { return max(T(1.0) - (T(1.0) - color) / other, T(0.0)); }
//@ blend right soft-light (Photoshop) <f32 vec3f vec4f>: soft light
fn soft_light(color: T, other: T) -> T { return select(sqrt(color) * (2.0 * other - T(1.0)) + 2.0 * color * (T(1.0) - other), 2.0 * color * other + color * color * (T(1.0) - 2.0 * other), other < T(0.5)); }
//@ blend right soft-light (Pegtop) <f32 vec3f vec4f>: soft light
fn soft_light_pegtop(color: T, other: T) -> T { return (T(1.0) - 2.0 * other) * color * color + 2.0 * color * other; }
//@ blend right exclusion <f32 vec3f vec4f>: exclusion, a + b − 2ab
fn exclusion(color: T, other: T) -> T { return color + other - 2.0 * color * other; }

//@ interpolation right <f32 vec3f vec4f>: interpolation by barycentric weights
fn barycentric(weights: vec3f, color: T, other: T, third: T) -> T { return color * weights.x + other * weights.y + third * weights.z; }
