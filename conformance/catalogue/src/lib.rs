//! What is asked: formulas with their inputs and hard cases, special values, built-in scenes, and the choice among them.

pub mod cases;
pub mod dialects;
pub mod filter;
pub mod nearest;
pub mod rulings;
pub mod scene;
pub mod select;
pub mod special;

pub use lightmeter_reference::Real;
