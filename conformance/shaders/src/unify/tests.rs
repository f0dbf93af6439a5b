use super::*;
use crate::lower::Lowering;
use std::collections::BTreeMap;

fn library() -> Library {
    Library::new().expect("the forms are read")
}

/// No two forms of a step that are of unlike worth are equal where both are drawn alike: one of them would never be found.
#[test]
fn forms_of_unlike_worth_are_unlike() {
    let library = library();
    let mut wrong = vec![];
    for group in &library.groups {
        for (k, a) in group.forms.iter().enumerate() {
            for b in &group.forms[..k] {
                let (one, other) = (&library.templates[a.template], &library.templates[b.template]);
                let is_same = || a.values.iter().zip(&b.values).all(|(x, y)| is_close(x, y, EXACT));
                if one.head.kind == other.head.kind && one.head.worth != other.head.worth && is_same() {
                    wrong.push(format!("{} and {}", one.name, other.name));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Each form is found in its own text, in WGSL and in GLSL: as itself, or as one of the same step, worth and name.
#[test]
fn each_form_is_found_in_its_own_text() {
    let library = library();
    let (text, _) = crate::templates::all().expect("the forms are read");
    let glsl: String = text.lines().map(|line| in_glsl(line) + "\n").collect();
    let wgsl = naga::front::wgsl::parse_str(&text).expect("the forms are WGSL");
    let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
    let glsl = naga::front::glsl::Frontend::default()
        .parse(&options, &format!("#version 450\n{glsl}void main() {{}}\n"))
        .unwrap_or_else(|errors| panic!("{}", errors.emit_to_string(&glsl)));
    let mut wrong: BTreeMap<String, String> = BTreeMap::new();
    for (language, module) in [("WGSL", &wgsl), ("GLSL", &glsl)] {
        let mut found = 0;
        for (_, function) in module.functions.iter() {
            let name = function.name.clone().unwrap_or_default();
            let Some(own) = library.templates.iter().find(|own| own.name == name) else { continue };
            let mut lowering = Lowering::new(module, &library::Plain);
            let root = lowering.root(function, &name, false);
            let mut finder = Finder::new(&lowering.graph, &library);
            let value = root.outputs[0].value;
            let bare = lowering.graph.without_sign(value).0;
            let matched = finder.best(value).or_else(|| finder.best(bare)).map(|own| &finder.template(&own).head);
            let is_it = matched.is_some_and(|head| {
                head.kind == own.head.kind && head.worth == own.head.worth && head.name == own.head.name
            });
            if !is_it {
                let seen = matched.map(|head| format!("{} {:?} {}", head.kind, head.worth, head.name));
                wrong.insert(format!("{name} in {language}"), format!("{seen:?}"));
            }
            found += 1;
        }
        assert_eq!(found, library.templates.len(), "{language}");
    }
    assert!(wrong.is_empty(), "{} of {}: {wrong:#?}", wrong.len(), library.templates.len());
}

/// A function of one line in GLSL.
fn in_glsl(line: &str) -> String {
    let Some(rest) = line.strip_prefix("fn ") else { return line.to_owned() };
    let ty = |own: &str| match own {
        "f32" => "float".to_owned(),
        other => other.trim_end_matches('f').replace("mat4x4", "mat4").replace("mat3x3", "mat3"),
    };
    let (name, rest) = rest.split_once('(').expect("parameters");
    let (parameters, rest) = rest.split_once(") -> ").expect("a result");
    let (result, body) = rest.split_once(' ').expect("a body");
    let parameters: Vec<String> = parameters
        .split(", ")
        .map(|own| {
            let (name, own) = own.split_once(": ").expect("a type");
            format!("{} {name}", ty(own))
        })
        .collect();
    // What is named in between is a number, but for vectors that are exposed.
    let vector = if name.starts_with("filmic") { ty(result) } else { "float".into() };
    let mut body = body.replace("let ", &format!("{vector} "));
    while let Some(at) = body.find("select(") {
        let (mut depth, mut commas, mut end) = (0, vec![], at);
        for (k, c) in body.char_indices().skip_while(|(k, _)| *k < at + 7) {
            match c {
                '(' => depth += 1,
                ')' if depth == 0 => {
                    end = k;
                    break;
                }
                ')' => depth -= 1,
                ',' if depth == 0 => commas.push(k),
                _ => {}
            }
        }
        let (no, yes, condition) =
            (&body[at + 7..commas[0]], &body[commas[0] + 1..commas[1]], &body[commas[1] + 1..end]);
        // Vectors are chosen by component.
        let is_vector =
            result != "f32" && ["<", ">"].iter().any(|own| condition.contains(own)) && condition.contains("vec3f");
        let choice = if is_vector {
            let (a, sign, b) =
                condition.split_once(" <= ").map(|(a, b)| (a, "lessThanEqual", b)).unwrap_or_else(|| {
                    let (a, b) = condition.split_once(" < ").expect("a comparison");
                    (a, "lessThan", b)
                });
            format!("mix({no}, {yes}, {sign}({a}, {b}))")
        } else {
            format!("(({condition}) ? ({yes}) : ({no}))")
        };
        body.replace_range(at..=end, &choice);
    }
    for (own, other) in
        [("vec2f", "vec2"), ("vec3f", "vec3"), ("vec4f", "vec4"), ("mat3x3f", "mat3"), ("f32(", "float(")]
    {
        body = body.replace(own, other);
    }
    format!("{} {name}({}) {body}", if result == "bool" { "bool".into() } else { ty(result) }, parameters.join(", "))
}
