//! What somebody may have meant who wrote a name that does not exist.

use std::collections::HashSet;

/// Names that are told at most.
const MOST_TOLD: usize = 3;
/// The part of a name's letters that may be wrong.
const MOST_WRONG: f64 = 0.4;

/// The names nearest to what was typed, the nearest first: those that contain it, and those that differ in few letters. Of an id the first
/// part, its family, may be typed alone, and the last.
#[must_use]
pub fn nearest<'a>(typed: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let typed = typed.to_lowercase();
    let is_path = typed.contains('/');
    let family = |name: &'a str| name.split_once('/').filter(|_| !is_path).map(|(family, _)| family);
    let mut found: Vec<(f64, &str)> = names
        .into_iter()
        .flat_map(|name| family(name).into_iter().chain([name]))
        .filter_map(|name| {
            let whole = name.to_lowercase();
            let last = whole.rsplit('/').next().unwrap_or_default();
            let of = if is_path { whole.as_str() } else { last };
            let length = of.chars().count().max(typed.chars().count()).max(1);
            #[expect(clippy::cast_precision_loss, reason = "lengths of names")]
            let wrong = strsim::damerau_levenshtein(of, &typed) as f64 / length as f64;
            // What contains it all is nearer than what is spelt alike.
            let wrong = if typed.len() >= 3 && whole.contains(&typed) { 0.1 * wrong } else { wrong };
            (wrong <= MOST_WRONG).then_some((wrong, name))
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.len().cmp(&b.1.len())));
    let mut told = HashSet::new();
    found.into_iter().map(|(_, name)| name).filter(|name| told.insert(*name)).take(MOST_TOLD).collect()
}

/// The same as the end of a sentence: `; did you mean …?`, or a full stop.
#[must_use]
pub fn did_you_mean<'a>(typed: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = nearest(typed, names).into_iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => ".".to_owned(),
        [one] => format!("; did you mean {one}?"),
        [others @ .., last] => format!("; did you mean {} or {last}?", others.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_letter_too_many_or_a_part_of_a_name_is_enough() {
        let names = ["fog/exp", "fog/exp2-opengl", "lighting/blinn", "attenuation/point", "shininess-doubled"];
        assert_eq!(nearest("fog/exq", names)[0], "fog/exp");
        assert_eq!(nearest("blin", names), ["lighting/blinn"]);
        assert_eq!(nearest("shinines", names), ["shininess-doubled"]);
        assert_eq!(nearest("nothing-like-it", names), [""; 0]);
        assert_eq!(nearest("fgo", names), ["fog"]);
        assert_eq!(did_you_mean("fgo/exp", names), "; did you mean `fog/exp`?");
    }
}
