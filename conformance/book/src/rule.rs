//! Equations of formulas whose line is a sentence, in the notation of lines: the same rule in symbols. The sentence stands below.
//!
//! Positions on the screen have their y pointing down, and `u × v` of two of them is the number `u.x·v.y − u.y·v.x`.

use lightmeter_scene::depth::Compare;

/// The equations by the ids that they are of; a `*` at the end stands for any ending.
const RULES: &[(&str, &str)] = &[
    (
        "interpolation/coverage",
        "covered = 1 where e ≥ 0 at each side, and e > 0 at each that is neither a top nor a left edge, else 0; \
         e = (b − a) × (p − a) at the side from a to b",
    ),
    ("interpolation/clip-volume", "inside = 1 where −w ≤ x ≤ w, −w ≤ y ≤ w, 0 ≤ z ≤ w, else 0"),
    ("interpolation/clip-volume-opengl", "inside = 1 where −w ≤ x ≤ w, −w ≤ y ≤ w, −w ≤ z ≤ w, else 0"),
    ("interpolation/front-facing", "front = 1 where A < 0, else 0; A = (b − a) × (c − a)"),
    ("interpolation/raster-facing", "front = 1 where A < 0, else 0; A = (b − a) × (c − a)"),
    ("interpolation/cull-back-ccw", "covered = 1 where the pixel is inside and A < 0, else 0; A = (b − a) × (c − a)"),
    ("interpolation/cull-back-cw", "covered = 1 where the pixel is inside and A > 0, else 0; A = (b − a) × (c − a)"),
    ("interpolation/cull-front-ccw", "covered = 1 where the pixel is inside and A ≥ 0, else 0; A = (b − a) × (c − a)"),
    ("interpolation/cull-front-cw", "covered = 1 where the pixel is inside and A ≤ 0, else 0; A = (b − a) × (c − a)"),
    ("interpolation/raster-attributes", "perspective = Σ λᵢ·aᵢ/wᵢ / Σ λᵢ/wᵢ; linear = Σ λᵢ·aᵢ"),
    ("interpolation/raster-position", "position = (x + ½, y + ½, Σ λᵢ·zᵢ/wᵢ, Σ λᵢ/wᵢ)"),
    (
        "interpolation/raster-line",
        "perspective = ((1 − t)·attr_a/wa + t·attr_b/wb) / ((1 − t)/wa + t/wb); linear = (1 − t)·attr_a + t·attr_b",
    ),
    (
        "interpolation/raster-clip",
        "covered = 1 where λ₀, λ₁, λ₂, w, z, w − z have one sign, else 0; (x, y, z, w) = Σ λᵢ·clipᵢ",
    ),
    ("interpolation/raster-top-left", "count = covered₁ + covered₂"),
    ("interpolation/raster-shared-edge", "count = covered₁ + covered₂ = 1"),
    ("interpolation/raster-frag-depth", "depth = clamp(depth, 0, 1)"),
    ("interpolation/raster-flat-points-*", "attr = a_k, k = m"),
    ("interpolation/raster-flat-line-list-first", "attr = a_k, k = 2·m"),
    ("interpolation/raster-flat-line-list-last", "attr = a_k, k = 2·m + 1"),
    ("interpolation/raster-flat-triangle-list-first", "attr = a_k, k = 3·m"),
    ("interpolation/raster-flat-triangle-list-last", "attr = a_k, k = 3·m + 2"),
    ("interpolation/raster-flat-line-strip-first", "attr = a_k, k = m"),
    ("interpolation/raster-flat-line-strip-last", "attr = a_k, k = m + 1"),
    ("interpolation/raster-flat-triangle-strip-first", "attr = a_k, k = m"),
    ("interpolation/raster-flat-triangle-strip-last", "attr = a_k, k = m + 2"),
    ("lighting/flat", "intensity = I(a, n); n = ⟨(b − a) × (c − a)⟩"),
    ("lighting/gouraud", "intensity = mix(I(pa, na), I(pb, nb), t)"),
    (
        "lighting/phong-interpolated",
        "intensity = I(n, l, v); n = ⟨mix(na, nb, t)⟩; l = ⟨mix(position − pa, position − pb, t)⟩; v = ⟨mix(−pa, −pb, t)⟩",
    ),
    (
        "lighting/phong-gated",
        "CF = LA*MA + LD*MD·max(l·n, 0) + LS*MS·FS; FS = max(r·v, 0)^shininess where l·n > 0, else 0",
    ),
    (
        "lighting/blinn-stable",
        "CF = LA*MA + LD*MD·max(l·n, 0) + LS*MS·FS; FS = exp(shininess·ln(1 − q)) where l·n > 0, else 0; q = ½|n − h|²",
    ),
];

/// The equation of a formula whose line is a sentence.
pub(crate) fn rule(id: &str) -> Option<String> {
    if let Some(name) = id.strip_prefix("depth/same-geometry-") {
        return Some(format!("seen = {}", chosen(&passes(name, "z", "z")?, "2", "1")));
    }
    if let Some((compare, written)) = id.strip_prefix("depth/test/").and_then(|rest| rest.split_once('/')) {
        let passes = passes(compare, "clamp(new)", "clamp(old)")?;
        let depth = if written == "write" { chosen(&passes, "clamp(new)", "clamp(old)") } else { "clamp(old)".into() };
        return Some(format!("seen = {}; depth = {depth}", chosen(&passes, "2", "1")));
    }
    let is_of = |pattern: &str| pattern.strip_suffix('*').map_or(pattern == id, |start| id.starts_with(start));
    RULES.iter().find(|(pattern, _)| is_of(pattern)).map(|(_, equation)| (*equation).to_owned())
}

/// When a depth test passes.
enum Passes {
    Always,
    Never,
    Where(String),
}

fn passes(name: &str, new: &str, old: &str) -> Option<Passes> {
    let sign = match Compare::ALL.into_iter().find(|compare| compare.name() == name)? {
        Compare::Always => return Some(Passes::Always),
        Compare::Never => return Some(Passes::Never),
        Compare::Less => '<',
        Compare::Equal => '=',
        Compare::LessEqual => '≤',
        Compare::Greater => '>',
        Compare::NotEqual => '≠',
        Compare::GreaterEqual => '≥',
    };
    Some(Passes::Where(format!("{new} {sign} {old}")))
}

/// One value where a test passes, and another one elsewhere.
fn chosen(passes: &Passes, then: &str, other: &str) -> String {
    match passes {
        Passes::Always => then.to_owned(),
        Passes::Never => other.to_owned(),
        Passes::Where(condition) => format!("{then} where {condition}, else {other}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::{set_equation, told};
    use lightmeter_catalogue::select::catalogue;

    #[test]
    fn every_formula_has_an_equation_and_every_rule_a_formula() {
        let catalogue = catalogue();
        for page in told(&catalogue) {
            let member = page.member;
            assert!(set_equation(&member.spec).0.contains("<math"), "{} has no equation", member.spec.id);
        }
        for (pattern, _) in RULES {
            let start = pattern.trim_end_matches('*');
            let is_of = |id: &str| if pattern.ends_with('*') { id.starts_with(start) } else { id == start };
            assert!(catalogue.iter().any(|member| is_of(&member.spec.id)), "{pattern} is of no formula");
        }
    }

    #[test]
    fn depth_tests_have_their_own_sign() {
        let said = |id: &str| rule(id).expect("it has one");
        assert_eq!(said("depth/same-geometry-less"), "seen = 2 where z < z, else 1");
        assert_eq!(said("depth/test/always/keep"), "seen = 2; depth = clamp(old)");
        assert!(
            said("depth/test/not-equal/write")
                .ends_with("depth = clamp(new) where clamp(new) ≠ clamp(old), else clamp(old)")
        );
    }
}
