//! The engine: a selection of cases, handed to subjects, whose answers are judged. It knows no GPU: what stands behind a subject is a
//! [`device::Device`].

mod again;
mod ask_again;
pub mod blend_unit;
pub mod device;
mod diagnosed;
pub mod evaluate;
mod expected;
pub mod image;
mod in_turn;
pub mod merge;
pub mod options;
pub mod piece;
pub mod renderer;
mod row_run;
pub mod rows;
pub mod run;
mod scout;
pub mod selection;
pub mod special;
pub mod stability;
pub mod subject;
mod supply;
pub mod sweep;
mod turn;
mod under_way;
pub mod witness;
