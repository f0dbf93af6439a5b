// Fragments below a threshold of alpha left out.

struct SceneCutout {
    threshold: f32,
}

@group(0) @binding(13) var<uniform> scene_cutout: SceneCutout;

//@ at cutout
if color.a < scene_cutout.threshold {
    discard;
}
