// Lambert factors, powers of cosines, normals, Fresnel terms.

//@ lambert right: Lambert's cosine max(n·l, 0)
fn lambert(n: vec3f, l: vec3f) -> f32 { return max(dot(n, l), 0.0); }
//@ lambert mistake incidence-of-both-sides: |n·l|: both sides are lit
fn lambert_absolute(n: vec3f, l: vec3f) -> f32 { return abs(dot(n, l)); }
//@ lambert mistake not-clamped weak: n·l is not held above 0
fn lambert_unclamped(n: vec3f, l: vec3f) -> f32 { return dot(n, l); }
//@ lambert dialect half-lambert (Valve, Half-Life): half Lambert, squared
fn half_lambert(n: vec3f, l: vec3f) -> f32 { let h = dot(n, l) * 0.5 + 0.5; return h * h; }
//@ lambert dialect half-lambert-not-squared: half Lambert without its square
fn half_lambert_plain(n: vec3f, l: vec3f) -> f32 { return dot(n, l) * 0.5 + 0.5; }
//@ lambert dialect half-lambert (Valve, Half-Life): half Lambert with an exponent
fn half_lambert_power(n: vec3f, l: vec3f, exponent: f32) -> f32 { return pow(dot(n, l) * 0.5 + 0.5, exponent); }
//@ lambert dialect ambient-as-floor: the cosine is held above an ambient value
fn lambert_floor(n: vec3f, l: vec3f, floor: f32) -> f32 { return max(dot(n, l), floor); }
//@ lambert dialect ambient-as-floor: the cosine is held above an ambient value, and below 1
fn lambert_floor_held(n: vec3f, l: vec3f, floor: f32) -> f32 { return clamp(dot(n, l), floor, 1.0); }
//@ lambert dialect ambient-as-floor: an ambient value is added to the cosine, held within 0 and 1
fn lambert_floor_one(n: vec3f, l: vec3f, floor: f32) -> f32 { return clamp(dot(n, l) + floor, 0.0, 1.0); }
//@ lambert dialect wrapped (GPU Gems 1, chapter 16): wrapped Lambert
fn lambert_wrapped(n: vec3f, l: vec3f, share: f32) -> f32 { return max((dot(n, l) + share) / (1.0 + share), 0.0); }
//@ lambert dialect wrapped (GPU Gems 1, chapter 16): wrapped Lambert, not held above 0
fn lambert_wrapped_unclamped(n: vec3f, l: vec3f, share: f32) -> f32 { return dot(n, l) * (1.0 - share) + share; }
//@ lambert dialect over-pi: Lambert over π
fn lambert_over_pi(n: vec3f, l: vec3f) -> f32 { return max(dot(n, l), 0.0) / 3.14159265358979; }
//@ lambert dialect scaled: Lambert's cosine scaled and shifted
fn lambert_scaled(n: vec3f, l: vec3f, share: f32, floor: f32) -> f32 { return max(dot(n, l), 0.0) * share + floor; }
//@ lambert dialect hemisphere (Direct3D SDK): a mix by (n·l + 1)/2
fn hemisphere(color: vec3f, other: vec3f, n: vec3f, l: vec3f) -> vec3f { return mix(color, other, dot(n, l) * 0.5 + 0.5); }
//@ lambert mistake squared: the cosine is squared
fn lambert_squared(n: vec3f, l: vec3f) -> f32 { let c = max(dot(n, l), 0.0); return c * c; }

//@ lobe right weak: the power of a cosine between two given vectors
fn lobe(a: vec3f, b: vec3f, exponent: f32) -> f32 { return pow(max(dot(a, b), 0.0), exponent); }
//@ lobe mistake unguarded weak: the power of a cosine that may be negative
fn lobe_unguarded(a: vec3f, b: vec3f, exponent: f32) -> f32 { return pow(dot(a, b), exponent); }
//@ lobe mistake both-sides weak: the power of a cosine's absolute value
fn lobe_absolute(a: vec3f, b: vec3f, exponent: f32) -> f32 { return pow(abs(dot(a, b)), exponent); }

//@ normal-transform right: the normal by the upper 3×3 of a matrix (w = 0)
fn normal_by_upper(m: mat4x4f, normal: vec3f) -> vec3f { return (m * vec4f(normal, 0.0)).xyz; }
//@ normal-transform right: the normal from the right of the upper 3×3 of a matrix: its transpose
fn normal_by_upper_transposed(m: mat4x4f, normal: vec3f) -> vec3f { return (vec4f(normal, 0.0) * m).xyz; }
//@ normal-transform right: the normal by the upper 3×3 of a matrix
fn normal_by_part(m: mat4x4f, normal: vec3f) -> vec3f { return mat3x3f(m[0].xyz, m[1].xyz, m[2].xyz) * normal; }
//@ normal-transform right: the normal from the right of the upper 3×3 of a matrix: its transpose
fn normal_by_part_transposed(m: mat4x4f, normal: vec3f) -> vec3f { return normal * mat3x3f(m[0].xyz, m[1].xyz, m[2].xyz); }
//@ normal-transform right: the normal as the difference of two places that a matrix moved
fn normal_by_difference(m: mat4x4f, normal: vec3f, offset: vec3f) -> vec3f { return (m * vec4f(offset + normal, 1.0)).xyz - (m * vec4f(offset, 1.0)).xyz; }
//@ normal-transform right: the normal's opposite as the difference of two places that a matrix moved
fn normal_by_difference_turned(m: mat4x4f, normal: vec3f, offset: vec3f) -> vec3f { return (m * vec4f(offset, 1.0)).xyz - (m * vec4f(offset + normal, 1.0)).xyz; }
//@ normal-transform right: a normal of four components by a matrix
fn normal_of_four(m: mat4x4f, normal: vec4f) -> vec3f { return (m * normal).xyz; }
//@ normal-transform mistake normal-with-translation: the normal is multiplied as (n, 1): the matrix's translation is added
fn normal_moved(m: mat4x4f, normal: vec3f) -> vec3f { return (m * vec4f(normal, 1.0)).xyz; }
//@ normal-transform mistake normal-with-translation: the normal is multiplied as (n, 1) and normalised as four components
fn normal_moved_normalised(m: mat4x4f, normal: vec3f) -> vec3f { return normalize(m * vec4f(normal, 1.0)).xyz; }
//@ normal-transform right normalised-with-w: the normal is normalised as four components, of which the last is 0 where the matrix is affine
fn normal_normalised_with_w(m: mat4x4f, normal: vec3f) -> vec3f { return normalize(m * vec4f(normal, 0.0)).xyz; }
//@ normal-transform right: the normal by a 3×3 matrix
fn normal_by_matrix(m: mat3x3f, normal: vec3f) -> vec3f { return m * normal; }
//@ normal-transform right: the normal from the right of a matrix: its transpose
fn normal_by_transpose(m: mat3x3f, normal: vec3f) -> vec3f { return normal * m; }
//@ normal-transform right: the normal by a transposed 3×3 matrix
fn normal_by_transposed(m: mat3x3f, normal: vec3f) -> vec3f { return transpose(m) * normal; }
//@ decode-normal right: a normal decoded from a texture, 2c − 1
fn normal_decoded(color: vec3f) -> vec3f { return color * 2.0 - 1.0; }
//@ decode-normal right: a normal decoded from a texture with a fourth component, 2c − 1
fn normal_decoded_four(color: vec4f) -> vec4f { return color * 2.0 - 1.0; }
//@ decode-normal right two-components: two components of a normal decoded from a texture, 2c − 1
fn normal_decoded_part(color: vec3f) -> vec3f { return color * vec3f(2.0, 2.0, 0.0) - vec3f(1.0, 1.0, 0.0); }
//@ decode-normal dialect of-bytes: a normal decoded from bytes, of which 128 is 0 and 255 is 1
fn normal_decoded_bytes(color: vec3f) -> vec3f { return color * (255.0 / 127.0) - 128.0 / 127.0; }
//@ decode-normal right of-bytes: a normal decoded from bytes, of which 128 is 0
fn normal_decoded_bytes_even(color: vec3f) -> vec3f { return color * (255.0 / 128.0) - 1.0; }

//@ schlick right <f32 vec3f>: Schlick's Fresnel term F0 + (1 − F0)(1 − c)⁵
fn schlick(f0: T, c: f32) -> T { return f0 + (T(1.0) - f0) * pow(1.0 - c, 5.0); }
//@ schlick right <f32 vec3f>: Schlick's Fresnel term F0 + (1 − F0)(1 − n·v)⁵
fn schlick_of_vectors(f0: T, a: vec3f, b: vec3f) -> T { return f0 + (T(1.0) - f0) * pow(1.0 - max(dot(a, b), 0.0), 5.0); }
//@ schlick right: Schlick's Fresnel factor (1 − n·v)⁵
fn schlick_factor(a: vec3f, b: vec3f) -> f32 { return pow(1.0 - max(dot(a, b), 0.0), 5.0); }
//@ schlick right: Schlick's Fresnel factor (1 − n·v)⁵, of a cosine that may be negative
fn schlick_factor_open(a: vec3f, b: vec3f) -> f32 { return pow(1.0 - dot(a, b), 5.0); }
//@ schlick dialect rim: a rim by (1 − n·v)^k
fn rim(a: vec3f, b: vec3f, exponent: f32) -> f32 { return pow(1.0 - max(dot(a, b), 0.0), exponent); }
//@ schlick dialect rim: a rim by (1 − n·v)^k, of a cosine that may be negative
fn rim_open(a: vec3f, b: vec3f, exponent: f32) -> f32 { return pow(1.0 - dot(a, b), exponent); }
//@ schlick dialect grazing (Burley 2012) <f32 vec3f>: Schlick's Fresnel term between two values, F0 + (F90 − F0)(1 − c)⁵
fn schlick_grazing(f0: T, f90: T, c: f32) -> T { return f0 + (f90 - f0) * pow(1.0 - c, 5.0); }
//@ schlick dialect rough (Lagarde): Schlick's Fresnel term with roughness
fn schlick_rough(f0: vec3f, c: f32, share: f32) -> vec3f { return f0 + (max(vec3f(1.0 - share), f0) - f0) * pow(1.0 - c, 5.0); }
//@ schlick dialect spherical-gaussian (Unreal): Schlick's Fresnel term by a power of two
fn schlick_gaussian(f0: vec3f, c: f32) -> vec3f { return f0 + (vec3f(1.0) - f0) * exp2((-5.55473 * c - 6.98316) * c); }
//@ schlick dialect spherical-gaussian (Unreal) <f32 vec3f>: Schlick's Fresnel term between two values by a power of two
fn schlick_gaussian_grazing(f0: T, f90: T, c: f32) -> T { return f0 + (f90 - f0) * exp2((-5.55473 * c - 6.98316) * c); }
