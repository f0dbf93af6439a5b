//! What a composed shader holds, for every section of the effects' subsets.

use super::*;

#[test]
fn dump() {
    let shaders = Shaders::built_in().unwrap_or_else(|e| panic!("{e}"));
    let composer = Composer::new(&shaders).unwrap();
    use Effect as E;
    let s: Effects = [
        E::Phong,
        E::InverseTranspose,
        E::Emissive,
        E::LightAmbient,
        E::Diffuse,
        E::SpecularBlinn,
        E::Gate,
        E::Spot,
        E::Point,
        E::Attenuation,
        E::TextureBilinear,
        E::Cutout,
        E::FogExp,
    ]
    .into_iter()
    .collect();
    for c in [composer.compose(s, Shader::Composed, None).unwrap(), composer.compose(s, Shader::Full, None).unwrap()] {
        eprintln!("{}\n=================", c.source);
        if let Err(e) = c.validate() {
            panic!("{e}");
        }
    }
}
