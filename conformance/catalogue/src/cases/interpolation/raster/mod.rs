//! Cases that only a rasteriser can answer: drawn, and looked at in one pixel. They belong to the interpolation family.
//! Formulas: `lightmeter_reference::interpolation`; what a rasteriser may give: `rasteriser`.

mod layout;

use super::{ATTR, ATTRIBUTE, attr, half_pixels, window};
use crate::cases::Visitor;
use crate::cases::formula::{Formula, bind, formula};
use crate::cases::rasteriser::target;
use crate::cases::rows::{Reader, Writer};
use crate::cases::spec::{Domain, Input, Kind, Output, Spec, ValueShape};
pub(in crate::cases) use layout::triangle_around_the_pixel;
use layout::{line_through_the_pixel, quad_around_the_pixel, quad_on_the_grid, triangle_across_the_volume};
use lightmeter_reference::interpolation;
use lightmeter_reference::{Real, Vec2, Vec4, Vector};
use lightmeter_scene::raster::{Provoking, Raster, Topology};

/// The middle of a pixel.
fn center<R: Real>(pixel: Vec2<R>) -> Vec2<R> {
    pixel.map(|corner| corner + R::literal(0.5))
}

const fn around(name: &'static str) -> Input {
    Input::new(name, ValueShape::Vec4, "clip", Domain::Around)
}

const PIXEL: Input = Input::new("pixel", ValueShape::Vec2, "pixel", Domain::Pixel);
const COVERED: Output = Output::new("covered", ValueShape::Scalar, "1");
const BOTH: [Output; 2] =
    [Output::new("perspective", ValueShape::Scalar, "1"), Output::new("linear", ValueShape::Scalar, "1")];

/// A triangle around a pixel, with an attribute at each vertex.
pub(in crate::cases) const TRIANGLE: &[Input] =
    &[around("a"), around("b"), around("c"), Input::new("attr", ValueShape::Vec3, "1", ATTRIBUTE), PIXEL];

macro_rules! raster_triangle {
    ($name:ident, $id:literal, $kind:expr, $fit:expr, $text:literal, [$($output:expr),*], |$($input:ident),*; $out:ident| $body:block) => {
        formula!(
            /// A triangle by the rasteriser.
            $name: $id by "", $text, "000 §6.1",
            [
                around("a"), around("b"), around("c"), Input::new("attr", ValueShape::Vec3, "1", ATTRIBUTE), PIXEL,
            ] -> [$($output),*],
            fit $fit,
            kind Kind::Raster($kind),
            |$($input),*; $out| $body,
        );
    };
}

raster_triangle!(
    RasterAttributes,
    "interpolation/raster-attributes",
    Raster::TriangleAttributes,
    triangle_around_the_pixel,
    "the attribute of a drawn triangle at a pixel: Σ λa/w / Σ λ/w, and Σ λa",
    [BOTH[0], BOTH[1]],
    |a, b, c, attr, pixel; out| {
        let fragment = interpolation::fragment([a, b, c], attr, &target(), center(pixel));
        out.scalar(fragment.perspective);
        out.scalar(fragment.linear);
    }
);
raster_triangle!(
    RasterPosition,
    "interpolation/raster-position",
    Raster::TrianglePosition,
    triangle_around_the_pixel,
    "gl_FragCoord of a drawn triangle: the pixel's centre from the upper left, window z, 1/w",
    [Output::new("position", ValueShape::Vec4, "pixel")],
    |a, b, c, attr, pixel; out| {
        let p = center(pixel);
        let fragment = interpolation::fragment([a, b, c], attr, &target(), p);
        out.vector(Vector([p.x(), p.y(), fragment.depth, fragment.inverse_w]));
    }
);
raster_triangle!(
    RasterFacing,
    "interpolation/raster-facing",
    Raster::Facing,
    triangle_around_the_pixel,
    "gl_FrontFacing of a drawn triangle: 1 where it is counter-clockwise as seen",
    [Output::new("front", ValueShape::Scalar, "1")],
    |a, b, c; out| {
        out.scalar(facing([a, b, c]));
    }
);
raster_triangle!(
    RasterClip,
    "interpolation/raster-clip",
    Raster::Clipped,
    triangle_across_the_volume,
    "1 where a triangle that reaches out of the clip volume still covers the pixel",
    [COVERED],
    |a, b, c, pixel; out| {
        out.scalar(interpolation::clipped_coverage([a, b, c], &target(), center(pixel)));
    }
);

/// Whether a triangle faces front: the pixel, which lies inside, is not looked at.
fn facing<R: Real>(clip: [Vec4<R>; 3]) -> R {
    interpolation::front_facing(clip.map(|v| {
        let window = interpolation::viewport(v, &target());
        Vector([window.x(), window.y()])
    }))
}

macro_rules! raster_culled {
    ($name:ident, $id:literal, $back:literal, $ccw:literal, $text:literal) => {
        raster_triangle!(
            $name,
            $id,
            Raster::Culled { back: $back, front_is_ccw: $ccw },
            triangle_around_the_pixel,
            $text,
            [COVERED],
            |a, b, c; out| {
                let (shown, front) = ($back == $ccw, facing([a, b, c]));
                out.scalar(if shown { front } else { R::literal(1.0) - front });
            }
        );
    };
}

raster_culled!(
    CullBackCcw,
    "interpolation/cull-back-ccw",
    true,
    true,
    "1 where a triangle survives: back faces culled, counter-clockwise is front"
);
raster_culled!(
    CullBackCw,
    "interpolation/cull-back-cw",
    true,
    false,
    "1 where a triangle survives: back faces culled, clockwise is front"
);
raster_culled!(
    CullFrontCcw,
    "interpolation/cull-front-ccw",
    false,
    true,
    "1 where a triangle survives: front faces culled, counter-clockwise is front"
);
raster_culled!(
    CullFrontCw,
    "interpolation/cull-front-cw",
    false,
    false,
    "1 where a triangle survives: front faces culled, clockwise is front"
);

formula!(
    /// A line by the rasteriser.
    RasterLine: "interpolation/raster-line" by "",
    "the attribute of a drawn line at a pixel that it passes through: perspective-correct, and linear", "000 §6.1",
    [around("a"), around("b"), attr("attr_a"), attr("attr_b"), PIXEL] -> [BOTH[0], BOTH[1]],
    fit line_through_the_pixel,
    kind Kind::Raster(Raster::LineAttributes),
    |a, b, attr_a, attr_b, pixel; out| {
        let (clip, attr) = ([a, b], [attr_a, attr_b]);
        let [perspective, linear] = interpolation::fragment_of_line(clip, attr, &target(), center(pixel));
        out.scalar(perspective);
        out.scalar(linear);
    },
);
const COUNT: Output = Output::new("count", ValueShape::Scalar, "1");

macro_rules! raster_quad {
    ($name:ident, $id:literal, $fit:expr, $text:literal, [$($input:expr),*]) => {
        formula!(
            /// Two triangles that share an edge.
            $name: $id by "", $text, "000 §6.1",
            [$($input),*, PIXEL] -> [COUNT],
            fit $fit,
            kind Kind::Raster(Raster::Quad),
            |a, b, c, d, pixel; out| {
                let p = center(pixel);
                out.scalar(interpolation::coverage([a, b, c], p) + interpolation::coverage([a, c, d], p));
            },
        );
    };
}

raster_quad!(
    RasterTopLeft,
    "interpolation/raster-top-left",
    quad_on_the_grid,
    "how many of two triangles with vertices on the half-pixel grid cover the pixel, ties by the top-left rule",
    [half_pixels("a"), half_pixels("b"), half_pixels("c"), half_pixels("d")]
);
raster_quad!(
    RasterSharedEdge,
    "interpolation/raster-shared-edge",
    quad_around_the_pixel,
    "how many of two triangles that share an edge cover a pixel near that edge: one, wherever it lies",
    [window("a"), window("b"), window("c"), window("d")]
);
formula!(
    /// A fragment's own depth, stored.
    RasterDepth: "interpolation/raster-frag-depth" by "",
    "the depth that a fragment wrote, read back from the depth buffer: clamp(depth, 0, 1)", "000 §6.1",
    [Input::scalar("depth", "1", Domain::Uniform(-0.5, 1.5)), PIXEL] -> [Output::new("depth", ValueShape::Scalar, "1")],
    kind Kind::Raster(Raster::OwnDepth),
    |depth; out| { out.scalar(interpolation::frag_depth(depth)); },
);

/// A flat attribute of a drawn list or strip.
#[derive(Clone, Copy, Debug)]
struct RasterFlat {
    topology: Topology,
    provoking: Provoking,
}

impl RasterFlat {
    /// Primitives that six vertices make.
    const fn primitives(self) -> u32 {
        match self.topology {
            Topology::Points => 6,
            Topology::LineList => 3,
            Topology::LineStrip => 5,
            Topology::TriangleList => 2,
            Topology::TriangleStrip => 4,
        }
    }
}

macro_rules! flat_inputs {
    ($last:literal) => {
        const {
            &[
                attr("a0"),
                attr("a1"),
                attr("a2"),
                attr("a3"),
                attr("a4"),
                attr("a5"),
                Input::scalar("primitive", "1", Domain::Whole(0, $last)),
                PIXEL,
            ]
        }
    };
}

impl Formula for RasterFlat {
    fn spec(&self) -> Spec {
        let inputs: &'static [Input] = match self.topology {
            Topology::Points => flat_inputs!(5),
            Topology::LineList => flat_inputs!(2),
            Topology::LineStrip => flat_inputs!(4),
            Topology::TriangleList => flat_inputs!(1),
            Topology::TriangleStrip => flat_inputs!(3),
        };
        Spec {
            id: format!("interpolation/raster-flat-{}-{}", self.topology.name(), self.provoking.name()),
            text: "the flat attribute of one primitive of a drawn list or strip: that of its provoking vertex",
            source: "000 §6.1; ruling 7",
            function: "",
            kind: Kind::Raster(Raster::Flat { topology: self.topology, provoking: self.provoking }),
            selectors: vec![],
            inputs,
            outputs: &[ATTR],
            fit: None,
            within: None,
            hard: &[],
            stable: None,
            is_normalised: false,
        }
    }

    fn evaluate<R: Real>(&self, x: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        // The inputs of one topology stand for all: they differ in the primitives that are drawn.
        bind!(x, flat_inputs!(5) => a0, a1, a2, a3, a4, a5, primitive);
        let attr = [a0, a1, a2, a3, a4, a5];
        let step = match self.topology {
            Topology::LineList => 2,
            Topology::TriangleList => 3,
            _ => 1,
        };
        let of = |m: u32| -> R {
            let first = (m * step) as usize;
            match self.topology.corners() {
                1 => attr[first],
                2 => interpolation::flat([attr[first], attr[first + 1]], self.provoking),
                _ => interpolation::flat([attr[first], attr[first + 1], attr[first + 2]], self.provoking),
            }
        };
        let chosen = (1..self.primitives())
            .fold(of(0), |value, m| R::if_ge(primitive, R::literal(f64::from(m)), || of(m), || value));
        out.scalar(chosen);
    }
}

pub(super) fn visit(visitor: &mut impl Visitor) {
    visitor.formula(RasterAttributes);
    visitor.formula(RasterPosition);
    visitor.formula(RasterLine);
    visitor.formula(RasterFacing);
    visitor.formula(RasterClip);
    visitor.formula(CullBackCcw);
    visitor.formula(CullBackCw);
    visitor.formula(CullFrontCcw);
    visitor.formula(CullFrontCw);
    visitor.formula(RasterTopLeft);
    visitor.formula(RasterSharedEdge);
    visitor.formula(RasterDepth);
    for topology in Topology::ALL {
        for provoking in Provoking::ALL {
            visitor.formula(RasterFlat { topology, provoking });
        }
    }
}
