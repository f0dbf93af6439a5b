//! Mistakes of the depth test.

use super::super::body::Body as Wrong;
use super::super::fault::Fault;
use super::super::fault::Step::Body;
use super::fault;

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "depth-compare-strictness",
        "equal depths pass where they are not to, or the reverse",
        &[&[Body(Wrong::OtherStrictness)]],
    )
    .seen_in("GL_LESS for GL_LEQUAL"),
    fault("depth-compare-reversed", "the depth test is the other way round", &[&[Body(Wrong::ReversedCompare)]])
        .seen_in("reversed depth without its compare function"),
    fault(
        "depth-mask-ignored",
        "depth is written where it is not to be, or the reverse",
        &[&[Body(Wrong::OtherWriting)]],
    ),
    fault("depth-written-always", "depth is written by fragments that fail the test", &[&[Body(Wrong::WrittenAlways)]]),
    fault("depth-not-clamped", "depth is not clamped to [0, 1]", &[&[Body(Wrong::DepthNotClamped)]]),
    fault("depth-taken-as-linear", "depth is read back as if it grew evenly", &[&[Body(Wrong::LinearDepth)]]),
    fault(
        "planes-exchanged",
        "near and far are exchanged where depth is read back",
        &[&[Body(Wrong::PlanesExchanged)]],
    ),
];
