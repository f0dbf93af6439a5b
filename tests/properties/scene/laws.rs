//! Laws of a frame as a whole: order, light, mirrors, depth conventions, and how the legal values narrow.

use super::{cases, difference, illegal};
use lightmeter::arithmetic::Profile;
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::image::expect;
use lightmeter_reference::render::{Image, render};
use lightmeter_scene::depth::{Compare, DepthTest};
use lightmeter_scene::frame::{Cull, Frame, Light};
use lightmeter_scene::stage::Intermediate;
use lightmeter_scene::target::TargetFormat;
use lightmeter_tests::frames::{Numbers, frame};
use proptest::prelude::*;

fn image(frame: &Frame) -> Image {
    render::<f64>(frame, None, None)
}

/// Nothing blended, nothing cut out, the nearest seen.
pub(super) fn opaque(frame: &mut Frame) {
    let compare = if frame.clear_depth < 0.5 { Compare::Greater } else { Compare::Less };
    for draw in &mut frame.draws {
        (draw.blend, draw.cutout, draw.depth) = (None, None, Some(DepthTest { compare, write: true }));
    }
}

fn shuffle<T>(items: &mut [T], n: &mut Numbers) {
    for last in (1..items.len()).rev() {
        items.swap(last, n.below(last + 1));
    }
}

/// The pixels whose nearest depth two draws have.
fn ties(frame: &Frame) -> Vec<bool> {
    let alone = |number: usize| {
        let frame = Frame { draws: vec![frame.draws[number].clone()], ..frame.clone() };
        render::<f64>(&frame, None, Some(Intermediate::Depth)).pixels
    };
    let depths: Vec<_> = (0..frame.draws.len()).map(alone).collect();
    let away = if frame.clear_depth < 0.5 { -1.0 } else { 1.0 };
    let tied = |pixel: usize| {
        // How far away each draw is there, that has a fragment.
        let drawn = depths.iter().filter(|depths| depths[pixel][3] > 0.0);
        let far: Vec<f64> = drawn.map(|depths| away * depths[pixel][0]).collect();
        let nearest = far.iter().copied().fold(f64::INFINITY, f64::min);
        far.iter().filter(|&&far| far == nearest).count() > 1
    };
    (0..depths[0].len()).map(tied).collect()
}

/// The frame with one of its draws again, in another colour: equal depths wherever that is seen.
fn twice(frame: &mut Frame, n: &mut Numbers) -> usize {
    let of = n.below(frame.draws.len());
    let mut again = frame.draws[of].clone();
    again.material.diffuse = again.material.diffuse.map(|c| 1.0 - 0.5 * c);
    again.material.emissive = [0.5, 0.25, 0.125];
    frame.draws.push(again);
    of
}

proptest! {
    #![proptest_config(cases(200))]

    /// The order of opaque draws, and of the triangles in them, changes nothing where no two have the same depth.
    #[test]
    fn order_of_what_is_opaque_does_not_matter(seed: u64) {
        let n = &mut Numbers::new(seed);
        let mut given = frame(seed);
        opaque(&mut given);
        if n.once_in(4) {
            twice(&mut given, n);
        }
        let mut other = given.clone();
        shuffle(&mut other.draws, n);
        other.meshes.iter_mut().for_each(|mesh| shuffle(&mut mesh.triangles, n));
        let (ties, one, other) = (ties(&given), image(&given), image(&other));
        let bits = |image: &Image, pixel: usize| image.pixels[pixel].map(f64::to_bits);
        let differs = |&pixel: &usize| !ties[pixel] && bits(&one, pixel) != bits(&other, pixel);
        prop_assert_eq!((0..ties.len()).find(differs), None);
    }

    /// Of equal depths the first drawn stays with `less`, the last with `less or equal`.
    #[test]
    fn equal_depths_are_decided_by_order(seed: u64) {
        let mut given = frame(seed);
        opaque(&mut given);
        let drawn = twice(&mut given, &mut Numbers::new(seed));
        given.draws = vec![given.draws[drawn].clone(), given.draws[given.draws.len() - 1].clone()];
        let alone = |number: usize| image(&Frame { draws: vec![given.draws[number].clone()], ..given.clone() });
        prop_assert_eq!(difference(&image(&given), &alone(0)), None);
        let last = alone(1);
        let or_equal = if given.clear_depth < 0.5 { Compare::GreaterEqual } else { Compare::LessEqual };
        given.draws.iter_mut().for_each(|draw| draw.depth = Some(DepthTest { compare: or_equal, write: true }));
        prop_assert_eq!(difference(&image(&given), &last), None);
    }

    /// `I(A ∪ B) + I(∅) = I(A) + I(B)`: fog, textures and vertex colours are affine in the light.
    #[test]
    fn light_adds(seed: u64) {
        let n = &mut Numbers::new(seed);
        let mut given = frame(seed);
        opaque(&mut given);
        given.target.format = TargetFormat::Rgba32Float;
        let (a, b): (Vec<Light>, Vec<Light>) = given.lights.clone().into_iter().partition(|_| n.once_in(2));
        let of = |lights: Vec<Light>| image(&Frame { lights, ..given.clone() }).pixels;
        let (all, none, a, b) = (of(given.lights.clone()), of(vec![]), of(a), of(b));
        for pixel in 0..all.len() {
            for k in 0..4 {
                let [all, none, a, b] = [&all, &none, &a, &b].map(|image| image[pixel][k]);
                // Each image is of at most 4 lights' terms, products of what is not negative, then of a few operations
                // for textures and fog, each of which rounds by ε/2; the fog's colour is at most 1.
                let rounding = 16.0 * f64::EPSILON * (all + none + a + b + 1.0);
                prop_assert!((all + none - a - b).abs() <= rounding, "{pixel} {k}: {all} + {none}, {a} + {b}");
            }
        }
    }

    /// Depth the other way round, projection and compare function swapped, shows the same.
    #[test]
    fn reversed_depth_shows_the_same(seed: u64) {
        let mut given = frame(seed);
        opaque(&mut given);
        let mut other = given.clone();
        other.clear_depth = 1.0 - given.clear_depth;
        // z′ = w − z
        other.projection.iter_mut().for_each(|column| column[2] = column[3] - column[2]);
        opaque(&mut other);
        let told = illegal(&given, None, &expect(&given, None, None, &WGSL), &image(&other)).next();
        prop_assert_eq!(told, None);
        if !is_clipped(&given) {
            prop_assert_eq!(difference(&image(&given), &image(&other)), None);
        }
    }

    /// Seen in a mirror, front faces are back faces and nothing else is new but the side.
    #[test]
    fn a_mirror_shows_the_mirrored_image(seed: u64, axis in 0..2_usize) {
        let given = frame(seed);
        let mut other = given.clone();
        other.projection.iter_mut().for_each(|column| column[axis] = -column[axis]);
        for draw in &mut other.draws {
            draw.cull = match draw.cull {
                Cull::None => Cull::None,
                Cull::Back => Cull::Front,
                Cull::Front => Cull::Back,
            };
        }
        let mut mirrored = image(&other);
        let width = mirrored.width;
        match axis {
            0 => mirrored.pixels.chunks_mut(width).for_each(<[_]>::reverse),
            _ => mirrored.pixels = mirrored.pixels.chunks(width).rev().flatten().copied().collect(),
        }
        let told = illegal(&given, None, &expect(&given, None, None, &WGSL), &mirrored).next();
        prop_assert_eq!(told, None);
    }

    /// What is legal with 8 subpixel bits is legal with 4, in each intermediate result.
    #[test]
    fn more_subpixel_bits_narrow_what_is_legal(seed: u64, stage in 0..=Intermediate::ALL.len()) {
        let (given, stage) = (frame(seed), Intermediate::ALL.get(stage).copied());
        let of = |subpixel_bits: u32| expect(&given, None, stage, &Profile { subpixel_bits, ..WGSL });
        for (pixel, (fine, coarse)) in of(8).iter().zip(&of(4)).enumerate() {
            for k in 0..4 {
                // Below the least normal number, what rounding may do is not monotonic: it may be flushed to 0 or not.
                let flushed = f64::from(f32::MIN_POSITIVE);
                let within = coarse.low[k] - flushed <= fine.low[k] && fine.high[k] <= coarse.high[k] + flushed;
                prop_assert!(within, "{pixel} {k}: {fine:?} is not in {coarse:?}");
            }
        }
    }
}

/// Whether the near or the far plane may cut a triangle of the frame.
fn is_clipped(frame: &Frame) -> bool {
    let columns = |m: [[f32; 4]; 4]| glam::DMat4::from_cols_array_2d(&m.map(|column| column.map(f64::from)));
    let projection = columns(frame.projection);
    frame.draws.iter().any(|draw| {
        let whole = projection * columns(draw.modelview);
        frame.meshes[draw.mesh].positions.iter().any(|position| {
            let clip = whole * glam::Vec3::from_array(*position).as_dvec3().extend(1.0);
            // The reversed projection is rounded to f32, so its planes lie that far off.
            let off = f64::from(f32::EPSILON) * clip.w.abs().max(1.0);
            clip.z < off || clip.z > clip.w - off
        })
    })
}
