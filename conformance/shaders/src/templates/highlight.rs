//! The forms of highlights, in every combination of what can be done to one.

/// A choice of a form: its part of the function's name, what is wrong or different (`mistake …`, `dialect …`), what is said, and the code.
type Choice = (&'static str, &'static str, &'static str, &'static str);

/// The cosine that the power is of.
const COSINES: [Choice; 5] = [
    ("phong", "", "Phong's highlight", "dot(reflect(-l, n), v)"),
    (
        "phong_single",
        "mistake mirror-not-doubled",
        "Phong's highlight with the mirrored vector (n·l)n − l, which lacks its factor 2",
        "dot(dot(n, l) * n - l, v)",
    ),
    ("blinn", "", "Blinn's highlight", "dot(n, normalize(l + v))"),
    (
        "blinn_mean",
        "mistake half-vector-as-mean",
        "Blinn's highlight with the mean (l + v)/2 for the half vector, not normalised",
        "dot(n, (l + v) / 2.0)",
    ),
    (
        "blinn_sum",
        "mistake half-vector-not-normalised",
        "Blinn's highlight with l + v for the half vector, not normalised",
        "dot(n, l + v)",
    ),
];
/// What holds the cosine above 0. `C` is the cosine.
const GUARDS: [Choice; 3] = [
    ("", "", "", "max(C, 0.0)"),
    ("_unguarded", "mistake unguarded", ", the power of a cosine that may be negative", "C"),
    ("_absolute", "mistake both-sides", ", of the cosine's absolute value", "abs(C)"),
];
/// The power. `G` is the guarded cosine.
const POWERS: [Choice; 2] = [
    ("", "", "", "pow(G, exponent)"),
    ("_inverse", "mistake exponent-inverse", ", with the exponent's reciprocal", "pow(G, 1.0 / exponent)"),
];
/// Where there is a highlight. `P` is the power.
const GATES: [Choice; 4] = [
    ("", "", "", "P"),
    ("_gated", "dialect gated", ", none where n·l ≤ 0", "select(0.0, P, dot(n, l) > 0.0)"),
    ("_times", "dialect times-lambert", ", times n·l", "max(dot(n, l), 0.0) * P"),
    (
        "_times_gated",
        "dialect times-lambert",
        ", times n·l where it is above 0",
        "select(0.0, dot(n, l) * P, dot(n, l) > 0.0)",
    ),
];
/// What normalises it.
const SCALES: [Choice; 6] = [
    ("", "", "", "P"),
    ("_by_two_pi", "dialect normalised", ", normalised by (S + 2)/2π", "(exponent + 2.0) / 6.28318530717958 * P"),
    ("_by_two", "dialect normalised", ", normalised by (S + 2)/2", "(exponent + 2.0) / 2.0 * P"),
    ("_by_eight_pi", "dialect normalised", ", normalised by (S + 8)/8π", "(exponent + 8.0) / 25.1327412287183 * P"),
    ("_by_two_eight_pi", "dialect normalised", ", normalised by (S + 2)/8π", "(exponent + 2.0) / 25.1327412287183 * P"),
    ("_by_eight", "dialect normalised", ", normalised by (S + 8)/8", "(exponent + 8.0) / 8.0 * P"),
];
/// Where it is seen from.
const VIEWS: [Choice; 2] =
    [("", "", "", "v: vec3f, "), ("_from_z", "dialect viewer-at-infinity", ", seen along z", "")];

/// All forms of highlights, each with at most one mistake.
pub(super) fn all() -> String {
    let mut text = String::new();
    for cosine in &COSINES {
        for guard in &GUARDS {
            for power in &POWERS {
                for gate in &GATES {
                    for scale in &SCALES {
                        for view in &VIEWS {
                            form([cosine, guard, power, gate, scale, view], &mut text);
                        }
                    }
                }
            }
        }
    }
    for (kind, cosine) in [("phong", COSINES[0].3), ("blinn", COSINES[2].3)] {
        text += &format!(
            "//@ {kind} dialect gated: {}, none where the cosine n·l is below a limit\n",
            if kind == "phong" { COSINES[0].2 } else { COSINES[2].2 }
        );
        text += &format!(
            "fn {kind}_gated_limit(n: vec3f, l: vec3f, v: vec3f, exponent: f32, share: f32) -> f32 {{ return select(0.0, pow(max({cosine}, 0.0), exponent), max(dot(n, l), 0.0) > share); }}\n"
        );
    }
    text
}

fn form(choices: [&Choice; 6], text: &mut String) {
    let [cosine, guard, power, gate, scale, view] = choices;
    let notes: Vec<&str> = choices.iter().map(|own| own.1).filter(|own| !own.is_empty()).collect();
    let mistakes: Vec<&&str> = notes.iter().filter(|own| own.starts_with("mistake")).collect();
    // What is seldom done at all is not done with anything else.
    let rare = [power.0, scale.0].iter().filter(|own| !own.is_empty()).count();
    if mistakes.len() > 1 || rare > 1 || rare == 1 && notes.len() > 1 {
        return;
    }
    let worth = mistakes.first().copied().or_else(|| notes.first()).copied().unwrap_or("right");
    let kind = cosine.0.split('_').next().unwrap_or_default();
    let name: String = choices.iter().map(|own| own.0).collect();
    let said: String = choices.iter().map(|own| own.2).collect();
    let code = guard.3.replace('C', cosine.3);
    let code = gate.3.replace('P', &power.3.replace('G', &code));
    let code = scale.3.replace('P', &code);
    let code = if view.3.is_empty() {
        code.replace(", v)", ", vec3f(0.0, 0.0, 1.0))").replace("l + v", "l + vec3f(0.0, 0.0, 1.0)")
    } else {
        code
    };
    *text += &format!("//@ {kind} {worth}: {said}\n");
    *text += &format!("fn {name}(n: vec3f, l: vec3f, {}exponent: f32) -> f32 {{ return {code}; }}\n", view.3);
}
