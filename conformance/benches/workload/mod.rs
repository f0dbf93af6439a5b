//! Named pieces of the processor's work, each in rounds of a known number of items: what `arithmetic` times and `instructions`
//! counts. One thread does all of it.
//!
//! * `FORMULA/inputs`, `…/reference`, `…/f32`, `…/accept`: a case drawn, and evaluated in f64, in f32 and as intervals.
//! * `judge/value`, `judge/image`: values and pixels against what is legal.
//! * `image/reference`, `image/legal`: an image by the reference, and what its pixels may hold.
//! * `store/FORMAT`: colours to a format's bits and back.
//! * `blend-unit/FORMAT/embedded`, `…/verdict`: a blend, and its verdict with tier and store.

use lightmeter::arithmetic::Accept;
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::blend_unit::embedded;
use lightmeter::blend_unit::pixel::{self, Units};
use lightmeter::blend_unit::rules::Rules;
use lightmeter::blend_unit::tally::{DrawnState, UnitTally};
use lightmeter::cases::Kind;
use lightmeter::cases::blend::UnitCase;
use lightmeter::devices::Known;
use lightmeter::image::file::StoredImage;
use lightmeter::image::{self, expect};
use lightmeter::judge::judge;
use lightmeter::scene::load;
use lightmeter::select::{CaseRef, Member, catalogue};
use lightmeter_reference::render::{Image, render};
use lightmeter_scene::blend::Route;
use lightmeter_scene::effects::effects;
use lightmeter_scene::target::TargetFormat;
use std::hint::black_box;
use std::rc::Rc;

/// Formulas that stand for their families: between them every operation of the arithmetics and the rasteriser's bounds.
pub(crate) const FORMULAS: [&str; 15] = [
    "interpolation/perspective",
    "interpolation/raster-line",
    "color/srgb-encode",
    "color/to-unorm8",
    "vector/normal-inverse-transpose",
    "vector/reflect",
    "lighting/specular-blinn",
    "lighting/two-lights",
    "attenuation/point",
    "attenuation/spot-exponent",
    "fog/linear",
    "fog/exp",
    "fog/exp2-opengl",
    "depth/recovered",
    BLEND,
];
const BLEND: &str = "blend/add/src-alpha/one-minus-src-alpha";
/// Its values are judged.
const JUDGED: &str = "lighting/two-lights";

const SEED: u64 = 1;
/// Cases of a round.
const CASES: usize = 64;
/// The scene of the images, and its pixels in a row and in a column.
const SCENE: &str = "phong-blinn";
const SIDE: u32 = 48;

/// A piece of work.
pub(crate) struct Workload {
    /// Its name.
    pub(crate) name: String,
    /// What is counted.
    pub(crate) item: &'static str,
    /// Items of a round.
    pub(crate) items: u64,
    round: Box<dyn FnMut()>,
}

impl Workload {
    fn new(name: String, item: &'static str, items: usize, round: impl FnMut() + 'static) -> Self {
        Self { name, item, items: items as u64, round: Box::new(round) }
    }

    /// Does a round: the same work each time.
    pub(crate) fn round(&mut self) {
        (self.round)();
    }
}

/// Keeps parallel loops on this thread.
pub(crate) fn on_one_thread() {
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global().expect("nothing ran before");
}

/// All of them, in the order of reports.
pub(crate) fn all() -> Vec<Workload> {
    let mut members: Vec<Rc<Member>> = catalogue().into_iter().map(Rc::new).collect();
    members.retain(|member| FORMULAS.contains(&member.spec.id.as_str()));
    let find = |id: &str| members.iter().find(|member| member.spec.id == id).expect("the formula is in the catalogue");
    let mut all: Vec<Workload> = FORMULAS.into_iter().flat_map(|id| formula(find(id))).collect();
    all.push(values(find(JUDGED)));
    all.extend(images());
    let cases = unit_cases(find(BLEND));
    for target in TargetFormat::ALL {
        all.push(store(target, &cases));
        all.extend(blend_unit(find(BLEND), target, &cases));
    }
    all
}

/// Random cases, row after row.
fn rows(member: &Member) -> Vec<f32> {
    let mut rows = vec![];
    for k in 0..CASES as u64 {
        member.inputs(CaseRef::Random(k), SEED, &mut rows);
    }
    rows
}

fn formula(member: &Rc<Member>) -> [Workload; 4] {
    let work =
        |what: &str, round: Box<dyn FnMut()>| Workload::new(format!("{}/{what}", member.spec.id), "case", CASES, round);
    let drawn = {
        let (member, mut row) = (Rc::clone(member), vec![]);
        move || {
            let draws = member.draws(SEED);
            for k in 0..CASES as u64 {
                row.clear();
                draws.inputs(CaseRef::Random(black_box(k)), &mut row);
                black_box(&row);
            }
        }
    };
    let reference = over_rows(member, 0.0, |member, row, out| member.formula.reference(row, out));
    let embedded = over_rows(member, 0.0, |member, row, out| member.formula.embedded(row, out));
    let legal = {
        let (member, rows) = (Rc::clone(member), rows(member));
        let mut legal = vec![Accept::ANY; CASES * member.spec.output_len()];
        move || {
            let (rows, inputs, outputs) = (black_box(&rows), member.spec.input_len(), member.spec.output_len());
            if matches!(member.spec.kind, Kind::Raster(_)) {
                for (row, legal) in rows.chunks_exact(inputs).zip(legal.chunks_exact_mut(outputs)) {
                    member.formula.promised_interval(member.spec.kind, row, &WGSL, legal);
                }
            } else {
                member.formula.intervals(rows, inputs, &WGSL, &mut legal);
            }
            black_box(&legal);
        }
    };
    [
        work("inputs", Box::new(drawn)),
        work("reference", reference),
        work("f32", embedded),
        work("accept", Box::new(legal)),
    ]
}

fn over_rows<R: Clone + 'static>(
    member: &Rc<Member>,
    blank: R,
    evaluate: impl Fn(&Member, &[f32], &mut [R]) + 'static,
) -> Box<dyn FnMut()> {
    let (member, rows, mut out) = (Rc::clone(member), rows(member), vec![blank; member.spec.output_len()]);
    Box::new(move || {
        for row in rows.chunks_exact(member.spec.input_len()) {
            evaluate(&member, black_box(row), &mut out);
            black_box(&out);
        }
    })
}

fn values(member: &Member) -> Workload {
    let outputs = member.spec.output_len();
    let (mut embedded, mut references, mut legal) =
        (vec![0.0_f32; CASES * outputs], vec![0.0; CASES * outputs], vec![Accept::ANY; CASES * outputs]);
    for (case, row) in rows(member).chunks_exact(member.spec.input_len()).enumerate() {
        let of = case * outputs..(case + 1) * outputs;
        member.formula.embedded(row, &mut embedded[of.clone()]);
        member.formula.reference(row, &mut references[of.clone()]);
        member.formula.interval(row, &WGSL, &mut legal[of]);
    }
    Workload::new("judge/value".into(), "value", embedded.len(), move || {
        for ((value, reference), legal) in embedded.iter().zip(&references).zip(&legal) {
            black_box(judge(black_box(value.to_bits()), *reference, legal));
        }
    })
}

fn images() -> [Workload; 3] {
    let mut frame = load::builtin(SCENE).expect("a test loads every scene that is built in").frame;
    (frame.target.width, frame.target.height) = (SIDE, SIDE);
    let frame = Rc::new(frame);
    let called = effects(&frame);
    let exact = render::<f64>(&frame, Some(&called), None);
    let fragments = usize::try_from(exact.fragments).expect("few fragments");
    let format = frame.target.format;
    let reference = StoredImage::unrounded(&exact, format);
    let image = StoredImage::of(&render::<f32>(&frame, Some(&called), None), format);
    let legal = expect(&frame, Some(&called), None, &WGSL);
    let pixels: Vec<usize> = (0..legal.len()).collect();
    let judged = move || {
        black_box(image::judge::judge(black_box(&image), &reference, &legal, &pixels));
    };
    let drawn = {
        let (frame, called) = (Rc::clone(&frame), called.clone());
        move || {
            black_box(render::<f64>(black_box(&frame), Some(&called), None));
        }
    };
    let expected = move || {
        black_box(expect(black_box(&frame), Some(&called), None, &WGSL));
    };
    [
        Workload::new("judge/image".into(), "pixel", (SIDE * SIDE) as usize, judged),
        Workload::new("image/reference".into(), "lit fragment", fragments, drawn),
        Workload::new("image/legal".into(), "lit fragment", fragments, expected),
    ]
}

fn unit_cases(member: &Member) -> Rc<[UnitCase]> {
    let Kind::Blend(program) = member.spec.kind else { unreachable!("a blend state") };
    rows(member).chunks_exact(member.spec.input_len()).map(|row| program.case(row)).collect()
}

fn store(target: TargetFormat, cases: &[UnitCase]) -> Workload {
    let pixels = cases.iter().map(|case| case.sources[0].map(f64::from)).collect();
    let image = Image { width: CASES, height: 1, pixels, fragments: 0 };
    Workload::new(format!("store/{}", target.name()), "pixel", CASES, move || {
        let mut bytes = vec![];
        for &pixel in &StoredImage::of(black_box(&image), target).pixels {
            pixel::write(target, pixel, &mut bytes);
        }
        black_box(StoredImage::read(CASES, target, &bytes));
    })
}

fn blend_unit(member: &Member, target: TargetFormat, cases: &Rc<[UnitCase]>) -> [Workload; 2] {
    let Kind::Blend(program) = member.spec.kind else { unreachable!("a blend state") };
    let name = |what: &str| format!("blend-unit/{}/{what}", target.name());
    let blend = move |case: &UnitCase| embedded::blend(program, target, case, &Rules::RIGHT);
    let pixels: Vec<Units> = cases.iter().map(blend).collect();
    let drawn = DrawnState { program, route: Route::Native, target, profile: &WGSL };
    let (blended, judged) = (Rc::clone(cases), Rc::clone(cases));
    let verdict = move || {
        let mut tally = UnitTally::default();
        let pixels = judged.iter().zip(&pixels).enumerate();
        let pixels = pixels.map(|(place, (case, pixel))| (place, black_box(case), *pixel));
        tally.pixels(drawn, &Known::default(), pixels);
        black_box(tally);
    };
    let blend = move || {
        for case in &*blended {
            black_box(blend(black_box(case)));
        }
    };
    [Workload::new(name("embedded"), "pixel", CASES, blend), Workload::new(name("verdict"), "pixel", CASES, verdict)]
}
