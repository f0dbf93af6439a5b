//! Where a source document cannot be taken at its word, or where several forms are in use: what the suite holds renderers to, and why.

/// What is decided of a question that the documents leave open, or answer wrongly.
#[derive(Clone, Copy, Debug)]
pub struct Ruling {
    /// Its number, by which formulas, scenes and pages name it.
    pub number: u32,
    /// What it is about.
    pub title: &'static str,
    /// What the documents say.
    pub document: &'static str,
    /// What is right.
    pub right: &'static str,
    /// Why.
    pub why: &'static str,
    /// The forms that the suite keeps, by the ids or the words that tell them apart.
    pub forms: &'static str,
}

/// A source document.
#[derive(Clone, Copy, Debug)]
pub struct SourceDocument {
    /// The number by which formulas name it, as in "000 §6.5".
    pub name: &'static str,
    /// What it is.
    pub what: &'static str,
}

/// The source documents.
pub const SOURCES: &[SourceDocument] = &[
    SourceDocument {
        name: "000",
        what: "lecture notes, in Spanish: \"Color e iluminación\", unit 6 of a course on virtual reality: colour, Phong's lighting, fog, \
               blending and depth, with programs in GLSL",
    },
    SourceDocument {
        name: "002",
        what: "lecture notes, in Spanish: \"Mezclado de colores\", unit 6 of a course on 3D programming: blending, cutouts and lightmaps",
    },
    SourceDocument {
        name: "003",
        what: "a tutorial, in Spanish: \"Modelo de iluminación Phong\" in OpenGL, with programs for Phong's and Gouraud's shading",
    },
    SourceDocument {
        name: "004",
        what: "lecture notes, in English: \"OpenGL Shading\", lecture 7 of Foundations of Computer Graphics: Blinn's highlight, attenuation, two lights",
    },
];

/// All rulings, in the order of their numbers.
pub const RULINGS: &[Ruling] = &[
    Ruling {
        number: 1,
        title: "SRC_ALPHA_SATURATE",
        document: "000 computes the factor min(As, 1 − As).",
        right: "min(As, 1 − Ad): the destination's alpha stands in it.",
        why: "OpenGL, Vulkan and WebGPU define it so, and Mesa's OpenGL gives it.",
        forms: "`blend/saturate-source-only` is the document's",
    },
    Ruling {
        number: 2,
        title: "The vector to a light at a point",
        document: "000 calls normalize(Lpos − Vpos) the vector −s.",
        right: "It points to the light, so it is s.",
        why: "003 and 004 agree, and so does geometry.",
        forms: "none: the other sign is a mistake that the diagnosis names",
    },
    Ruling {
        number: 3,
        title: "Blinn's halfway vector",
        document: "000 takes v + s as it is.",
        right: "It is normalised before its cosine is raised to a power.",
        why: "004 normalises it; without that the highlight's size changes with the angle.",
        forms: "`vector/halfway-unnormalised` is the document's",
    },
    Ruling {
        number: 4,
        title: "Squared exponential fog",
        document: "000 computes exp(−d·z²).",
        right: "Both that and exp(−(d·z)²), each under its own name.",
        why: "OpenGL squares the density, too. Neither is an error: they give their density different units.",
        forms: "`fog/exp2-document`, `fog/exp2-opengl`",
    },
    Ruling {
        number: 5,
        title: "Components of a direction",
        document: "000 sums four components in its diffuse term, w among them.",
        right: "Three: a direction has w = 0.",
        why: "The w of a point would add to the cosine.",
        forms: "none",
    },
    Ruling {
        number: 6,
        title: "Normals in eye space",
        document: "000 and 003 transform normals by the modelview.",
        right: "By the inverse transpose of its upper left 3 × 3.",
        why: "Both agree up to length for rigid motion and uniform scale; under other scale only the inverse transpose stays \
              perpendicular to the surface.",
        forms: "`vector/normal-modelview`, `vector/normal-inverse-transpose`; in scenes `normals: modelview`",
    },
    Ruling {
        number: 7,
        title: "The provoking vertex",
        document: "000 takes a flat attribute from the last vertex.",
        right: "LAST and FIRST are both formulas.",
        why: "OpenGL takes the last, Vulkan and WebGPU the first. WebGPU offers no choice, so LAST is reached by turning the indices round.",
        forms: "`interpolation/flat-last`, `interpolation/flat-first`",
    },
    Ruling {
        number: 8,
        title: "The ambient term",
        document: "000 multiplies ambient light and material; 004 adds a constant.",
        right: "Both are formulas.",
        why: "Each is in use, and neither follows from the other.",
        forms: "`lighting/ambient`, `lighting/ambient-constant`; in scenes `product` and `constant`",
    },
    Ruling {
        number: 9,
        title: "A highlight where the light is behind the surface",
        document: "000, 003 and 004 compute the highlight whatever the sign of n·l.",
        right: "Both that and the gated one, each by its name.",
        why: "OpenGL's fixed function sets it to 0 where n·l ≤ 0.",
        forms: "`lighting/phong-gated`, `lighting/point-opengl`; in scenes `specular_gate: documents` and `opengl`",
    },
    Ruling {
        number: 10,
        title: "The range of the fog factor",
        document: "000 clamps it in its shader and not in its text.",
        right: "It is clamped to [0, 1]. Where dmin = dmax it is a step; where dmax < dmin fog is turned round.",
        why: "OpenGL does so, and a factor beyond [0, 1] mixes colours that are not there.",
        forms: "none",
    },
    Ruling {
        number: 11,
        title: "What attenuation and spotlights weaken",
        document: "004 multiplies the diffuse and the specular term.",
        right: "Attenuation and spotlights weaken the diffuse and the specular term. OpenGL's fixed function also weakens the light's ambient term, which is a separate formula.",
        why: "Both are in use.",
        forms: "`lighting/point-opengl`; in scenes `light_ambient: documents` and `opengl`",
    },
    Ruling {
        number: 12,
        title: "A power of a cosine that is 0",
        document: "No document says what max(c, 0)^S is at c ≤ 0.",
        right: "0 for S > 0. For S = 0 it is 1 where c > 0, and where c ≤ 0 both 0 and 1 are legal. Where rounding leaves the sign of c \
                open, everything from 0 to the greater end is.",
        why: "pow(0, 0) is undefined in every shading language.",
        forms: "none",
    },
    Ruling {
        number: 13,
        title: "Which way a light's direction points",
        document: "000's is the way in which light travels, 004's points to the light.",
        right: "Both, by name; each formula says which it takes.",
        why: "Each is in use, and taking one for the other is the commonest mistake of all.",
        forms: "`direction: travel` and `toward`; `lighting/diffuse-travel`, `lighting/diffuse-toward`",
    },
    Ruling {
        number: 14,
        title: "Alpha of a lit colour",
        document: "000 and 003 write 1, 004 sums it like a colour, so that it may exceed 1.",
        right: "These and that of the diffuse material, each by name.",
        why: "OpenGL's fixed function takes the material's.",
        forms: "`one`, `sum`, `material`; `lighting/two-lights` sums",
    },
    Ruling {
        number: 15,
        title: "What gl_FragDepth is where a shader does not write it",
        document: "000 says \"z in homogeneous coordinates\".",
        right: "The z of the window: after the division by w and the viewport.",
        why: "The depth test compares that.",
        forms: "none",
    },
    Ruling {
        number: 16,
        title: "Negative cosines",
        document: "000 has max(…, 0) in its shaders and not in its text.",
        right: "With max, in the diffuse and in the specular term.",
        why: "A light behind a surface takes no light away.",
        forms: "none: leaving out the max is a mistake, which the diagnosis names",
    },
];

/// The page of sources, rulings and words.
#[must_use]
pub fn markdown() -> String {
    let mut page = String::from(
        "# Sources, rulings and words\n\nFormulas name where they are from, as \"000 §6.5\": section 6.5 of document 000. Where documents are \
         wrong, or differ, a ruling says what the suite holds renderers to; formulas, scenes and pages name it by its number. `lightmeter \
         show ruling/9` prints one.\n\n## Sources\n\n| name | what it is |\n|---|---|\n",
    );
    for SourceDocument { name, what } in SOURCES {
        page += &format!("| {name} | {what} |\n");
    }
    page +=
        "\n## Rulings\n\n| ruling | what the documents say | what is right | why | forms |\n|---|---|---|---|---|\n";
    for Ruling { number, title, document, right, why, forms } in RULINGS {
        page +=
            &format!("| <a id=\"ruling-{number}\"></a>{number}: {title} | {document} | {right} | {why} | {forms} |\n");
    }
    page += "\n## Words with a meaning of their own\n\n| word | what it means here |\n|---|---|\n";
    for (word, meaning) in GLOSSARY {
        page += &format!("| {word} | {meaning} |\n");
    }
    page
}

/// The words that mean something in particular here.
pub const GLOSSARY: &[(&str, &str)] = &[
    ("adapter", "what runs shaders: a GPU with its driver, or a driver that needs none, such as lavapipe"),
    ("case", "one input of a formula, a blend state or a table of special values, or one pixel of a scene, with an id"),
    ("verdict", "whether one number that came out of a case in one stage is legal"),
    ("legal", "within the interval that the accuracy rules allow for this input"),
    (
        "undecided",
        "a verdict where the rules allow any value, such as of an overflow; it neither passes nor fails (`indeterminate` in the JSON)",
    ),
    ("margin", "how much of its tolerance a value takes: 1 is all of it, and more fails"),
    ("profile", "the accuracy rules that a renderer is held to: WGSL's, Vulkan's or OpenGL's"),
    ("hard case", "an input at which a formula is easily computed wrongly; its name says what makes it hard"),
    (
        "stable form, naive form",
        "two ways to compute the same: one that keeps its accuracy at hard cases, and the one that loses it there",
    ),
    (
        "stage",
        "where a formula is computed: the compute stage, the fragment stage, the rasteriser, the blend unit; `answer` of another renderer",
    ),
    (
        "deviation",
        "a departure of a driver from the rules that is known, named and granted as long as its witness still shows it",
    ),
    (
        "witness",
        "a fixed case in which a deviation shows; once it no longer does, the driver has been fixed and the deviation can be removed",
    ),
    ("dialect", "one of several forms in use, such as OpenGL's and the documents' exponential fog"),
    (
        "ULP",
        "the distance of two neighbouring floats at a number's size; an error of 2 ULP has one more float between the value and the reference",
    ),
    (
        "condition, condition number",
        "by how much a rounding of the inputs grows in the result: 1 where it stays what it is, 1e6 where six digits are lost",
    ),
    ("mistake", "a way to compute a formula or a scene wrongly that the diagnosis knows by name"),
    (
        "marked pixel",
        "a pixel of a scene whose colour depends on a decision that rounding may turn, such as whether an edge covers it; it is judged by all colours that are legal there, and left out of the statistics of errors",
    ),
    (
        "group verdict",
        "that values which are legal one by one lie to one side together, further than rounding explains",
    ),
    ("scouted", "judged by its first few cases ahead of the rest, so that what fails is told early"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_of_rulings_is_as_written_here() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/rulings.md");
        let page = std::fs::read_to_string(&path).unwrap_or_default();
        assert_eq!(page, markdown(), "`lightmeter page rulings --out docs/rulings.md` writes it");
    }

    #[test]
    fn rulings_are_numbered_without_a_gap() {
        assert!(RULINGS.iter().zip(1..).all(|(ruling, number)| ruling.number == number));
    }
}
