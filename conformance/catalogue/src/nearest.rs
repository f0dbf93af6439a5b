//! What somebody may have meant who wrote a name that does not exist.

/// Names that are told at most.
const MOST_TOLD: usize = 3;
/// The part of a name's letters that may be wrong.
const MOST_WRONG: f64 = 0.4;

/// The names nearest to what was typed, the nearest first: those that contain it, and those that differ in few letters. Of an id the last
/// part may be typed alone.
#[must_use]
pub fn nearest<'a>(typed: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let typed = typed.to_lowercase();
    let is_path = typed.contains('/');
    let mut found: Vec<(f64, &str)> = names
        .into_iter()
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
    found.dedup_by(|a, b| a.1 == b.1);
    found.into_iter().take(MOST_TOLD).map(|(_, name)| name).collect()
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
        assert_eq!(did_you_mean("fgo/exp", names), "; did you mean `fog/exp`?");
    }
}
