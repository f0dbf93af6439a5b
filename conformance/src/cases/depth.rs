//! Cases of the depth test: every compare function, with and without writing. Formulas: `lightmeter_reference::depth`.

use super::formula::Formula;
use super::rows::{Reader, Writer};
use super::spec::{Domain, Hard, Input, Kind, Output, Shape, Spec};
use super::{Visitor, raster};
use lightmeter_gpu::Raster;
use lightmeter_reference::Real;
use lightmeter_reference::depth::{passes, test};
use lightmeter_scene::depth::{Compare, DepthTest};

/// A fragment over another.
#[derive(Clone, Copy, Debug)]
struct OverAnother(DepthTest);

impl Formula for OverAnother {
    fn spec(&self) -> Spec {
        const BEYOND: Domain = Domain::Uniform(-0.25, 1.25);
        const INPUTS: &[Input] = &[Input::scalar("new", "1", BEYOND), Input::scalar("old", "1", BEYOND)];
        const OUTPUTS: &[Output] = &[Output::new("seen", Shape::Scalar, "1"), Output::new("depth", Shape::Scalar, "1")];
        let DepthTest { compare, write } = self.0;
        Spec {
            id: format!("depth/test/{}", self.0),
            text: "seen = 2 and depth = new (where written) if clamp(new) passes against clamp(old), else 1 and old",
            source: "000 §6.6, 002; ruling 15",
            function: "depth_test",
            kind: Kind::Depth(self.0),
            selectors: vec![compare.code(), u32::from(write)],
            inputs: INPUTS,
            outputs: OUTPUTS,
            fit: Some(bring_together),
            hard: hard(self.0),
        }
    }

    fn evaluate<R: Real>(&self, x: &mut Reader<'_, R>, out: &mut Writer<'_, R>) {
        let (new, old) = (x.scalar(), x.scalar());
        let left = test(self.0, new, old);
        out.scalar(left.seen);
        out.scalar(left.depth);
    }
}

/// Of four cases one has equal depths, one the next above and one the next below: depths drawn apart never meet.
fn bring_together(row: &mut [f32]) {
    let new = row[0];
    row[1] = match new.to_bits() & 3 {
        0 => new,
        1 => new.next_up(),
        2 => new.next_down(),
        _ => row[1],
    };
}

/// The least f32 above ½.
const NEXT_TO_HALF: f32 = f32::from_bits(0x3f00_0001);

const fn hard(by: DepthTest) -> &'static [Hard] {
    match (by.compare, by.write) {
        (Compare::Less, true) => &[Hard {
            name: "nearer-before-the-near-plane",
            pins: "both are 0 once clamped, so neither is nearer",
            inputs: &[("new", &[-0.5]), ("old", &[-0.25])],
        }],
        (Compare::Equal, true) => &[Hard {
            name: "equal-beyond-the-far-plane",
            pins: "both are 1 once clamped",
            inputs: &[("new", &[1.25]), ("old", &[1.5])],
        }],
        (Compare::NotEqual, true) => &[Hard {
            name: "the-next-float",
            pins: "one unit in the last place is a difference",
            inputs: &[("new", &[NEXT_TO_HALF]), ("old", &[0.5])],
        }],
        (Compare::Always, false) => &[Hard {
            name: "drawn-last",
            pins: "without a test what is drawn last is seen, however far",
            inputs: &[("new", &[1.0]), ("old", &[0.0])],
        }],
        (Compare::GreaterEqual, true) => &[Hard {
            name: "reversed",
            pins: "with depth reversed, 1 at the near plane, the greater is nearer",
            inputs: &[("new", &[0.75]), ("old", &[0.25])],
        }],
        _ => &[],
    }
}

/// A triangle over itself: its depths, whatever the rasteriser makes of them, meet themselves.
#[derive(Clone, Copy, Debug)]
struct OverItself(Compare);

impl Formula for OverItself {
    fn spec(&self) -> Spec {
        const OUTPUTS: &[Output] = &[Output::new("seen", Shape::Scalar, "1")];
        Spec {
            id: format!("depth/same-geometry-{}", self.0.name()),
            text: "seen = 2 if a triangle that is drawn again passes against itself, else 1",
            source: "000 §6.6",
            function: "",
            kind: Kind::Raster(Raster::SameDepth(self.0)),
            selectors: vec![],
            inputs: raster::TRIANGLE,
            outputs: OUTPUTS,
            fit: Some(raster::triangle_around_the_pixel),
            hard: &[],
        }
    }

    fn evaluate<R: Real>(&self, _x: &mut Reader<'_, R>, out: &mut Writer<'_, R>) {
        let depth = R::literal(0.5);
        out.scalar(passes(self.0, depth, depth) + R::literal(1.0));
    }
}

pub(super) fn visit(visitor: &mut impl Visitor) {
    for by in DepthTest::all() {
        visitor.formula(OverAnother(by));
    }
    for compare in Compare::ALL {
        visitor.formula(OverItself(compare));
    }
}
