//! Mistakes of vectors and transforms.

use super::super::alteration::{Do, Form, NORMALISED};
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::{Before, Instead};
use super::super::op::Op;
use super::{at, fault, form, given, input, pass, pass_as, result, swap};

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "matrix-transposed",
        "columns of a matrix are taken for rows",
        &[
            &[input("view", Op::Transpose), input("model", Op::Transpose)],
            &[input("view", Op::Transpose)],
            &[input("modelview", Op::Transpose)],
        ],
    )
    .seen_in("row-major matrices uploaded as they are"),
    fault(
        "normals-by-modelview",
        "normals are transformed by the modelview",
        &[&[form("modelview⁻ᵀ·n", Form::NormalByModelview)], &[form("⟨modelview⁻ᵀ·n⟩", Form::NormalByModelview)]],
    )
    .seen_in("documents 000 and 003"),
    fault(
        "normals-by-inverse-transpose",
        "normals are transformed by the inverse transpose where the modelview is asked for",
        &[&[Instead(&[("vector/normal-modelview", "vector/normal-inverse-transpose")])]],
    ),
    fault(
        "inverse-not-transposed",
        "normals are transformed by the inverse, not transposed",
        &[&[form("modelview⁻ᵀ·n", Form::NormalByInverse)], &[form("⟨modelview⁻ᵀ·n⟩", Form::NormalByInverse)]],
    ),
    fault(
        "determinant-forgotten",
        "normals are transformed by the cofactors, not over the determinant",
        &[&[form("modelview⁻ᵀ·n", Form::NormalByCofactors)], &[form("⟨modelview⁻ᵀ·n⟩", Form::NormalByCofactors)]],
    )
    .seen_in("mirrored objects lit from behind"),
    fault(
        "determinant-without-its-sign",
        "normals are transformed by the cofactors over the determinant's absolute value",
        &[&[form("modelview⁻ᵀ·n", Form::NormalByUnsigned)], &[form("⟨modelview⁻ᵀ·n⟩", Form::NormalByUnsigned)]],
    )
    .seen_in("mirrored objects lit from behind"),
    fault(
        "normal-normalised",
        "the normal is normalised, where the formula keeps its length",
        &[&[result("modelview⁻ᵀ·n", Op::Normalize)], &[result("normal by the modelview", Op::Normalize)]],
    ),
    fault(
        "w-divide-missing",
        "a position is not divided by its w",
        &[&[form("xyz/w", Form::NotDivided)], &[form("ndc", Form::NotDivided)]],
    ),
    fault(
        "direction-divided",
        "a light at infinity is divided by its w of 0",
        &[&[form("xyz/w", Form::DividedAlways)]],
    ),
    fault(
        "negative-w-not-divided",
        "a position whose w is below 0 is not divided by it",
        &[&[form("xyz/w", Form::DividedIfPositive)]],
    )
    .seen_in("w > 0 for w ≠ 0"),
    fault(
        "w-without-its-sign",
        "a position is divided by w's absolute value",
        &[&[given("xyz/w", "eye", Op::Component(3, &Op::Abs))]],
    ),
    fault(
        "matrices-exchanged",
        "model and view are multiplied in the wrong order",
        &[&[swap("view·model·position", "view", "model")]],
    ),
    fault(
        "translation-forgotten",
        "a matrix's translation is forgotten",
        &[&[input("modelview", Op::NoTranslation)], &[input("view", Op::NoTranslation)]],
    )
    .only(|spec| spec.id != "vector/light-direction"),
    fault(
        "normals-averaged",
        "averaged normals are divided by their number, not normalised",
        &[&[pass_as("⟨Σn⟩", "sum", Op::Scale(1.0 / 3.0))]],
    ),
    fault("winding-reversed", "the face's corners are taken in reverse", &[&[Before(In::Swap("b", "c"))]])
        .only(|spec| {
            let id = spec.id.as_str();
            id.starts_with("vector/face-normal")
                || matches!(id, "lighting/flat" | "interpolation/front-facing" | "interpolation/raster-facing")
        })
        .seen_in("clockwise meshes; a mirrored projection"),
    fault("face-normal-not-normalised", "the normal of a face is not normalised", &[&[pass("face's n", "cross")]])
        .seen_in("normals weighted by area"),
    fault(
        "zero-normalised",
        "a vector without length is normalised like any other",
        &[
            &[Instead(&[
                ("vector/normalize", "vector/normalize-unguarded"),
                ("vector/halfway", "vector/halfway-unguarded"),
            ])],
            &[pass_as("l", "to_light", Op::NormalizeAny)],
            &[pass_as("face's n", "cross", Op::NormalizeAny)],
            &[pass_as("⟨Σn⟩", "sum", Op::NormalizeAny)],
            &[pass_as("⟨n⟩", "n", Op::NormalizeAny)],
        ],
    )
    .seen_in("GLSL's normalize"),
    fault(
        "normalised-by-sum",
        "vectors are divided by the sum of their components' magnitudes",
        &[&[pass_as("⟨v⟩", "v", Op::OverSum)]],
    ),
    fault(
        "normalised-by-largest",
        "vectors are divided by their largest component",
        &[&[pass_as("⟨v⟩", "v", Op::OverLargest)]],
    ),
    fault(
        "normalised-by-square",
        "vectors are divided by their squared length",
        &[&[pass_as("⟨v⟩", "v", Op::OverSquare)]],
    ),
    fault("length-squared", "the length is squared", &[&[form("|v|", Form::SquaredLength)]]),
    fault(
        "model-matrix-lost",
        "the model matrix is not applied",
        &[&[given("view·model·position", "model", Op::Identity)]],
    ),
    fault(
        "view-matrix-lost",
        "the view matrix is not applied",
        &[&[given("view·model·position", "view", Op::Identity)], &[given("view·direction", "view", Op::Identity)]],
    ),
    fault("modelview-lost", "the modelview matrix is not applied", &[&[input("modelview", Op::Identity)]]),
    fault(
        "fast-inverse-square-root",
        "vectors are normalised by an approximate inverse square root",
        &[&[at(NORMALISED, Do::FirstAs(Op::FastNormalize))]],
    )
    .seen_in("Quake III's Q_rsqrt"),
    fault(
        "short-vectors-without-direction",
        "a vector shorter than 1e-7 is taken for one without a length",
        &[&[at(NORMALISED, Do::FirstAs(Op::NormalizeFrom(1e-7)))]],
    )
    .seen_in("an epsilon added to the squared length"),
    fault(
        "z-axis-for-zero",
        "the z axis is taken for a vector without length",
        &[&[at(NORMALISED, Do::FirstAs(Op::NormalizeOrZ))]],
    )
    .seen_in("guards against NaN"),
    fault(
        "epsilon-added-to-length",
        "1e-6 is added to the length that a vector is divided by",
        &[&[at(NORMALISED, Do::FirstAs(Op::OverLengthPlus(1e-6)))]],
    ),
    fault(
        "length-at-least-1e-12",
        "the length that a vector is divided by is held above 1e-12",
        &[&[at(NORMALISED, Do::FirstAs(Op::OverLengthAtLeast(1e-12)))]],
    )
    .seen_in("PyTorch, functional.normalize"),
    fault(
        "normalised-by-sum-to-the-light",
        "the vector to the light is divided by the sum of its components' magnitudes",
        &[&[pass_as("l", "to_light", Op::OverSum)]],
    ),
];
