// Spotlights. l points to the light, the axis away from it.

//@ spot dialect ramp (LearnOpenGL): the spotlight's edge as a straight ramp of cosines
fn spot_ramp(l: vec3f, axis: vec3f, inner: f32, outer: f32) -> f32 { return clamp((dot(-l, axis) - outer) / (inner - outer), 0.0, 1.0); }
//@ spot dialect ramp (LearnOpenGL): the spotlight's edge as a straight ramp of cosines over a width
fn spot_width(l: vec3f, axis: vec3f, outer: f32, width: f32) -> f32 { return clamp((dot(-l, axis) - outer) / width, 0.0, 1.0); }
//@ spot dialect ramp (Lagarde 2014): the spotlight's edge as a straight ramp, scaled and shifted
fn spot_scaled(l: vec3f, axis: vec3f, scale: f32, k: f32) -> f32 { return clamp(dot(-l, axis) * scale + k, 0.0, 1.0); }
//@ spot dialect ramp: the spotlight's edge as a straight ramp of cosines from its axis
fn spot_from_axis(l: vec3f, axis: vec3f, outer: f32) -> f32 { return clamp((dot(-l, axis) - outer) / (1.0 - outer), 0.0, 1.0); }
//@ spot dialect smoothstep (three.js): the spotlight's edge by smoothstep of cosines
fn spot_smooth(l: vec3f, axis: vec3f, inner: f32, outer: f32) -> f32 { let t = clamp((dot(-l, axis) - outer) / (inner - outer), 0.0, 1.0); return t * t * (3.0 - 2.0 * t); }
//@ spot dialect squared: the spotlight's edge as a ramp of cosines, squared
fn spot_squared(l: vec3f, axis: vec3f, inner: f32, outer: f32) -> f32 { let t = clamp((dot(-l, axis) - outer) / (inner - outer), 0.0, 1.0); return t * t; }
//@ spot mistake not-clamped: the spotlight's ramp is not held within 0 and 1
fn spot_ramp_open(l: vec3f, axis: vec3f, inner: f32, outer: f32) -> f32 { return (dot(-l, axis) - outer) / (inner - outer); }
//@ spot mistake not-clamped: the spotlight's ramp of a cosine held above 0 is not held within 0 and 1
fn spot_ramp_open_held(l: vec3f, axis: vec3f, inner: f32, outer: f32) -> f32 { return (max(dot(-l, axis), 0.0) - outer) / (inner - outer); }
//@ spot dialect ramp: the spotlight's edge as a straight ramp of a cosine held above 0
fn spot_ramp_held(l: vec3f, axis: vec3f, inner: f32, outer: f32) -> f32 { return clamp((max(dot(-l, axis), 0.0) - outer) / (inner - outer), 0.0, 1.0); }
//@ spot right: the spotlight's cone with an exponent
fn spot_power(l: vec3f, axis: vec3f, cut: f32, exponent: f32) -> f32 { let c = dot(-l, axis); return select(0.0, pow(max(c, 0.0), exponent), c >= cut); }
//@ spot right unguarded: the spotlight's cone with an exponent; a cosine below 0 has no power
fn spot_power_open(l: vec3f, axis: vec3f, cut: f32, exponent: f32) -> f32 { let c = dot(-l, axis); return select(0.0, pow(c, exponent), c >= cut); }
//@ spot right: a cone with a hard edge
fn spot_hard(l: vec3f, axis: vec3f, cut: f32) -> f32 { return select(0.0, 1.0, dot(-l, axis) >= cut); }
//@ spot right transparent <f32 vec3f vec4f>: a cone with a hard edge about what it lights
fn spot_gate(l: vec3f, axis: vec3f, cut: f32, lit: T) -> T { return select(T(0.0), lit, dot(-l, axis) >= cut); }
//@ spot mistake cone-turned: the spotlight shines outside of its cone
fn spot_turned(l: vec3f, axis: vec3f, cut: f32, lit: f32) -> f32 { return select(0.0, lit, dot(-l, axis) <= cut); }
//@ spot dialect linear-cone transparent <f32 vec3f vec4f> (ogldev): the spotlight fades by a straight line from its axis to its edge
fn spot_linear_gate(l: vec3f, axis: vec3f, cut: f32, lit: T) -> T { let c = dot(-l, axis); return select(T(0.0), lit * (1.0 - (1.0 - c) / (1.0 - cut)), c > cut); }
//@ spot right weak: what is within a cone with a hard edge
fn spot_condition(l: vec3f, axis: vec3f, cut: f32) -> bool { return dot(-l, axis) > cut; }
//@ spot right weak: what is outside a cone with a hard edge
fn spot_condition_turned(l: vec3f, axis: vec3f, cut: f32) -> bool { return dot(-l, axis) < cut; }
