//! Where programs in use compute different things by the same name: who computes what.

/// Whose form it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speaker {
    /// The source documents, or some of them.
    Documents,
    /// OpenGL, by its fixed function or its rules.
    OpenGl,
    /// three.js 0.180, by its built-in materials.
    ThreeJs,
}

impl Speaker {
    /// All of them, in the order in which they are told.
    pub const ALL: [Self; 3] = [Self::Documents, Self::OpenGl, Self::ThreeJs];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Documents => "the documents",
            Self::OpenGl => "OpenGL",
            Self::ThreeJs => "three.js",
        }
    }
}

/// What one of them computes.
#[derive(Clone, Copy, Debug)]
pub struct DialectForm {
    /// Who computes it.
    pub speaker: Speaker,
    /// The ids of formulas that compute it; none where the suite has no such formula.
    pub formulas: &'static [&'static str],
    /// What it is, in words.
    pub what: &'static str,
}

/// A thing that is computed in different ways.
#[derive(Clone, Copy, Debug)]
pub struct Dialects {
    /// What it is about.
    pub title: &'static str,
    /// The number of the ruling that decides what the suite does, where there is one.
    pub ruling: Option<u32>,
    /// Who computes what.
    pub forms: &'static [DialectForm],
}

impl Dialects {
    /// Whether a formula is one of the forms.
    #[must_use]
    pub fn concern(&self, id: &str) -> bool {
        self.forms.iter().any(|form| form.formulas.contains(&id))
    }
}

const fn documents(formulas: &'static [&'static str], what: &'static str) -> DialectForm {
    DialectForm { speaker: Speaker::Documents, formulas, what }
}

const fn opengl(formulas: &'static [&'static str], what: &'static str) -> DialectForm {
    DialectForm { speaker: Speaker::OpenGl, formulas, what }
}

const fn threejs(formulas: &'static [&'static str], what: &'static str) -> DialectForm {
    DialectForm { speaker: Speaker::ThreeJs, formulas, what }
}

/// All that is known to be computed in different ways.
pub const DIALECTS: &[Dialects] = &[
    Dialects {
        title: "Linear fog",
        ruling: Some(10),
        forms: &[
            documents(
                &["fog/linear", "fog/linear-radial"],
                "a ramp from dmin to dmax; 000's text does not clamp it, its shader does",
            ),
            opengl(
                &["fog/linear", "fog/linear-radial", "fog/linear-multiply-add"],
                "a ramp, clamped; the distance is |z|, or |p| by an extension",
            ),
            threejs(&[], "smoothstep(near, far, −z) in place of a ramp"),
        ],
    },
    Dialects {
        title: "Exponential fog",
        ruling: None,
        forms: &[
            documents(&["fog/exp"], "exp(−density·|z|)"),
            opengl(&["fog/exp", "fog/exp-radial"], "exp(−density·c), where c is |z|, or |p| by an extension"),
            threejs(&[], "none: three.js has linear and squared exponential fog"),
        ],
    },
    Dialects {
        title: "Squared exponential fog",
        ruling: Some(4),
        forms: &[
            documents(
                &["fog/exp2-document", "fog/exp2-document-radial", "fog/exp2-document-square"],
                "exp(−density·z²): the density is not squared",
            ),
            opengl(
                &["fog/exp2-opengl", "fog/exp2-opengl-radial", "fog/exp2-opengl-squares"],
                "exp(−(density·c)²): the density is squared, too",
            ),
            threejs(
                &["fog/exp2-opengl", "fog/exp2-opengl-squares"],
                "1 − exp(−density²·z²), by which the fog is mixed in",
            ),
        ],
    },
    Dialects {
        title: "Which way a light's direction points",
        ruling: Some(13),
        forms: &[
            documents(
                &[
                    "lighting/diffuse-travel",
                    "lighting/phong",
                    "lighting/blinn",
                    "lighting/diffuse-toward",
                    "lighting/two-lights",
                ],
                "000: the way in which light travels; 004: towards the light",
            ),
            opengl(&["lighting/diffuse-toward"], "towards the light: GL_POSITION with w = 0"),
            threejs(&["lighting/diffuse-toward"], "towards the light: from its target to its position"),
        ],
    },
    Dialects {
        title: "A highlight where the light is behind the surface",
        ruling: Some(9),
        forms: &[
            documents(
                &["lighting/phong", "lighting/blinn", "lighting/point-phong", "lighting/point-blinn"],
                "computed whatever the sign of n·l",
            ),
            opengl(&["lighting/phong-gated", "lighting/point-opengl", "lighting/blinn-stable"], "0 where n·l ≤ 0"),
            threejs(&[], "multiplied by max(n·l, 0), which it falls off with"),
        ],
    },
    Dialects {
        title: "The half vector",
        ruling: Some(3),
        forms: &[
            documents(
                &["vector/halfway", "vector/halfway-unnormalised", "lighting/blinn", "lighting/blinn-unnormalised"],
                "004 normalises it, 000 does not",
            ),
            opengl(&["vector/halfway", "lighting/point-opengl"], "normalised"),
            threejs(&["vector/halfway"], "normalised"),
        ],
    },
    Dialects {
        title: "The highlight itself",
        ruling: None,
        forms: &[
            documents(
                &["lighting/specular-phong", "lighting/phong", "lighting/specular-blinn", "lighting/blinn"],
                "(r·v)^S by 000 and 003, (n·h)^S by 000 and 004",
            ),
            opengl(&["lighting/specular-blinn", "lighting/point-opengl"], "(n·h)^S"),
            threejs(&[], "(S/2 + 1)/4 · (n·h)^S · n·l, with Schlick's Fresnel term towards white (MeshPhongMaterial)"),
        ],
    },
    Dialects {
        title: "The ambient term",
        ruling: Some(8),
        forms: &[
            documents(
                &["lighting/ambient", "lighting/ambient-constant"],
                "000 multiplies light and material, 004 adds a constant",
            ),
            opengl(&["lighting/ambient"], "light and material are multiplied, of each light and of the whole scene"),
            threejs(&["lighting/ambient"], "the ambient light times the material's diffuse colour"),
        ],
    },
    Dialects {
        title: "Attenuation",
        ruling: None,
        forms: &[
            documents(
                &[
                    "attenuation/polynomial",
                    "attenuation/point",
                    "attenuation/constant",
                    "attenuation/linear",
                    "attenuation/square",
                ],
                "1/(kc + kl·d + kq·d²)",
            ),
            opengl(&["attenuation/polynomial", "attenuation/point"], "1/(kc + kl·d + kq·d²)"),
            threejs(&[], "1/max(d^decay, 0.01), times a window that ends at the light's range"),
        ],
    },
    Dialects {
        title: "What attenuation and spotlights weaken",
        ruling: Some(11),
        forms: &[
            documents(
                &["lighting/point-phong", "lighting/point-blinn", "lighting/spot"],
                "the diffuse and the specular term",
            ),
            opengl(&["lighting/point-opengl"], "the light's ambient term as well"),
            threejs(&["lighting/point-blinn"], "the diffuse and the specular term: lights have no ambient term"),
        ],
    },
    Dialects {
        title: "Spotlights",
        ruling: None,
        forms: &[
            documents(&["attenuation/spot-cutoff"], "000: a cone with a sharp edge"),
            opengl(
                &["attenuation/spot-exponent", "attenuation/spot-exponent-by-chord", "lighting/spot"],
                "a sharp edge, and within it max(−l·axis, 0)^e",
            ),
            threejs(&[], "smoothstep between the cosines of the cone and of its penumbra"),
        ],
    },
    Dialects {
        title: "Normals in eye space",
        ruling: Some(6),
        forms: &[
            documents(
                &["vector/normal-modelview", "vector/normal-inverse-transpose"],
                "000 and 003 take the modelview, 004 its inverse transpose",
            ),
            opengl(
                &["vector/normal-inverse-transpose"],
                "the inverse transpose; the length is restored by GL_NORMALIZE",
            ),
            threejs(&["vector/normal-inverse-transpose"], "the inverse transpose (normalMatrix), normalised"),
        ],
    },
    Dialects {
        title: "Alpha of a lit colour",
        ruling: Some(14),
        forms: &[
            documents(&["lighting/phong", "lighting/two-lights"], "1 by 000 and 003; 004 sums it like a colour"),
            opengl(&["lighting/point-opengl"], "the alpha of the diffuse material"),
            threejs(&[], "the material's opacity"),
        ],
    },
    Dialects {
        title: "The provoking vertex",
        ruling: Some(7),
        forms: &[
            documents(&["interpolation/flat-last"], "the last vertex"),
            opengl(
                &["interpolation/flat-last", "interpolation/flat-first"],
                "the last vertex, or the first by glProvokingVertex",
            ),
            threejs(&["interpolation/flat-last"], "the last vertex, as WebGL has it"),
        ],
    },
    Dialects {
        title: "Depth in clip coordinates",
        ruling: None,
        forms: &[
            documents(&["interpolation/viewport-opengl", "interpolation/clip-volume-opengl"], "z from −w to w"),
            opengl(
                &["interpolation/viewport-opengl", "interpolation/clip-volume-opengl"],
                "z from −w to w; Vulkan and WebGPU take 0 to w (interpolation/viewport, interpolation/clip-volume)",
            ),
            threejs(&["interpolation/viewport-opengl", "interpolation/clip-volume-opengl"], "z from −w to w on WebGL"),
        ],
    },
    Dialects {
        title: "SRC_ALPHA_SATURATE",
        ruling: Some(1),
        forms: &[
            documents(&["blend/saturate-source-only"], "000: min(As, 1 − As)"),
            opengl(&["blend/add/src-alpha-saturate/one"], "min(As, 1 − Ad)"),
            threejs(&["blend/add/src-alpha-saturate/one"], "min(As, 1 − Ad), as WebGL has it"),
        ],
    },
    Dialects {
        title: "Colours multiplied",
        ruling: None,
        forms: &[
            documents(&["blend/mode-mul", "color/modulate"], "002: src * dst, which reads no alpha"),
            opengl(&["color/modulate"], "GL_MODULATE multiplies a texture; blending leaves the factors to the program"),
            threejs(&[], "MultiplyBlending is src·As·dst + dst·(1 − As)"),
        ],
    },
];

#[cfg(test)]
mod tests {
    use super::{DIALECTS, Speaker};
    use crate::rulings::RULINGS;
    use crate::select::catalogue;

    #[test]
    fn every_form_is_a_formula_and_everybody_is_told() {
        let catalogue = catalogue();
        for one in DIALECTS {
            let speakers: Vec<Speaker> = one.forms.iter().map(|form| form.speaker).collect();
            assert_eq!(speakers, Speaker::ALL, "{}", one.title);
            for id in one.forms.iter().flat_map(|form| form.formulas) {
                assert!(catalogue.iter().any(|member| member.spec.id == *id), "{id} of `{}`", one.title);
            }
            assert!(
                one.ruling.is_none_or(|number| RULINGS.iter().any(|ruling| ruling.number == number)),
                "{}",
                one.title
            );
        }
    }

    /// A ruling that names several formulas decides between dialects, which are told here.
    #[test]
    fn every_ruling_between_formulas_is_told() {
        for ruling in RULINGS {
            let named: Vec<&str> =
                ruling.forms.split('`').skip(1).step_by(2).filter(|name| name.contains('/')).collect();
            for id in named {
                let is_told = DIALECTS.iter().any(|one| one.concern(id));
                assert!(is_told, "ruling {} names {id}, which no row of dialects has", ruling.number);
            }
        }
    }
}
