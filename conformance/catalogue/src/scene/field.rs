//! Where in a scene something stands, and what is wrong with it.

use std::fmt;

/// Why a scene is refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A file that cannot be read.
    #[error("cannot read {file}: {error}")]
    File {
        /// Its path.
        file: String,
        /// Why not. It is not the error's source: the message has it.
        error: std::io::Error,
    },
    /// No scene of that name is built in.
    #[error("no file and no built-in scene `{name}`{meant} `lightmeter list scene` lists those that are built in")]
    Unknown {
        /// The name.
        name: String,
        /// The names that are nearest to it, as the end of a sentence.
        meant: String,
    },
    /// A field that holds what it may not.
    #[error("field `{path}` {holds}; expected {allowed}")]
    Field {
        /// Where it stands: `lights[2].cutoff_deg`.
        path: String,
        /// What it holds.
        holds: String,
        /// What is allowed.
        allowed: String,
    },
    /// What is not JSON, or not of the schema.
    #[error("field `{path}`: {says}")]
    Json {
        /// Where it stands; `.` for the scene itself.
        path: String,
        /// What is wrong, with line and column.
        says: String,
    },
}

/// A place in a scene.
#[derive(Clone, Copy, Debug)]
pub(super) enum At<'a> {
    /// The scene itself.
    Scene,
    /// A field of what stands there.
    Field(&'a At<'a>, &'a str),
    /// An entry of what stands there.
    Item(&'a At<'a>, usize),
}

impl At<'_> {
    pub(super) const fn field<'a>(&'a self, name: &'a str) -> At<'a> {
        At::Field(self, name)
    }

    pub(super) const fn item(&self, place: usize) -> At<'_> {
        At::Item(self, place)
    }

    /// What stands here is refused.
    pub(super) fn refuse(&self, holds: impl fmt::Display, allowed: impl fmt::Display) -> SceneError {
        SceneError::Field { path: self.to_string(), holds: holds.to_string(), allowed: allowed.to_string() }
    }

    /// What stands here is refused unless it is right.
    pub(super) fn require(&self, right: bool, holds: impl fmt::Display, allowed: &str) -> Result<(), SceneError> {
        if right { Ok(()) } else { Err(self.refuse(format_args!("is {holds}"), allowed)) }
    }

    /// The f32 nearest to a number.
    pub(super) fn number(&self, x: f64) -> Result<f32, SceneError> {
        #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is what is asked for")]
        let nearest = x as f32;
        self.require(nearest.is_finite(), x, "a number within the range of f32")?;
        Ok(nearest)
    }

    /// The f32s nearest to numbers.
    pub(super) fn numbers<const N: usize>(&self, numbers: [f64; N]) -> Result<[f32; N], SceneError> {
        let mut nearest = [0.0; N];
        for (place, x) in numbers.into_iter().enumerate() {
            nearest[place] = self.item(place).number(x)?;
        }
        Ok(nearest)
    }

    /// The f32 nearest to a number that is to be 0 or above.
    pub(super) fn not_negative(&self, x: f64) -> Result<f32, SceneError> {
        let nearest = self.number(x)?;
        self.require(nearest >= 0.0, x, "a number that is 0 or above")?;
        Ok(nearest)
    }

    /// The f32 nearest to a number that is to be above 0, as an f32 too.
    pub(super) fn positive(&self, x: f64) -> Result<f32, SceneError> {
        let nearest = self.number(x)?;
        self.require(nearest > 0.0, x, "a number above 0")?;
        Ok(nearest)
    }

    /// The f32 nearest to a number that is to be from 0 to 1.
    pub(super) fn share(&self, x: f64) -> Result<f32, SceneError> {
        self.require((0.0..=1.0).contains(&x), x, "a number from 0 to 1")?;
        self.number(x)
    }

    /// A vector that is to have a direction, also as f32s.
    pub(super) fn direction(&self, v: [f64; 3]) -> Result<[f32; 3], SceneError> {
        let nearest = self.numbers(v)?;
        let shown = format!("[{}, {}, {}]", v[0], v[1], v[2]);
        self.require(nearest.iter().any(|&x| x != 0.0), shown, "a vector that is not 0")?;
        Ok(nearest)
    }

    /// A thing of that name among those that there are.
    pub(super) fn named<T>(&self, found: Option<T>, name: &str, known: &[&str]) -> Result<T, SceneError> {
        let known = if known.is_empty() { "a name, of which there are none".into() } else { one_of(known) };
        found.ok_or_else(|| self.refuse(format_args!("is `{name}`"), known))
    }
}

/// The names, for a message.
pub(super) fn one_of(names: &[&str]) -> String {
    format!("one of {}", names.join(", "))
}

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene => Ok(()),
            Self::Field(Self::Scene, name) => f.write_str(name),
            Self::Field(of, name) => write!(f, "{of}.{name}"),
            Self::Item(of, place) => write!(f, "{of}[{place}]"),
        }
    }
}
