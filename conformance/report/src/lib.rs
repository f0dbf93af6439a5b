//! Reports for people and for servers, pages and pictures: from the JSON of runs.

mod against;
pub mod bench;
pub mod gate;
pub mod github;
pub mod junit;
pub mod live;
pub mod mistakes;
pub mod page;
pub mod selftest;
pub mod special;
pub mod sweep;
pub mod text;
