//! Images under judgement: each scene as a subject draws it, against what is legal.
//!
//! `drawn` is one image by a subject, `diagnose` says where a wrong one first departs, `verdict` judges one, and `run` takes scenes
//! through all of these. `asked` takes the images of renderers that are asked case by case, of which there is nothing but the image.

pub(crate) mod asked;
pub mod diagnose;
pub mod drawn;
pub mod run;
pub mod verdict;
