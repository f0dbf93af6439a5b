//! Globs that select cases by id: `*` stays within a segment, `**` crosses segments; a match of any ancestor selects all
//! that is below it.

use globset::{GlobBuilder, GlobMatcher};

/// A set of globs; empty, it selects everything.
#[derive(Clone, Debug, Default)]
pub struct Filter {
    globs: Vec<PathGlob>,
}

/// A glob, whole and by segments.
#[derive(Clone, Debug)]
struct PathGlob {
    text: String,
    whole: GlobMatcher,
    /// The segments before the first `**`.
    head: Vec<GlobMatcher>,
    /// Whether there is a `**`, behind which any number of segments may follow.
    is_deep: bool,
}

impl PathGlob {
    fn new(text: &str) -> Result<Self, globset::Error> {
        let compile = |text: &str| -> Result<GlobMatcher, globset::Error> {
            Ok(GlobBuilder::new(text).literal_separator(true).build()?.compile_matcher())
        };
        // Alternatives may hold slashes: such a glob is tried whole.
        let is_deep = |text: &str| text.contains("**") || text.contains('{');
        let head: Vec<&str> = text.split('/').take_while(|segment| !is_deep(segment)).collect();
        Ok(Self {
            text: text.to_owned(),
            whole: compile(text)?,
            is_deep: is_deep(text),
            head: head.into_iter().map(compile).collect::<Result<_, _>>()?,
        })
    }

    /// Whether some id below the path may match.
    fn reaches_below(&self, path: &str) -> bool {
        let depth = path.split('/').count();
        (self.is_deep || self.head.len() > depth)
            && self.text.contains(['*', '?', '[', '{'])
            && path.split('/').zip(&self.head).all(|(segment, glob)| glob.is_match(segment))
    }
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
        let read = |text: &str| {
            PathGlob::new(text.trim_end_matches('/'))
                .map_err(|error| FilterError { text: text.into(), message: error.kind().to_string() })
        };
        Ok(Self { globs: texts.iter().map(|text| read(text.as_ref())).collect::<Result<_, _>>()? })
    }

    /// Whether everything below `id`, or `id` itself, is selected.
    #[must_use]
    pub fn selects(&self, id: &str) -> bool {
        self.globs.is_empty()
            || ancestors(id).any(|ancestor| self.globs.iter().any(|glob| glob.whole.is_match(ancestor)))
    }

    /// Whether a wildcard may select something below the path where the path itself is not selected: if not, no id below
    /// need be tried.
    #[must_use]
    pub fn reaches_below(&self, path: &str) -> bool {
        self.globs.iter().any(|glob| glob.reaches_below(path))
    }

    /// Whether some glob is long enough to match an id of `segments` segments other than by an ancestor of it.
    #[must_use]
    pub fn is_as_deep_as(&self, segments: usize) -> bool {
        self.globs.iter().any(|glob| glob.text.contains("**") || glob.text.matches('/').count() + 1 >= segments)
    }

    /// The globs as they were written.
    pub fn globs(&self) -> impl Iterator<Item = &str> {
        self.globs.iter().map(|glob| glob.text.as_str())
    }

    /// The globs that may name one case: those without wildcards.
    pub fn literals(&self) -> impl Iterator<Item = &str> {
        self.globs.iter().map(|glob| glob.text.as_str()).filter(|text| !text.contains(['*', '?', '[', '{']))
    }

    /// Whether there is no glob, so that everything is selected.
    #[must_use]
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
            ("{fog/linear,fog/exp}", "fog/exp/random/000017", true),
        ];
        for (glob, id, expected) in rows {
            let filter = Filter::new(&[glob]).expect("the glob is valid");
            assert_eq!(filter.selects(id), expected, "{glob} on {id}");
            let path = id.rsplit_once('/').expect("an id has a parent").0;
            let is_named = filter.literals().any(|literal| literal == id);
            assert!(!expected || is_named || filter.selects(path) || filter.reaches_below(path), "{glob} reaches {id}");
        }
    }
}
