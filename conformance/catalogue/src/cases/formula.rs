//! A formula that is judged: its description, and its evaluation in any arithmetic.

use super::rasteriser;
use super::rows::{Reader, Wanted, Writer};
use super::spec::{Kind, Spec};
use lightmeter_arithmetic::mistaken::Mistaken;
use lightmeter_arithmetic::{Accept, Dual, Profile, RandomLegal, Trace, dual};
use lightmeter_reference::Real;
use lightmeter_scene::along::Along;
use lightmeter_scene::raster::Raster;

/// A formula over any arithmetic.
pub trait Formula: Send + Sync + 'static {
    /// Its description.
    fn spec(&self) -> Spec;

    /// Its outputs for a row of inputs.
    fn evaluate<R: Real>(&self, x: &Reader<'_, R>, out: &mut Writer<'_, R>);
}

/// Is shown formulas one by one, each of a type of its own.
pub trait Visitor {
    /// The next formula.
    fn formula<F: Formula>(&mut self, formula: F);
}

/// A formula in the arithmetics of the suite, its type forgotten: here alone, and in each of them once, is its code made.
/// Outputs are for a row of inputs; numbers that are not wanted need not be worked out.
pub trait AnyFormula: Send + Sync {
    /// Its description.
    fn spec(&self) -> Spec;

    /// In f64: the reference.
    fn on_f64(&self, inputs: &[f64], wanted: Wanted, out: &mut [f64]);

    /// In f32: the embedded implementation.
    fn on_f32(&self, inputs: &[f32], wanted: Wanted, out: &mut [f32]);

    /// In intervals of legal values, inside [`Profile::scope`].
    fn on_accept(&self, inputs: &[Accept], wanted: Wanted, out: &mut [Accept]);

    /// In legal values drawn at random, inside [`Profile::scope`].
    fn on_draw(&self, inputs: &[RandomLegal], out: &mut [RandomLegal]);

    /// In values and intervals with the steps that lead to them, inside [`Profile::scope`].
    fn on_trace(&self, inputs: &[Trace], out: &mut [Trace]);

    /// In values with their derivatives.
    fn on_dual(&self, inputs: &[Dual], out: &mut [Dual]);

    /// In f64, steps going wrong, inside [`making`](lightmeter_arithmetic::mistaken::making).
    fn on_mistaken_f64(&self, inputs: &[Mistaken<f64>], out: &mut [Mistaken<f64>]);

    /// The same in f32.
    fn on_mistaken_f32(&self, inputs: &[Mistaken<f32>], out: &mut [Mistaken<f32>]);

    /// The same in intervals, inside [`Profile::scope`] too.
    fn on_mistaken_accept(&self, inputs: &[Mistaken<Accept>], out: &mut [Mistaken<Accept>]);
}

impl<F: Formula> AnyFormula for F {
    fn spec(&self) -> Spec {
        Formula::spec(self)
    }

    fn on_f64(&self, inputs: &[f64], wanted: Wanted, out: &mut [f64]) {
        self.evaluate(&Reader::new(inputs), &mut Writer::new(out, wanted));
    }

    fn on_f32(&self, inputs: &[f32], wanted: Wanted, out: &mut [f32]) {
        self.evaluate(&Reader::new(inputs), &mut Writer::new(out, wanted));
    }

    fn on_accept(&self, inputs: &[Accept], wanted: Wanted, out: &mut [Accept]) {
        self.evaluate(&Reader::new(inputs), &mut Writer::new(out, wanted));
    }

    fn on_draw(&self, inputs: &[RandomLegal], out: &mut [RandomLegal]) {
        self.evaluate(&Reader::new(inputs), &mut Writer::new(out, Wanted::ALL));
    }

    fn on_trace(&self, inputs: &[Trace], out: &mut [Trace]) {
        self.evaluate(&Reader::new(inputs), &mut Writer::new(out, Wanted::ALL));
    }

    fn on_dual(&self, inputs: &[Dual], out: &mut [Dual]) {
        self.evaluate(&Reader::new(inputs), &mut Writer::new(out, Wanted::ALL));
    }

    fn on_mistaken_f64(&self, inputs: &[Mistaken<f64>], out: &mut [Mistaken<f64>]) {
        self.evaluate(&Reader::new(inputs), &mut Writer::new(out, Wanted::ALL));
    }

    fn on_mistaken_f32(&self, inputs: &[Mistaken<f32>], out: &mut [Mistaken<f32>]) {
        self.evaluate(&Reader::new(inputs), &mut Writer::new(out, Wanted::ALL));
    }

    fn on_mistaken_accept(&self, inputs: &[Mistaken<Accept>], out: &mut [Mistaken<Accept>]) {
        self.evaluate(&Reader::new(inputs), &mut Writer::new(out, Wanted::ALL));
    }
}

/// Room for the inputs of any formula, so that a row is widened without an allocation.
const MOST_INPUTS: usize = 80;
/// Room for the outputs of any formula.
const MOST_OUTPUTS: usize = 16;

/// Widens a row of inputs for an evaluation.
fn widened<R: Real>(inputs: &[f32], evaluate: impl FnOnce(&[R])) {
    let mut row = [R::literal(0.0); MOST_INPUTS];
    evaluate(widened_in(&mut row, inputs));
}

/// The same where there is room already.
#[inline]
fn widened_in<'a, R: Real>(row: &'a mut [R; MOST_INPUTS], inputs: &[f32]) -> &'a [R] {
    for (wide, &narrow) in row.iter_mut().zip(inputs) {
        *wide = R::input(narrow);
    }
    &row[..inputs.len()]
}

/// Evaluates one output for each of `inputs` in the place of the row's free number.
fn evaluate_along<R: Real>(
    along: &Along<'_>,
    inputs: impl Iterator<Item = R>,
    out: &mut [R],
    evaluate: impl Fn(&[R], Wanted, &mut [R]),
) {
    let mut row = [R::literal(0.0); MOST_INPUTS];
    widened_in(&mut row, along.row);
    let mut outputs = [R::literal(0.0); MOST_OUTPUTS];
    for (input, out) in inputs.zip(out) {
        row[along.free] = input;
        evaluate(&row[..along.row.len()], Wanted::only(along.output), &mut outputs);
        *out = outputs[along.output];
    }
}

impl dyn AnyFormula + '_ {
    /// The reference.
    #[inline]
    pub fn reference(&self, inputs: &[f32], out: &mut [f64]) {
        widened(inputs, |row| self.on_f64(row, Wanted::ALL, out));
    }

    /// The reference of many rows of inputs, `stride` numbers each.
    pub fn references(&self, rows: &[f32], stride: usize, out: &mut [f64]) {
        let outputs = out.len() / (rows.len() / stride);
        let mut row = [0.0; MOST_INPUTS];
        for (inputs, out) in rows.chunks_exact(stride).zip(out.chunks_exact_mut(outputs)) {
            self.on_f64(widened_in(&mut row, inputs), Wanted::ALL, out);
        }
    }

    /// The embedded implementation in f32.
    #[inline]
    pub fn embedded(&self, inputs: &[f32], out: &mut [f32]) {
        self.on_f32(inputs, Wanted::ALL, out);
    }

    /// The values that a profile makes legal in the programmable stages.
    #[inline]
    pub fn interval(&self, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        profile.scope(|| widened(inputs, |row| self.on_accept(row, Wanted::ALL, out)));
    }

    /// The same for many rows of inputs, `stride` numbers each.
    pub fn intervals(&self, rows: &[f32], stride: usize, profile: &Profile, out: &mut [Accept]) {
        let outputs = out.len() / (rows.len() / stride);
        profile.scope(|| {
            let mut row = [Accept::exactly(0.0); MOST_INPUTS];
            for (inputs, out) in rows.chunks_exact(stride).zip(out.chunks_exact_mut(outputs)) {
                self.on_accept(widened_in(&mut row, inputs), Wanted::ALL, out);
            }
        });
    }

    /// The values that a profile makes legal as they leave a rasteriser, which snaps positions to the profile's subpixel bits.
    pub fn raster_interval(&self, kind: Raster, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        match kind {
            Raster::Flat { .. } | Raster::SameDepth(_) => self.interval(inputs, profile, out),
            // If a vertex or an attribute is NaN or infinite, any result is legal.
            _ if inputs.iter().any(|x| !x.is_finite()) => out.fill(Accept::ANY),
            _ => profile.scope(|| rasteriser::interval(kind, inputs, profile.subpixel_bits, out)),
        }
    }

    /// The values that a profile makes legal where nothing else is known: of a raster formula those of a rasteriser.
    pub fn promised_interval(&self, kind: Kind, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        match kind {
            Kind::Raster(raster) => self.raster_interval(raster, inputs, profile, out),
            Kind::Arithmetic | Kind::Blend(_) | Kind::Depth(_) => self.interval(inputs, profile, out),
        }
    }

    /// The reference and the interval of each output, with the steps that lead to them.
    pub fn trace(&self, inputs: &[f32], profile: &Profile, out: &mut [Trace]) {
        profile.scope(|| widened(inputs, |row| self.on_trace(row, out)));
    }

    /// The outputs with their derivatives with respect to each input in turn.
    #[must_use]
    pub fn derivatives(&self, inputs: &[f32]) -> Vec<Vec<Dual>> {
        let outputs = self.spec().output_len();
        let mut row: Vec<Dual> = inputs.iter().map(|&x| Dual::constant(x.into())).collect();
        let with_respect_to = |(k, &input): (usize, &f32)| {
            row[k] = Dual::variable(input.into());
            let mut out = vec![Dual::constant(0.0); outputs];
            self.on_dual(&row, &mut out);
            row[k] = Dual::constant(input.into());
            out
        };
        inputs.iter().enumerate().map(with_respect_to).collect()
    }

    /// The condition number of each output.
    #[must_use]
    pub fn condition(&self, inputs: &[f32]) -> Vec<f64> {
        let by_input = self.derivatives(inputs);
        let outputs = by_input.first().map_or(0, Vec::len);
        (0..outputs).map(|output| dual::condition(inputs, &by_input, output)).collect()
    }

    /// One output of the reference along one input: for each of `inputs` in the place of the row's free number.
    pub fn reference_along(&self, along: &Along<'_>, inputs: &[f32], out: &mut [f64]) {
        let inputs = inputs.iter().map(|&x| x.into());
        evaluate_along(along, inputs, out, |row, wanted, out| self.on_f64(row, wanted, out));
    }

    /// The same of the embedded implementation.
    pub fn embedded_along(&self, along: &Along<'_>, inputs: &[f32], out: &mut [f32]) {
        let inputs = inputs.iter().copied();
        evaluate_along(along, inputs, out, |row, wanted, out| self.on_f32(row, wanted, out));
    }

    /// The values of that output that a profile makes legal in the programmable stages.
    pub fn interval_along(&self, along: &Along<'_>, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        self.legal_along(along, inputs.iter().map(|&x| Accept::input(x)), profile, out);
    }

    /// What is legal of that output somewhere while the free number goes from `first` to `last`.
    #[must_use]
    pub fn interval_between(&self, along: &Along<'_>, first: f32, last: f32, profile: &Profile) -> Accept {
        let mut out = [Accept::ANY];
        let range = std::iter::once(Accept::from_bounds(first.into(), last.into()));
        self.legal_along(along, range, profile, &mut out);
        out[0]
    }

    fn legal_along(
        &self,
        along: &Along<'_>,
        inputs: impl Iterator<Item = Accept>,
        profile: &Profile,
        out: &mut [Accept],
    ) {
        profile.scope(|| evaluate_along(along, inputs, out, |row, wanted, out| self.on_accept(row, wanted, out)));
    }
}

/// Takes inputs off a row by their names: `bind!(x, INPUTS => src, dst)` binds `src` and `dst`. A name that the inputs
/// do not have is an error of compilation.
#[macro_export]
macro_rules! bind {
    ($x:ident, $inputs:expr => $($name:ident),+) => {
        $(let $name = $x.at(const { $crate::cases::slot($inputs, stringify!($name)) });)+
    };
}
pub use bind;

/// Defines a formula of a fixed description. Its body names the inputs that it takes, and then where outputs go.
#[macro_export]
macro_rules! formula {
    (
        $(#[$doc:meta])* $name:ident: $id:literal by $function:literal,
        $text:literal, $source:literal, $(normalised $normalised:literal,)?
        [$($input:expr),* $(,)?] -> [$($output:expr),* $(,)?],
        $(fit $fit:expr,)?
        $(within $within:expr,)?
        $(kind $kind:expr,)?
        $(stable $bound:literal $size:ident $because:literal,)?
        |$($taken:ident),+; $out:ident| $body:block
        $(, hard [$($hard:expr),* $(,)?])? $(,)?
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        struct $name;

        impl $name {
            const INPUTS: &[$crate::cases::Input] = &[$($input),*];
        }

        impl $crate::cases::Formula for $name {
            fn spec(&self) -> $crate::cases::Spec {
                const NORMALISED: &[bool] = &[$($normalised)?];
                const FIT: &[fn(&$crate::cases::Spec, &mut [f32])] = &[$($fit)?];
                const WITHIN: &[fn(&mut [f32])] = &[$($within)?];
                const KIND: &[$crate::cases::Kind] = &[$($kind)?];
                const OUTPUTS: &[$crate::cases::Output] = &[$($output),*];
                const OWN: &[$crate::cases::Hard] = &[$($($hard),*)?];
                const COLORS: usize = $crate::cases::colors($name::INPUTS);
                const GIVEN: usize = $crate::cases::given_beyond($name::INPUTS);
                const BEYOND: [(&str, &[f32]); GIVEN] = $crate::cases::beyond($name::INPUTS);
                $crate::cases::formula::placed!(
                    $name; NONE Lit Some(&[0.0]); HALF Lit Some(&[0.5]); FROM_BEHIND Behind Some(&[0.5]); SHORT Short None;
                    NO_NORMAL NO_NORMAL Some(&[2.0]); NO_NORMAL_BEHIND NO_NORMAL_BEHIND Some(&[2.0]);
                    NO_LIGHT NO_LIGHT Some(&[2.0]); NO_LIGHT_BEHIND NO_LIGHT_BEHIND Some(&[2.0]);
                    NO_VIEW NO_VIEW Some(&[2.0]); NO_VIEW_BEHIND NO_VIEW_BEHIND Some(&[2.0]);
                    NO_VIEW_GRAZING NO_VIEW_GRAZING Some(&[2.0])
                );
                const COMMON: $crate::cases::CommonCases = $crate::cases::CommonCases {
                    beyond: &BEYOND,
                    no_shininess: NONE,
                    half: HALF,
                    behind: FROM_BEHIND,
                    short: SHORT,
                    lacking: [[NO_NORMAL, NO_NORMAL_BEHIND], [NO_LIGHT, NO_LIGHT_BEHIND], [NO_VIEW, NO_VIEW_BEHIND]],
                    grazing: NO_VIEW_GRAZING,
                };
                const HARD: &[$crate::cases::Hard] = &{
                    const ALL: [$crate::cases::Hard; OWN.len() + COMMON.count(COLORS > 0)] =
                        $crate::cases::and_common(OWN, COLORS > 0, &COMMON);
                    ALL
                };
                const STABLE: &[$crate::cases::Stable] = &[
                    $($crate::cases::Stable { bound: $bound, size: $crate::cases::Size::$size, because: $because })?
                ];
                $crate::cases::Spec {
                    id: $id.into(),
                    text: $text,
                    source: $source,
                    function: $function,
                    kind: KIND.first().copied().unwrap_or($crate::cases::Kind::Arithmetic),
                    selectors: vec![],
                    inputs: Self::INPUTS,
                    outputs: OUTPUTS,
                    fit: FIT.first().copied(),
                    within: WITHIN.first().copied(),
                    hard: HARD,
                    stable: STABLE.first().copied(),
                    is_normalised: NORMALISED.contains(&true),
                }
            }

            fn evaluate<R: $crate::Real>(
                &self,
                x: &$crate::cases::Reader<'_, R>,
                $out: &mut $crate::cases::Writer<'_, R>,
            ) {
                $crate::cases::formula::bind!(x, Self::INPUTS => $($taken),+);
                $body
            }
        }
    };
}
pub use formula;

/// Constants of the inputs of hard cases that a formula has in common with others: name, surface and shininess of each.
#[macro_export]
macro_rules! placed {
    ($formula:ident; $($name:ident $surface:ident $shininess:expr);+) => {
        $(
            const $name: $crate::cases::Values = &{
                const SURFACE: $crate::cases::Surface = $crate::cases::Surface::$surface;
                const SHININESS: Option<&[f32]> = $shininess;
                const GIVEN: usize =
                    $crate::cases::given_placed($formula::INPUTS, SURFACE, SHININESS.is_some());
                const PLACED: [(&str, &[f32]); GIVEN] =
                    $crate::cases::placed($formula::INPUTS, SURFACE, SHININESS);
                PLACED
            };
        )+
    };
}
pub use placed;
