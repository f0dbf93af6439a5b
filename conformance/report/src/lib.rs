//! Reports for people and for servers, pages and pictures: from the JSON of runs.

mod against;
#[cfg(feature = "pages")]
pub mod bench;
pub mod github;
#[cfg(feature = "pages")]
pub mod html;
#[cfg(feature = "pages")]
pub mod junit;
pub mod live;
pub mod mistakes;
#[cfg(feature = "pages")]
pub mod page;
#[cfg(feature = "pages")]
mod plot;
pub mod sarif;
#[cfg(feature = "pages")]
pub mod selftest;
pub mod special;
pub mod sweep;
pub mod table;
pub mod text;

/// How much is said to people.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// What fails, and the verdict.
    Quiet,
    /// What was judged besides, and what is out of the ordinary.
    #[default]
    Normal,
    /// All that is known: how near each family comes to its limits, hard cases, bits, what deviations excuse.
    Verbose,
}
