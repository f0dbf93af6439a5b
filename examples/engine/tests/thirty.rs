//! Thirty formulas, five of which are wrong as engines are: each test that fails names the bug. `cargo test --test thirty`.

use lightmeter::harness::{Formulas, Suite};
use std::process::ExitCode;
use tiny_engine::{self as engine, Vec3};

fn zip(a: Vec3, b: Vec3, f: impl Fn(f32, f32) -> f32) -> Vec3 {
    [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])]
}

fn add(a: Vec3, b: Vec3) -> Vec3 {
    zip(a, b, |a, b| a + b)
}

fn subtract(a: Vec3, b: Vec3) -> Vec3 {
    zip(a, b, |a, b| a - b)
}

fn times(a: Vec3, b: Vec3) -> Vec3 {
    zip(a, b, |a, b| a * b)
}

fn scale(a: Vec3, by: f32) -> Vec3 {
    a.map(|x| x * by)
}

fn dot(a: Vec3, b: Vec3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn lobe(cosine: f32, shininess: f32) -> f32 {
    if cosine > 0.0 || shininess == 0.0 { cosine.max(0.0).powf(shininess) } else { 0.0 }
}

fn rgba([r, g, b]: Vec3) -> [f32; 4] {
    [r, g, b, 1.0]
}

fn vectors(formulas: Formulas) -> Formulas {
    formulas
        .with("vector/reflect", |x| engine::reflect(x.vec3("i"), x.vec3("n")))
        // Bug: the normal's share is taken once, not twice.
        .with("vector/reflect-toward", |x| {
            let (l, n) = (x.vec3("l"), x.vec3("n"));
            subtract(scale(n, dot(l, n)), l)
        })
        .with("vector/halfway", |x| engine::normalize(add(x.vec3("v"), x.vec3("l"))))
        .with("vector/halfway-unnormalised", |x| add(x.vec3("v"), x.vec3("l")))
        .with("vector/normalize", |x| engine::normalize(x.vec3("v")))
        .with("vector/toward", |x| engine::toward(x.vec3("light"), x.vec3("p")))
        .with("vector/average-normal", |x| engine::normalize(add(add(x.vec3("n0"), x.vec3("n1")), x.vec3("n2"))))
        .with("vector/face-normal", |x| {
            let a = x.vec3("a");
            engine::normalize(cross(subtract(x.vec3("b"), a), subtract(x.vec3("c"), a)))
        })
        .with("vector/length", |x| dot(x.vec3("v"), x.vec3("v")).sqrt())
        .with("vector/normal-modelview", |x| {
            let ([a, b, c], n) = (x.mat3("modelview"), x.vec3("n"));
            add(add(scale(a, n[0]), scale(b, n[1])), scale(c, n[2]))
        })
}

fn colors(formulas: Formulas) -> Formulas {
    formulas
        .with("color/modulate", |x| {
            let (texel, color) = (x.vec4("texel"), x.vec4("color"));
            [0, 1, 2, 3].map(|k| texel[k] * color[k])
        })
        .with("color/replace", |x| x.vec4("texel"))
        .with("color/sum", |x| add(x.vec3("a"), x.vec3("b")).map(|c| c.clamp(0.0, 1.0)))
        .with("color/uniform", |x| rgba(x.vec3("color")))
        .with("color/per-vertex", |x| {
            let [a, b, c] = x.vec3("weights");
            rgba(add(add(scale(x.vec3("a"), a), scale(x.vec3("b"), b)), scale(x.vec3("c"), c)))
        })
        .with("color/from-unorm8", |x| x.float("byte") / 255.0)
        .with("color/gamma-encode", |x| x.float("c").powf(1.0 / 2.2))
}

fn air(formulas: Formulas) -> Formulas {
    formulas
        .with("fog/exp", |x| {
            let f = engine::fog_exp(x.float("density"), x.vec3("p")[2]);
            (f, engine::mix(x.vec3("fog"), x.vec3("shaded"), f))
        })
        // Bug: the density is not squared with the distance.
        .with("fog/exp2-opengl", |x| {
            let z = x.vec3("p")[2];
            let f = (-x.float("density") * z * z).exp().clamp(0.0, 1.0);
            (f, engine::mix(x.vec3("fog"), x.vec3("shaded"), f))
        })
        .with("attenuation/constant", |_| 1.0)
        .with("attenuation/linear", |x| 1.0 / x.float("d"))
        .with("attenuation/square", |x| engine::attenuation(0.0, 0.0, 1.0, x.float("d")))
        .with("attenuation/polynomial", |x| {
            engine::attenuation(x.float("kc"), x.float("kl"), x.float("kq"), x.float("d"))
        })
        // Bug: the coefficient of the squared distance is multiplied by the distance alone.
        .with("attenuation/point", |x| {
            let d = engine::distance(x.vec3("light"), x.vec3("p"));
            1.0 / (x.float("kc") + x.float("kl") * d + x.float("kq") * d)
        })
}

fn lighting(formulas: Formulas) -> Formulas {
    formulas
        .with("lighting/ambient", |x| times(x.vec3("la"), x.vec3("ma")))
        .with("lighting/diffuse-toward", |x| {
            scale(times(x.vec3("ld"), x.vec3("md")), dot(x.vec3("l"), x.vec3("n")).max(0.0))
        })
        // Bug: the way the light travels is taken for the way to the light.
        .with("lighting/diffuse-travel", |x| {
            scale(times(x.vec3("ld"), x.vec3("md")), dot(x.vec3("i"), x.vec3("n")).max(0.0))
        })
        .with("lighting/specular-phong", |x| {
            scale(times(x.vec3("ls"), x.vec3("ms")), lobe(dot(x.vec3("r"), x.vec3("v")), x.float("shininess")))
        })
        .with("lighting/sum", |x| {
            let terms = ["ambient", "diffuse0", "diffuse1", "specular0", "specular1"];
            terms.into_iter().fold(x.vec3("emissive"), |sum, term| add(sum, x.vec3(term)))
        })
        // Bug, of the engine: see its source.
        .with("lighting/blinn", |x| {
            let colors = |[ambient, diffuse, specular]: [&str; 3]| engine::Colors {
                ambient: x.vec3(ambient),
                diffuse: x.vec3(diffuse),
                specular: x.vec3(specular),
            };
            let (light, surface) = (colors(["la", "ld", "ls"]), colors(["ma", "md", "ms"]));
            let shininess = x.float("shininess");
            engine::blinn(light, surface, shininess, x.vec3("p"), x.vec3("normal"), x.vec3("direction"))
        })
}

fn main() -> ExitCode {
    let formulas = Formulas::new("thirty", env!("CARGO_PKG_VERSION"));
    Suite::new(lighting(air(colors(vectors(formulas))))).main()
}
