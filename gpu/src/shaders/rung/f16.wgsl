// What elementary.wgsl has for binary32, in binary16, whose range is 2^-24 to 65504.

// ln(1 + x) for x > -1. The series is cut off where its next term is below 2^-12 of the first.
fn elementary_ln_1p(x: f16) -> f16 {
    if abs(x) > 0.125h {
        return log(1.0h + x);
    }
    return x * (1.0h + x * (-0.5h + x * (0.3333333h + x * -0.25h)));
}

// exp(x) - 1. Likewise.
fn elementary_exp_m1(x: f16) -> f16 {
    if abs(x) > 0.5h {
        return exp(x) - 1.0h;
    }
    return x * (1.0h + x * (0.5h + x * (0.1666667h + x * (0.04166667h + x * 0.008333333h))));
}

fn elementary_opaque(x: f16) -> f16 {
    return x;
}

fn elementary_difference_of_products(a: f16, b: f16, c: f16, d: f16) -> f16 {
    return a * b - c * d;
}

// A power of two that brings a magnitude of [2^-15, 2^15) into [2^-3, 2^3), in steps of 2^6.
fn elementary_binary_scale(magnitude: f16) -> f16 {
    var scale = 32768.0h;
    if magnitude >= 0.000030517578125h { scale = 4096.0h; }
    if magnitude >= 0.001953125h { scale = 64.0h; }
    if magnitude >= 0.125h { scale = 1.0h; }
    if magnitude >= 8.0h { scale = 0.015625h; }
    if magnitude >= 512.0h { scale = 0.000244140625h; }
    return scale;
}
