//! Mistakes of the depth test.

use super::super::alteration::Form;
use super::super::fault::Fault;
use super::super::fault::Step::{Instead, Test};
use super::super::op::Op;
use super::{fault, form, given, output, pass, swap};
use lightmeter_scene::depth::{Compare, DepthTest};

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "depth-compare-strictness",
        "equal depths are treated the other way: they pass where they should fail, or fail where they should pass",
        &[
            &[Test(other_strictness)],
            &[Instead(&[
                ("depth/same-geometry-less", "depth/same-geometry-less-equal"),
                ("depth/same-geometry-less-equal", "depth/same-geometry-less"),
                ("depth/same-geometry-greater", "depth/same-geometry-greater-equal"),
                ("depth/same-geometry-greater-equal", "depth/same-geometry-greater"),
                ("depth/same-geometry-equal", "depth/same-geometry-not-equal"),
                ("depth/same-geometry-not-equal", "depth/same-geometry-equal"),
                ("depth/same-geometry-always", "depth/same-geometry-never"),
                ("depth/same-geometry-never", "depth/same-geometry-always"),
            ])],
        ],
    )
    .seen_in("GL_LESS for GL_LEQUAL"),
    fault("depth-compare-reversed", "the depth test is the other way round", &[&[Test(reversed_compare)]])
        .seen_in("reversed depth without its compare function"),
    fault(
        "depth-mask-ignored",
        "depth is written where it should not be, or not written where it should be",
        &[&[Test(other_writing)]],
    ),
    fault(
        "depth-written-always",
        "depth is written by fragments that fail the test",
        &[&[pass("depth left", "written")]],
    ),
    fault("depth-not-clamped", "depth is not clamped to [0, 1]", &[&[pass("depth clamped", "depth")]]),
    fault(
        "depth-taken-as-linear",
        "depth is read back as if it grew evenly",
        &[
            &[form("z", Form::LinearDepthRead)],
            &[form("depth", Form::LinearDepth)],
            &[form("reversed depth", Form::LinearDepth)],
        ],
    ),
    fault(
        "planes-exchanged",
        "near and far are exchanged",
        &[&[swap("z", "near", "far")], &[swap("depth", "near", "far")], &[swap("reversed depth", "near", "far")]],
    ),
    fault(
        "depth-from-minus-one",
        "depth is in [−1, 1], OpenGL's, where it is to be in [0, 1]",
        &[
            &[given("z", "depth", Op::Offset(1.0)), given("z", "depth", Op::Scale(0.5))],
            &[output("depth", Op::Scale(2.0)), output("depth", Op::Offset(-1.0))],
        ],
    ),
    fault(
        "depth-read-from-minus-one",
        "depth is read as if it were in [−1, 1] by 2·depth − 1",
        &[&[given("z", "depth", Op::Scale(2.0)), given("z", "depth", Op::Offset(-1.0))]],
    ),
    fault(
        "depth-not-reversed",
        "reversed and ordinary depth are confused",
        &[&[Instead(&[("depth/stored", "depth/stored-reversed"), ("depth/stored-reversed", "depth/stored")])]],
    ),
];

fn other_strictness(test: DepthTest) -> DepthTest {
    let compare = match test.compare {
        Compare::Less => Compare::LessEqual,
        Compare::LessEqual => Compare::Less,
        Compare::Greater => Compare::GreaterEqual,
        Compare::GreaterEqual => Compare::Greater,
        other => other,
    };
    DepthTest { compare, ..test }
}

fn reversed_compare(test: DepthTest) -> DepthTest {
    let compare = match test.compare {
        Compare::Less => Compare::Greater,
        Compare::Greater => Compare::Less,
        Compare::LessEqual => Compare::GreaterEqual,
        Compare::GreaterEqual => Compare::LessEqual,
        Compare::Equal => Compare::NotEqual,
        Compare::NotEqual => Compare::Equal,
        other => other,
    };
    DepthTest { compare, ..test }
}

fn other_writing(test: DepthTest) -> DepthTest {
    DepthTest { write: !test.write, ..test }
}
