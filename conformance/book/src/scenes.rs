//! The gallery of scenes: each drawn by the reference, with what it shows.

use crate::contents::Place;
use lightmeter_catalogue::scene::load::Loaded;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_reference::render::render;
use lightmeter_scene::effects::{Effects, effects};
use maud::{Markup, html};

/// The picture of a scene, by the reference.
pub(crate) fn drawn(scene: &Loaded) -> StoredImage {
    StoredImage::of(&render::<f64>(&scene.frame, None, None), scene.frame.target.format)
}

/// The file of a scene's picture.
pub(crate) fn picture(scene: &Loaded) -> String {
    format!("pictures/scene-{}.png", scene.name)
}

/// The gallery.
pub(crate) fn gallery(scenes: &[Loaded], place: &Place<'_>) -> Markup {
    html! {
        h1 { "Gallery of scenes" }
        p {
            "Each scene calls for some effects, and only those are computed. The pictures are the reference’s; " code { "lightmeter run 'scene/*'" }
            " holds a renderer to them pixel by pixel. " a href=(place.to("appendix/scenes.html")) { "What runs found" } " stands in an appendix."
        }
        div.gallery {
            @for scene in scenes {
                figure id=(scene.name) {
                    a href=(place.to(&picture(scene))) { img src=(place.to(&picture(scene))) alt=(scene.title) width=(scene.frame.target.width) loading="lazy"; }
                    figcaption {
                        b { (scene.title) } " " code { "scene/" (scene.name) } p { (scene.shows.trim()) }
                        details { summary { "effects and commands" }
                            p { (effects(&scene.frame).iter().flat_map(|called| called.effects.iter()).fold(Effects::NONE, Effects::with)) }
                            pre tabindex="0" { code { "lightmeter run scene/" (scene.name) "\nlightmeter render " (scene.name) " --out " (scene.name) ".png\nlightmeter show scene/" (scene.name) " --wgsl" } }
                        }
                    }
                }
            }
        }
    }
}
