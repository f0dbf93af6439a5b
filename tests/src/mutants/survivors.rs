//! The mutants that are known to survive, as `tests/mutants.txt` lists them: a line each, what it is and its name.

use super::campaign::MutantClass;
use super::generate::Mutant;
use std::collections::BTreeMap;
use std::io;
use std::path::PathBuf;

/// The file, in the repository.
pub const SURVIVORS: &str = "tests/mutants.txt";

const HEADER: &str = "\
# Mutants of the shaders that no default run fails, as `./x mutants --update` finds them: what each is, and its name.
# equal: the same bits on a million inputs of each formula and on all hard cases; of scenes, in a million pixels of random frames and in all built-in ones.
# legal: other bits, all within the intervals; of fixed functions, a million answers that are; of special values, all that there are.
# missed: a value that is not legal, on an input that a default run does not draw.
";

/// Mutants that are known to survive.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Survivors {
    of: BTreeMap<String, String>,
}

impl Survivors {
    /// Those of the file; none where there is no file.
    ///
    /// # Errors
    /// Where it cannot be read, or a line is not `CLASS NAME`.
    pub fn read() -> io::Result<Self> {
        let text = match std::fs::read_to_string(path()) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            text => text?,
        };
        let lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with('#') && !line.trim().is_empty());
        let named = lines.map(|(number, line)| {
            let (class, name) =
                line.split_once(char::is_whitespace).filter(|(class, _)| is_class(class)).ok_or_else(|| {
                    io::Error::other(format!(
                        "line {}: expected a class and a mutant, such as `equal    fog.wgsl …`",
                        number + 1
                    ))
                })?;
            Ok((name.trim().to_owned(), class.to_owned()))
        });
        Ok(Self { of: named.collect::<io::Result<_>>()? })
    }

    /// Whether a mutant is killed, or survives as what it is known for.
    #[must_use]
    pub fn allows(&self, mutant: &Mutant, finding: MutantClass) -> bool {
        !finding.survives() || self.of.get(&mutant.name()).is_some_and(|class| *class == finding.to_string())
    }

    /// What a mutant is known for; `None` where it is not known to survive.
    #[must_use]
    pub fn class(&self, mutant: &Mutant) -> Option<&str> {
        self.of.get(&mutant.name()).map(String::as_str)
    }

    /// Takes what became of a mutant for what is known of it.
    pub fn note(&mut self, mutant: &Mutant, finding: MutantClass) {
        if finding.survives() {
            self.of.insert(mutant.name(), finding.to_string());
        } else {
            self.of.remove(&mutant.name());
        }
    }

    /// Writes the file.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn write(&self) -> io::Result<()> {
        let mut lines: Vec<String> = self.of.iter().map(|(name, class)| format!("{class:<9}{name}\n")).collect();
        lines.sort();
        std::fs::write(path(), format!("{HEADER}{}", lines.concat()))
    }

    /// Leaves out what is no mutant any more.
    pub fn retain(&mut self, is_mutant: impl Fn(&str) -> bool) {
        self.of.retain(|name, _| is_mutant(name));
    }

    /// How many are known for this.
    #[must_use]
    pub fn count(&self, finding: MutantClass) -> usize {
        self.of.values().filter(|class| **class == finding.to_string()).count()
    }

    /// The names of all.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.of.keys().map(String::as_str)
    }
}

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("mutants.txt")
}

fn is_class(text: &str) -> bool {
    MutantClass::ALL.iter().any(|finding| finding.survives() && finding.to_string() == text)
}
