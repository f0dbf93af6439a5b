//! Files that a shader includes, and macros that its host defines.

use super::lines::Lines;
use super::options::ReadOptions;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Includes within includes.
const MOST_DEPTH: usize = 8;
/// Bytes of all that is included.
const MOST_BYTES: usize = 4 << 20;
/// Sets of definitions that are tried.
const MOST_SETS: usize = 6;

/// Definitions of macros: names and values.
pub(super) type Definitions = Vec<(String, String)>;

/// The words of a text.
pub(super) fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

/// A line's directive without its mark.
fn directive(line: &str) -> Option<&str> {
    line.trim_start().strip_prefix('#').map(str::trim_start)
}

/// What is included stands in the place of the directive; what is not there is noted.
pub(super) fn included(own: &Lines, options: &ReadOptions, notes: &mut Vec<String>) -> Lines {
    let mut found = Lines::default();
    let mut bytes = 0;
    for (line, number) in own.iter() {
        include(line, number, options, &mut found, notes, (0, &mut bytes));
    }
    found
}

fn include(
    line: &str,
    number: u32,
    options: &ReadOptions,
    found: &mut Lines,
    notes: &mut Vec<String>,
    (depth, bytes): (usize, &mut usize),
) {
    let name = directive(line).and_then(|own| {
        let rest =
            ["include", "pragma include", "moj_import", "import"].iter().find_map(|word| own.strip_prefix(word))?;
        let rest = rest.trim();
        Some(rest.trim_matches(['"', '<', '>', ' ', '(', ')']).to_owned())
    });
    let Some(name) = name else {
        found.push(line, number);
        return;
    };
    match file(&name, options).filter(|_| depth < MOST_DEPTH) {
        Some(path) => {
            let text = lightmeter_files::read::text(&path, MOST_BYTES as u64).unwrap_or_default();
            *bytes += text.len();
            if *bytes > MOST_BYTES {
                notes.push(format!("line {number}: `{name}` is left out: more is included than is read"));
                return;
            }
            // Its lines are the directive's.
            for (line, _) in Lines::of_file(&text).iter() {
                include(line, number, options, found, notes, (depth + 1, bytes));
            }
        }
        None if depth >= MOST_DEPTH => {
            notes.push(format!("line {number}: `{name}` is included too deep, and left out"))
        }
        None => {
            notes.push(format!(
                "line {number}: `{name}` is not there, and left out; `-I DIR` says where included files are"
            ));
            found.push("", number);
        }
    }
}

/// A file below one of the folders that were given, and nowhere else.
fn file(name: &str, options: &ReadOptions) -> Option<PathBuf> {
    options.include.iter().find_map(|folder| {
        let folder = folder.canonicalize().ok()?;
        let path = folder.join(name.trim_start_matches('/')).canonicalize().ok()?;
        (path.starts_with(&folder) && path.is_file()).then_some(path)
    })
}

/// What a shader's directives ask its host for.
#[derive(Default)]
struct Asked {
    /// Names that are asked for: `#ifdef`, `defined`.
    defined: BTreeSet<String>,
    /// Names whose number is asked for: `#if`, the size of an array.
    numbers: BTreeSet<String>,
    /// Names with what they are compared with.
    compared: Vec<(String, String)>,
}

fn asked(text: &str) -> Asked {
    let mut own = Asked::default();
    let mut known: BTreeSet<&str> = BTreeSet::from(["GL_ES", "__VERSION__", "GL_FRAGMENT_PRECISION_HIGH", "defined"]);
    for line in text.lines() {
        if let Some(rest) = line.split_once("const int ").map(|(_, rest)| rest) {
            known.extend(words(rest).next());
        }
        let Some(own_directive) = directive(line) else { continue };
        let name = |rest: &'_ str| words(rest).next().map(str::to_owned);
        if let Some(rest) = own_directive.strip_prefix("define") {
            known.extend(words(rest).next());
        } else if let Some(rest) = own_directive.strip_prefix("ifdef").or_else(|| own_directive.strip_prefix("ifndef"))
        {
            own.defined.extend(name(rest).filter(|name| !known.contains(&**name)));
        } else if let Some(rest) = own_directive.strip_prefix("if").or_else(|| own_directive.strip_prefix("elif")) {
            let rest = rest.split("//").next().unwrap_or_default();
            let all: Vec<&str> = words(rest).collect();
            for (k, word) in all.iter().enumerate() {
                let is_name = word.starts_with(|c: char| c.is_alphabetic()) && !known.contains(word);
                if is_name && k > 0 && all[k - 1] == "defined" {
                    own.defined.insert((*word).into());
                } else if is_name {
                    own.numbers.insert((*word).into());
                }
            }
            if let ([name, value], true) = (&*all, rest.contains("==")) {
                own.compared.push(((*name).into(), (*value).into()));
            }
        }
    }
    for size in text.split('[').skip(1).filter_map(|rest| rest.split(']').next()) {
        let size = size.trim();
        let is_macro = size.starts_with(|c: char| c.is_ascii_uppercase())
            && size.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
        if is_macro && !known.contains(size) {
            own.numbers.insert(size.into());
        }
    }
    own.defined.retain(|name| !own.numbers.contains(name));
    own
}

/// Names that switch a step on.
const STEPS: [&str; 6] = ["SPECULAR", "FOG", "LIGHT", "DIFFUSE", "GAMMA", "NORMAL"];
/// Names that have such a word, and switch something else.
const NO_STEPS: [&str; 9] = ["NO_", "AREA", "COUNT", "MAP", "TEXTURE", "CULLING", "DISABLE", "SHADOW", "_H"];

/// Sets of definitions under which a text is read, each with what it is called.
pub(super) fn configurations(text: &str, given: &[(String, String)]) -> Vec<(String, Definitions)> {
    let mut asked = asked(text);
    let is_given = |name: &String| given.iter().any(|(own, _)| own == name);
    asked.numbers.retain(|name| !is_given(name));
    asked.defined.retain(|name| !is_given(name));
    asked.compared.retain(|(name, _)| asked.numbers.contains(name));
    let start: Definitions = given.to_vec();
    let values: Vec<&String> = asked.compared.iter().map(|(_, value)| value).collect();
    let is_macro = |name: &String| name.contains(|c: char| c.is_ascii_uppercase());
    let ones = |but: &str| -> Definitions {
        let names = asked.numbers.iter().filter(|name| *name != but && !values.contains(name) && is_macro(name));
        names.map(|name| (name.clone(), "1".to_owned())).collect()
    };
    let called =
        |own: &Definitions| own.iter().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ");
    let mut sets: Vec<Definitions> = vec![];
    // The stage, where one file has two.
    let named = |starts: &[&str], marks: &[&str]| {
        let is_own = |name: &&String| {
            let name = name.to_uppercase();
            name.split('_').any(|part| {
                starts.iter().any(|start| part.starts_with(start)) || marks.iter().any(|mark| part.ends_with(mark))
            })
        };
        asked.defined.iter().filter(is_own).min_by_key(|name| name.len()).cloned()
    };
    let stages = [named(&["FRAG", "PIXEL"], &["PS", "FS", "FSH"]), named(&["VERT"], &["VS", "VSH"])];
    if let [Some(fragment), Some(vertex)] = &stages
        && fragment != vertex
    {
        let mut found = vec![];
        for stage in [fragment, vertex] {
            // The other of the two is left out for good.
            let others = text.replace(&**(if stage == fragment { vertex } else { fragment }), "LIGHTMETER_OTHER_STAGE");
            let given: Definitions = given.iter().cloned().chain([(stage.clone(), "1".to_owned())]).collect();
            let named = |called: String| if called.is_empty() { stage.clone() } else { format!("{stage}, {called}") };
            found.extend(configurations(&others, &given).into_iter().map(|(called, own)| (named(called), own)));
        }
        return found;
    }
    if let Some((name, _)) = asked.compared.first() {
        let compared: BTreeSet<&String> =
            asked.compared.iter().filter(|(own, _)| own == name).map(|(_, value)| value).collect();
        sets.extend(compared.into_iter().map(|value| [ones(name), vec![(name.clone(), value.clone())]].concat()));
    } else {
        sets.push(ones(""));
    }
    sets.truncate(MOST_SETS);
    let switches: Definitions = asked
        .defined
        .iter()
        .filter(|name| {
            let name = name.to_uppercase();
            STEPS.iter().any(|own| name.contains(own)) && !NO_STEPS.iter().any(|own| name.contains(own))
        })
        .map(|name| (name.clone(), "1".into()))
        .collect();
    if !switches.is_empty() {
        sets.push(sets[0].iter().cloned().chain(switches).collect());
    }
    sets.into_iter().map(|own| (called(&own), start.iter().cloned().chain(own).collect())).collect()
}

/// All that a text asks for, defined.
pub(super) fn all_asked(text: &str, given: &[(String, String)]) -> Definitions {
    let all = asked(text);
    let names = all.defined.into_iter().chain(all.numbers);
    given.iter().cloned().chain(names.map(|name| (name, "1".to_owned()))).collect()
}
