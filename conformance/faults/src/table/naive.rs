//! Forms that lose what a stable one keeps.

use super::super::fault::Fault;
use super::super::fault::Step::Naive;
use super::fault;
use lightmeter_catalogue::cases::Spec;

pub(super) const FAULTS: &[Fault] =
    &[fault("naive-form", "the formula is evaluated in the naive form that it is the stable one of", &[&[Naive]])
        .only(is_wrong)
        .rounding()];

/// Elsewhere the accuracy rules permit what the naive form gives: that the stable one is better is its own claim.
fn is_wrong(spec: &Spec) -> bool {
    let permitted =
        ["fog/exp2-document", "fog/exp2-opengl", "interpolation/edge-compensated", "blend/subtract-compensated"];
    !permitted.contains(&spec.id.as_str())
}
