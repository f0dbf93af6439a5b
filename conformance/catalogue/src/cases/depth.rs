//! Cases of the depth test: every compare function, with and without writing. Formulas: `lightmeter_reference::depth`.

use super::Visitor;
use super::formula::{Formula, bind, formula};
use super::interpolation::raster;
use super::rows::{Reader, Writer};
use super::spec::{Domain, Hard, Input, Kind, Output, Spec, ValueShape};
use lightmeter_reference::Real;
use lightmeter_reference::depth::{passes, recovered, recovered_reversed, stored, stored_reversed, test};
use lightmeter_scene::depth::{Compare, DepthTest};
use lightmeter_scene::raster::Raster;

const BEYOND: Domain = Domain::Uniform(-0.25, 1.25);
const DEPTHS: &[Input] = &[Input::scalar("new", "1", BEYOND), Input::scalar("old", "1", BEYOND)];

/// A fragment over another.
#[derive(Clone, Copy, Debug)]
struct OverAnother(DepthTest);

impl Formula for OverAnother {
    fn spec(&self) -> Spec {
        const OUTPUTS: &[Output] =
            &[Output::new("seen", ValueShape::Scalar, "1"), Output::new("depth", ValueShape::Scalar, "1")];
        let DepthTest { compare, write } = self.0;
        Spec {
            id: format!("depth/test/{}", self.0),
            text: "seen = 2 and depth = new (where written) if clamp(new) passes against clamp(old), else 1 and old",
            source: "000 §6.6, 002; ruling 15",
            function: "depth_test",
            kind: Kind::Depth(self.0),
            selectors: vec![compare.code(), u32::from(write)],
            inputs: DEPTHS,
            outputs: OUTPUTS,
            fit: Some(bring_together),
            within: None,
            hard: hard(self.0),
            stable: None,
            is_normalised: false,
        }
    }

    fn evaluate<R: Real>(&self, x: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        bind!(x, DEPTHS => new, old);
        let left = test(self.0, new, old);
        out.scalar(left.seen);
        out.scalar(left.depth);
    }
}

/// Of four cases one has equal depths, one the next above and one the next below: depths drawn apart never meet.
fn bring_together(_: &Spec, row: &mut [f32]) {
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
        (Compare::Less, true) => {
            const {
                &[Hard::new(
                    "nearer-before-the-near-plane",
                    "both are 0 once clamped, so neither is nearer",
                    &[("new", &[-0.5]), ("old", &[-0.25])],
                )]
            }
        }
        (Compare::Equal, true) => {
            const {
                &[Hard::new(
                    "equal-beyond-the-far-plane",
                    "both are 1 once clamped",
                    &[("new", &[1.25]), ("old", &[1.5])],
                )]
            }
        }
        (Compare::NotEqual, true) => {
            const {
                &[Hard::new(
                    "the-next-float",
                    "one unit in the last place is a difference",
                    &[("new", &[NEXT_TO_HALF]), ("old", &[0.5])],
                )]
            }
        }
        (Compare::Always, false) => {
            const {
                &[Hard::new(
                    "drawn-last",
                    "without a test what is drawn last is seen, however far",
                    &[("new", &[1.0]), ("old", &[0.0])],
                )]
            }
        }
        (Compare::GreaterEqual, true) => {
            const {
                &[Hard::new(
                    "reversed",
                    "with depth reversed, 1 at the near plane, the greater is nearer",
                    &[("new", &[0.75]), ("old", &[0.25])],
                )]
            }
        }
        _ => &[],
    }
}

/// A triangle over itself: its depths, whatever the rasteriser makes of them, meet themselves.
#[derive(Clone, Copy, Debug)]
struct OverItself(Compare);

impl Formula for OverItself {
    fn spec(&self) -> Spec {
        const OUTPUTS: &[Output] = &[Output::new("seen", ValueShape::Scalar, "1")];
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
            within: None,
            hard: &[],
            stable: None,
            is_normalised: false,
        }
    }

    fn evaluate<R: Real>(&self, _x: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        let depth = R::literal(0.5);
        out.scalar(passes(self.0, depth, depth) + R::literal(1.0));
    }
}

const NEAR: Input = Input::scalar("near", "unit", Domain::LogUniform(0.5, 1.0));
const FAR: Input = Input::scalar("far", "unit", Domain::LogUniform(50.0, 100.0));
const EYE_DISTANCE: Input = Input::scalar("z", "unit", Domain::LogUniform(1.0, 50.0));
/// Near plane, distance and far plane in this order.
fn between_the_planes(row: &mut [f32]) {
    if row[0] > row[1] {
        row.swap(0, 1);
    }
    row[1] = row[1].max(row[0].next_up());
    row[2] = row[2].clamp(row[0], row[1]);
}

const STORED: Output = Output::new("depth", ValueShape::Scalar, "1");
const READ_BACK: Output = Output::new("z", ValueShape::Scalar, "unit");

formula!(
    /// A distance as depth.
    Stored: "depth/stored" by "depth_stored",
    "depth = f(z − n)/(z(f − n))", "000 §6.6; ruling 15",
    [NEAR, FAR, EYE_DISTANCE] -> [STORED],
    within between_the_planes,
    |near, far, z; out| { out.scalar(stored(near, far, z)); },
    hard [
        Hard::new("just-behind-the-near-plane", "a depth of 6 parts in a million", &[("near", &[0.75]), ("z", &[0.750_005])]),
        Hard::new("just-before-the-far-plane", "a depth just below 1", &[("far", &[96.0]), ("z", &[95.9999])]),
        Hard::new("at-the-near-plane", "0", &[("near", &[0.75]), ("z", &[0.75])]).at_an_end(),
        Hard::new("at-the-far-plane", "1", &[("far", &[96.0]), ("z", &[96.0])]).at_an_end(),
    ],
);
formula!(
    /// A distance as depth reversed.
    StoredReversed: "depth/stored-reversed" by "depth_stored_reversed",
    "depth = n(f − z)/(z(f − n))", "000 §6.6, with depth reversed",
    [NEAR, FAR, EYE_DISTANCE] -> [STORED],
    within between_the_planes,
    |near, far, z; out| { out.scalar(stored_reversed(near, far, z)); },
    hard [
        Hard::new("just-behind-the-near-plane", "a depth just below 1", &[("near", &[0.75]), ("z", &[0.750_005])]),
        Hard::new("just-before-the-far-plane", "a depth of 8 parts in a billion", &[("far", &[96.0]), ("z", &[95.9999])]),
        Hard::new("at-the-near-plane", "1", &[("near", &[0.75]), ("z", &[0.75])]).at_an_end(),
        Hard::new("at-the-far-plane", "0", &[("far", &[96.0]), ("z", &[96.0])]).at_an_end(),
    ],
);
formula!(
    /// A distance read back from depth.
    Recovered: "depth/recovered" by "depth_recovered",
    "z = n·f/(f − depth(f − n)), depth = f(z − n)/(z(f − n))", "000 §6.6; ruling 15",
    [NEAR, FAR, EYE_DISTANCE] -> [READ_BACK],
    within between_the_planes,
    |near, far, z; out| { out.scalar(recovered(near, far, z)); },
    hard [
        Hard::new("far-out", "beyond 100 units", &[("near", &[10.0]), ("far", &[1000.0]), ("z", &[700.0])]),
        Hard::new("far-out-of-a-deep-range", "ill-conditioned: a step of depth is 0.024 units", &[("near", &[0.1]), ("far", &[1000.0]), ("z", &[200.0])]),
        Hard::new("at-near", "as near as it is drawn", &[("near", &[0.25]), ("far", &[64.0]), ("z", &[0.25])]).at_an_end(),
        Hard::new("at-far", "as far as it is drawn", &[("near", &[16.0]), ("far", &[4096.0]), ("z", &[4096.0])]).at_an_end(),
    ],
);
formula!(
    /// A distance read back from depth reversed.
    RecoveredReversed: "depth/recovered-reversed" by "depth_recovered_reversed",
    "z = n·f/(n + depth(f − n)), depth = n(f − z)/(z(f − n))", "000 §6.6, with depth reversed",
    [NEAR, FAR, EYE_DISTANCE] -> [READ_BACK],
    within between_the_planes,
    stable 32.0 Own "five products, two differences that cancel by little and two divisions of at most 2½ ULP",
    |near, far, z; out| { out.scalar(recovered_reversed(near, far, z)); },
    hard [
        Hard::new("at-900-of-1000", "near 0.1, far 1000: no nearer than half a unit", &[("near", &[0.1]), ("far", &[1000.0]), ("z", &[900.3])])
            .naive("depth/recovered", "a step of depth is 0.48 units", 500.0),
        Hard::new("near-1e-3-far-1e6", "near and far 1e9 apart", &[("near", &[1e-3]), ("far", &[1e6]), ("z", &[1234.5])])
            .naive("depth/recovered", "1 − depth has lost 20 bits", 1e5),
        Hard::new("a-room", "near 0.01, far 1e5, at 10", &[("near", &[0.01]), ("far", &[1e5]), ("z", &[10.7])])
            .naive("depth/recovered", "1 − depth has lost 10 bits", 100.0),
        Hard::new("the-horizon", "near 0.1, far 1e7, at 1e5", &[("near", &[0.1]), ("far", &[1e7]), ("z", &[123_456.0])])
            .naive("depth/recovered", "1 − depth has lost 20 bits", 1e5),
    ],
);

pub(super) fn visit(visitor: &mut impl Visitor) {
    for by in DepthTest::all() {
        visitor.formula(OverAnother(by));
    }
    for compare in Compare::ALL {
        visitor.formula(OverItself(compare));
    }
    visitor.formula(Stored);
    visitor.formula(StoredReversed);
    visitor.formula(Recovered);
    visitor.formula(RecoveredReversed);
}
