//! Mistakes of vectors and transforms.

use super::super::body::Body as Wrong;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::{Before, Body, Instead};
use super::fault;

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "matrix-transposed",
        "columns of a matrix are taken for rows",
        &[
            &[Before(In::Transpose("view")), Before(In::Transpose("model"))],
            &[Before(In::Transpose("view"))],
            &[Before(In::Transpose("modelview"))],
        ],
    )
    .seen_in("row-major matrices uploaded as they are"),
    fault("normals-by-modelview", "normals are transformed by the modelview", &[&[Body(Wrong::NormalByModelview)]])
        .seen_in("documents 000 and 003"),
    fault(
        "normals-by-inverse-transpose",
        "normals are transformed by the inverse transpose where the modelview is asked for",
        &[&[Instead(&[("vector/normal-modelview", "vector/normal-inverse-transpose")])]],
    ),
    fault(
        "inverse-not-transposed",
        "normals are transformed by the inverse, not transposed",
        &[&[Body(Wrong::NormalByInverse)]],
    ),
    fault(
        "determinant-forgotten",
        "normals are transformed by the cofactors, not over the determinant",
        &[&[Body(Wrong::NormalByBareCofactors)]],
    )
    .seen_in("mirrored objects lit from behind"),
    fault(
        "w-divide-missing",
        "a position is not divided by its w",
        &[&[Body(Wrong::NotDivided)], &[Body(Wrong::WindowNotDivided)]],
    ),
    fault("direction-divided", "a light at infinity is divided by its w of 0", &[&[Body(Wrong::DividedAlways)]]),
    fault(
        "matrices-exchanged",
        "model and view are multiplied in the wrong order",
        &[&[Body(Wrong::MatricesExchanged)]],
    ),
    fault(
        "translation-forgotten",
        "a matrix's translation is forgotten",
        &[&[Before(In::NoTranslation("modelview"))], &[Before(In::NoTranslation("view"))]],
    )
    .only(|spec| spec.id != "vector/light-direction"),
    fault(
        "normals-averaged",
        "averaged normals are divided by their number, not normalised",
        &[&[Body(Wrong::MeanNormal)]],
    ),
    fault("winding-reversed", "the face's corners are taken in reverse", &[&[Before(In::Swap("b", "c"))]])
        .only(|spec| {
            let id = spec.id.as_str();
            id.starts_with("vector/face-normal")
                || matches!(id, "lighting/flat" | "interpolation/front-facing" | "interpolation/raster-facing")
        })
        .seen_in("clockwise meshes; a mirrored projection"),
    fault("face-normal-not-normalised", "the normal of a face is not normalised", &[&[Body(Wrong::FaceNotNormalised)]])
        .seen_in("normals weighted by area"),
    fault(
        "zero-normalised",
        "a vector without length is normalised like any other",
        &[&[Instead(&[
            ("vector/normalize", "vector/normalize-unguarded"),
            ("vector/halfway", "vector/halfway-unguarded"),
        ])]],
    )
    .seen_in("GLSL's normalize"),
    fault("normalised-by-sum", "vectors are divided by the sum of their components", &[&[Body(Wrong::NormalizeBySum)]]),
    fault(
        "normalised-by-largest",
        "vectors are divided by their largest component",
        &[&[Body(Wrong::NormalizeByLargest)]],
    ),
    fault("normalised-by-square", "vectors are divided by their squared length", &[&[Body(Wrong::NormalizeBySquare)]]),
    fault("length-squared", "the length is squared", &[&[Body(Wrong::SquaredLength)]]),
];
