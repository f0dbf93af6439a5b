//! Which way each branch of the scenes' shaders goes: shaders in which every branch leaves a mark on the pixel for which it is taken.
//!
//! A *site* is a condition of `if` or `select`, or a `min`, `max` or `clamp` of scalars. Its *ways* are false and true, the argument that a `min` or a
//! `max` gives, and the three parts of a `clamp`. A marked shader computes what the right one does, leaves nothing out, and gives its marks in place of
//! the colour. Only fragments are marked: what is computed at vertices alone has no pixel.

use crate::mutants::tokens::{Token, tokens};
use lightmeter_gpu::compose::Composition;
use lightmeter_gpu::work::Resources;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Marks in a component of a pixel, each of which is a bit of a whole number that f32 holds.
const BITS: usize = 24;
/// Marks in a pixel.
const MOST: usize = 4 * BITS;

/// A site: the function that it is in, and its text.
pub type Site = (String, String);

/// The ways that were taken of each site.
#[derive(Clone, Debug, Default)]
pub struct BranchWays(pub BTreeMap<Site, (BTreeSet<&'static str>, &'static [&'static str])>);

impl BranchWays {
    /// Adds what the pixels of a frame say; `marks` are those of the shaders that drew it.
    pub fn see(&mut self, marks: &[Mark], pixels: &[[f32; 4]]) {
        let mut seen = [0_u32; 4];
        for pixel in pixels {
            for (seen, &component) in seen.iter_mut().zip(pixel) {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a whole number below 2^24"
                )]
                let bits = component as u32;
                *seen |= bits;
            }
        }
        for mark in marks {
            let (taken, _) = self.0.entry(mark.site.clone()).or_insert_with(|| (BTreeSet::new(), mark.ways));
            if seen[mark.bit / BITS] >> (mark.bit % BITS) & 1 == 1 {
                taken.insert(mark.way);
            }
        }
    }

    /// The ways that were never taken, as `function: text, way`.
    #[must_use]
    pub fn missing(&self) -> Vec<String> {
        let of = |((function, text), (taken, ways)): (&Site, &(BTreeSet<&'static str>, &'static [&'static str]))| {
            ways.iter()
                .filter(|way| !taken.contains(*way))
                .map(|way| format!("{function}: {text}, {way}"))
                .collect::<Vec<_>>()
        };
        self.0.iter().flat_map(of).collect()
    }
}

/// A way of a site, and the bit that says that it was taken.
#[derive(Clone, Debug)]
pub struct Mark {
    site: Site,
    way: &'static str,
    ways: &'static [&'static str],
    bit: usize,
}

const CONDITION: &[&str] = &["false", "true"];
const EXTREME: &[&str] = &["the first", "the second"];
const CLAMP: &[&str] = &["below", "within", "above"];

/// What a marked shader has besides. The last function marks a clamp by three bits, the others mark by two.
const SUPPORT: &str = "
var<private> branch_marks: vec4u;
fn branch_mark(bit: u32) { branch_marks[bit / 24u] |= 1u << (bit % 24u); }
fn branch_if(bit: u32, holds: bool) -> bool { branch_mark(bit + u32(holds)); return holds; }
fn branch_max(bit: u32, a: f32, b: f32) -> f32 { branch_mark(bit + u32(a < b)); return max(a, b); }
fn branch_min(bit: u32, a: f32, b: f32) -> f32 { branch_mark(bit + u32(b < a)); return min(a, b); }
fn branch_clamp(bit: u32, x: f32, low: f32, high: f32) -> f32 {
    branch_mark(bit + select(select(1u, 2u, x > high), 0u, x < low));
    return clamp(x, low, high);
}
fn branch_clamp_whole(bit: u32, x: i32, low: i32, high: i32) -> i32 {
    branch_mark(bit + select(select(1u, 2u, x > high), 0u, x < low));
    return clamp(x, low, high);
}
";

/// Puts marks into the shaders of a frame; the marks of all of them, which draw by the same bits.
///
/// # Panics
/// Where a shader has more ways than a pixel has bits, or cannot be marked.
pub fn mark(resources: &mut Resources) -> Vec<Mark> {
    let mut sites: Vec<(Site, &'static [&'static str], usize)> = vec![];
    let mut next = 0;
    for shader in &mut resources.shaders {
        let text = shader.source.replace("discard;", "");
        let mut edits = vec![];
        for found in found(&text) {
            let known = sites.iter().find(|(site, ..)| *site == found.site).map(|(.., bit)| *bit);
            let forms = found.forms(known.unwrap_or(next));
            // What is no scalar is no site.
            let Some(form) = forms.into_iter().find(|form| is_valid(&edited(&text, form.clone()))) else { continue };
            edits.extend(form);
            if known.is_none() {
                sites.push((found.site, found.ways, next));
                next += found.ways.len();
            }
        }
        shader.source = entered(&edited(&text, edits));
    }
    assert!(next <= MOST, "{next} ways, and a pixel has {MOST} bits");
    let each = |(site, ways, bit): (Site, &'static [&'static str], usize)| {
        ways.iter()
            .enumerate()
            .map(move |(k, way)| Mark { site: site.clone(), way, ways, bit: bit + k })
            .collect::<Vec<_>>()
    };
    sites.into_iter().flat_map(each).collect()
}

/// The shader whose fragments give their marks.
fn entered(text: &str) -> String {
    let (entry, marked) = (Composition::FRAGMENT, "branch_fragment");
    let header = format!("@fragment\nfn {entry}(");
    let start = text.find(&header).expect("the shader has a fragment's entry point");
    let end = start + text[start..].find('{').expect("a function has a body");
    let takes = if text[start..end].contains("in: SceneVaryings") { ("in: SceneVaryings", "in") } else { ("", "") };
    let function = text[start..end].replacen(&header, &format!("fn {marked}("), 1).replace("@location(0) ", "");
    let own = format!(
        "{SUPPORT}\n@fragment\nfn {entry}({}) -> @location(0) vec4f {{\n    let color = {marked}({});\n    return vec4f(branch_marks);\n}}\n",
        takes.0, takes.1
    );
    format!("{}{function}{}{own}", &text[..start], &text[end..])
}

fn is_valid(text: &str) -> bool {
    let module = naga::front::wgsl::parse_str(&format!("{text}{SUPPORT}"));
    let validate = |module| {
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all())
            .validate(&module)
            .is_ok()
    };
    module.is_ok_and(validate)
}

/// A part of a text, and what takes its place.
type Edit = (Range<usize>, String);

/// The text with all changes, the last of which comes first, so that the others keep their places.
fn edited(text: &str, mut edits: Vec<Edit>) -> String {
    edits.sort_by_key(|(range, _)| (range.start, range.end));
    let mut text = text.to_owned();
    for (range, other) in edits.into_iter().rev() {
        text.replace_range(range, &other);
    }
    text
}

/// A site in a text.
struct Found {
    site: Site,
    ways: &'static [&'static str],
    /// The functions that may stand in its place, by the types of the arguments.
    functions: &'static [&'static str],
    /// What a function takes the place of: a condition, or the name of a built-in and its bracket.
    range: Range<usize>,
    is_condition: bool,
}

impl Found {
    /// The changes by which each of the functions takes its place.
    fn forms(&self, bit: usize) -> Vec<Vec<Edit>> {
        let Range { start, end } = self.range;
        let form = |function: &&str| {
            let opened = format!("{function}({bit}u, ");
            if self.is_condition {
                vec![(start..start, opened), (end..end, ")".into())]
            } else {
                vec![(start..end, opened)]
            }
        };
        self.functions.iter().map(form).collect()
    }
}

/// All sites of a text.
fn found(text: &str) -> Vec<Found> {
    let tokens = tokens(text);
    let word = |at: usize| tokens.get(at).map(|token: &Token| &text[token.range.clone()]).unwrap_or_default();
    let line = |range: Range<usize>| text[range].split_whitespace().collect::<Vec<_>>().join(" ");
    let (mut function, mut found) = (String::new(), vec![]);
    for at in 0..tokens.len() {
        let span = |from: usize, to: usize| tokens[from].range.start..tokens[to].range.end;
        match word(at) {
            "fn" => word(at + 1).clone_into(&mut function),
            "if" => {
                let end = (at..tokens.len()).find(|&k| word(k) == "{").unwrap_or(at + 2) - 1;
                let range = span(at + 1, end);
                let site = (function.clone(), format!("if {}", line(range.clone())));
                found.push(Found { site, ways: CONDITION, functions: &["branch_if"], range, is_condition: true });
            }
            name @ ("select" | "max" | "min" | "clamp") if word(at + 1) == "(" => {
                let arguments = arguments(&word, at + 1, tokens.len());
                let Some(last) = arguments.last() else { continue };
                let site = (function.clone(), line(span(at, last.end)));
                let (ways, functions): (_, &'static [&'static str]) = match name {
                    "select" => (CONDITION, &["branch_if"]),
                    "max" => (EXTREME, &["branch_max"]),
                    "min" => (EXTREME, &["branch_min"]),
                    _ => (CLAMP, &["branch_clamp", "branch_clamp_whole"]),
                };
                let is_condition = name == "select";
                let range = if is_condition { span(last.start, last.end - 1) } else { span(at, at + 1) };
                found.push(Found { site, ways, functions, range, is_condition });
            }
            _ => {}
        }
    }
    found
}

/// The tokens of each argument of a call, without the commas; the last ends where the bracket closes.
fn arguments<'a>(word: &dyn Fn(usize) -> &'a str, open: usize, tokens: usize) -> Vec<Range<usize>> {
    let (mut depth, mut first, mut found) = (0_usize, open + 1, vec![]);
    for at in open..tokens {
        match word(at) {
            "(" | "[" => depth += 1,
            ")" | "]" => depth -= 1,
            "," if depth == 1 => {
                found.push(first..at);
                first = at + 1;
            }
            _ => {}
        }
        if depth == 0 {
            found.push(first..at);
            break;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_gpu::work::ShaderResource;

    #[test]
    fn every_site_of_a_shader_is_marked() {
        let source = "
fn f(x: f32, v: vec3f) -> f32 {
    if max(x, 1.0) <= 0.0 { return min(x, 1.0); }
    let w = max(v, vec3f(0.0));
    return select(clamp(x, 0.0, max(x, w.x)), 2.0, x > 3.0);
}
@fragment
fn scene_fragment() -> @location(0) vec4f {
    if f(1.0, vec3f(2.0)) < 0.5 { discard; }
    return vec4f(f(3.0, vec3f(1.0)));
}
";
        let mut resources = Resources {
            shaders: vec![ShaderResource { label: "s".into(), source: source.into() }],
            ..Default::default()
        };
        let marks = mark(&mut resources);
        assert!(is_valid(&resources.shaders[0].source.replace(SUPPORT, "")), "{}", resources.shaders[0].source);
        let sites: BTreeSet<(&str, &str)> =
            marks.iter().map(|mark| (mark.site.0.as_str(), mark.site.1.as_str())).collect();
        let expected = [
            ("f", "clamp(x, 0.0, max(x, w.x))"),
            ("f", "if max(x, 1.0) <= 0.0"),
            ("f", "max(x, 1.0)"),
            ("f", "min(x, 1.0)"),
            ("f", "max(x, w.x)"),
            ("f", "select(clamp(x, 0.0, max(x, w.x)), 2.0, x > 3.0)"),
            ("scene_fragment", "if f(1.0, vec3f(2.0)) < 0.5"),
        ];
        assert_eq!(sites, BTreeSet::from(expected));
        let mut taken = BranchWays::default();
        taken.see(&marks, &[[0.0; 4]]);
        assert_eq!(taken.missing().len(), marks.len());
        taken.see(&marks, &[[16_777_215.0; 4]]);
        assert!(taken.missing().is_empty());
    }
}
