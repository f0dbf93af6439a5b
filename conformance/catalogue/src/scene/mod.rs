//! Scenes: from what is written to what is drawn.
//!
//! [`load`] reads JSON, files and names and gives a [`Frame`](lightmeter_scene::frame::Frame), or an [`SceneError`] that
//! says which field holds what, and what is allowed. [`library`] has the scenes that are built in.

mod blend;
mod camera;
mod field;
pub mod files;
pub mod library;
mod lights;
pub mod load;
mod material;
mod mesh;
mod objects;
pub mod select;
mod texture;

pub use field::SceneError;
pub use load::Loaded;
