//! A renderer's words, as they are shown.

/// Characters of a renderer's words that are told.
const MOST_TOLD: usize = 300;

/// Characters of a line that is quoted since it is no answer.
pub(super) const MOST_QUOTED: usize = 60;

/// A renderer's words, as far as they are told: fit to be shown, and not without end.
#[must_use]
pub fn clipped(words: &str) -> String {
    clipped_to(words, MOST_TOLD)
}

/// Such words, up to a number of characters.
pub(super) fn clipped_to(words: &str, most: usize) -> String {
    let cut: String = words.trim().chars().take(most).collect();
    let mut told = lightmeter_files::shown(&cut).into_owned();
    if words.trim().chars().nth(most).is_some() {
        told.push('…');
    }
    told
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_told_without_end_and_control() {
        assert_eq!(clipped(" a\u{1b}[2Jb\nc "), r"a\u{1b}[2Jb\u{a}c");
        let long = clipped(&"x".repeat(1 << 20));
        assert!(long.chars().count() == MOST_TOLD + 1 && long.ends_with('…'));
    }
}
