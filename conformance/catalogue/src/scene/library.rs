//! The scenes that are built in: those of the documents, and the files that they name.

use std::io;

macro_rules! scenes {
    ($($name:literal)*) => {
        [$(($name, include_str!(concat!("../../scenes/", $name, ".json")))),*]
    };
}

const COUNT: usize = 48;

/// Each built-in scene's name and JSON.
pub const SCENES: [(&str, &str); COUNT] = scenes! {
    "attached-lights"
    "averaged-normals"
    "color-cube"
    "combined-ambient"
    "combined-exp"
    "combined-exp2-document"
    "combined-exp2-opengl"
    "combined-linear"
    "crossing"
    "dark-light"
    "depth-on-off"
    "eight-lights"
    "eight-points"
    "eight-spots"
    "fixed-color"
    "flat"
    "fog-exp"
    "fog-exp2-document"
    "fog-exp2-opengl"
    "fog-linear"
    "fog-radial"
    "gouraud"
    "light-ambient"
    "light-ambient-opengl"
    "lightmap"
    "lights-together"
    "many-points"
    "many-spots"
    "many-suns"
    "many-units"
    "missed-highlight"
    "near-clip"
    "obj"
    "phong"
    "phong-blinn"
    "plastic-metal"
    "reversed-depth"
    "scaled-normals"
    "shininess"
    "sorted"
    "spotlight"
    "teapot"
    "texture-edges"
    "thresholds"
    "transformed"
    "translucent-square"
    "unit-light"
    "viewer"
};

/// The files that they name.
const ASSETS: [(&str, &[u8]); 3] = [
    ("bricks.png", include_bytes!("../../scenes/bricks.png")),
    ("house.mtl", include_bytes!("../../scenes/house.mtl")),
    ("house.obj", include_bytes!("../../scenes/house.obj")),
];

/// The bytes of a file that a built-in scene names.
///
/// # Errors
///
/// Where there is none.
pub fn asset(name: &str) -> io::Result<Vec<u8>> {
    let found = ASSETS.iter().find(|(own, _)| *own == name);
    found.map(|(_, bytes)| bytes.to_vec()).ok_or_else(|| io::ErrorKind::NotFound.into())
}

#[cfg(test)]
mod tests {
    use crate::scene::select::builtin;
    use lightmeter_scene::effects::{EXCLUSIVE, Effect, Effects, effects};
    use lightmeter_scene::target::TargetFormat;

    /// What a draw still calls for whose colour a texture replaces.
    const BESIDE_A_REPLACED_COLOR: [Effect; 10] = [
        Effect::TextureNearest,
        Effect::TextureBilinear,
        Effect::LightmapNearest,
        Effect::LightmapBilinear,
        Effect::Cutout,
        Effect::FogLinear,
        Effect::FogExp,
        Effect::FogExp2Document,
        Effect::FogExp2OpenGl,
        Effect::FogRadial,
    ];

    fn can_meet(a: Effect, b: Effect) -> bool {
        let is_replaced = [(a, b), (b, a)]
            .into_iter()
            .any(|(one, other)| one == Effect::TextureReplace && !BESIDE_A_REPLACED_COLOR.contains(&other));
        !is_replaced && !EXCLUSIVE.iter().any(|set| set.contains(&a) && set.contains(&b))
    }

    #[test]
    #[cfg_attr(not(feature = "scenes"), ignore = "scenes read files of images and meshes")]
    fn every_two_effects_that_can_meet_do_so_in_a_draw_and_each_is_drawn_on_floats() {
        let mut draws: Vec<Effects> = vec![];
        let mut on_floats = Effects::NONE;
        for place in 0..super::COUNT {
            let frame = builtin(place, None).expect("it is right").frame;
            let called: Vec<Effects> = effects(&frame).iter().map(|draw| draw.effects).collect();
            if frame.target.format == TargetFormat::Rgba32Float {
                on_floats = called.iter().flat_map(|effects| effects.iter()).fold(on_floats, Effects::with);
            }
            draws.extend(called);
        }
        let mut apart = vec![];
        for (k, a) in Effect::ALL.into_iter().enumerate() {
            for b in Effect::ALL.into_iter().skip(k + 1) {
                let meets = draws.iter().any(|effects| effects.has(a) && effects.has(b));
                assert!(!meets || can_meet(a, b), "{} and {} meet", a.name(), b.name());
                if can_meet(a, b) && !meets {
                    apart.push(format!("{} and {}", a.name(), b.name()));
                }
            }
        }
        assert!(apart.is_empty(), "in no draw: {}", apart.join(", "));
        let missing: Vec<&str> = Effect::ALL.iter().filter(|&&e| !on_floats.has(e)).map(|e| e.name()).collect();
        assert!(missing.is_empty(), "on no target of floats: {}", missing.join(", "));
    }
}
