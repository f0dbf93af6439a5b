//! Names as people give them to variables of shaders, brought to words that a list of synonyms knows.

/// Short forms of words.
const SHORT: [(&str, &str); 43] = [
    ("pos", "position"),
    ("loc", "position"),
    ("location", "position"),
    ("coord", "position"),
    ("point", "position"),
    ("col", "color"),
    ("colour", "color"),
    ("clr", "color"),
    ("rgb", "color"),
    ("amb", "ambient"),
    ("diff", "diffuse"),
    ("dif", "diffuse"),
    ("spec", "specular"),
    ("spe", "specular"),
    ("norm", "normal"),
    ("nrm", "normal"),
    ("nor", "normal"),
    ("normals", "normal"),
    ("mat", "material"),
    ("mtl", "material"),
    ("lights", "light"),
    ("lamp", "light"),
    ("sun", "light"),
    ("lite", "light"),
    ("cam", "camera"),
    ("viewer", "eye"),
    ("quad", "quadratic"),
    ("lin", "linear"),
    ("const", "constant"),
    ("dist", "distance"),
    ("refl", "reflect"),
    ("reflected", "reflect"),
    ("reflection", "reflect"),
    ("halfway", "half"),
    ("atten", "attenuation"),
    ("vector", "vec"),
    ("att", "attenuation"),
    ("flashlight", "light"),
    ("spotlight", "light"),
    ("pointlight", "light"),
    ("dirlight", "light"),
    ("bulb", "light"),
    ("torch", "light"),
];

/// Words that say what a variable is to the pipeline, and nothing of its meaning.
const NOISE: [&str; 31] = [
    "u",
    "a",
    "v",
    "f",
    "g",
    "s",
    "m",
    "o",
    "i",
    "in",
    "out",
    "vs",
    "fs",
    "gs",
    "ps",
    "frag",
    "fragment",
    "vertex",
    "vert",
    "vtx",
    "pixel",
    "interp",
    "interpolated",
    "varying",
    "uniform",
    "attr",
    "attribute",
    "my",
    "the",
    "input",
    "output",
];

/// Words of the space that something is in: in which one is settled by all inputs together.
const SPACES: [&str; 17] = [
    "world",
    "object",
    "model",
    "obj",
    "local",
    "ws",
    "es",
    "os",
    "cs",
    "vs",
    "space",
    "surface",
    "worldspace",
    "cameraspace",
    "viewspace",
    "eyespace",
    "objectspace",
];

/// The same of words that may also be who looks.
const VIEWS: [&str; 3] = ["eye", "view", "camera"];

/// Structures whose name says what their members are of.
const OWNERS: [&str; 6] = ["light", "material", "fog", "spot", "attenuation", "falloff"];

/// The words of an identifier: `u_lightPos0` is u, light, position.
fn words(name: &str) -> Vec<String> {
    let mut found: Vec<String> = vec![];
    let mut last = ' ';
    let letters: Vec<char> = name.chars().collect();
    for (k, &c) in letters.iter().enumerate() {
        let is_next_small = letters.get(k + 1).is_some_and(|next| next.is_lowercase());
        let begins = c.is_alphabetic()
            && (!last.is_alphabetic()
                || (c.is_uppercase() && (last.is_lowercase() || (last.is_uppercase() && is_next_small))));
        if begins {
            found.push(String::new());
        }
        if c.is_alphabetic()
            && let Some(word) = found.last_mut()
        {
            word.extend(c.to_lowercase());
        }
        last = c;
    }
    // `mynormal` is one of the habits of courses.
    let own = |word: String| word.strip_prefix("my").filter(|rest| rest.len() > 3).map(str::to_owned).unwrap_or(word);
    let long =
        |word: String| SHORT.iter().find(|(short, _)| *short == word).map_or(word, |(_, long)| (*long).to_owned());
    found.into_iter().map(own).map(long).collect()
}

/// A variable's name, or a member's, as the words that a synonym may have, the most telling first.
pub(crate) fn keys(name: &str) -> Vec<String> {
    // naga numbers what goes from stage to stage, and tells nothing of it.
    if name.trim_start_matches('_').starts_with("vs2fs_location") {
        return vec![];
    }
    let mut parts: Vec<Vec<String>> =
        name.split('.').map(|part| words(part.split('[').next().unwrap_or(part))).collect();
    let own = parts.pop().unwrap_or_default();
    let owners = parts.iter().flatten().filter(|word| OWNERS.contains(&word.as_str()));
    // A spotlight is a light, however its structure is called.
    let owners = owners.map(|word| if word == "spot" { "light".to_owned() } else { word.clone() });
    let mut all: Vec<String> = owners.chain(own.iter().cloned()).collect();
    all.dedup();
    let without = |words: &[String], dropped: &[&str]| -> Vec<String> {
        let kept: Vec<String> = words.iter().filter(|word| !dropped.contains(&word.as_str())).cloned().collect();
        if kept.is_empty() { words.to_vec() } else { kept }
    };
    let plain = without(&all, &NOISE);
    let placeless = without(&plain, &SPACES);
    let viewless = without(&placeless, &VIEWS);
    let mut keys: Vec<String> = [all, plain, placeless, viewless, own].iter().map(|words| words.concat()).collect();
    keys.dedup();
    keys
}

/// A name that neither a word of WGSL nor another name is.
pub(crate) fn safe(kind: &str, name: Option<&str>, k: usize) -> String {
    let plain: String =
        name.unwrap_or_default().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let mut words = plain.split('_').filter(|word| !word.is_empty()).collect::<Vec<_>>().join("_");
    if !words.is_empty() {
        words.push('_');
    }
    format!("user_{kind}_{words}{k}x")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_by_their_words() {
        for (name, key) in [
            ("u_lightPos", "lightposition"),
            ("vNormal", "normal"),
            ("fs_in.FragPos", "position"),
            ("lights[0].position", "lightposition"),
            ("pointLight.pos", "lightposition"),
            ("material.shininess", "materialshininess"),
            ("uViewPos", "viewposition"),
            ("worldNormal", "normal"),
            ("N", "n"),
            ("V", "v"),
            ("light.lightColor", "lightcolor"),
            ("FOG_DENSITY", "fogdensity"),
            ("_WorldSpaceCameraPos", "cameraposition"),
            ("gEyeWorldPos", "eyeposition"),
            ("spotLight.position", "lightposition"),
            ("u_spot.exponent", "lightexponent"),
            ("Normal_cameraspace", "normal"),
        ] {
            assert!(keys(name).contains(&key.to_owned()), "{name}: {:?}", keys(name));
        }
    }
}
