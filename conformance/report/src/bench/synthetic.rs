//! A made-up document with everything that a real one may have in it, for tests of what is made of one.

use lightmeter_document::Number;
use lightmeter_document::bench::ladder::family;
use lightmeter_document::bench::pareto::front_of;
use lightmeter_document::bench::*;

/// SplitMix64.
pub(crate) struct SyntheticDraw(u64);

impl SyntheticDraw {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, end: u32) -> u32 {
        u32::try_from(self.next() % u64::from(end)).expect("it is below a u32")
    }

    /// From 0 to 1.
    fn unit(&mut self) -> f64 {
        f64::from(self.below(1 << 24)) / f64::from(1 << 24)
    }

    /// 1 but for a factor of at most `most`, even in its logarithm.
    fn about(&mut self, most: f64) -> f64 {
        most.powf(2.0 * self.unit() - 1.0)
    }
}

/// Errors whose largest is `ulp` ULP.
pub(crate) fn errors(ulp: f64) -> Errors {
    let spread = |max: f64| Spread { max: Number(max), p99: Number(max / 3.0), mean: Number(max / 20.0) };
    let lost = if ulp.is_finite() { 0 } else { 3 };
    let absolute = ulp * 6e-8;
    Errors {
        values: 16384,
        lost,
        nothing_promised: 0,
        ulp: spread(ulp),
        steps: spread(255.0 * absolute),
        absolute: spread(absolute),
    }
}

/// A row that was measured.
pub(crate) fn row(name: &str, ns: f64, ratio: f64, ulp: f64) -> BenchRow {
    let verdict = match ratio {
        x if x < 0.97 => Rank::Faster,
        x if x > 1.03 => Rank::Slower,
        _ => Rank::Tie,
    };
    let spread = [ratio * 0.97, ratio * 1.03];
    let quartiles_ns = [ns * 0.98, ns * 1.02];
    let clock = if name.starts_with("cpu-") { "processor" } else { "timestamps" }.to_owned();
    let time = Time { clock, ns, quartiles_ns, ratio, spread, verdict, turns: 15, rejected: 0, note: None };
    BenchRow {
        name: name.into(),
        what: format!("{name}, in a line"),
        claims_exact: true,
        unavailable: None,
        as_f32: false,
        disqualified: None,
        random: Some(errors(ulp)),
        hard: None,
        rounding: None,
        time: Some(time),
        compile_ms: None,
    }
}

/// A group whose first row is the baseline.
pub(crate) fn group(id: &str, rows: Vec<BenchRow>) -> BenchGroup {
    let family = id.split('/').next().unwrap_or_default();
    let kind = match family {
        "technique" | "stable" => GroupKind::Technique,
        "scene" => GroupKind::Scene,
        _ => GroupKind::Formula,
    };
    let mut group = BenchGroup {
        id: id.into(),
        kind,
        family: family.into(),
        title: format!("{id}: v/|v| and the like"),
        ideal: "the published formula in f64".into(),
        baseline: rows.first().map(|row| row.name.clone()).unwrap_or_default(),
        unit: if kind == GroupKind::Scene { "frame" } else { "evaluation" }.into(),
        work: "16,384 random cases, 12 hard ones and 384 near them".into(),
        rows,
        front: vec![],
    };
    let baseline = group.baseline.clone();
    let first = group.rows.iter_mut().find(|row| row.name == baseline).and_then(|row| row.time.as_mut());
    if let Some(time) = first {
        time.verdict = Rank::Baseline;
    }
    group.front = front_of(&group);
    group
}

/// Rungs with their usual ratio and largest error in ULP.
const RUNGS: [(&str, f64, f64); 9] = [
    ("f32", 1.0, 5.0),
    ("f16", 0.62, 9000.0),
    ("f32-cheap", 0.8, 60.0),
    ("f32-stable", 1.15, 1.4),
    ("double-float", 6.0, 0.5),
    ("f64", 11.0, 0.5),
    ("cpu-f32", 40.0, 4.0),
    ("cpu-f64", 48.0, 0.5),
    ("cpu-accept", 900.0, 30.0),
];

const FAMILIES: [(&str, &[&str], usize); 8] = [
    ("interpolation", &["line", "triangle", "perspective", "viewport"], 16),
    ("color", &["to-unorm8", "srgb-encode", "srgb-decode"], 12),
    ("vector", &["reflect", "halfway", "normalize", "normalize-scaled"], 24),
    ("lighting", &["blinn", "phong", "specular-nonlocal", "cosine-power-by-chord"], 30),
    ("attenuation", &["polynomial", "spot-cutoff"], 11),
    ("fog", &["exp", "exp2-document", "exp2-opengl", "linear"], 14),
    ("depth", &["recovered"], 2),
    ("blend", &["over", "add", "multiply"], 19),
];

/// A row: its name, ratio and largest error in ULP.
type Made<'a> = (&'a str, f64, f64);

const TECHNIQUES: [(&str, &[Made]); 12] = [
    ("viewer", &[("local", 1.0, 6.0), ("infinite", 0.7, 4e6)]),
    ("specular", &[("phong", 1.0, 9.0), ("blinn", 0.93, 3e6), ("blinn-fitted", 0.96, 9e5), ("chord", 1.9, 2.0)]),
    ("power", &[("pow", 1.0, 200.0), ("exp2-log2", 1.0, 200.0), ("schlick", 0.4, 6e5), ("squarings", 0.5, 11.0)]),
    (
        "normalize",
        &[("inverse-sqrt", 1.0, 3.0), ("divide", 1.2, 2.0), ("scaled", 1.6, 1.5), ("none", 0.2, f64::INFINITY)],
    ),
    ("fog-distance", &[("radial", 1.0, 8.0), ("plane", 0.65, 2e6)]),
    ("fog-place", &[("fragment", 1.0, 8.0), ("vertex", 0.4, 4e5)]),
    (
        "fog-exp",
        &[
            ("exp", 1.0, 90.0),
            ("exp2", 0.99, 40.0),
            ("taylor-3", 0.6, 8e5),
            ("table-64", 0.8, 2e4),
            ("table-256", 0.81, 1500.0),
            ("table-1024", 0.83, 95.0),
        ],
    ),
    ("srgb", &[("exact", 1.0, 12.0), ("gamma-2.2", 0.9, 5e5), ("square", 0.12, 3e6), ("polynomial", 0.3, 4e4)]),
    ("attenuation", &[("horner", 1.0, 2.0), ("powers", 1.01, 2.0)]),
    ("normals", &[("cofactors", 1.0, 4.0), ("inverse-transpose", 2.3, 40.0), ("model-view", 0.5, 8e6)]),
    ("blend", &[("unit", 1.0, 3e4), ("shader", 3.1, 0.0)]),
    ("mix", &[("two-products", 1.0, 0.0), ("incremental", 0.97, 1e7), ("built-in", 1.0, 0.0)]),
];

/// Two adapters, each with every kind of group.
pub(crate) fn document() -> BenchDocument {
    let mut draw = SyntheticDraw::new(1);
    let mut first = measured("lavapipe", 1.0, &mut draw);
    first.is_cpu = true;
    first.device = "llvmpipe (LLVM 15.0.6, 256 bits)".into();
    first.driver = "llvmpipe, Mesa 22.3.6 (LLVM 15.0.6)".into();
    first.clock = ClockUse { kind: "timestamps".into(), note: None, readings: 41_234, rejected: 3, grain_ns: None };
    let why = "the driver has no shader-f16";
    first.rungs.iter_mut().filter(|rung| rung.name == "f16").for_each(|rung| rung.unavailable = Some(why.into()));
    for group in &mut first.groups {
        group.rows.iter_mut().filter(|row| row.name == "f16").for_each(|row| take_away(row, why));
        group.front = front_of(group);
    }
    first.families = families(&first.groups);
    let mut second = measured("h100", 0.01, &mut draw);
    second.device = "NVIDIA H100".into();
    second.driver = "NVIDIA, 550.54".into();
    let note =
        "timestamps stood still in 4 of 5 trials, so times are those of the clock on the wall around a submission";
    second.clock = ClockUse {
        kind: "wall".into(),
        note: Some(note.into()),
        readings: 40_002,
        rejected: 0,
        grain_ns: Some(100_000),
    };
    let times = second.groups.iter_mut().flat_map(|group| &mut group.rows).filter_map(|row| row.time.as_mut());
    times.filter(|time| time.clock == "timestamps").for_each(|time| time.clock = "wall".into());
    BenchDocument {
        schema: SCHEMA.into(),
        command: "./x bench --adapter all --format json --out bench.json".into(),
        version: "0.1.0".into(),
        made_at: None,
        quick: false,
        seed: 1,
        seconds: 512.3,
        cores: 2,
        adapters: vec![first, second],
        interrupted: None,
    }
}

fn take_away(row: &mut BenchRow, why: &str) {
    row.unavailable = Some(why.into());
    (row.random, row.hard, row.time, row.disqualified) = (None, None, None, None);
}

fn families(groups: &[BenchGroup]) -> Vec<Family> {
    let of = |id: &'static str| groups.iter().filter(move |group| group.family == id);
    FAMILIES.iter().map(|(id, ..)| family(id, of(id))).collect()
}

fn measured(adapter: &str, scale: f64, draw: &mut SyntheticDraw) -> Measured {
    let mut groups = vec![];
    for (family, names, count) in FAMILIES {
        for place in 0..count {
            let id =
                names.get(place).map_or_else(|| format!("{family}/form-{place:02}"), |name| format!("{family}/{name}"));
            groups.push(formula(&id, scale, draw));
        }
    }
    for (id, rows) in TECHNIQUES {
        groups.push(technique(&format!("technique/{id}"), rows, scale, draw));
    }
    for (id, naive) in [("fog-exp2", 3000.0), ("normalize", f64::INFINITY), ("edge", 4.7e12), ("power", 1.2e5)] {
        let mut group =
            technique(&format!("stable/{id}"), &[("published", 1.0, 4.0), ("stable", 1.2, 1.5)], scale, draw);
        group.rows[0].hard = Some(errors(naive));
        group.rows[1].hard = Some(errors(1.8));
        groups.push(group);
    }
    for place in 0..32 {
        groups.push(scene(place, scale, draw));
    }
    let unavailable = |name: &str| (name == "f64" && scale < 0.1).then(|| "no shader-f64".to_owned());
    let rungs = RUNGS.iter().map(|(name, ..)| RungUse {
        name: (*name).into(),
        what: format!("arithmetic of {name}"),
        unavailable: unavailable(name),
    });
    Measured {
        adapter: adapter.into(),
        device: String::new(),
        backend: "vulkan".into(),
        driver: String::new(),
        is_cpu: false,
        clock: ClockUse { kind: String::new(), note: None, readings: 0, rejected: 0, grain_ns: None },
        rungs: rungs.collect(),
        families: families(&groups),
        groups,
        scalings: scalings(scale, draw),
        claims: claims(),
    }
}

fn formula(id: &str, scale: f64, draw: &mut SyntheticDraw) -> BenchGroup {
    let (weight, loss) = (scale * draw.about(6.0), draw.about(12.0));
    let is_exact = draw.below(9) == 0;
    let mut rows = vec![];
    for (name, ratio, ulp) in RUNGS {
        let ratio = if name == "f32" { 1.0 } else { ratio * draw.about(1.5) };
        let mut ulp = ulp * if name == "f64" || ulp < 1.0 { draw.about(1.1) } else { loss * draw.about(2.0) };
        if is_exact && name != "f16" {
            ulp = 0.0;
        } else if name == "f64" && draw.below(3) == 0 || name == "f16" && draw.below(12) == 0 {
            ulp = if name == "f64" { 0.0 } else { f64::INFINITY };
        }
        let mut row = row(name, weight * ratio, ratio, ulp);
        row.hard = id.len().is_multiple_of(2).then(|| errors(ulp * 40.0 * draw.about(3.0)));
        row.rounding = (name == "f32-cheap").then(|| errors(ulp / 4.0));
        row.compile_ms = (!name.starts_with("cpu-")).then(|| 11.0 * draw.about(2.0));
        if name == "f32-cheap" && draw.below(14) == 0 {
            row.disqualified = Some("lies outside the acceptance intervals at 12 of 16,384 cases".into());
        }
        if name == "f64" && scale < 0.1 {
            take_away(&mut row, "no shader-f64");
        }
        if name == "double-float" && draw.below(10) == 0 {
            take_away(&mut row, "no double-float form of pow is written | none is published");
        }
        rows.push(row);
    }
    group(id, rows)
}

fn technique(id: &str, rows: &[Made], scale: f64, draw: &mut SyntheticDraw) -> BenchGroup {
    let weight = scale * draw.about(5.0);
    let of = |&(name, ratio, ulp): &Made| {
        let mut row = row(name, weight * ratio, ratio, ulp);
        row.claims_exact = ulp < 1e4;
        if name == "table-64" {
            row.disqualified = Some("differs from its own formula by 0.02 beyond z = 80: the table ends there".into());
        }
        if name == "unit" && scale < 0.1 {
            take_away(&mut row, "the wall clock does not tell a blend unit's time from a draw's");
        }
        row
    };
    group(id, rows.iter().map(of).collect())
}

fn scene(place: usize, scale: f64, draw: &mut SyntheticDraw) -> BenchGroup {
    let named = ["teapot", "attached-lights", "missed-highlight", "fogged-floor"];
    let id = named.get(place).map_or_else(|| format!("scene/made-up-{place:02}"), |name| format!("scene/{name}"));
    let weight = 4e6 * scale * draw.about(3.0);
    let rows = RUNGS.iter().filter(|(name, ..)| !["double-float", "f64", "cpu-f32"].contains(name));
    let of = |&(name, ratio, ulp): &Made| {
        let ratio = if name == "f32" { 1.0 } else { ratio * draw.about(1.3) };
        let mut row = row(name, weight * ratio, ratio, 3000.0 * ulp * draw.about(3.0));
        if name == "cpu-f64" {
            row.random = Some(errors(0.0));
        }
        if let Some(time) = row.time.as_mut().filter(|_| place == 3) {
            time.rejected = 2;
            time.note = Some("the driver compiled anew in 2 turns".into());
        }
        row
    };
    group(&id, rows.map(of).collect())
}

fn scalings(scale: f64, draw: &mut SyntheticDraw) -> Vec<Scaling> {
    let rows = [
        ("lights", "a lit quad of 256² pixels", 1, 7, 9e4, 3e5, 1.01),
        ("vertices", "points, one a vertex", 100, 7, 5e4, 8.0, 1.0),
        ("pixels", "a lit quad", 1024, 6, 7e4, 4.0, 0.97),
        ("cases", "lighting/blinn", 1024, 6, 2e4, 1.5, 0.99),
    ];
    let of = |(id, what, from, steps, fixed, factor, exponent): (&str, &str, u64, u32, f64, f64, f64)| {
        let point = |step: u32, draw: &mut SyntheticDraw| {
            let work = from * 4_u64.pow(step);
            #[expect(clippy::cast_precision_loss, reason = "small")]
            let ns = scale * (fixed + factor * (work as f64).powf(exponent)) * draw.about(1.06);
            ScalingPoint { work, ns, quartiles_ns: [ns * 0.95, ns * 1.08] }
        };
        Scaling {
            id: id.into(),
            what: what.into(),
            unit: if id == "vertices" { "vertex" } else { id.trim_end_matches('s') }.into(),
            clock: "timestamps".into(),
            points: (0..steps).map(|step| point(step, draw)).collect(),
            unavailable: if id == "lights" {
                vec![(1 << 20, "more than a storage buffer holds".into())]
            } else {
                vec![]
            },
            fit: (id != "vertices" || scale > 0.1).then_some(Fit {
                fixed_ns: scale * fixed,
                factor_ns: scale * factor,
                exponent,
                residual: 0.06,
            }),
        }
    };
    rows.into_iter().map(of).collect()
}

#[expect(clippy::too_many_lines, reason = "a table of claims")]
fn claims() -> Vec<Claim> {
    type BenchRow<'a> = (&'a str, &'a str, &'a str, &'a str, [&'a str; 2], f64, Option<bool>);
    let rows: [BenchRow; 7] = [
        (
            "infinite-viewer",
            "000 §6.4",
            "an infinite viewer is cheaper and a little off",
            "technique/viewer",
            ["infinite", "local"],
            0.7,
            Some(true),
        ),
        (
            "blinn-cheaper",
            "000 §6.5",
            "Blinn's model is cheaper than Phong's",
            "technique/specular",
            ["blinn", "phong"],
            0.93,
            Some(true),
        ),
        (
            "half-way-exponent",
            "000 §6.5",
            "a fitted exponent makes Blinn look as Phong",
            "technique/specular",
            ["blinn-fitted", "phong"],
            0.96,
            Some(false),
        ),
        (
            "horner",
            "001 §2",
            "Horner's form costs nothing more",
            "technique/attenuation",
            ["horner", "powers"],
            0.99,
            None,
        ),
        (
            "fog-vertex",
            "002 §3",
            "fog at the vertices is cheap and wrong on large triangles",
            "technique/fog-place",
            ["vertex", "fragment"],
            0.4,
            Some(true),
        ),
        (
            "fog-plane",
            "002 §3",
            "fog by depth is cheaper than by distance",
            "technique/fog-distance",
            ["plane", "radial"],
            0.65,
            Some(true),
        ),
        (
            "gamma",
            "003 §1",
            "a power of 2.2 is as good as sRGB's curve",
            "technique/srgb",
            ["gamma-2.2", "exact"],
            0.9,
            Some(false),
        ),
    ];
    let of = |(id, source, claim, group, [row, other], ratio, holds): BenchRow| Claim {
        id: id.into(),
        source: source.into(),
        claim: claim.into(),
        group: group.into(),
        rows: [row.into(), other.into()],
        ratio,
        spread: [ratio * 0.97, ratio * 1.03],
        error_is: "the largest error in 1/255".into(),
        error: Number(3.2),
        holds,
        sentence: format!("{row} takes {ratio:.2} times as long as {other}, and is off by 3.2/255 at most"),
    };
    rows.into_iter().map(of).collect()
}
