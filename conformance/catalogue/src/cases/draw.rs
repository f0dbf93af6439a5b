//! Inputs drawn by counter: those of case k follow from the generator's version, the seed, the formula's id and k alone,
//! so that shards, baselines and a case shown by itself agree.

use super::program::Program;
use super::spec::{Domain, Hard, Input, Kind, Spec, ValueShape};
use lightmeter_scene::blend::{Equation, Factor, Separate, State};

/// Raised whenever the same seed would give other inputs.
pub const GENERATOR_VERSION: u64 = 4;
/// The version by which random inputs are drawn. It stays where boundary cases alone change, so that each random case keeps its inputs.
const DRAWN_BY: u64 = 3;

/// What the random cases of a formula by one seed have in common, worked out once for all of them.
#[derive(Debug)]
pub struct Drawing<'a> {
    spec: &'a Spec,
    path: u64,
    /// The binary logarithms of each input's bounds, where it is drawn evenly in the logarithm.
    bounds: Vec<[f64; 2]>,
}

impl<'a> Drawing<'a> {
    /// Of a formula and a seed.
    #[must_use]
    pub fn new(spec: &'a Spec, seed: u64) -> Self {
        let bounds = |input: &Input| match input.domain {
            Domain::LogUniform(low, high) | Domain::Vector(low, high) | Domain::Transform(low, high) => {
                [low, high].map(|bound| core_math::log2(bound.into()))
            }
            _ => [0.0; 2],
        };
        Self { spec, path: path(&spec.id, seed), bounds: spec.inputs.iter().map(bounds).collect() }
    }

    /// The inputs of random case `k`, appended to a row.
    pub fn inputs(&self, k: u64, row: &mut Vec<f32>) {
        let mut numbers = Numbers::new(self.path, k);
        let start = row.len();
        if let Kind::Blend(Program::Draw(state, _)) = self.spec.kind {
            blend_pair(self.path, state, k, row);
            return;
        }
        for (input, &bounds) in self.spec.inputs.iter().zip(&self.bounds) {
            draw(input, bounds, &mut numbers, row);
        }
        if let Some(fit) = self.spec.fit {
            fit(self.spec, &mut row[start..]);
        }
    }
}

/// What follows from the generator's version, the seed and a formula's id.
fn path(id: &str, seed: u64) -> u64 {
    // FNV-1a of the id, then mixed with the rest.
    let hash = id.bytes().fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    mix(hash ^ mix(seed ^ mix(DRAWN_BY)))
}

impl Input {
    /// Whether any number between two others will do.
    const fn is_continuous(&self) -> bool {
        !matches!(self.domain, Domain::Whole(..) | Domain::Halves(..) | Domain::Pixel)
    }

    /// Whether a negative number has no meaning.
    fn is_never_negative(&self) -> bool {
        match self.domain {
            Domain::Uniform(low, _) => low >= 0.0,
            Domain::LogUniform(..) | Domain::Unit | Domain::Weights => true,
            _ => false,
        }
    }

    /// A value in the middle of the domain, for the inputs that a hard case leaves open.
    pub fn middle(&self, row: &mut Vec<f32>) {
        let middle = match self.domain {
            Domain::Uniform(low, high) | Domain::Halves(low, high) => low.midpoint(high),
            Domain::LogUniform(low, high) => (low * high).sqrt(),
            Domain::Unit | Domain::Around => 0.5,
            Domain::Whole(low, _) => small(low),
            Domain::Pixel => 128.0,
            Domain::Weights => 1.0 / small(u32::try_from(self.shape.components()).unwrap_or(1)),
            Domain::Direction | Domain::Vector(..) => {
                row.extend([0.0, 0.0, 1.0]);
                return;
            }
            Domain::Transform(..) => {
                let side = if self.shape == ValueShape::Mat4 { 4 } else { 3 };
                row.extend((0..side * side).map(|k| if k % (side + 1) == 0 { 1.0 } else { 0.0 }));
                return;
            }
        };
        row.extend(std::iter::repeat_n(middle, self.shape.components()));
    }
}

/// Moves the numbers that a hard case gives by a few ULP, up or down, the k-th way.
///
/// Whole numbers stay, and so does a 0 among other components. A 0 by itself becomes one of the least normal numbers, of
/// either sign where the input may be negative. At an end of what the formula is for all stay.
pub fn move_by_ulps(spec: &Spec, hard: &Hard, k: u64, row: &mut [f32]) {
    const FARTHEST: u64 = 3;
    if hard.is_at_an_end {
        return;
    }
    let mut numbers = Numbers::new(path(&format!("{}/hard/{}", spec.id, hard.name), 0), k);
    for input in spec.inputs {
        let is_given = hard.inputs.iter().any(|(name, _)| *name == input.name);
        let Some(range) = spec.place(input.name).filter(|_| is_given && input.is_continuous()) else { continue };
        let is_zero = row[range.clone()].iter().all(|&x| x == 0.0);
        for x in &mut row[range] {
            let steps = numbers.next() >> 7;
            let (count, up) = (1 + steps % FARTHEST, steps >> 32 & 1 == 1);
            // A third stays where it is, so that one input is moved alone too.
            if numbers.next().is_multiple_of(3) || (*x == 0.0 && !is_zero) {
                continue;
            }
            if *x == 0.0 {
                *x = if up || input.is_never_negative() { f32::MIN_POSITIVE } else { -f32::MIN_POSITIVE };
                continue;
            }
            for _ in 0..count {
                *x = if up { x.next_up() } else { x.next_down() };
            }
        }
    }
}

fn draw(input: &Input, bounds: [f64; 2], numbers: &mut Numbers, row: &mut Vec<f32>) {
    let len = input.shape.components();
    match input.domain {
        Domain::Around => row.extend((0..len).map(|_| numbers.uniform(0.0, 1.0))),
        Domain::Uniform(low, high) => row.extend((0..len).map(|_| numbers.uniform(low, high))),
        Domain::LogUniform(..) => row.extend((0..len).map(|_| numbers.log_uniform(bounds))),
        Domain::Unit => row.extend((0..len).map(|_| numbers.unit())),
        Domain::Direction => row.extend(numbers.direction(1.0)),
        Domain::Vector(..) => {
            let length = numbers.log_uniform(bounds);
            row.extend(numbers.direction(length.into()));
        }
        Domain::Weights => numbers.weights(len, row),
        Domain::Whole(low, high) => row.extend((0..len).map(|_| numbers.whole(low, high))),
        Domain::Halves(low, high) => {
            let steps = whole((high - low) * 2.0);
            row.extend((0..len).map(|_| low + numbers.whole(0, steps) * 0.5));
        }
        Domain::Transform(..) => numbers.transform(input.shape, bounds, row),
        Domain::Pixel => row.extend(numbers.pixel()),
    }
}

/// The corners that source and destination take together.
const CORNERS: [f32; 7] =
    [0.0, 1.0, 0.5, 1.0 / 255.0, 254.0 / 255.0, f32::from_bits(0x3f7f_ffff), f32::from_bits(0x3f80_0001)];
/// Cases after which the corners come again: twice 2¹¹, once for each constant.
const ROUND: u64 = 1 << 11;

/// Source, destination and constant of a blend state.
///
/// Even cases have a constant of [0, 1], odd ones one outside; a state has two constants. Of each 2,048 pairs 833 go
/// through all corners: each of the 7⁴ combinations of colour and alpha of both sides stands in one of the three colour
/// components. The rest are drawn: in [0, 1], in whole 255ths, beyond [0, 1], equal, or with both alphas 0 or 1.
fn blend_pair(path: u64, state: Separate, k: u64, row: &mut Vec<f32>) {
    let mut numbers = Numbers::new(path, k);
    // An odd factor permutes the pairs of a round, so that a few cases have some of each kind.
    let place = (k >> 1).wrapping_mul(0x2f5) & (ROUND - 1);
    let first_round = k >> 1 < ROUND;
    let corner = |n: u64| CORNERS[usize::try_from(n % 7).unwrap_or_default()];
    const ALPHAS: u64 = 49;
    const TRIPLES: u64 = 17;
    if first_round && place < ALPHAS * TRIPLES {
        let (alphas, triple) = (place / TRIPLES, place % TRIPLES);
        let pair = |component: u64| 3 * triple + component;
        row.extend((0..3).map(|component| corner(pair(component) / 7)));
        row.push(corner(alphas / 7));
        row.extend((0..3).map(|component| corner(pair(component))));
        row.push(corner(alphas));
    } else {
        let start = row.len();
        match numbers.next() & 7 {
            0 | 1 => row.extend((0..8).map(|_| numbers.uniform(-0.5, 1.5))),
            2 => row.extend((0..8).map(|_| numbers.whole(0, 255) / 255.0)),
            3 => {
                row.extend((0..4).map(|_| numbers.unit()));
                row.extend_from_within(start..);
            }
            4 => row.extend((0..8).map(|n| if n % 4 == 3 { numbers.whole(0, 1) } else { numbers.unit() })),
            _ => row.extend((0..8).map(|_| numbers.unit())),
        }
    }
    if !state.reads_constant() {
        row.extend([0.0; 4]);
        return;
    }
    let outside = k & 1 == 1;
    let mut numbers = Numbers::new(path, u64::MAX - u64::from(outside));
    row.extend((0..4).map(|_| match (outside, numbers.next() & 1) {
        (false, _) => numbers.uniform(0.0, 1.0),
        (true, 0) => numbers.uniform(-0.5, 0.0),
        (true, _) => numbers.uniform(1.0, 1.5),
    }));
}

/// States drawn from the (15 × 15 × 5)² with separate ones for colour and alpha.
pub(super) fn separate_states(seed: u64, count: u64) -> Vec<Separate> {
    let path = path("blend/separate", seed);
    let draw = |k| {
        let mut numbers = Numbers::new(path, k);
        let mut below = |n: usize| usize::try_from((numbers.next() >> 32) % n as u64).unwrap_or_default();
        let mut state =
            || State { equation: Equation::ALL[below(5)], src: Factor::ALL[below(15)], dst: Factor::ALL[below(15)] };
        Separate { color: state(), alpha: state() }
    };
    (0..count).map(draw).collect()
}

/// The numbers of one case.
struct Numbers {
    key: u64,
    k: u64,
    path: u64,
    drawn: u64,
}

impl Numbers {
    const fn new(path: u64, k: u64) -> Self {
        Self { key: mix(path ^ mix(k)), k, path, drawn: 0 }
    }

    fn next(&mut self) -> u64 {
        self.drawn += 1;
        mix(self.key.wrapping_add(self.drawn.wrapping_mul(0x9e37_79b9_7f4a_7c15)))
    }

    /// Evenly in [0, 1), in steps of 2⁻⁵³.
    fn fraction(&mut self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "53 bits fit an f64")]
        let fraction = (self.next() >> 11) as f64 / (1u64 << 53) as f64;
        fraction
    }

    fn uniform(&mut self, low: f32, high: f32) -> f32 {
        let (low, high) = (f64::from(low), f64::from(high));
        narrow(low + self.fraction() * (high - low))
    }

    /// Evenly in the logarithm, between bounds whose binary logarithms these are.
    fn log_uniform(&mut self, [low, high]: [f64; 2]) -> f32 {
        narrow(core_math::exp2(low + self.fraction() * (high - low)))
    }

    fn unit(&mut self) -> f32 {
        match self.next() & 31 {
            0 => 0.0,
            1 => 1.0,
            _ => self.uniform(0.0, 1.0),
        }
    }

    fn whole(&mut self, low: u32, high: u32) -> f32 {
        let span = u64::from(high - low) + 1;
        low_bits(u64::from(low) + (self.next() >> 16) % span)
    }

    /// A vector of that length whose direction is evenly distributed.
    fn direction(&mut self, length: f64) -> [f32; 3] {
        let z = 2.0 * self.fraction() - 1.0;
        let angle = std::f64::consts::TAU * self.fraction();
        let r = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = core_math::sincos(angle);
        [r * cos, r * sin, z].map(|x| narrow(x * length))
    }

    fn weights(&mut self, len: usize, row: &mut Vec<f32>) {
        let mut cuts: Vec<f64> = (1..len).map(|_| self.fraction()).collect();
        cuts.sort_by(f64::total_cmp);
        let mut last = 0.0;
        let start = row.len();
        for cut in cuts {
            row.push(narrow(cut - last));
            last = cut;
        }
        let rest: f64 = row[start..].iter().map(|&w| f64::from(w)).sum();
        row.push(narrow((1.0 - rest).max(0.0)));
    }

    fn transform(&mut self, shape: ValueShape, bounds: [f64; 2], row: &mut Vec<f32>) {
        // A random unit quaternion (Shoemake), then a scale of each axis.
        let (u, a, b) = (self.fraction(), self.fraction(), self.fraction());
        let (a, b) = (a * std::f64::consts::TAU, b * std::f64::consts::TAU);
        let (p, q) = ((1.0 - u).sqrt(), u.sqrt());
        let ((sin_a, cos_a), (sin_b, cos_b)) = (core_math::sincos(a), core_math::sincos(b));
        let (x, y, z, w) = (p * sin_a, p * cos_a, q * sin_b, q * cos_b);
        let columns = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)],
            [2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)],
            [2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        // Scaled along each axis, one of them mirrored half the time, then sheared: no two columns at right angles.
        let mirrored = if self.next() & 1 == 0 { 1.0 } else { -1.0 };
        let scales = [0, 1, 2].map(|axis| f64::from(self.log_uniform(bounds)) * if axis == 0 { mirrored } else { 1.0 });
        let shears: [f64; 3] = std::array::from_fn(|_| self.fraction() - 0.5);
        let scaled = [0, 1, 2].map(|k| columns[k].map(|x: f64| x * scales[k]));
        let plus = |a: [f64; 3], b: [f64; 3], s: f64| [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
        let second = plus(scaled[1], scaled[0], shears[0]);
        let third = plus(plus(scaled[2], scaled[0], shears[1]), scaled[1], shears[2]);
        for column in [scaled[0], second, third] {
            row.extend(column.map(narrow));
            if shape == ValueShape::Mat4 {
                row.push(self.uniform(-0.01, 0.01));
            }
        }
        if shape == ValueShape::Mat4 {
            // From ½ to 2.
            let w = self.log_uniform([-1.0, 1.0]);
            row.extend([self.uniform(-10.0, 10.0), self.uniform(-10.0, 10.0), self.uniform(-10.0, 10.0), w]);
        }
    }

    /// A pixel in [64, 192)². Multiplication by an odd number permutes the 2¹⁴ of them.
    fn pixel(&self) -> [f32; 2] {
        let place = self.k.wrapping_mul(0x2545).wrapping_add(self.path) & 0x3fff;
        [low_bits(64 + (place & 127)), low_bits(64 + (place >> 7))]
    }
}

/// The finaliser of SplitMix64: a permutation of all numbers that leaves no pattern.
#[must_use]
pub const fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[expect(clippy::cast_possible_truncation, reason = "inputs are the nearest f32")]
pub(super) const fn narrow(x: f64) -> f32 {
    x as f32
}

#[expect(clippy::cast_precision_loss, reason = "whole numbers below 2²⁴ are exact")]
const fn low_bits(x: u64) -> f32 {
    (x & 0xff_ffff) as f32
}

fn small(x: u32) -> f32 {
    low_bits(x.into())
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive whole number")]
const fn whole(x: f32) -> u32 {
    x as u32
}
