//! HLSL of Direct3D 9 and of effects as compilers of today read it, and its entry points.

use super::lines::Lines;
use super::macros::words;

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

/// Textures and samplers of Direct3D 9 as those of 10.
pub(super) fn of_direct3d_9(own: &Lines) -> Lines {
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
pub(super) fn without_states(own: &Lines) -> Lines {
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
