//! Splitting triangles changes nothing beyond the bound: what is linear over a triangle is linear over its parts.
//!
//! Vertices are normalised and lit before they are interpolated, so a new vertex holds what the triangle has there only
//! where normals are the same all over a mesh and nothing is lit at the vertices: random frames are made so.

use super::{cases, illegal};
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::image::expect;
use lightmeter_reference::render::{Image, render};
use lightmeter_scene::frame::{Frame, Mesh};
use lightmeter_scene::shading::Frequency;
use lightmeter_tests::frames::{Numbers, frame};
use proptest::prelude::*;

/// The frame lit at the fragments, with one normal a mesh.
fn smooth(frame: &mut Frame) {
    for draw in &mut frame.draws {
        if let Some(shading) = &mut draw.shading {
            shading.frequency = Frequency::Phong;
        }
    }
    for mesh in &mut frame.meshes {
        mesh.normals.fill([0.25, -0.5, 1.0]);
    }
}

/// A new vertex, the average of others.
fn average(mesh: &mut Mesh, of: &[u32]) -> u32 {
    fn row<const N: usize>(rows: &mut Vec<[f32; N]>, of: &[u32]) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "the nearest f32 of a few")]
        let mean =
            |k: usize| (of.iter().map(|&v| f64::from(rows[v as usize][k])).sum::<f64>() / of.len() as f64) as f32;
        let made = std::array::from_fn(mean);
        rows.push(made);
    }
    row(&mut mesh.positions, of);
    row(&mut mesh.normals, of);
    row(&mut mesh.uvs, of);
    row(&mut mesh.lightmap_uvs, of);
    row(&mut mesh.colors, of);
    u32::try_from(mesh.positions.len() - 1).expect("a small mesh")
}

/// Each triangle, or so, into three at its centroid.
fn at_centroids(mesh: &mut Mesh, n: &mut Numbers) {
    for [a, b, c] in std::mem::take(&mut mesh.triangles) {
        if n.once_in(4) {
            mesh.triangles.push([a, b, c]);
        } else {
            let m = average(mesh, &[a, b, c]);
            mesh.triangles.extend([[a, b, m], [b, c, m], [c, a, m]]);
        }
    }
}

/// An edge at its middle: the triangles on both sides of it become two each.
fn at_an_edge(mesh: &mut Mesh, n: &mut Numbers) {
    let [from, to, _] = mesh.triangles[n.below(mesh.triangles.len())];
    let m = average(mesh, &[from, to]);
    for [a, b, c] in std::mem::take(&mut mesh.triangles) {
        // Turned so that the edge is its first.
        let turned = [[a, b, c], [b, c, a], [c, a, b]];
        match turned.into_iter().find(|[a, b, _]| [*a, *b] == [from, to] || [*a, *b] == [to, from]) {
            Some([a, b, c]) => mesh.triangles.extend([[a, m, c], [m, b, c]]),
            None => mesh.triangles.push([a, b, c]),
        }
    }
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn splitting_changes_nothing_beyond_the_bound(seed: u64, middle: bool) {
        let n = &mut Numbers::new(seed);
        let mut whole = frame(seed);
        smooth(&mut whole);
        let mut split = whole.clone();
        split.meshes.iter_mut().for_each(|mesh| if middle { at_an_edge(mesh, n) } else { at_centroids(mesh, n) });
        let image = |frame: &Frame| -> Image { render::<f64>(frame, None, None) };
        let told = illegal(&whole, None, &expect(&whole, None, None, &WGSL), &image(&split)).next();
        prop_assert_eq!(told, None, "split within the whole");
        let told = illegal(&split, None, &expect(&split, None, None, &WGSL), &image(&whole)).next();
        prop_assert_eq!(told, None, "whole within the split");
    }
}
