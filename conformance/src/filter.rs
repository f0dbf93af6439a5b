//! Globs that select cases by id: `*` stays within a segment, `**` crosses segments; a match of any ancestor selects all
//! that is below it.

use globset::{Glob, GlobBuilder, GlobMatcher};

/// A set of globs; empty, it selects everything.
#[derive(Clone, Debug, Default)]
pub struct Filter {
    globs: Vec<GlobMatcher>,
}

/// A glob that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("filter `{text}` is not a glob: {message}; expected something like `fog`, `fog/*/hard` or `blend/add/**/0007`")]
pub struct FilterError {
    text: String,
    message: String,
}

impl Filter {
    /// Reads globs.
    ///
    /// # Errors
    /// Where one cannot be read.
    pub fn new<S: AsRef<str>>(texts: &[S]) -> Result<Self, FilterError> {
        let glob = |text: &str| -> Result<GlobMatcher, FilterError> {
            let built: Result<Glob, globset::Error> = GlobBuilder::new(text).literal_separator(true).build();
            built
                .map(|glob| glob.compile_matcher())
                .map_err(|error| FilterError { text: text.into(), message: error.kind().to_string() })
        };
        Ok(Self { globs: texts.iter().map(|text| glob(text.as_ref().trim_end_matches('/'))).collect::<Result<_, _>>()? })
    }

    /// Whether everything below `id`, or `id` itself, is selected.
    #[must_use]
    pub fn selects(&self, id: &str) -> bool {
        self.globs.is_empty() || ancestors(id).any(|ancestor| self.globs.iter().any(|glob| glob.is_match(ancestor)))
    }

    /// The globs that match nothing among the ids, by [`Filter::selects`] of each alone.
    pub fn is_empty(&self) -> bool {
        self.globs.is_empty()
    }
}

/// `a/b/c`, then `a/b`, then `a`.
fn ancestors(id: &str) -> impl Iterator<Item = &str> {
    std::iter::successors(Some(id), |id| id.rsplit_once('/').map(|(parent, _)| parent))
}

#[cfg(test)]
mod tests {
    use super::Filter;

    #[test]
    fn globs_match_an_id_or_an_ancestor() {
        let rows = [
            ("fog", "fog/linear/random/000017", true),
            ("fog/*/hard", "fog/linear/hard/dmin-equals-dmax", true),
            ("fog/*/hard", "fog/linear/random/000017", false),
            ("fog/*", "fog/linear/hard/dmin-equals-dmax", true),
            ("f*", "fog/linear/random/000017", true),
            ("*/linear", "fog/linear/random/000017", true),
            ("*", "fog/linear/random/000017", true),
            ("fo", "fog/linear/random/000017", false),
            ("blend/add/**/0007", "blend/add/zero/one/0007", true),
            ("blend/add/**/0007", "blend/add/zero/one/0008", false),
            ("fog/linear/random/000017", "fog/linear/random/000017", true),
        ];
        for (glob, id, expected) in rows {
            let filter = Filter::new(&[glob]).expect("the glob is valid");
            assert_eq!(filter.selects(id), expected, "{glob} on {id}");
        }
    }
}
