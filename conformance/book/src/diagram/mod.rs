//! Diagrams of formulas: points, vectors and quantities, chosen and labelled by the names of the inputs.

mod raster;

use lightmeter_catalogue::cases::{Kind, Spec};
use lightmeter_scene::blend::Equation;
use maud::{Markup, html};

/// The diagram of a formula.
pub(crate) fn diagram(spec: &Spec) -> Markup {
    let has = |name: &str| spec.inputs.iter().any(|input| input.name == name);
    let of = |names: &[&str]| names.iter().any(|name| has(name));
    match (spec.kind, spec.family()) {
        (Kind::Raster(raster), _) => raster::raster(raster).unwrap_or_else(|| flow(spec)),
        (Kind::Blend(program), _) => blend(program.layer(0).0.color.equation),
        (Kind::Depth(test), _) => raster::depth_test(test.compare),
        (_, "fog") => fog(spec),
        (_, "depth") if of(&["near"]) => frustum(),
        (_, "attenuation") if has("axis") => surface(spec),
        (_, "attenuation") => falloff(spec),
        (_, "interpolation") if has("clip") => viewport(),
        (_, "interpolation") if of(&["lambda", "w"]) => perspective(),
        (_, "interpolation") if has("v1") => scanline(),
        (_, "interpolation" | "color") if has("c") && of(&["p", "weights"]) => triangle(),
        (_, "interpolation") if has("a") && has("p") => edge(),
        (_, "interpolation") if of(&["a", "t"]) => span(),
        (_, "lighting") if of(&["pa", "a"]) && !spec.id.contains("cosine-power") => vertices(),
        (_, "lighting" | "vector")
            if of(&["n", "normal", "l", "i", "r", "v"])
                && !spec.id.contains("normalize")
                && !spec.id.contains("length")
                && !has("modelview") =>
        {
            surface(spec)
        }
        (_, "lighting") if spec.id.contains("cosine-power") => angle(),
        (_, "vector") if has("v") => length(),
        (_, "vector") if of(&["modelview", "view"]) => transform(spec),
        (_, "vector") if of(&["a", "n0"]) => vertices(),
        _ => flow(spec),
    }
}

fn figure(width: u32, height: u32, label: &str, body: &Markup) -> Markup {
    html! {
        figure.diagram {
            svg viewBox={ "0 0 " (width) " " (height) } role="img" aria-label=(label) { (body) }
            figcaption { (label) }
        }
    }
}

/// An arrow with its name beside its head.
fn arrow(from: [f64; 2], to: [f64; 2], name: &str, class: &str) -> Markup {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let length = dx.hypot(dy).max(1.0);
    let [ux, uy] = [dx / length, dy / length];
    let head =
        |side: f64| format!("{:.1},{:.1}", to[0] - 9.0 * ux - side * 4.0 * uy, to[1] - 9.0 * uy + side * 4.0 * ux);
    html! {
        g class={ "arrow " (class) } {
            line x1=(fixed(from[0])) y1=(fixed(from[1])) x2=(fixed(to[0] - 6.0 * ux)) y2=(fixed(to[1] - 6.0 * uy)) {}
            polygon points={ (fixed(to[0])) "," (fixed(to[1])) " " (head(1.0)) " " (head(-1.0)) } {}
            text x=(fixed(to[0] + 12.0 * ux)) y=(fixed(to[1] + 12.0 * uy + 4.0)) text-anchor="middle" { (name) }
        }
    }
}

fn fixed(x: f64) -> String {
    format!("{x:.1}")
}

fn dot(at: [f64; 2], name: &str) -> Markup {
    html! { circle.point cx=(fixed(at[0])) cy=(fixed(at[1])) r="3.5" {} text x=(fixed(at[0] + 8.0)) y=(fixed(at[1] + 15.0)) { (name) } }
}

/// A point of a surface with the vectors that the formula takes or makes of what it takes.
fn surface(spec: &Spec) -> Markup {
    let has = |name: &str| spec.inputs.iter().any(|input| input.name == name);
    let says = |what: &str| spec.text.contains(what) || spec.rules().iter().any(|rule| rule.contains(what));
    let p = [200.0, 170.0];
    let at = |degrees: f64, length: f64| {
        [p[0] + length * degrees.to_radians().sin(), p[1] - length * degrees.to_radians().cos()]
    };
    let is_phong = has("r") || says("r·v") || says("r = ") || says("Phong");
    let is_blinn = has("h") || says("n·h") || says("h = ") || says("Blinn");
    let is_point = has("position") || has("light");
    let direction = spec.inputs.iter().find(|input| input.name == "direction" || input.name == "i");
    let travels = direction.is_some_and(|input| !spec.input_means(input).starts_with("towards"));
    let n = if has("normal") { "normal" } else { "n" };
    let has_v = has("v") || has("p") || is_phong || is_blinn;
    let mut words = vec![];
    let body = html! {
        line.surface x1="60" y1="170" x2="340" y2="170" {}
        @if has("n") || has("normal") || spec.family() == "lighting" { (arrow(p, at(0.0, 120.0), n, "main")) }
        @if has("l") || direction.is_some() || is_point || has("axis") || is_phong && spec.family() == "lighting" { (arrow(p, at(-48.0, 130.0), "l", "light")) @let () = words.push("l to the light"); }
        @if is_point || has("axis") { circle.lamp cx=(fixed(at(-48.0, 158.0)[0])) cy=(fixed(at(-48.0, 158.0)[1])) r="7" {} text x=(fixed(at(-48.0, 158.0)[0] - 12.0)) y=(fixed(at(-48.0, 158.0)[1] - 10.0)) text-anchor="end" { @if has("light") { "light" } @else if is_point { "position" } @else { "light" } } }
        @if let Some(input) = direction.filter(|_| travels) { (arrow(at(-60.0, 150.0), at(-66.0, 66.0), input.name, "travel")) @let () = words.push("the light travels the other way"); }
        @if has_v { (arrow(p, at(68.0, 125.0), "v", "")) @let () = words.push("v to the eye"); }
        @if is_phong { (arrow(p, at(48.0, 120.0), "r", "made")) @let () = words.push("r mirrors l at n"); }
        @if is_blinn { (arrow(p, at(10.0, 95.0), "h", "made")) @let () = words.push("h halves the angle between l and v"); }
        @if has("axis") {
            (arrow(at(-48.0, 152.0), at(-40.0, 62.0), "axis", "travel"))
            path.cone d={ "M" (fixed(at(-48.0, 155.0)[0])) " " (fixed(at(-48.0, 155.0)[1])) "L" (fixed(p[0] + 40.0)) " 170L" (fixed(p[0] - 110.0)) " 170Z" } {}
            @let () = words.push("the cone ends at the cutoff");
        }
        (dot(p, if has("p") { "p" } else { "" }))
    };
    let label = if words.is_empty() {
        "At a point of a surface".to_owned()
    } else {
        format!("At a point of a surface: {}", words.join("; "))
    };
    figure(400, 200, &label, &body)
}

fn fog(spec: &Spec) -> Markup {
    let has = |name: &str| spec.inputs.iter().any(|input| input.name == name);
    let is_radial = spec.id.contains("radial");
    let (eye, p) = ([40.0, 120.0], [270.0, 50.0]);
    let along = [p[0], eye[1]];
    let label =
        if is_radial { "Distance is |p|, from the eye itself" } else { "Distance is |z|, along the line of sight" };
    let body = html! {
        @for k in 0..8 { rect.mist x=(80 + 40 * k) y="10" width="40" height="150" fill-opacity=(format!("{:.2}", 0.06 * f64::from(k + 1))) {} }
        line.surface x1="40" y1="120" x2="390" y2="120" {}
        (dot(eye, "eye"))
        (dot(p, if has("p") { "p" } else { "surface" }))
        @if has("distance") { (arrow(eye, along, "distance", "main")) }
        @else if is_radial { (arrow(eye, p, "|p|", "main")) line.helper x1="40" y1="120" x2="270" y2="120" {} text x="200" y="136" { "|z|" } }
        @else { (arrow(eye, along, "|z|", "main")) line.helper x1=(eye[0]) y1=(eye[1]) x2=(p[0]) y2=(p[1]) {} line.helper x1=(p[0]) y1=(p[1]) x2=(along[0]) y2=(along[1]) {} }
        @if has("dmin") { line.mark x1="120" y1="10" x2="120" y2="160" {} text x="124" y="24" { "dmin" } line.mark x1="360" y1="10" x2="360" y2="160" {} text x="356" y="24" text-anchor="end" { "dmax" } }
    };
    figure(400, 170, label, &body)
}

fn falloff(spec: &Spec) -> Markup {
    let named =
        if spec.inputs.iter().any(|input| input.name == "light") { ["light", "p"] } else { ["light", "surface"] };
    let body = html! {
        @for (radius, opacity) in [(110, 0.10), (75, 0.16), (45, 0.26), (22, 0.45)] { circle.glow cx="130" cy="115" r=(radius) fill-opacity=(opacity) {} }
        (dot([130.0, 115.0], named[0]))
        (dot([330.0, 90.0], named[1]))
        (arrow([130.0, 115.0], [326.0, 91.0], "", "main"))
        text x="235" y="92" { "d" }
    };
    figure(400, 230, "The light weakens with the distance d", &body)
}

fn triangle() -> Markup {
    let body = html! {
        polygon.part-a points="230,95 340,150 190,20" {} polygon.part-b points="230,95 190,20 70,160" {} polygon.part-c points="230,95 70,160 340,150" {}
        polygon.outline points="70,160 340,150 190,20" {}
        text x="255" y="80" { "α" } text x="155" y="90" { "β" } text x="215" y="140" { "γ" }
        (dot([70.0, 160.0], "a")) (dot([340.0, 150.0], "b")) (dot([190.0, 20.0], "c")) (dot([230.0, 95.0], "p"))
    };
    figure(400, 190, "Each weight is the area opposite its vertex over the whole", &body)
}

fn edge() -> Markup {
    let body = html! {
        (arrow([70.0, 150.0], [320.0, 110.0], "b − a", "main")) (arrow([70.0, 150.0], [190.0, 30.0], "p − a", "light"))
        (dot([70.0, 150.0], "a")) (dot([320.0, 110.0], "b")) (dot([190.0, 30.0], "p"))
    };
    figure(400, 180, "The sign tells the side of the edge on which p lies", &body)
}

fn span() -> Markup {
    let body = html! {
        line.surface x1="60" y1="60" x2="340" y2="60" {} line.mark x1="144" y1="40" x2="144" y2="80" {}
        (dot([60.0, 60.0], "a")) (dot([340.0, 60.0], "b")) text x="60" y="36" { "t = 0" } text x="130" y="32" { "t" } text x="330" y="36" { "t = 1" }
    };
    figure(400, 95, "Between two ends", &body)
}

fn perspective() -> Markup {
    let body = html! {
        (dot([40.0, 110.0], "eye"))
        line.surface x1="120" y1="20" x2="120" y2="180" {} text x="106" y="16" { "screen" }
        line.outline x1="180" y1="40" x2="350" y2="150" {}
        line.helper x1="40" y1="110" x2="180" y2="40" {} line.helper x1="40" y1="110" x2="350" y2="150" {} line.helper x1="40" y1="110" x2="241" y2="79.5" {}
        (dot([180.0, 40.0], "a, w small")) (dot([350.0, 150.0], "b, w large")) (dot([241.0, 79.5], "half way on the screen"))
    };
    figure(420, 190, "Half way on the screen is nearer than half way in space, so attributes are divided by w", &body)
}

fn scanline() -> Markup {
    let body = html! {
        polygon.outline points="180,20 70,160 330,140" {} line.mark x1="105" y1="115" x2="281" y2="115" {}
        (dot([180.0, 20.0], "v1")) (dot([70.0, 160.0], "v2")) (dot([330.0, 140.0], "v3"))
        (dot([105.0, 115.0], "Ia")) (dot([281.0, 115.0], "Ib")) (dot([200.0, 115.0], "p"))
    };
    figure(400, 190, "Down the edges first, then along the span", &body)
}

fn viewport() -> Markup {
    let body = html! {
        rect.outline x="30" y="35" width="120" height="120" {} text x="90" y="24" text-anchor="middle" { "clip, divided by w" } text x="36" y="150" { "−1" } text x="136" y="48" { "1" }
        (dot([110.0, 70.0], ""))
        (arrow([165.0, 95.0], [225.0, 95.0], "", "main"))
        rect.outline x="240" y="50" width="150" height="90" {} text x="315" y="24" text-anchor="middle" { "window" } text x="240" y="46" { "origin" } text x="388" y="156" text-anchor="end" { "size" }
        (dot([340.0, 76.0], ""))
    };
    figure(420, 170, "From the clip volume to the pixels of a viewport", &body)
}

fn vertices() -> Markup {
    let body = html! {
        path.surface d="M60 150 Q200 60 340 150" fill="none" {}
        (arrow([60.0, 150.0], [22.0, 70.0], "na", "main")) (arrow([340.0, 150.0], [378.0, 70.0], "nb", "main")) (arrow([200.0, 105.0], [200.0, 25.0], "n", "made"))
        (dot([60.0, 150.0], "a")) (dot([340.0, 150.0], "b")) (dot([200.0, 105.0], "between"))
    };
    figure(400, 180, "At the vertices, and between them", &body)
}

fn angle() -> Markup {
    let body = html! {
        (arrow([80.0, 150.0], [300.0, 60.0], "b", "main")) (arrow([80.0, 150.0], [220.0, 25.0], "a", "light"))
        path.helper d="M160 117 A86 86 0 0 0 144 93" fill="none" {} text x="170" y="102" { "a·b is the cosine" }
    };
    figure(400, 170, "A cosine of two unit vectors, raised to a power", &body)
}

fn length() -> Markup {
    let body = html! {
        circle.outline cx="150" cy="110" r="70" {} text x="150" y="198" text-anchor="middle" { "length 1" }
        (arrow([150.0, 110.0], [330.0, 30.0], "v", "light")) (arrow([150.0, 110.0], [214.0, 81.6], "⟨v⟩", "main"))
    };
    figure(400, 205, "A vector, and the unit vector of its direction", &body)
}

fn transform(spec: &Spec) -> Markup {
    let is_normal = spec.inputs.iter().any(|input| input.name == "n");
    if !is_normal {
        return flow(spec);
    }
    let body = html! {
        circle.outline cx="90" cy="100" r="45" {} (arrow([122.0, 68.0], [155.0, 35.0], "n", "main")) text x="90" y="170" text-anchor="middle" { "the model" }
        (arrow([170.0, 110.0], [220.0, 110.0], "", "light"))
        ellipse.outline cx="310" cy="100" rx="80" ry="35" {} (arrow([366.0, 75.0], [382.0, 28.0], "n′", "made")) (arrow([366.0, 75.0], [412.0, 52.0], "M·n", "travel")) text x="310" y="170" text-anchor="middle" { "in eye space" }
    };
    figure(440, 180, "Under a scale that is not uniform only the inverse transpose keeps a normal perpendicular", &body)
}

fn frustum() -> Markup {
    let body = html! {
        (dot([40.0, 100.0], "eye"))
        polygon.outline points="110,65 110,135 360,10 360,190" {}
        line.mark x1="110" y1="65" x2="110" y2="135" {} line.mark x1="360" y1="10" x2="360" y2="190" {}
        text x="98" y="58" { "near" } text x="352" y="206" text-anchor="end" { "far" }
        (arrow([40.0, 100.0], [240.0, 100.0], "", "main")) text x="180" y="92" { "z" }
    };
    figure(400, 212, "Depth is 0 at one plane and 1 at the other, and not even between them", &body)
}

/// The blend unit.
pub(crate) fn blend(equation: Equation) -> Markup {
    if equation.ignores_factors() {
        return blend_without_factors(equation);
    }
    let frame = |x: u32, y: u32, width: u32, name: &str| {
        html! { rect.outline x=(x) y=(y) width=(width) height="34" rx="5" {} text x=(x + width / 2) y=(y + 22) text-anchor="middle" { (name) } }
    };
    let body = html! {
        (frame(20, 20, 90, "src")) (frame(20, 110, 90, "dst")) (frame(150, 20, 60, "× S")) (frame(150, 110, 60, "× D")) (frame(250, 65, 80, "equation")) (frame(370, 65, 70, "target"))
        (arrow([110.0, 37.0], [148.0, 37.0], "", "main")) (arrow([110.0, 127.0], [148.0, 127.0], "", "main"))
        (arrow([210.0, 37.0], [250.0, 72.0], "", "main")) (arrow([210.0, 127.0], [250.0, 92.0], "", "main")) (arrow([330.0, 82.0], [368.0, 82.0], "", "main"))
        path.helper d="M405 99 V160 H65 V146" fill="none" {}
    };
    figure(460, 170, "What is drawn and what is there, each times its factor, come together by the equation", &body)
}

/// The blend unit where the equation takes no factors.
fn blend_without_factors(equation: Equation) -> Markup {
    let frame = |x: u32, y: u32, width: u32, name: &str| {
        html! { rect.outline x=(x) y=(y) width=(width) height="34" rx="5" {} text x=(x + width / 2) y=(y + 22) text-anchor="middle" { (name) } }
    };
    let body = html! {
        (frame(20, 20, 90, "src")) (frame(20, 110, 90, "dst")) (frame(200, 65, 80, equation.name())) (frame(340, 65, 70, "target"))
        (arrow([110.0, 37.0], [198.0, 72.0], "", "main")) (arrow([110.0, 127.0], [198.0, 92.0], "", "main")) (arrow([280.0, 82.0], [338.0, 82.0], "", "main"))
        path.helper d="M375 99 V160 H65 V146" fill="none" {}
    };
    figure(440, 170, "What is drawn and what is there, component by component, without factors", &body)
}

/// What goes in and what comes out.
fn flow(spec: &Spec) -> Markup {
    let rows = spec.inputs.len().max(spec.outputs.len());
    let height = 20 + 30 * u32::try_from(rows).unwrap_or(1);
    let middle = f64::from(height) / 2.0;
    let y = |k: usize, of: usize| {
        #[expect(clippy::cast_precision_loss, reason = "a few boxes")]
        let (k, of) = (k as f64, of as f64);
        middle + 30.0 * (k - (of - 1.0) / 2.0)
    };
    let body = html! {
        @for (k, input) in spec.inputs.iter().enumerate() {
            text x="120" y=(fixed(y(k, spec.inputs.len()) + 4.0)) text-anchor="end" { (input.name) }
            (arrow([126.0, y(k, spec.inputs.len())], [172.0, middle + (y(k, spec.inputs.len()) - middle) * 0.3], "", "main"))
        }
        rect.outline x="172" y=(fixed(middle - 22.0)) width="120" height="44" rx="6" {}
        text x="232" y=(fixed(middle + 4.0)) text-anchor="middle" { (spec.id.split_once('/').map_or("", |(_, name)| name).chars().take(19).collect::<String>()) }
        @for (k, output) in spec.outputs.iter().enumerate() {
            (arrow([292.0, middle], [338.0, y(k, spec.outputs.len())], "", "main"))
            text x="346" y=(fixed(y(k, spec.outputs.len()) + 4.0)) { (output.name) }
        }
    };
    figure(420, height, "What goes in, and what comes out", &body)
}
