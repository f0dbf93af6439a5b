//! Numbers and settings as they stand on a command line.

/// A finite f32, decimal or by its bits.
pub(crate) fn float(text: &str) -> Result<f32, String> {
    let x = match text.strip_prefix("0x") {
        Some(hex) => u32::from_str_radix(hex, 16).ok().map(f32::from_bits),
        None => text.parse().ok(),
    };
    let x = x.ok_or("not a number; expected one such as 0.5, 1e6 or 0x3f800000")?;
    if !x.is_finite() {
        return Err(format!("{x} is no float that a sweep can reach; expected a finite f32, at most {:e}", f32::MAX));
    }
    Ok(x)
}

pub(crate) fn setting(text: &str) -> Result<(String, Vec<f32>), String> {
    let expected = || "expected NAME=VALUE, as density=0.01 or fog=0.5,0.5,1".to_owned();
    let (name, values) = text.split_once('=').ok_or_else(expected)?;
    let values: Result<Vec<f32>, String> =
        values.split(',').map(|value| float(value.trim()).map_err(|error| format!("`{value}`: {error}"))).collect();
    Ok((name.trim().to_owned(), values?))
}
