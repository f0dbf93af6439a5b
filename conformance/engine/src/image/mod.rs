//! Images under judgement: each scene as a subject draws it, against what is legal.
//!
//! `drawn` is one image by a subject, `diagnose` says where a wrong one first departs, and `run` takes scenes through both.

pub mod diagnose;
pub mod drawn;
pub mod run;

pub use lightmeter_judge::image::*;
