//! Pages to look things up on: all formulas, all mistakes, words, the command line, exit codes, schemas.

use crate::blend::shown_by;
use crate::contents::Place;
use crate::formula::{Told, dialect, link, page_of, sentence, told};
use crate::{BookSources, CommandHelp};
use lightmeter_catalogue::dialects::DIALECTS;
use lightmeter_catalogue::rulings::GLOSSARY;
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::load::Loaded;
use lightmeter_catalogue::select::Member;
use lightmeter_faults::{faults, listed};
use lightmeter_report::html::prose;
use lightmeter_scene::blend::{Equation, Factor};
use maud::{Markup, html};
use serde_json::Value;
use std::collections::BTreeMap;

/// All formulas, family by family, with the equations and factors of blending.
pub(crate) fn formulas(catalogue: &[Member], place: &Place<'_>) -> Markup {
    let mut families: Vec<(&str, Vec<&Member>)> = vec![];
    for member in catalogue.iter().filter(|member| page_of(&member.spec).is_some()) {
        match families.iter_mut().find(|(family, _)| *family == member.spec.family()) {
            Some((_, members)) => members.push(member),
            None => families.push((member.spec.family(), vec![member])),
        }
    }
    html! {
        h1 { "All formulas" }
        p { "Each formula has a page with its equation, a picture, who computes it otherwise, its code, its errors in 32 bits, its hard cases, and the mistakes that are known of it." }
        @for (family, members) in &families {
            h2 id=(family) { (family) }
            div.wide tabindex="0" role="group" aria-label=(family) { table { tbody {
                @for member in members { tr { th scope="row" { (link(&member.spec.id, place, catalogue)) } td { (member.spec.text) } } }
            } } }
        }
        h2 #equations { "Blend equations" }
        ul { @for one in Equation::ALL { li { a href=(place.to(&format!("blend/equation/{}.html", one.name()))) { code { (one.name()) } } " as in " code { "blend/" (shown_by(one)) } } } }
        h2 #factors { "Blend factors" }
        ul { @for factor in Factor::ALL { li { a href=(place.to(&format!("blend/factor/{}.html", factor.name()))) { code { (factor.name()) } } ": " (factor.formulas()[0]) " in the colour, " (factor.formulas()[1]) " in alpha" } } }
    }
}

/// Everything that programs in use compute in different ways.
pub(crate) fn dialects(catalogue: &[Member], place: &Place<'_>) -> Markup {
    html! {
        h1 { "Who computes what" }
        p { "The same name stands for different formulas in the documents, in OpenGL and in three.js. None of them is an error in itself: a renderer is held to the one that it declares." }
        @for one in DIALECTS { (dialect(one, place, catalogue)) }
    }
}

/// All mistakes, with the formulas that each concerns.
pub(crate) fn mistakes(catalogue: &[Member], place: &Place<'_>) -> Markup {
    let pages = told(catalogue);
    let mut concerned: BTreeMap<&str, Vec<&Told<'_>>> = BTreeMap::new();
    for page in &pages {
        for fault in listed(page.member) {
            concerned.entry(fault.name).or_default().push(page);
        }
    }
    html! {
        h1 { "Mistakes that are known by name" }
        p { "Where a renderer fails, the suite names the mistake that explains its answers, if it knows one. " code { "lightmeter show CASE --mistake NAME" } " computes a case as a renderer with the mistake would." }
        details { summary { "All names" } ul.names { @for fault in faults() { li { a href={ "#" (fault.name) } { code { (fault.name) } } } } } }
        @for fault in faults() {
            section {
                h2 id=(fault.name) { code { (fault.name) } }
                p { (prose(&sentence(fault.says))) @if let Some(seen) = fault.seen_in { " Seen in: " (seen) "." } }
                @if let Some(pages) = concerned.get(fault.name) {
                    details { summary { (pages.len()) @if pages.len() == 1 { " formula" } @else { " formulas" } }
                        ul { @for page in pages { li { a href={ (place.to(&page.path)) "#mistake-" (fault.name) } { code { (page.member.spec.id) } } } } }
                    }
                } @else { p.hint { "It concerns blend states or depth tests alone." } }
            }
        }
    }
}

/// Words with a meaning of their own.
pub(crate) fn glossary() -> Markup {
    html! {
        h1 { "Glossary" }
        p { "These words have a meaning of their own here. " code { "lightmeter show WORD" } " says the same." }
        dl.glossary { @for (words, means) in GLOSSARY { dt id=(words.split(", ").next().unwrap_or_default().replace(' ', "-")) { (words) } dd { (prose(&sentence(means))) } } }
    }
}

/// What the command line can be asked.
pub(crate) fn command_line(commands: &[CommandHelp]) -> Markup {
    html! {
        h1 { "The command line" }
        p { "This is what " code { "lightmeter COMMAND --help" } " prints." }
        ul { @for one in commands { li { a href={ "#" (one.name) } { code { (one.name) } } ": " (one.about) } } }
        @for one in commands { h2 id=(one.name) { code { "lightmeter " (one.name) } } pre tabindex="0" { (one.help) } }
    }
}

/// What exit codes mean.
pub(crate) fn exit_codes(codes: &[(String, String)]) -> Markup {
    html! {
        h1 { "Exit codes" }
        p { "Every command ends with one of these. A script needs no more than the code." }
        div.wide tabindex="0" role="group" aria-label="exit codes" { table {
            thead { tr { th scope="col" { "code" } th scope="col" { "meaning" } } }
            tbody { @for (code, means) in codes { tr { th scope="row" { (code) } td { (means) } } } }
        } }
    }
}

/// The files that are read or written, each with its schema.
pub(crate) fn schemas(sources: &BookSources, place: &Place<'_>) -> Markup {
    html! {
        h1 { "Schemas" }
        p { "Each file that lightmeter reads or writes has a JSON Schema, which " code { "lightmeter schema NAME" } " prints. Fields may be added to a file; none changes its meaning." }
        ul { @for (name, schema) in &sources.schemas { li { a href=(place.to(&format!("reference/schema/{name}.html"))) { code { (name) } } @if let Some(says) = schema["description"].as_str() { ": " (prose(first_line(says))) } } } }
    }
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

/// How a scene is written: an example, and its fields.
pub(crate) fn scene_files(sources: &BookSources, example: &Loaded, place: &Place<'_>) -> Markup {
    let written = SCENES.iter().find(|(name, _)| *name == example.name).map(|(_, text)| *text);
    let described = sources.schemas.iter().find(|(name, _)| name == "scene");
    html! {
        h1 { "Scene files" }
        p { "A scene is a file of JSON. " code { "lightmeter render FILE --out scene.png" } " draws one, " code { "lightmeter effects FILE" } " says what it calls for, and " a href=(place.to("scenes.html")) { "the gallery" } " has those that are built in." }
        @if let Some(text) = written { h2 { "An example: " code { (example.name) } } pre tabindex="0" { code { (text) } } }
        @if let Some((_, schema)) = described { h2 { "Its fields" } (object("", schema)) @if let Some(definitions) = schema["$defs"].as_object() { @for (name, one) in definitions { (object(name, one)) } } }
    }
}

/// A schema as tables: the file itself, and each of the objects in it.
pub(crate) fn schema(name: &str, schema: &Value) -> Markup {
    let definitions = schema["$defs"].as_object();
    html! {
        h1 { "The schema " code { (name) } }
        (object("", schema))
        @if let Some(definitions) = definitions { @for (name, one) in definitions { (object(name, one)) } }
    }
}

fn object(name: &str, schema: &Value) -> Markup {
    let properties = schema["properties"].as_object();
    let required = |field: &str| schema["required"].as_array().is_some_and(|all| all.iter().any(|one| one == field));
    let choices: Vec<&Value> = ["oneOf", "anyOf"].iter().filter_map(|key| schema[*key].as_array()).flatten().collect();
    html! {
        @if !name.is_empty() { h2 id={ "def-" (name) } { code { (name) } } }
        @if let Some(says) = schema["description"].as_str() { p { (prose(says)) } }
        @if let Some(properties) = properties { div.wide tabindex="0" role="group" aria-label={ "fields of " (if name.is_empty() { "the file" } else { name }) } { table {
            thead { tr { th scope="col" { "field" } th scope="col" { "type" } th scope="col" { "meaning" } } }
            tbody { @for (field, of) in properties { tr { th scope="row" { code { (field) } @if !required(field) { span.quiet { " may be missing" } } } td { (kind(of)) } td { @if let Some(says) = of["description"].as_str() { (prose(says)) } } } } }
        } } }
        @if !choices.is_empty() { ul { @for choice in choices { li { (kind(choice)) @if let Some(says) = choice["description"].as_str() { ": " (prose(says)) } } } } }
        @if let Some(words) = schema["enum"].as_array() { p { "One of: " (words.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")) } }
    }
}

/// What a value may be, in few words; an object of its own as a link.
fn kind(schema: &Value) -> Markup {
    if let Some(name) = schema["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/")) {
        return html! { a href={ "#def-" (name) } { (name) } };
    }
    if let Some(constant) = schema.get("const") {
        return html! { code { (constant.to_string()) } };
    }
    for key in ["anyOf", "oneOf"] {
        if let Some(choices) = schema[key].as_array() {
            return html! { @for (k, choice) in choices.iter().enumerate() { @if k > 0 { " or " } (kind(choice)) } };
        }
    }
    if let Some(words) = schema["enum"].as_array() {
        return html! { (words.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")) };
    }
    match &schema["type"] {
        Value::String(name) if name == "array" => html! { "array of " (kind(&schema["items"])) },
        Value::String(name) if name == "object" && schema["properties"].is_object() => {
            html! { "object of " (schema["properties"].as_object().map(|fields| fields.keys().cloned().collect::<Vec<_>>().join(", ")).unwrap_or_default()) }
        }
        Value::String(name) => html! { (name) },
        Value::Array(names) => html! { (names.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(" or ")) },
        _ => html! { "any" },
    }
}
