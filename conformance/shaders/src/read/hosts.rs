//! Shaders as hosts wrap them: within other languages, several in a file.

use super::lines::Lines;
use super::macros::words;
use naga::ShaderStage;

/// A shader of several in a file. Lines of others are empty.
pub(super) struct Section {
    pub(super) lines: Lines,
    /// The stage that the file names.
    pub(super) stage: Option<ShaderStage>,
}

/// The stage that a word names; none of those that are not read.
fn stage(word: &str) -> Option<Option<ShaderStage>> {
    match &*word.to_lowercase() {
        "vertex" | "vert" | "vs" | "vertex_shader" | "vertexshader" => Some(Some(ShaderStage::Vertex)),
        "fragment" | "frag" | "fs" | "pixel" | "ps" | "fragment_shader" | "fragmentshader" => {
            Some(Some(ShaderStage::Fragment))
        }
        "compute" | "comp" | "cs" => Some(Some(ShaderStage::Compute)),
        "geometry" | "geom" | "tess_control" | "tess_evaluation" | "end" | "block" => Some(None),
        _ => None,
    }
}

/// The stage of the section that a line begins: `#shader vertex`, `#type fragment`, `#pragma stage fragment`, `@fs name`, `[VERTEX]`,
/// `-- Fragment`.
fn marker(line: &str) -> Option<Option<ShaderStage>> {
    let line = line.trim();
    let rest = ["#shader", "#type", "#pragma stage", "#section", "#stage", "--", "@"]
        .iter()
        .find_map(|mark| line.strip_prefix(mark));
    let bracketed = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
    let rest = rest.or(bracketed)?;
    stage(words(rest).next()?)
}

/// The shaders of a file, if it says that it has several.
pub(super) fn sections(own: &Lines) -> Vec<Section> {
    let strings = own.text.matches("R\"").count();
    if strings > 1 {
        return raw_strings(own);
    }
    if own.iter().filter_map(|(line, _)| marker(line)).flatten().count() == 0 {
        return by_versions(own);
    }
    let blank = |upto: &Lines| {
        let mut found = Lines::default();
        upto.iter().for_each(|(line, number)| found.push(line, number));
        found
    };
    let (mut shared, mut found) = (Lines::default(), Vec::<Section>::new());
    // What stands before the first belongs to all.
    let mut is_first = true;
    for (line, number) in own.iter() {
        if let Some(stage) = marker(line) {
            is_first = false;
            found.push(Section { lines: blank(&shared), stage });
            continue;
        }
        match found.last_mut() {
            Some(section) => section.lines.push(line, number),
            None if is_first => shared.push(line, number),
            None => {}
        }
    }
    found.retain(|own| own.stage.is_some());
    found
}

/// Shaders that each begin with their version.
fn by_versions(own: &Lines) -> Vec<Section> {
    let begins = |line: &str| line.trim_start().starts_with("#version");
    if own.iter().filter(|(line, _)| begins(line)).count() < 2 {
        return vec![];
    }
    let mut found: Vec<Section> = vec![];
    for (line, number) in own.iter() {
        if begins(line) || found.is_empty() {
            found.push(Section { lines: Lines::default(), stage: None });
        }
        if let Some(section) = found.last_mut() {
            section.lines.push(line, number);
        }
    }
    found.retain(|own| own.lines.text.contains('{'));
    found
}

/// Shaders in the strings of another language.
fn raw_strings(own: &Lines) -> Vec<Section> {
    let mut found: Vec<Section> = vec![];
    let mut end: Option<String> = None;
    for (line, number) in own.iter() {
        let mut rest = line;
        if end.is_none() {
            let Some((_, after)) = line.split_once("R\"") else { continue };
            let Some((name, after)) = after.split_once('(') else { continue };
            end = Some(format!("){name}\""));
            found.push(Section { lines: Lines::default(), stage: None });
            rest = after;
        }
        let (inside, is_over) = match end.as_ref().and_then(|end| rest.split_once(&**end)) {
            Some((inside, _)) => (inside, true),
            None => (rest, false),
        };
        if let Some(section) = found.last_mut() {
            section.lines.push(inside, number);
        }
        if is_over {
            end = None;
        }
    }
    found
}

/// Programs in HLSL within Unity's ShaderLab.
pub(super) fn of_shader_lab(own: &Lines) -> Vec<Lines> {
    const STARTS: [&str; 4] = ["CGPROGRAM", "HLSLPROGRAM", "CGINCLUDE", "HLSLINCLUDE"];
    const ENDS: [&str; 2] = ["ENDCG", "ENDHLSL"];
    let (mut shared, mut found) = (Lines::default(), Vec::<Lines>::new());
    let mut is_inside = None;
    for (line, number) in own.iter() {
        let word = words(line).next().unwrap_or_default();
        if STARTS.contains(&word) {
            let is_shared = word.ends_with("INCLUDE");
            is_inside = Some(is_shared);
            if !is_shared {
                found.push(shared.clone());
            }
        } else if ENDS.contains(&word) {
            is_inside = None;
        } else {
            match (is_inside, found.last_mut()) {
                (Some(true), _) => shared.push(line, number),
                (Some(false), Some(program)) => program.push(line, number),
                _ => {}
            }
        }
    }
    found
}

/// What Unity's own included files define, as far as programs need it to be read.
pub(super) const OF_UNITY: &str = "#define fixed float
#define fixed2 float2
#define fixed3 float3
#define fixed4 float4
#define UNITY_FOG_COORDS(at)
#define UNITY_TRANSFER_FOG(to, at)
#define UNITY_APPLY_FOG(at, color)
#define UNITY_VERTEX_INPUT_INSTANCE_ID
#define UNITY_VERTEX_OUTPUT_STEREO
#define UNITY_SETUP_INSTANCE_ID(of)
#define UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(of)
#define UNITY_TRANSFER_INSTANCE_ID(a, b)
#define SHADOW_COORDS(at)
#define LIGHTING_COORDS(a, b)
#define TRANSFER_SHADOW(of)
#define TRANSFER_VERTEX_TO_FRAGMENT(of)
#define UNITY_LIGHTING_COORDS(a, b)
#define TRANSFORM_TEX(at, map) (at)
#define UNITY_INITIALIZE_OUTPUT(type, of)
#define CBUFFER_START(name)
#define CBUFFER_END
#define TEXTURE2D(map) Texture2D map
#define SAMPLER(name) SamplerState name
#define SAMPLE_TEXTURE2D(map, by, at) map.Sample(by, at)";

/// What only a host's language has is taken off.
pub(super) fn mended(own: &Lines, notes: &mut Vec<String>) -> Lines {
    let mut found = Lines::default();
    let wrapper = ["STRINGIFY", "R\"(", "R\"glsl("].iter().find_map(|word| {
        let at = own.text.find(word)?;
        Some((at, own.text[at..].find('(')? + at))
    });
    let wrapper_end = wrapper.and_then(|(_, open)| own.text[open..].rfind(')').map(|end| end + open));
    let mut at = 0;
    for (line, number) in own.iter() {
        let mut kept = line.to_owned();
        if let (Some((_, open)), Some(end)) = (wrapper, wrapper_end) {
            let inside = |(k, c): (usize, char)| if at + k > open && at + k < end { c } else { ' ' };
            kept = line.char_indices().map(inside).collect();
        }
        at += line.len() + 1;
        kept = without_places(&kept);
        if is_of_a_host(&kept) {
            notes.push(format!("line {number}: `{}` is no directive of GLSL, and left out", kept.trim()));
            kept = String::new();
        }
        let word = kept.trim_start();
        if let Some(rest) = word.strip_prefix("subroutine") {
            // `subroutine(T) vec4 f()` stays a function.
            kept = rest
                .trim_start()
                .strip_prefix('(')
                .and_then(|rest| rest.split_once(')'))
                .map_or_else(String::new, |(_, rest)| rest.to_owned());
        }
        found.push(&kept, number);
    }
    let godot = words(&own.text).next() == Some("shader_type");
    if godot {
        found = of_godot(&found);
    }
    if wrapper.is_some() {
        notes.push("it is wrapped for another language: the wrapper is taken off".into());
    }
    for (host, word) in [("IN", "in"), ("OUT", "out")] {
        let begins = |line: &str| line.trim_start().strip_prefix(host).is_some_and(|rest| rest.starts_with(' '));
        if found.text.lines().any(begins) && !found.text.contains(&format!("define {host}")) {
            let mut with = Lines::default();
            for (line, number) in found.iter() {
                let rest = line.trim_start().strip_prefix(host).filter(|rest| rest.starts_with(' '));
                with.push(&rest.map_or_else(|| line.to_owned(), |rest| format!("{word}{rest}")), number);
            }
            found = with;
        }
    }
    found
}

/// A line of which the places that another language fills are numbers: `${COUNT}`.
pub(super) fn without_places(line: &str) -> String {
    let mut line = line.to_owned();
    while let Some((start, end)) = line.find("${").and_then(|at| Some((at, line[at..].find('}')? + at + 1))) {
        line.replace_range(start..end, "1");
    }
    line
}

/// Whether a line is a directive that no shader's preprocessor knows.
fn is_of_a_host(line: &str) -> bool {
    const KNOWN: [&str; 13] = [
        "define",
        "undef",
        "if",
        "ifdef",
        "ifndef",
        "else",
        "elif",
        "endif",
        "error",
        "pragma",
        "extension",
        "version",
        "line",
    ];
    let directive = line.trim_start().strip_prefix('#').and_then(|rest| words(rest).next());
    directive.is_some_and(|word| !KNOWN.contains(&word))
}

/// Godot's language is GLSL with hints at its uniforms.
fn of_godot(own: &Lines) -> Lines {
    let mut found = Lines::default();
    for (line, number) in own.iter() {
        let first = words(line).next().unwrap_or_default();
        let kept = match (first, line.split_once(':')) {
            ("shader_type" | "render_mode" | "group_uniforms", _) => String::new(),
            ("uniform", Some((declared, rest))) => {
                let value = rest.find('=').map_or("", |at| &rest[at..]);
                format!("{declared}{}", if value.is_empty() { ";" } else { value })
            }
            _ => line.to_owned(),
        };
        found.push(&kept, number);
    }
    found
}
