//! Techniques as formulas: those of a group take the same numbers, and the first is what the others stand in for. None of them
//! is in the catalogue, so that `run` does not judge them; a property test does.

use super::Bench;
use super::contest::{Arithmetic, Contender, On, Sample, contest};
use super::ended::BenchError;
use super::formulas::on_device;
use lightmeter_catalogue::cases::formula::formula;
use lightmeter_catalogue::cases::{Domain, Formula, Hard, Input, Output, Spec, ValueShape};
use lightmeter_catalogue::select::Member;
use lightmeter_document::bench::{BenchGroup, GroupKind};
use lightmeter_gpu::Rung;
use lightmeter_reference::lighting::{self, Specular, highlight, incidence};
use lightmeter_reference::{Real, Vec3, Vector, fog, interpolation, vector};
use lightmeter_scene::shading::Distance;

/// A technique, and what it is in a line.
struct Technique {
    name: &'static str,
    what: &'static str,
    member: Member,
}

/// Techniques that compute the same, the ideal first.
pub(super) struct Techniques {
    /// `technique/viewer`.
    pub(super) id: &'static str,
    title: &'static str,
    ideal: &'static str,
    baseline: &'static str,
    techniques: Vec<Technique>,
}

const P: Input = Input::position("p");
const NORMAL: Input = Input::vector("normal");
const TRAVEL: Input = Input::vector("i");
const UNIT_TRAVEL: Input = Input::direction("i");
const KD: Input = Input::scalar("kd", "1", Domain::Unit);
const KS: Input = Input::scalar("ks", "1", Domain::Unit);
const SHININESS: Input = Input::scalar("shininess", "1", Domain::LogUniform(1.0, 256.0));
const INTENSITY: Output = Output::new("intensity", ValueShape::Scalar, "color");
const FACTOR: Output = Output::new("f", ValueShape::Scalar, "1");
const RAMP_A: Input = Input::scalar("a", "1", Domain::Uniform(0.0, 0.5));
const RAMP_B: Input = Input::scalar("b", "1", Domain::Uniform(0.5, 1.0));

/// A point within some 45 degrees about the view's axis, 1 to 10 units away, whose normal faces the eye and the light: p, the
/// normal and the light's travel are a row's first nine numbers.
fn in_view(_: &Spec, row: &mut [f32]) {
    let z = 1.0 + 0.9 * row[2].abs();
    row[0] *= 0.04 * z;
    row[1] *= 0.04 * z;
    row[2] = -z;
    let dot = |row: &[f32], a: usize, b: usize| (0..3).map(|k| row[a + k] * row[b + k]).sum::<f32>();
    let turn = |row: &mut [f32], at: usize| row[at..at + 3].iter_mut().for_each(|x| *x = -*x);
    if dot(row, 3, 0) > 0.0 {
        turn(row, 3);
    }
    if dot(row, 3, 6) > 0.0 {
        turn(row, 6);
    }
}

/// The same without a light.
fn before_the_eye(_: &Spec, row: &mut [f32]) {
    row[2] = -(1.0 + 0.9 * row[2].abs());
}

/// Two unit vectors some 20 degrees apart at most: the second is drawn near the first.
fn near_each_other(_: &Spec, row: &mut [f32]) {
    let near: [f32; 3] = std::array::from_fn(|k| row[k] + 0.35 * row[3 + k]);
    let length = near.iter().map(|x| x * x).sum::<f32>().sqrt();
    for (k, x) in near.into_iter().enumerate() {
        row[3 + k] = x / length;
    }
}

/// n, l, v, l as it is given.
fn vectors<R: Real>(p: Vec3<R>, normal: Vec3<R>, travel: Vec3<R>) -> [Vec3<R>; 3] {
    [normal.normalize(), -travel, (-p).normalize()]
}

fn lit<R: Real>(model: Specular, [n, l, v]: [Vec3<R>; 3], [kd, ks, shininess]: [R; 3]) -> R {
    kd * incidence(l, n) + ks * highlight(model, n, l, v, shininess)
}

formula!(
    Local: "technique/viewer-local" by "technique_viewer_local",
    "kd·max(l·n, 0) + ks·max(r·v, 0)^S", "000 §6.3", [P, NORMAL, TRAVEL, KD, KS, SHININESS] -> [INTENSITY], fit in_view,
    |p, normal, i, kd, ks, shininess; out| {
        let [n, l, v] = vectors(p, normal, i);
        out.scalar(lit(Specular::Phong, [n, l.normalize(), v], [kd, ks, shininess]));
    },
    hard [
        Hard::new("wide-angle", "a point at 76 degrees from the view's axis", &[
            ("p", &[4.0, 0.0, -1.0]), ("normal", &[-0.6, 0.0, 0.8]), ("i", &[0.0, 0.0, -1.0]), ("shininess", &[32.0]),
        ]),
        Hard::new("great-shininess", "a narrow highlight", &[
            ("p", &[0.0, 0.1, -2.0]), ("normal", &[0.0, 0.0, 1.0]), ("i", &[0.0, 0.05, -1.0]), ("shininess", &[10_000.0]),
        ]),
    ],
);
formula!(
    NonLocal: "technique/viewer-nonlocal" by "technique_viewer_nonlocal",
    "kd·max(l·n, 0) + ks·max(r.z, 0)^S", "000 §6.4", [P, NORMAL, TRAVEL, KD, KS, SHININESS] -> [INTENSITY], fit in_view,
    |p, normal, i, kd, ks, shininess; out| {
        let [n, l, _] = vectors(p, normal, i);
        let v = Vector([R::literal(0.0), R::literal(0.0), R::literal(1.0)]);
        out.scalar(lit(Specular::Phong, [n, l.normalize(), v], [kd, ks, shininess]));
    },
);
formula!(
    PhongNormalised: "technique/highlight-phong-normalised" by "technique_highlight_phong_normalised",
    "kd·max(l·n, 0) + ks·max(⟨r⟩·v, 0)^S", "000 §6.4", [P, NORMAL, TRAVEL, KD, KS, SHININESS] -> [INTENSITY], fit in_view,
    |p, normal, i, kd, ks, shininess; out| {
        let [n, l, v] = vectors(p, normal, i);
        let l = l.normalize();
        let r = vector::reflect(-l, n).normalize();
        let weights: [R; 2] = [kd, ks];
        out.scalar(weights[0] * incidence(l, n) + weights[1] * lighting::cosine_power(r, v, shininess));
    },
    hard [
        Hard::new("grazing", "the light along the surface", &[
            ("p", &[0.0, 0.0, -3.0]), ("normal", &[0.0, 0.0, 1.0]), ("i", &[1.0, 0.0, -1e-3]), ("shininess", &[64.0]),
        ]),
    ],
);
formula!(
    Phong: "technique/highlight-phong" by "technique_viewer_local",
    "kd·max(l·n, 0) + ks·max(r·v, 0)^S", "000 §6.3", [P, NORMAL, TRAVEL, KD, KS, SHININESS] -> [INTENSITY], fit in_view,
    |p, normal, i, kd, ks, shininess; out| {
        let [n, l, v] = vectors(p, normal, i);
        out.scalar(lit(Specular::Phong, [n, l.normalize(), v], [kd, ks, shininess]));
    },
);
formula!(
    Blinn: "technique/highlight-blinn" by "technique_highlight_blinn",
    "kd·max(l·n, 0) + ks·max(n·h, 0)^S", "000 §6.4", [P, NORMAL, TRAVEL, KD, KS, SHININESS] -> [INTENSITY], fit in_view,
    |p, normal, i, kd, ks, shininess; out| {
        let [n, l, v] = vectors(p, normal, i);
        out.scalar(lit(Specular::Blinn, [n, l.normalize(), v], [kd, ks, shininess]));
    },
);
formula!(
    BlinnFourfold: "technique/highlight-blinn-fourfold" by "technique_highlight_blinn_fourfold",
    "kd·max(l·n, 0) + ks·max(n·h, 0)^4S", "000 §6.4", [P, NORMAL, TRAVEL, KD, KS, SHININESS] -> [INTENSITY], fit in_view,
    |p, normal, i, kd, ks, shininess; out| {
        let [n, l, v] = vectors(p, normal, i);
        out.scalar(lit(Specular::Blinn, [n, l.normalize(), v], [kd, ks, R::literal(4.0) * shininess]));
    },
);
formula!(
    Normalised: "technique/light-normalised" by "technique_viewer_local",
    "kd·max(l·n, 0) + ks·max(r·v, 0)^S, l = ⟨−i⟩", "000 §6.3", [P, NORMAL, UNIT_TRAVEL, KD, KS, SHININESS] -> [INTENSITY],
    fit in_view,
    |p, normal, i, kd, ks, shininess; out| {
        let [n, l, v] = vectors(p, normal, i);
        out.scalar(lit(Specular::Phong, [n, l.normalize(), v], [kd, ks, shininess]));
    },
    hard [
        Hard::new("a-tenth-short", "a direction of length 0.9, as interpolation or a scale leaves it", &[
            ("p", &[0.0, 0.0, -3.0]), ("normal", &[0.0, 0.0, 1.0]), ("i", &[0.0, 0.0, -0.9]), ("shininess", &[32.0]),
        ]),
        Hard::new("a-tenth-long", "a direction of length 1.1", &[
            ("p", &[0.0, 0.0, -3.0]), ("normal", &[0.0, 0.0, 1.0]), ("i", &[0.0, 0.0, -1.1]), ("shininess", &[32.0]),
        ]),
    ],
);
formula!(
    AssumedUnit: "technique/light-assumed-unit" by "technique_light_assumed_unit",
    "kd·max(l·n, 0) + ks·max(r·v, 0)^S, l = −i", "000 §6.4", [P, NORMAL, UNIT_TRAVEL, KD, KS, SHININESS] -> [INTENSITY],
    fit in_view,
    |p, normal, i, kd, ks, shininess; out| { out.scalar(lit(Specular::Phong, vectors(p, normal, i), [kd, ks, shininess])); },
);

const A: Input = Input::direction("a");
const B: Input = Input::direction("b");
const EXPONENT: Input = Input::scalar("exponent", "1", Domain::LogUniform(1.0, 1000.0));

formula!(
    Power: "technique/power" by "technique_power",
    "max(a·b, 0)^S", "000 §6.3", [A, B, EXPONENT] -> [FACTOR], fit near_each_other,
    |a, b, exponent; out| { out.scalar(lighting::cosine_power(a, b, exponent)); },
);
formula!(
    PowerByChord: "technique/power-by-chord" by "technique_power_by_chord",
    "exp(S·log1p(−½|a − b|²))", "Goldberg 1991 on log1p", [A, B, EXPONENT] -> [FACTOR], fit near_each_other,
    |a, b, exponent; out| { out.scalar(lighting::cosine_power_by_chord(a, b, exponent)); },
    hard [
        Hard::new("ten-thousand", "shininess 1e4, half a degree off", &[
            ("a", &[0.0, 0.0, 1.0]), ("b", &[0.008_726_535, 0.0, 0.999_961_9]), ("exponent", &[1e4]),
        ]),
        Hard::new("a-million", "shininess 1e6, a twentieth of a degree off", &[
            ("a", &[0.0, 0.0, 1.0]), ("b", &[0.000_872_664_5, 0.0, 0.999_999_6]), ("exponent", &[1e6]),
        ]),
    ],
);
formula!(
    PowerBySchlick: "technique/power-by-schlick" by "technique_power_by_schlick",
    "t/(S − S·t + t), t = max(a·b, 0)", "Schlick 1994", [A, B, EXPONENT] -> [FACTOR], fit near_each_other,
    |a, b, exponent; out| { out.scalar(lighting::cosine_power_by_schlick(a, b, exponent)); },
);

const DENSITY: Input = Input::scalar("density", "1/unit", Domain::LogUniform(0.01, 1.0));

formula!(
    Radial: "technique/distance-radial" by "technique_distance_radial",
    "exp(−d·|p|)", "000 §6.5", [P, DENSITY] -> [FACTOR], fit before_the_eye,
    |p, density; out| { out.scalar(fog::exp(fog::distance(p, Distance::Radial), density)); },
    hard [
        Hard::new("wide-angle", "a point at 76 degrees from the view's axis", &[
            ("p", &[4.0, 0.0, -1.0]), ("density", &[0.5]),
        ]),
    ],
);
formula!(
    Planar: "technique/distance-planar" by "technique_distance_planar",
    "exp(−d·|z|)", "000 §6.5", [P, DENSITY] -> [FACTOR], fit before_the_eye,
    |p, density; out| { out.scalar(fog::exp(fog::distance(p, Distance::Planar), density)); },
);

/// The greatest value of a span is its last one where it rises.
fn rising(row: &mut [f32]) {
    if row[0] > row[1] {
        row.swap(0, 1);
    }
}

macro_rules! span {
    ($direct:ident $by:ident $n:literal $id:literal $by_id:literal $function:literal $by_function:literal) => {
        formula!(
            $direct: $id by $function, "a·(1 − t) + b·t at t = (N − 1)/N", "004", [RAMP_A, RAMP_B] -> [FACTOR], within rising,
            |a, b; out| {
                // Exact: N is a power of two.
                out.scalar(interpolation::mix(a, b, R::literal(f64::from($n - 1) / f64::from($n))));
            },
        );
        formula!(
            $by: $by_id by $by_function, "a + (b − a)/N + … + (b − a)/N", "004", [RAMP_A, RAMP_B] -> [FACTOR], within rising,
            |a, b; out| {
                out.scalar(interpolation::last_by_differences::<R, $n>(a, b));
            },
        );
    };
}

span!(Span16 By16 16 "technique/span-16" "technique/span-16-by-differences" "technique_span_16" "technique_span_16_by_differences");
span!(Span64 By64 64 "technique/span-64" "technique/span-64-by-differences" "technique_span_64" "technique_span_64_by_differences");
span!(Span256 By256 256 "technique/span-256" "technique/span-256-by-differences" "technique_span_256" "technique_span_256_by_differences");
span!(Span1024 By1024 1024 "technique/span-1024" "technique/span-1024-by-differences" "technique_span_1024" "technique_span_1024_by_differences");
span!(Span4096 By4096 4096 "technique/span-4096" "technique/span-4096-by-differences" "technique_span_4096" "technique_span_4096_by_differences");

fn technique(name: &'static str, what: &'static str, formula: impl Formula) -> Technique {
    Technique { name, what, member: Member::new(Box::new(formula)) }
}

/// All of them.
pub(super) fn all() -> Vec<Techniques> {
    let mut all = points();
    all.extend(spans());
    all
}

/// The formulas of all techniques, each once, described as those of the catalogue are.
#[must_use]
pub fn formulas() -> Vec<Member> {
    all().into_iter().flat_map(|group| group.techniques).map(|technique| technique.member).collect()
}

/// What is computed at a point.
fn points() -> Vec<Techniques> {
    vec![
        Techniques {
            id: "technique/viewer",
            title: "a local viewer, v = ⟨−p⟩, against one infinitely far away, v = (0, 0, 1)",
            ideal: "a local viewer, in f64",
            baseline: "local",
            techniques: vec![
                technique("local", "v computed for each point", Local),
                technique("nonlocal", "v = (0, 0, 1)", NonLocal),
            ],
        },
        Techniques {
            id: "technique/highlight",
            title: "Phong's highlight by the mirrored light against Blinn's by the half vector",
            ideal: "Phong's, in f64",
            baseline: "phong",
            techniques: vec![
                technique("phong-normalised", "r·v, r normalised", PhongNormalised),
                technique("phong", "r·v, r as it is reflected: of length 1 where n and l are", Phong),
                technique("blinn", "n·h of the same exponent: another, wider highlight", Blinn),
                technique("blinn-fourfold", "n·h of four times the exponent, which comes near Phong's", BlinnFourfold),
            ],
        },
        Techniques {
            id: "technique/unit-light",
            title: "a light's direction normalised against taken as a unit vector",
            ideal: "normalised, in f64",
            baseline: "normalised",
            techniques: vec![
                technique("normalised", "l = ⟨−i⟩", Normalised),
                technique("assumed-unit", "l = −i", AssumedUnit),
            ],
        },
        Techniques {
            id: "technique/power",
            title: "a highlight's power by pow, by the chord, and Schlick's approximation",
            ideal: "the power of the angle between the two, by the chord in f64",
            baseline: "pow",
            techniques: vec![
                technique("chord", "exp(S·log1p(−½|a − b|²)), the stable form", PowerByChord),
                technique("pow", "pow of the dot product", Power),
                technique("schlick", "t/(S − S·t + t)", PowerBySchlick),
            ],
        },
        Techniques {
            id: "technique/fog-distance",
            title: "fog by the distance from the eye against the depth before it",
            ideal: "the distance, in f64",
            baseline: "radial",
            techniques: vec![technique("radial", "|p|", Radial), technique("planar", "|z|", Planar)],
        },
    ]
}

/// Spans of pixels, by their lengths.
fn spans() -> Vec<Techniques> {
    let span = |id, direct: Technique, by: Technique| Techniques {
        id,
        title: "a span of pixels, each computed against forward differences; a time is of a whole span",
        ideal: "the last pixel's value in f64",
        baseline: "direct",
        techniques: vec![direct, by],
    };
    vec![
        span("technique/span-16", technique("direct", DIRECT, Span16), technique("differences", DIFFERENCES, By16)),
        span("technique/span-64", technique("direct", DIRECT, Span64), technique("differences", DIFFERENCES, By64)),
        span("technique/span-256", technique("direct", DIRECT, Span256), technique("differences", DIFFERENCES, By256)),
        span(
            "technique/span-1024",
            technique("direct", DIRECT, Span1024),
            technique("differences", DIFFERENCES, By1024),
        ),
        span(
            "technique/span-4096",
            technique("direct", DIRECT, Span4096),
            technique("differences", DIFFERENCES, By4096),
        ),
    ]
}

const DIRECT: &str = "a·(1 − t) + b·t at each pixel";
const DIFFERENCES: &str = "the step added once a pixel";

/// The techniques of a group, each at the ladder's rungs.
pub(super) fn techniques(bench: &Bench<'_>, group: &Techniques) -> Result<BenchGroup, BenchError> {
    let ideal = &group.techniques[0].member;
    let sample = Sample::new(&[ideal], bench.setting.cases, bench.setting.seed);
    let mut contenders = vec![];
    for (k, technique) in group.techniques.iter().enumerate() {
        contenders.extend(at_every_rung(bench, technique.name, technique.what, (k > 0).then_some(&technique.member)));
    }
    let (rows, work) = contest(bench, &sample, &contenders, group.baseline)?;
    Ok(BenchGroup {
        id: group.id.into(),
        kind: GroupKind::Technique,
        family: "technique".into(),
        title: group.title.into(),
        ideal: group.ideal.into(),
        baseline: group.baseline.into(),
        unit: "evaluation".into(),
        work,
        rows,
        front: vec![],
    })
}

/// A technique at each rung of the ladder and in the processor's arithmetics; at f32 it goes by its name alone.
fn at_every_rung<'a>(
    bench: &Bench<'_>,
    technique: &str,
    what: &str,
    formula: Option<&'a Member>,
) -> Vec<Contender<'a>> {
    let name = |rung: Rung| match rung {
        Rung::F32 => technique.to_owned(),
        _ => format!("{technique} {}", rung.name()),
    };
    let device = on_device(bench.ladder, formula, name).into_iter().map(|contender| Contender {
        what: match contender.on {
            On::Device(Rung::F32) => what.into(),
            _ => format!("{what}; {}", contender.what),
        },
        ..contender
    });
    let processor = Arithmetic::ALL.into_iter().map(|arithmetic| Contender {
        name: format!("{technique} {}", arithmetic.name()),
        what: format!("{what}; {}", arithmetic.what()),
        formula,
        on: On::Processor(arithmetic),
        unavailable: None,
    });
    device.chain(processor).collect()
}

/// The published and the stable form of a formula that has both, at its hard cases.
pub(super) fn stable(bench: &Bench<'_>, member: &Member) -> Result<Option<BenchGroup>, BenchError> {
    let mut naive: Vec<&Member> = vec![];
    for hard in member.spec.hard.iter().filter_map(|hard| hard.naive) {
        let rival = bench.catalogue.iter().find(|rival| rival.spec.id == hard.formula);
        naive.extend(rival.filter(|rival| naive.iter().all(|known| known.spec.id != rival.spec.id)));
    }
    let Some(first) = naive.first() else { return Ok(None) };
    let sample = Sample::new(&[member], bench.setting.cases, bench.setting.seed);
    let mut contenders = at_every_rung(bench, &short(member), member.spec.text, None);
    for naive in &naive {
        // In stable forms a published one would be the stable one.
        let rungs = at_every_rung(bench, &short(naive), naive.spec.text, Some(naive));
        contenders.extend(rungs.into_iter().filter(|contender| contender.on != On::Device(Rung::Stable)));
    }
    let (rows, work) = contest(bench, &sample, &contenders, &short(first))?;
    Ok(Some(BenchGroup {
        id: format!("stable/{}", member.spec.id),
        kind: GroupKind::Technique,
        family: "stable".into(),
        title: format!("the stable form of {} against published ones", member.spec.id),
        ideal: format!("{} in f64", member.spec.id),
        baseline: short(first),
        unit: "evaluation".into(),
        work,
        rows,
        front: vec![],
    }))
}

/// A formula's name in its family.
fn short(member: &Member) -> String {
    member.spec.id.split_once('/').map_or_else(|| member.spec.id.clone(), |(_, name)| name.to_owned())
}
