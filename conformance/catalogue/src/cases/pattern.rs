//! Patterns of formulas' ids, in which `*` stands for any characters, slashes too.

/// Whether one of several patterns, between spaces, matches the whole of an id.
pub(super) fn any_matches(patterns: &str, id: &str) -> bool {
    patterns.split(' ').any(|pattern| matches(pattern, id))
}

fn matches(pattern: &str, id: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == id,
        Some((head, rest)) => id.strip_prefix(head).is_some_and(|tail| {
            let mut starts = tail.char_indices().map(|(at, _)| at).chain([tail.len()]);
            starts.any(|at| matches(rest, &tail[at..]))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::any_matches;

    #[test]
    fn a_star_stands_for_any_characters() {
        for (patterns, id, expected) in [
            ("*", "fog/exp", true),
            ("fog/exp", "fog/exp", true),
            ("fog/exp", "fog/exp-radial", false),
            ("fog/exp*", "fog/exp-radial", true),
            ("fog/*-radial", "fog/exp-radial", true),
            ("fog/*-radial", "fog/exp-radial-scaled", false),
            ("blend/*/one/*", "blend/add/one/zero", true),
            ("blend/*/one/*", "blend/add/zero/one", false),
            ("depth/* fog/exp", "fog/exp", true),
            ("depth/* fog/exp", "fog/linear", false),
        ] {
            assert_eq!(any_matches(patterns, id), expected, "`{patterns}` and {id}");
        }
    }
}
