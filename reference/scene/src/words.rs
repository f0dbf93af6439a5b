//! Enumerations whose variants are written by a word each.

/// Declares an enumeration with the word of each variant, which stands for it in JSON, ids and reports.
macro_rules! words {
    ($(#[$meta:meta])* pub enum $name:ident { $($(#[$says:meta])* $variant:ident = $word:literal,)+ }) => {
        $(#[$meta])*
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
        )]
        pub enum $name {
            $($(#[$says])* #[serde(rename = $word)] $variant,)+
        }

        impl $name {
            /// All of them, in the order of their codes.
            pub const ALL: [Self; [$($word),+].len()] = [$(Self::$variant),+];

            /// The word that stands for it in JSON, ids and reports.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }

            /// The one that a word stands for.
            #[must_use]
            pub fn by_name(name: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|one| one.name() == name)
            }

            /// Its place in [`Self::ALL`], which is the selector that shaders take.
            #[must_use]
            pub const fn code(self) -> u32 {
                self as u32
            }
        }
    };
}

pub(crate) use words;
