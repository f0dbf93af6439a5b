//! HLSL of Direct3D 9 and of effects as compilers of today read it, and its entry points.

use super::lines::Lines;
use super::macros::words;
use std::collections::HashSet;

/// Characters of an annotation.
const MOST_ANNOTATION: usize = 8192;

/// Entry points of HLSL: their names, and whether each is a vertex shader's.
pub(super) fn entries(text: &str) -> Vec<(String, bool)> {
    let mut found: Vec<(String, bool)> = vec![];
    for (start, is_vertex) in [("#pragma fragment ", false), ("#pragma vertex ", true)] {
        let name = text.lines().find_map(|line| words(line.trim().strip_prefix(start)?).next());
        found.extend(name.map(|name| (name.to_owned(), is_vertex)));
    }
    if !found.is_empty() {
        return found;
    }
    let flat = text.to_lowercase();
    for (semantic, is_vertex) in [
        (": sv_target", false),
        (":sv_target", false),
        (": color", false),
        (":color", false),
        (": sv_position", true),
        (":sv_position", true),
        (": position", true),
    ] {
        for (at, _) in flat.match_indices(semantic) {
            let before = text[..at].trim_end();
            // The semantic of a function follows its brackets.
            let Some(open) = before.strip_suffix(')').and_then(opening) else { continue };
            let name = words(&before[..open]).last().unwrap_or_default().to_owned();
            if !name.is_empty() && name != "register" && !found.iter().any(|(own, _)| *own == name) {
                found.push((name, is_vertex));
            }
        }
    }
    for (name, is_vertex) in [
        ("main", false),
        ("PS", false),
        ("PSMain", false),
        ("PSmain", false),
        ("ps_main", false),
        ("VS", true),
        ("VSMain", true),
        ("vs_main", true),
    ] {
        let is_there = words(text).any(|own| own == name) && text.contains(&format!("{name}("));
        if is_there && !found.iter().any(|(own, _)| own == name) {
            found.push((name.into(), is_vertex));
        }
    }
    found.truncate(4);
    found
}

/// A text without what effects and hosts add to HLSL, so that a compiler reads it.
pub(super) fn plain(own: &Lines, notes: &mut Vec<String>) -> Lines {
    let shaders = without_states(&of_direct3d_9(&without_annotations(own)));
    without_macros_of_hosts(&shaders, notes)
}

/// Textures and samplers of Direct3D 9 as those of 10.
fn of_direct3d_9(own: &Lines) -> Lines {
    const SAMPLERS: [&str; 6] = ["sampler", "sampler2D", "samplerCUBE", "sampler3D", "sampler1D", "Sampler2D"];
    let mut found = Lines::default();
    let is_old =
        words(&own.text).any(|own| matches!(own, "tex2D" | "texCUBE" | "tex2Dlod" | "tex2Dproj" | "sampler_state"));
    if !is_old {
        return own.clone();
    }
    found.push_all(
        "#define tex2D(s, at) s##_map.Sample(s, (at).xy)\n#define tex2Dlod(s, at) s##_map.SampleLevel(s, (at).xy, (at).w)\n\
         #define tex2Dproj(s, at) s##_map.Sample(s, (at).xy / (at).w)\n#define texCUBE(s, at) s##_map.Sample(s, (at).xyz)",
    );
    // Whether a sampler's state is being read, which stands in braces.
    let (mut is_state, mut depth) = (false, 0_i32);
    for (line, number) in own.iter() {
        let code = line.split("//").next().unwrap_or_default();
        let is_qualifier = |word: &&str| matches!(*word, "uniform" | "static" | "shared" | "extern");
        let all: Vec<&str> = words(code).skip_while(is_qualifier).collect();
        let is_call = code.contains('(') && !code.contains("register");
        let mut kept = line.to_owned();
        match all.first() {
            _ if is_state => kept = String::new(),
            Some(&("texture" | "Texture" | "texture2D")) if all.len() >= 2 && !is_call => kept = String::new(),
            Some(word) if SAMPLERS.contains(word) && all.len() >= 2 && !is_call => {
                let kind = if *word == "samplerCUBE" { "TextureCube" } else { "Texture2D" };
                kept = format!("{kind} {0}_map; SamplerState {0};", all[1]);
                is_state = !code.contains(';') || code.contains('{');
            }
            _ => {}
        }
        if is_state {
            depth += code.chars().map(|c| i32::from(c == '{') - i32::from(c == '}')).sum::<i32>();
            is_state = !(depth == 0 && code.contains(['}', ';']));
        }
        found.push(&kept, number);
    }
    found
}

/// States of Direct3D 10's effects, in braces after a name, are taken off.
fn without_states(own: &Lines) -> Lines {
    const STATES: [&str; 5] =
        ["SamplerState", "SamplerComparisonState", "BlendState", "RasterizerState", "DepthStencilState"];
    let mut found = Lines::default();
    // Whether a state's braces are looked for, and how many are open.
    let (mut is_state, mut depth) = (false, 0_i32);
    for (line, number) in own.iter() {
        let code = line.split("//").next().unwrap_or_default();
        let all: Vec<&str> = words(code).collect();
        let begins = depth == 0 && all.len() == 2 && STATES.contains(&all[0]) && !code.contains(';');
        if !begins && !is_state {
            found.push(line, number);
            continue;
        }
        let declares = begins && all[0].starts_with("Sampler");
        found.push(&if declares { format!("{} {};", all[0], all[1]) } else { String::new() }, number);
        depth += code.chars().map(|c| i32::from(c == '{') - i32::from(c == '}')).sum::<i32>();
        is_state = depth > 0 || !code.contains('}');
    }
    found
}

/// Annotations of effects are taken off: `float x < string UIName = "x"; > = 1.0;`.
fn without_annotations(own: &Lines) -> Lines {
    let mut text = String::new();
    // What was read of the statement.
    let mut statement = String::new();
    let mut rest = own.text.as_str();
    while let Some(c) = rest.chars().next() {
        let is_skipped = c == '#' || rest.starts_with("//");
        let skipped = if is_skipped { rest.find('\n').unwrap_or(rest.len()) } else { 0 };
        let annotation = if c == '<' && is_declaration(&statement) { annotation(rest) } else { None };
        let taken = annotation.unwrap_or(if skipped > 0 { skipped } else { c.len_utf8() });
        let (now, after) = rest.split_at(taken);
        if annotation.is_some() {
            text.extend(now.chars().filter(|c| *c == '\n'));
        } else {
            text += now;
        }
        match c {
            ';' | '{' | '}' => statement.clear(),
            _ if taken == c.len_utf8() => statement.push(c),
            _ => {}
        }
        rest = after;
    }
    own.with_text(&text)
}

/// Whether a statement so far is a type and a name.
fn is_declaration(statement: &str) -> bool {
    let all: Vec<&str> = words(statement).collect();
    all.len() >= 2 && !statement.contains(['(', '=', '<']) && !matches!(all[0], "return" | "else" | "case")
}

/// The length of an annotation that a text begins with: assignments, each with a semicolon, between `<` and `>`.
fn annotation(text: &str) -> Option<usize> {
    let (mut in_quotes, mut has_value) = (false, false);
    for (k, c) in text.char_indices().skip(1).take(MOST_ANNOTATION) {
        match c {
            '"' => in_quotes = !in_quotes,
            _ if in_quotes => {}
            '>' => return has_value.then_some(k + 1),
            '=' => has_value = true,
            '{' | '}' => return None,
            _ => {}
        }
    }
    None
}

/// Takes off registers whose number is a macro that is not defined here, and lines that are nothing but such a macro.
fn without_macros_of_hosts(own: &Lines, notes: &mut Vec<String>) -> Lines {
    let defines = own.text.lines().filter(|line| line.trim_start().starts_with("#define"));
    let defined: HashSet<&str> = defines.filter_map(|line| words(line).nth(1)).collect();
    let mut found = Lines::default();
    let mut depth = 0_i32;
    for (line, number) in own.iter() {
        let code = line.split("//").next().unwrap_or_default().trim();
        let name = words(code).next().unwrap_or_default();
        let is_macro = name.len() > 3 && name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
        let after = code.strip_prefix(name).unwrap_or_default().trim_end_matches(';').trim();
        let inside = after.strip_suffix(')');
        let is_whole = after.is_empty() || inside.is_some_and(|inside| opening(inside) == Some(0));
        let is_lone = depth == 0 && is_macro && code.starts_with(name) && is_whole;
        depth += code.chars().map(|c| i32::from(c == '{') - i32::from(c == '}')).sum::<i32>();
        if is_lone && !defined.contains(name) {
            notes.push(format!("line {number}: the macro `{name}` is not there: the line is left out"));
            found.push("", number);
            continue;
        }
        let register = line.split_once("register").and_then(|(before, rest)| {
            let before = before.trim_end().strip_suffix(':')?;
            let (number, after) = rest.trim_start().strip_prefix('(')?.split_once(')')?;
            let name = number.split(',').next().unwrap_or_default().trim();
            let is_number = name.chars().skip(1).all(|c| c.is_ascii_digit());
            (!is_number && !defined.contains(name)).then(|| format!("{before}{after}"))
        });
        found.push(register.as_deref().unwrap_or(line), number);
    }
    found
}

/// The place of the bracket that a text's last closes.
fn opening(text: &str) -> Option<usize> {
    let mut depth = 1;
    for (k, c) in text.char_indices().rev() {
        match c {
            ')' => depth += 1,
            '(' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(k);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Lines {
        Lines::of_file(text)
    }

    #[test]
    fn annotations_are_taken_off_and_comparisons_and_types_are_not() {
        let taken = without_annotations(&of("uniform float a <\n  ui = \"> b\"; most = 8.0;\n> = 2.0;\nfloat b;\n"));
        assert_eq!(taken.text, "uniform float a \n\n = 2.0;\nfloat b;\n");
        let kept = "uniform Texture2D<float4> map;\nbool less(float a, float b) { return a < b; }\nfor (int k = 0; k < 4; k++) x = a > b;\n// a b < c = 1; >\n";
        assert_eq!(without_annotations(&of(kept)).text, kept);
    }

    #[test]
    fn macros_that_are_elsewhere_are_left_out_where_they_stand_alone() {
        let mut notes = vec![];
        let text = "#define OWN(x) x;\nOWN(float a)\nHOSTS(\"a\", b)\nHOSTS_TOO\nfloat4 MAIN() {\nCALL(a);\n}\nTexture2D m : register(SLOT, space0); SamplerState s : register(s0);\n";
        let taken = without_macros_of_hosts(&of(text), &mut notes);
        let wanted = "#define OWN(x) x;\nOWN(float a)\n\n\nfloat4 MAIN() {\nCALL(a);\n}\nTexture2D m ; SamplerState s : register(s0);\n";
        assert_eq!((taken.text.as_str(), notes.len()), (wanted, 2));
    }
}
