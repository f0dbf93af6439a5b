// Elementary functions that WGSL lacks, each with a relative error of a few 2^-24 where the obvious form cancels, and exact
// scaling by powers of two.

// ln(1 + x) for x > -1. The series is cut off where its next term is below 2^-26 of the first.
fn elementary_ln_1p(x: f32) -> f32 {
    if abs(x) > 0.0625 {
        return log(1.0 + x);
    }
    return x * (1.0 + x * (-1.0 / 2.0 + x * (1.0 / 3.0 + x * (-1.0 / 4.0 + x * (1.0 / 5.0 + x * (-1.0 / 6.0))))));
}

// exp(x) - 1. Likewise.
fn elementary_exp_m1(x: f32) -> f32 {
    if abs(x) > 0.5 {
        return exp(x) - 1.0;
    }
    let tail = 1.0 / 120.0 + x * (1.0 / 720.0 + x * (1.0 / 5040.0 + x * (1.0 / 40320.0)));
    return x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * tail))));
}

// The upper 12 bits of a number's significand: the product of two such is exact. What masks the bits cannot be taken for
// algebra by a compiler.
fn elementary_upper(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) & 0xfffff000u);
}

// The same number, opaque to a compiler. Mesa's takes (x - y) + z for x + (z - y), which loses z where x and y nearly cancel.
fn elementary_opaque(x: f32) -> f32 {
    return bitcast<f32>(reverseBits(reverseBits(bitcast<u32>(x))));
}

// a*b - product, exactly, for the product as rounded (Dekker).
fn elementary_product_error(a: f32, b: f32, product: f32) -> f32 {
    let a1 = elementary_upper(a);
    let b1 = elementary_upper(b);
    let a2 = a - a1;
    let b2 = b - b1;
    let first = elementary_opaque(a1 * b1 - product);
    let second = elementary_opaque(first + a1 * b2);
    return elementary_opaque(second + a2 * b1) + a2 * b2;
}

// a*b - c*d: the difference of the rounded products, and that of their errors (Cornea, Harrison & Tang 2002).
fn elementary_difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    let ab = a * b;
    let cd = c * d;
    return elementary_opaque(ab - cd) + (elementary_product_error(a, b, ab) - elementary_product_error(c, d, cd));
}

// A power of two that brings a magnitude of [2^-126, 2^128) into [2^-20, 2^20), in steps of 2^40.
fn elementary_binary_scale(magnitude: f32) -> f32 {
    var scale = 0x1p120;
    if magnitude >= 0x1p-100 { scale = 0x1p80; }
    if magnitude >= 0x1p-60 { scale = 0x1p40; }
    if magnitude >= 0x1p-20 { scale = 1.0; }
    if magnitude >= 0x1p20 { scale = 0x1p-40; }
    if magnitude >= 0x1p60 { scale = 0x1p-80; }
    if magnitude >= 0x1p100 { scale = 0x1p-120; }
    return scale;
}
