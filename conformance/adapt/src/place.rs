//! Where in a shader's text a step of a formula is likely to stand.

/// What a line that computes a step has: any of these, each of whose words it has all of.
type Signs = &'static [&'static [&'static str]];

/// The steps of formulas, with what a line has that computes one.
const STEPS: &[(&[&str], Signs)] = &[
    (&["h", "n·h"], &[&["half"], &["Half"], &["normalize(", "+"], &[" h ="], &[" H ="]]),
    (&["r", "r·v", "i·n"], &[&["reflect("]]),
    (&["n"], &[&["normalize(", "ormal"], &[" n ="], &[" N ="], &["norm ="]]),
    (&["l"], &[&["normalize(", "ight"], &[" l ="], &[" L ="]]),
    (&["v"], &[&["normalize(", "iew"], &["normalize(", "ye"], &["normalize(", "osition"], &[" v ="], &[" V ="]]),
    (&["FS", "CS"], &[&["pow("]]),
    (&["FI", "l·n", "CD"], &[&["max(", "dot("], &["abs(", "dot("], &["iffuse", "dot("], &["dot("]]),
    (&["CA"], &[&["mbient"]]),
    (&["atten", "kc + kl·d + kq·d²", "d"], &[&["ttenuation"], &["atten"], &["/", "uadratic"], &["falloff"]]),
    (&["spot", "cone", "−l·axis"], &[&["utoff"], &["utOff"], &["spot"], &["cone"]]),
    (&["exp", "−density·distance"], &[&["exp("], &["exp2("]]),
    (&["f"], &[&["exp("], &["exp2("], &["smoothstep("], &["clamp("], &["factor"], &["Factor"]]),
    (&["clamp"], &[&["clamp("]]),
    (&["distance"], &[&["length("], &["distance("], &["abs("], &[".z"], &["dist"]]),
    (&["color"], &[&["mix("]]),
];

/// The line of a text that computes a step, from 1, with its words; `None` where none or several do.
#[must_use]
pub fn line_of_step<'a>(text: &'a str, step: &str) -> Option<(usize, &'a str)> {
    let (_, signs) = STEPS.iter().find(|(names, _)| names.contains(&step))?;
    // A weaker sign says nothing where several lines have a stronger one.
    let mut found = signs.iter().map(|words| lines(text, |line| words.iter().all(|word| line.contains(word))));
    one(&found.find(|found| !found.is_empty())?)
}

/// The line of a text that has one of these variables.
#[must_use]
pub fn line_of_variable<'a>(text: &'a str, names: &[&str]) -> Option<(usize, &'a str)> {
    let last =
        |name: &&str| name.rsplit('.').next().unwrap_or_default().split('[').next().unwrap_or_default().to_owned();
    let names: Vec<String> = names.iter().map(last).collect();
    let has = |line: &str| {
        line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| names.iter().any(|name| name == word))
    };
    one(&lines(text, has))
}

/// The one of several; `None` of none and of more.
fn one<T: Copy>(found: &[T]) -> Option<T> {
    match found {
        [one] => Some(*one),
        _ => None,
    }
}

/// The lines that are code and are chosen.
fn lines(text: &str, is_chosen: impl Fn(&str) -> bool) -> Vec<(usize, &str)> {
    let is_code = |line: &str| line.contains('=') || line.contains("return ");
    let code = |line: &'_ str| line.split("//").next().unwrap_or_default().trim_end().len();
    let found = text.lines().enumerate().filter_map(|(k, line)| {
        let line = line[..code(line)].trim();
        (is_code(line) && is_chosen(line)).then_some((k + 1, line))
    });
    found.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_of_a_step_is_found_where_there_is_one() {
        let text = "uniform vec3 fogColor; // exp(\nvoid main() {\n    vec3 h = (l + v) * 0.5;\n    float f = exp(-d);\n    c = mix(fogColor, x, f);\n    a = dot(n, l) + dot(n, h);\n    b = dot(n, l);\n}\n";
        assert_eq!(line_of_step(text, "h"), Some((3, "vec3 h = (l + v) * 0.5;")));
        assert_eq!(line_of_step(text, "exp").map(|(line, _)| line), Some(4));
        assert_eq!(line_of_step(text, "l·n"), None);
        assert_eq!(line_of_variable(text, &["fogColor"]).map(|(line, _)| line), Some(5));
        // Two lines reflect, so that neither is it, whatever else they have.
        let text = "a = reflect(i, n);\nb = reflect(j, n);\nvec3 h = x;\n";
        assert_eq!(line_of_step(text, "r"), None);
        // A half vector by name is a stronger sign than a letter, and two of them decide nothing.
        let text = "vec3 halfway = a;\nvec3 half2 = b;\nvec3 h = c;\n";
        assert_eq!(line_of_step(text, "h"), None);
    }
}
