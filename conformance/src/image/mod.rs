//! Images under judgement: each scene as a subject draws it, against what is legal.
//!
//! `drawn` is one image by a subject, `diagnose` says where a wrong one first departs, `run` takes scenes through both, and `cost`
//! measures what effects cost that are not called for.

mod cost;
pub mod diagnose;
pub mod drawn;
pub mod run;

pub use lightmeter_judge::image::*;
