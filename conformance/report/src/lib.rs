//! Reports for people and for servers, and pages made from the JSON of runs.

pub mod junit;
pub mod page;
pub mod selftest;
pub mod special;
pub mod text;
