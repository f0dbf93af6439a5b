// Built-in functions by themselves, for checks of what is known of a driver.

fn probe_exp(x: f32) -> f32 {
    return exp(x);
}

fn probe_exp2(x: f32) -> f32 {
    return exp2(x);
}
