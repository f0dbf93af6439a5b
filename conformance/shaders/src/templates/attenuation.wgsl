// How light fades with distance.

//@ attenuation right: 1/(kc + kl·d + kq·d²)
fn attenuation(kc: f32, kl: f32, kq: f32, d: f32) -> f32 { return 1.0 / (kc + kl * d + kq * d * d); }
//@ attenuation right: 1/(1 + kl·d + kq·d²)
fn attenuation_one(kl: f32, kq: f32, d: f32) -> f32 { return 1.0 / (1.0 + kl * d + kq * d * d); }
//@ attenuation right: 1/(1 + k·d + k·d²)
fn attenuation_twice(k: f32, d: f32) -> f32 { return 1.0 / (1.0 + k * d + k * d * d); }
//@ attenuation right: 1/(kc + kq·d²)
fn attenuation_constant_quadratic(kc: f32, kq: f32, d: f32) -> f32 { return 1.0 / (kc + kq * d * d); }
//@ attenuation right: 1/(kc + kl·d)
fn attenuation_constant_linear(kc: f32, kl: f32, d: f32) -> f32 { return 1.0 / (kc + kl * d); }
//@ attenuation right: 1/(1 + kq·d²)
fn attenuation_quadratic(kq: f32, d: f32) -> f32 { return 1.0 / (1.0 + kq * d * d); }
//@ attenuation right: 1/(1 + kl·d)
fn attenuation_linear(kl: f32, d: f32) -> f32 { return 1.0 / (1.0 + kl * d); }
//@ attenuation right: 1/(kl·d + kq·d²)
fn attenuation_linear_quadratic(kl: f32, kq: f32, d: f32) -> f32 { return 1.0 / (kl * d + kq * d * d); }
//@ attenuation right: 1/(1 + d²)
fn attenuation_one_square(offset: vec3f) -> f32 { return 1.0 / (1.0 + dot(offset, offset)); }
//@ attenuation right inverse-square: the inverse square 1/d²
fn inverse_square(offset: vec3f) -> f32 { return 1.0 / dot(offset, offset); }
//@ attenuation right inverse-square: k/d²
fn inverse_square_of(offset: vec3f, k: f32) -> f32 { return k / dot(offset, offset); }
//@ attenuation right inverse-square: a colour over d²
fn inverse_square_colored(offset: vec3f, color: vec3f) -> vec3f { return color / dot(offset, offset); }
//@ attenuation right inverse-square: a colour over k·d²
fn inverse_square_colored_by(offset: vec3f, color: vec3f, k: f32) -> vec3f { return color / (k * dot(offset, offset)); }
//@ attenuation right inverse-square: a/(k·d²)
fn inverse_square_scaled(offset: vec3f, k: f32, kq: f32) -> f32 { return k / (kq * dot(offset, offset)); }
//@ attenuation dialect power: 1/d^k
fn inverse_power(d: f32, exponent: f32) -> f32 { return 1.0 / pow(d, exponent); }
//@ attenuation right inverse-square: 1/(k·d²)
fn inverse_square_by(offset: vec3f, k: f32) -> f32 { return 1.0 / (k * dot(offset, offset)); }
//@ attenuation right inverse-square weak: the inverse square 1/d²
fn inverse_square_given(d: f32) -> f32 { return 1.0 / (d * d); }
//@ attenuation right inverse-square weak: k/d²
fn inverse_square_given_of(d: f32, k: f32) -> f32 { return k / (d * d); }
//@ attenuation dialect inverse-square-held: 1/d², with d² held above a limit
fn inverse_square_held(offset: vec3f, k: f32) -> f32 { return 1.0 / max(dot(offset, offset), k); }
//@ attenuation dialect inverse-square-held: k/(d² + c)
fn inverse_square_softened(offset: vec3f, k: f32, kc: f32) -> f32 { return k / (dot(offset, offset) + kc); }
//@ attenuation right inverse: 1/d
fn inverse(offset: vec3f) -> f32 { return 1.0 / length(offset); }
//@ attenuation right inverse: 1/(k·d)
fn inverse_by(offset: vec3f, k: f32) -> f32 { return 1.0 / (k * length(offset)); }
//@ attenuation mistake distance-to-the-fourth: 1/d⁴ where 1/d² is due
fn inverse_fourth(offset: vec3f) -> f32 { let q = dot(offset, offset); return 1.0 / (q * q); }
//@ attenuation mistake quadratic-without-square: the quadratic coefficient is multiplied by d, not by d²
fn quadratic_without_square(kc: f32, kl: f32, kq: f32, d: f32) -> f32 { return 1.0 / (kc + kl * d + kq * d); }
//@ attenuation mistake reciprocal-of-the-first-term: only the first term is divided by
fn reciprocal_of_first(kc: f32, kl: f32, kq: f32, d: f32) -> f32 { return 1.0 / kc + kl * d + kq * d * d; }
//@ divisor right: kc + kl·d + kq·d², to divide by
fn divisor(kc: f32, kl: f32, kq: f32, d: f32) -> f32 { return kc + kl * d + kq * d * d; }
//@ divisor right: 1 + kl·d + kq·d², to divide by
fn divisor_one(kl: f32, kq: f32, d: f32) -> f32 { return 1.0 + kl * d + kq * d * d; }
//@ divisor right: 1 + k·d + k·d², to divide by
fn divisor_twice(k: f32, d: f32) -> f32 { return 1.0 + k * d + k * d * d; }
//@ divisor right weak: kc + kq·d², to divide by
fn divisor_constant_quadratic(kc: f32, kq: f32, d: f32) -> f32 { return kc + kq * d * d; }
//@ divisor right weak: d², to divide by
fn divisor_square(offset: vec3f) -> f32 { return dot(offset, offset); }
//@ attenuation dialect window-of-unreal (Karis 2013): (1 − (d/r)⁴)²/(1 + d²), held within 0 and 1
fn window_unreal(d: f32, radius: f32) -> f32 { let w = clamp(1.0 - pow(d / radius, 4.0), 0.0, 1.0); return w * w / (1.0 + d * d); }
//@ attenuation dialect window (Lagarde 2014): (1 − (d/r)⁴)²/d²
fn window_inverse_square(d: f32, radius: f32) -> f32 { let w = clamp(1.0 - pow(d / radius, 4.0), 0.0, 1.0); return w * w / (d * d); }
//@ attenuation dialect window (Lagarde 2014): (1 − (d/r)⁴)²
fn window_fourth(d: f32, radius: f32) -> f32 { let w = clamp(1.0 - pow(d / radius, 4.0), 0.0, 1.0); return w * w; }
//@ attenuation dialect window: 1 − (d/r)⁴
fn window_fourth_plain(d: f32, radius: f32) -> f32 { return clamp(1.0 - pow(d / radius, 4.0), 0.0, 1.0); }
//@ attenuation dialect window: (1 − (d/r)²)²
fn window_square(d: f32, radius: f32) -> f32 { let w = clamp(1.0 - (d / radius) * (d / radius), 0.0, 1.0); return w * w; }
//@ attenuation dialect window: (1 − (d/r)²)², not held above 0
fn window_square_open(d: f32, radius: f32) -> f32 { let w = 1.0 - (d / radius) * (d / radius); return w * w; }
//@ attenuation dialect window: 1 − (d/r)², held above 0
fn window_plain(d: f32, radius: f32) -> f32 { return max(1.0 - (d / radius) * (d / radius), 0.0); }
//@ attenuation dialect window: 1 − d²/k, held above 0
fn window_of_squares(offset: vec3f, k: f32) -> f32 { return max(1.0 - dot(offset, offset) / k, 0.0); }
//@ attenuation dialect window: 1 − k·d², held above 0
fn window_by_factor(offset: vec3f, k: f32) -> f32 { return max(1.0 - dot(offset, offset) * k, 0.0); }
//@ attenuation dialect linear-to-a-radius: (1 − d/r)²
fn linear_squared_open(d: f32, radius: f32) -> f32 { let w = 1.0 - d / radius; return w * w; }
//@ attenuation dialect linear-to-a-radius: (1 − d/r)², held above 0
fn linear_squared(d: f32, radius: f32) -> f32 { let w = max(1.0 - d / radius, 0.0); return w * w; }
//@ attenuation dialect linear-to-a-radius (three.js): (1 − d/r)^k, held above 0
fn linear_power(d: f32, radius: f32, exponent: f32) -> f32 { return pow(clamp(1.0 - d / radius, 0.0, 1.0), exponent); }
//@ attenuation dialect linear-to-a-radius: 1 − d/r, held above 0
fn linear_to_radius(d: f32, radius: f32) -> f32 { return max(1.0 - d / radius, 0.0); }
//@ attenuation dialect linear-to-a-radius weak: 1 − d/r, not held above 0
fn linear_open(d: f32, radius: f32) -> f32 { return 1.0 - d / radius; }
//@ attenuation dialect linear-to-a-radius weak: (r − d)/r, held above 0
fn linear_difference(d: f32, radius: f32) -> f32 { return max((radius - d) / radius, 0.0); }
//@ attenuation dialect radius-squared: 1/(1 + d/r)²
fn radius_squared(d: f32, radius: f32) -> f32 { let w = 1.0 + d / radius; return 1.0 / (w * w); }
//@ attenuation dialect radius-squared: 1/(1 + (d/r)²)
fn radius_ratio(d: f32, radius: f32) -> f32 { return 1.0 / (1.0 + (d / radius) * (d / radius)); }
