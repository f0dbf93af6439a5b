//! The inputs that a formula is certified on: the suite's own random and hard cases, and edges.
//!
//! An edge is a random case in which one number stands at an end: of its domain, before the formula's numbers are made to
//! fit each other; or, for arithmetic, at 0, ±1, the least normal and subnormal, 1e±30, or another of the case's numbers, a
//! last bit beside it or negated.

use lightmeter::cases::{Domain, Drawing, Kind, Spec};
use lightmeter::select::{CaseRef, Member, random_cases};

/// The seed of random cases, that of a run.
const SEED: u64 = 1;
/// The seed of the cases that edges are made from.
const EDGE_SEED: u64 = 2;

/// A row of inputs and what it is called.
pub(super) struct Row {
    pub(super) name: String,
    pub(super) inputs: Vec<f32>,
}

/// What a number is set to, whatever its domain.
const EXTREMES: [(&str, f32); 10] = [
    ("0", 0.0),
    ("1", 1.0),
    ("−1", -1.0),
    ("the least normal", f32::MIN_POSITIVE),
    ("the least subnormal", f32::from_bits(1)),
    ("a subnormal", -1e-40),
    ("1e-30", 1e-30),
    ("−1e-30", -1e-30),
    ("1e30", 1e30),
    ("−1e30", -1e30),
];

/// What a number is made of another, and how that is told.
type Made = (&'static str, fn(f32) -> f32);

/// What a number is set to beside another.
const BESIDE: [Made; 4] = [("", |x| x), ("just above ", f32::next_up), ("just below ", f32::next_down), ("−", |x| -x)];

/// The rows of a formula: its random cases, and all others.
pub(super) fn rows(member: &Member, cases: u64) -> Vec<Row> {
    let spec = &member.spec;
    let near = |place| (0..member.near()).map(move |k| CaseRef::Near(place, k));
    let hard = (0..spec.hard.len()).flat_map(|place| std::iter::once(CaseRef::Hard(place)).chain(near(place)));
    let boundary = (0..member.boundary()).map(CaseRef::Boundary);
    let random = (0..random_cases(spec, cases)).map(CaseRef::Random);
    let mut rows: Vec<Row> = hard
        .chain(boundary)
        .chain(random)
        .map(|case| {
            let mut inputs = vec![];
            member.inputs(case, SEED, &mut inputs);
            Row { name: member.case_id(case), inputs }
        })
        .collect();
    if random_cases(spec, 1) > 0 {
        edges(spec, &mut rows);
        if !matches!(spec.kind, Kind::Raster(_)) {
            vector_edges(spec, &mut rows);
        }
    }
    rows
}

fn edges(spec: &Spec, rows: &mut Vec<Row>) {
    let loose = Spec { fit: None, ..spec.clone() };
    let names = names(spec);
    for (at, (name, domain)) in names.iter().enumerate() {
        let case = at as u64;
        let mut push = |inputs: Vec<f32>, what: String| {
            rows.push(Row { name: format!("{}: {name} = {what}", spec.id), inputs });
        };
        for end in ends(*domain) {
            let mut row = vec![];
            Drawing::new(&loose, EDGE_SEED).inputs(case, &mut row);
            row[at] = end;
            if let Some(fit) = spec.fit {
                fit(spec, &mut row);
            }
            // A fit may move the number that was put there. What a rasteriser is drawn with, it makes of raw numbers.
            if matches!(spec.kind, Kind::Arithmetic) {
                row[at] = end;
            }
            push(row, format!("{end:e}"));
        }
        // What a rasteriser may give is bounded for what lies around the pixel alone, as the domains do.
        if matches!(spec.kind, Kind::Raster(_)) {
            continue;
        }
        let mut row = vec![];
        Drawing::new(spec, EDGE_SEED).inputs(case, &mut row);
        let with = |x: f32| {
            let mut row = row.clone();
            row[at] = x;
            row
        };
        for (what, x) in EXTREMES {
            push(with(x), what.into());
        }
        // A step that shares no factor with few lengths: others of the same vector, and of others.
        for step in [1, 3] {
            let other = (at + step) % row.len();
            if other == at {
                continue;
            }
            for (what, beside) in BESIDE {
                push(with(beside(row[other])), format!("{what}{}", names[other].0));
            }
        }
    }
}

/// A whole vector, matrix or set of weights as another of the case's, so that they cancel or coincide.
fn vector_edges(spec: &Spec, rows: &mut Vec<Row>) {
    /// Three times as long, and no longer to be told from its negative by its digits.
    const FACES: [Made; 5] = [
        ("", |x| x),
        ("−", |x| -x),
        ("−3·", |x| -3.0 * x),
        ("just beside ", f32::next_up),
        ("just beside −", |x| (-x).next_up()),
    ];
    let places: Vec<(&str, usize, usize)> = spec
        .inputs
        .iter()
        .scan(0, |start, input| {
            let (at, len) = (*start, input.shape.components());
            *start += len;
            Some((input.name, at, len))
        })
        .filter(|(_, _, len)| *len > 1)
        .collect();
    let pairs = places.iter().flat_map(|a| places.iter().map(move |b| (a, b)));
    for (case, ((name, to, len), (other, from, _))) in (0_u64..).zip(pairs.filter(|(a, b)| a.1 != b.1 && a.2 == b.2)) {
        for (what, face) in FACES {
            let mut row = vec![];
            Drawing::new(spec, EDGE_SEED).inputs(case, &mut row);
            for k in 0..*len {
                row[to + k] = face(row[from + k]);
            }
            rows.push(Row { name: format!("{}: {name} = {what}{other}", spec.id), inputs: row });
        }
    }
}

/// The name and the domain of each number of a row.
fn names(spec: &Spec) -> Vec<(String, Domain)> {
    let of = |input: &lightmeter::cases::Input| {
        let (input, count) = (*input, input.shape.components());
        (0..count).map(move |k| {
            let name = if count == 1 { input.name.into() } else { format!("{}[{k}]", input.name) };
            (name, input.domain)
        })
    };
    spec.inputs.iter().flat_map(of).collect()
}

fn ends(domain: Domain) -> Vec<f32> {
    #[expect(clippy::cast_precision_loss, reason = "small whole numbers")]
    match domain {
        Domain::Uniform(low, high) | Domain::LogUniform(low, high) | Domain::Halves(low, high) => vec![low, high],
        Domain::Unit | Domain::Weights | Domain::Around => vec![0.0, 1.0],
        Domain::Whole(low, high) => vec![low as f32, high as f32],
        Domain::Direction => vec![-1.0, 0.0, 1.0],
        Domain::Vector(_, high) | Domain::Transform(_, high) => vec![-high, 0.0, high],
        // The pixels are another for each case already.
        Domain::Pixel => vec![],
    }
}
