//! One test for each formula that the engine has: `cargo test --test conformance`.

use lightmeter::harness::{Formulas, Suite};
use std::process::ExitCode;
use tiny_engine as engine;

fn main() -> ExitCode {
    let formulas = Formulas::new("tiny-engine", env!("CARGO_PKG_VERSION"))
        .with("vector/reflect", |x| engine::reflect(x.vec3("i"), x.vec3("n")))
        .with("vector/toward", |x| engine::toward(x.vec3("light"), x.vec3("p")))
        .with("attenuation/point", |x| {
            let d = engine::distance(x.vec3("light"), x.vec3("p"));
            engine::attenuation(x.float("kc"), x.float("kl"), x.float("kq"), d)
        })
        .with("fog/exp", |x| {
            let f = engine::fog_exp(x.float("density"), x.vec3("p")[2]);
            (f, engine::mix(x.vec3("fog"), x.vec3("shaded"), f))
        })
        .with("lighting/blinn", |x| {
            let colors = |[ambient, diffuse, specular]: [&str; 3]| engine::Colors {
                ambient: x.vec3(ambient),
                diffuse: x.vec3(diffuse),
                specular: x.vec3(specular),
            };
            let (light, surface) = (colors(["la", "ld", "ls"]), colors(["ma", "md", "ms"]));
            let shininess = x.float("shininess");
            engine::blinn(light, surface, shininess, x.vec3("p"), x.vec3("normal"), x.vec3("direction"))
        });
    // A renderer that has known failures, and an earlier result, adds
    //     .expectations("known-failures.toml").baseline("baseline.json")
    Suite::new(formulas).main()
}
