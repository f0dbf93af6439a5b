//! Mistakes in how a colour is given out, whatever it is of.

use super::super::change::After as Out;
use super::super::fault::Step::After;
use super::super::fault::{Fault, Step};
use super::super::op::Op;
use super::{colors, fault, input, where_colors_are_drawn};
use lightmeter_catalogue::cases::{Kind, Spec};

pub(super) const FAULTS: &[Fault] = &[
    fault("gamma-encoded", "the output is gamma-encoded, c^(1/2.2)", &[&[colors(Op::Rgb(&Op::Power(1.0 / 2.2)))]])
        .only(where_colors_are_drawn),
    fault("srgb-encoded", "the output is sRGB-encoded", &[&[colors(Op::Rgb(&Op::Encode))]])
        .only(where_colors_are_drawn)
        .seen_in("three.js, the default output colour space"),
    fault("srgb-decoded", "the output is decoded as if it were sRGB", &[&[colors(Op::Rgb(&Op::Decode))]])
        .only(where_colors_are_drawn),
    fault(
        "materials-decoded",
        "the material's colours are decoded as if they were sRGB",
        &[
            &[input("ma", Op::Rgb(&Op::Decode)), input("md", Op::Rgb(&Op::Decode)), input("ms", Op::Rgb(&Op::Decode))],
            &[input("ma", Op::Rgb(&Op::Decode))],
            &[input("md", Op::Rgb(&Op::Decode))],
            &[input("ms", Op::Rgb(&Op::Decode))],
            &[input("diffuse", Op::Rgb(&Op::Decode)), input("specular", Op::Rgb(&Op::Decode))],
            &[input("surface", Op::Rgb(&Op::Decode))],
            &[input("texel", Op::Rgb(&Op::Decode))],
        ],
    )
    .only(|spec| spec.id != "lighting/highlight-plastic")
    .seen_in("three.js, Color.setHex under colour management"),
    fault("output-clamped", "the sum is clamped to [0, 1] before the target's own clamp", &[&[colors(Op::Clamp)]])
        .only(where_sums_go_beyond)
        .seen_in("OpenGL's fixed function"),
    fault("red-and-blue-swapped", "red and blue are swapped", &[&[colors(Op::RedBlue)]])
        .only(where_colors_are_drawn)
        .seen_in("BGRA read as RGBA"),
    fault("truncated-store", "the output is cut to whole 255ths", &[&[colors(Op::Truncate)]])
        .only(where_colors_are_drawn),
    fault("stored-in-8-bits", "the output is rounded to whole 255ths", &[&[colors(Op::Bytes)]])
        .only(where_colors_are_drawn)
        .seen_in("answers read back from an 8-bit target"),
    fault(
        "all-stored-in-8-bits",
        "every output is rounded to whole 255ths, colours and others",
        &[&[After(Out::All(Op::Bytes))]],
    )
    .only(where_colors_are_drawn)
    .seen_in("answers read back from an 8-bit target"),
    fault("premultiplied-output", "the output is multiplied by its alpha", &[&[colors(Op::Premultiply)]])
        .only(where_alpha_varies)
        .seen_in("a browser's canvas"),
    fault("alpha-dropped", "alpha is 1 whatever it is to be", &[&[colors(Op::Opaque)]])
        .only(where_alpha_varies)
        .seen_in("three.js, materials not marked transparent"),
    fault(
        "alpha-clamped",
        "alpha is clamped to [0, 1] before the target's own clamp",
        &[&[colors(Op::Component(3, &Op::Clamp))]],
    )
    .only(where_alpha_goes_beyond),
    fault("alpha-zero", "alpha is 0", &[&[colors(Op::Component(3, &Op::Set(0.0)))]]).only(where_colors_are_drawn),
    fault("alpha-srgb-encoded", "alpha is sRGB-encoded", &[&[colors(Op::Component(3, &Op::Encode))]])
        .only(where_alpha_varies),
    fault("alpha-summed", "alpha is the sum of all terms, as the colours are", &[&[Step::AlphaSummed]]),
    fault("alpha-of-the-texture", "alpha is the texture's", &[&[After(Out::Take("color", "texel"))]]),
    fault("alpha-of-the-color", "alpha is the colour's alone", &[&[After(Out::Take("color", "color"))]]),
    fault(
        "lights-limited",
        "the lights' colours are limited to 1",
        &[
            &[input("la", Op::AtMost(1.0)), input("ld", Op::AtMost(1.0)), input("ls", Op::AtMost(1.0))],
            &[input("la", Op::AtMost(1.0))],
            &[input("ld", Op::AtMost(1.0))],
            &[input("ls", Op::AtMost(1.0))],
            &[input("color0", Op::AtMost(1.0)), input("color1", Op::AtMost(1.0))],
        ],
    ),
    fault("negative-clamped", "colours are held above 0", &[&[colors(Op::AtLeast(0.0))]])
        .only(where_colors_are_computed),
    fault("bright-clamped", "colours are limited to 1", &[&[colors(Op::AtMost(1.0))]]).only(where_colors_are_computed),
];

/// Whether an alpha comes out that may be other than 1.
fn where_alpha_varies(spec: &Spec) -> bool {
    where_colors_are_drawn(spec)
        && match spec.family() {
            "lighting" => matches!(spec.id.as_str(), "lighting/point-opengl" | "lighting/two-lights"),
            "color" => matches!(spec.id.as_str(), "color/modulate" | "color/replace"),
            _ => true,
        }
}

/// Where an alpha comes out that may leave [0, 1].
fn where_alpha_goes_beyond(spec: &Spec) -> bool {
    spec.id == "lighting/two-lights" || spec.id == "color/modulate" || spec.id == "color/replace"
}

/// Sums that may leave [0, 1].
fn where_sums_go_beyond(spec: &Spec) -> bool {
    match spec.family() {
        // Attenuated light is seldom as bright as that.
        "lighting" if spec.place("kc").is_some() => false,
        "lighting" => {
            !["ambient", "diffuse-", "specular-", "highlight-"]
                .iter()
                .any(|stem| spec.id["lighting/".len()..].starts_with(stem))
                || spec.id == "lighting/ambient-constant"
        }
        _ => matches!(spec.id.as_str(), "blend/mode-add" | "blend/unpremultiply" | "blend/unpremultiply-guarded"),
    }
}

/// Draws with a state have their own mistake of this kind.
fn where_colors_are_computed(spec: &Spec) -> bool {
    where_colors_are_drawn(spec) && matches!(spec.kind, Kind::Arithmetic)
}
