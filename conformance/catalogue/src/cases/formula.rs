//! A formula that is judged: its description, and its evaluation in any arithmetic.

use super::raster;
use super::rows::{Reader, Writer};
use super::spec::{Kind, Spec};
use lightmeter_arithmetic::{Accept, Dual, Profile, RandomLegal, Trace, dual};
use lightmeter_reference::Real;
use lightmeter_scene::along::Along;
use lightmeter_scene::raster::Raster;

/// A formula over any arithmetic.
pub trait Formula: Send + Sync + 'static {
    /// Its description.
    fn spec(&self) -> Spec;

    /// Its outputs for a row of inputs.
    fn evaluate<R: Real>(&self, x: &mut Reader<'_, R>, out: &mut Writer<'_, R>);
}

/// Is shown formulas one by one, each of a type of its own.
pub trait Visitor {
    /// The next formula.
    fn formula<F: Formula>(&mut self, formula: F);
}

/// A formula in the arithmetics of the suite, its type forgotten.
pub trait AnyFormula: Send + Sync {
    /// Its description.
    fn spec(&self) -> Spec;

    /// The reference.
    fn reference(&self, inputs: &[f32], out: &mut [f64]);

    /// The embedded implementation in f32.
    fn embedded(&self, inputs: &[f32], out: &mut [f32]);

    /// The values that a profile makes legal in the programmable stages.
    fn interval(&self, inputs: &[f32], profile: &Profile, out: &mut [Accept]);

    /// The same for many rows of inputs, `stride` numbers each.
    fn intervals(&self, rows: &[f32], stride: usize, profile: &Profile, out: &mut [Accept]);

    /// The outputs for a row of inputs of f64.
    fn on_f64(&self, inputs: &[f64], out: &mut [f64]);

    /// The same of f32.
    fn on_f32(&self, inputs: &[f32], out: &mut [f32]);

    /// The same of intervals, inside [`Profile::scope`].
    fn on_accept(&self, inputs: &[Accept], out: &mut [Accept]);

    /// The same of legal evaluations drawn at random, inside [`Profile::scope`].
    fn on_draw(&self, inputs: &[RandomLegal], out: &mut [RandomLegal]);

    /// The values that a profile makes legal as they leave a rasteriser, which snaps positions to the profile's subpixel bits.
    fn raster_interval(&self, kind: Raster, inputs: &[f32], profile: &Profile, out: &mut [Accept]);

    /// The values that a profile makes legal where nothing else is known: of a raster formula those of a rasteriser.
    fn promised_interval(&self, kind: Kind, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        match kind {
            Kind::Raster(raster) => self.raster_interval(raster, inputs, profile, out),
            Kind::Arithmetic | Kind::Blend(_) | Kind::Depth(_) => self.interval(inputs, profile, out),
        }
    }

    /// The reference and the interval of each output, with the steps that lead to them.
    fn trace(&self, inputs: &[f32], profile: &Profile, out: &mut [Trace]);

    /// The outputs with their derivatives with respect to each input in turn.
    fn derivatives(&self, inputs: &[f32]) -> Vec<Vec<Dual>>;

    /// The condition number of each output.
    fn condition(&self, inputs: &[f32]) -> Vec<f64> {
        let by_input = self.derivatives(inputs);
        let outputs = by_input.first().map_or(0, Vec::len);
        (0..outputs).map(|output| dual::condition(inputs, &by_input, output)).collect()
    }

    /// One output of the reference along one input: for each of `inputs` in the place of the row's free number.
    fn reference_along(&self, along: &Along<'_>, inputs: &[f32], out: &mut [f64]);

    /// The same of the embedded implementation.
    fn embedded_along(&self, along: &Along<'_>, inputs: &[f32], out: &mut [f32]);

    /// The values of that output that a profile makes legal in the programmable stages.
    fn interval_along(&self, along: &Along<'_>, inputs: &[f32], profile: &Profile, out: &mut [Accept]);

    /// What is legal of that output somewhere while the free number goes from `first` to `last`.
    fn interval_between(&self, along: &Along<'_>, first: f32, last: f32, profile: &Profile) -> Accept;
}

/// Room for the inputs of any formula, so that a row is widened without an allocation.
const MOST_INPUTS: usize = 80;
/// Room for the outputs of any formula.
const MOST_OUTPUTS: usize = 16;

/// Widens a row of inputs for an evaluation.
fn run<R: Real>(inputs: &[f32], evaluate: impl FnOnce(&[R])) {
    let mut row = [R::literal(0.0); MOST_INPUTS];
    for (wide, &narrow) in row.iter_mut().zip(inputs) {
        *wide = R::input(narrow);
    }
    evaluate(&row[..inputs.len()]);
}

/// The same along one input, in a loop of the formula's own type.
fn run_along<F: Formula, R: Real>(formula: &F, along: &Along<'_>, inputs: impl Iterator<Item = R>, out: &mut [R]) {
    let mut row = [R::literal(0.0); MOST_INPUTS];
    for (wide, &narrow) in row.iter_mut().zip(along.row) {
        *wide = R::input(narrow);
    }
    let mut outputs = [R::literal(0.0); MOST_OUTPUTS];
    for (input, out) in inputs.zip(out) {
        row[along.free] = input;
        formula.evaluate(&mut Reader::new(&row[..along.row.len()]), &mut Writer::only(&mut outputs, along.output));
        *out = outputs[along.output];
    }
}

impl<F: Formula> AnyFormula for F {
    fn spec(&self) -> Spec {
        Formula::spec(self)
    }

    fn reference(&self, inputs: &[f32], out: &mut [f64]) {
        run(inputs, |row| self.on_f64(row, out));
    }

    fn embedded(&self, inputs: &[f32], out: &mut [f32]) {
        self.on_f32(inputs, out);
    }

    fn interval(&self, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        profile.scope(|| run(inputs, |row| self.on_accept(row, out)));
    }

    fn intervals(&self, rows: &[f32], stride: usize, profile: &Profile, out: &mut [Accept]) {
        let outputs = out.len() / (rows.len() / stride);
        profile.scope(|| {
            for (inputs, out) in rows.chunks_exact(stride).zip(out.chunks_exact_mut(outputs)) {
                run(inputs, |row| self.on_accept(row, out));
            }
        });
    }

    #[inline(never)]
    fn on_f64(&self, inputs: &[f64], out: &mut [f64]) {
        self.evaluate(&mut Reader::new(inputs), &mut Writer::new(out));
    }

    #[inline(never)]
    fn on_f32(&self, inputs: &[f32], out: &mut [f32]) {
        self.evaluate(&mut Reader::new(inputs), &mut Writer::new(out));
    }

    #[inline(never)]
    fn on_accept(&self, inputs: &[Accept], out: &mut [Accept]) {
        self.evaluate(&mut Reader::new(inputs), &mut Writer::new(out));
    }

    #[inline(never)]
    fn on_draw(&self, inputs: &[RandomLegal], out: &mut [RandomLegal]) {
        self.evaluate(&mut Reader::new(inputs), &mut Writer::new(out));
    }

    fn raster_interval(&self, kind: Raster, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        match kind {
            Raster::Flat { .. } | Raster::SameDepth(_) => self.interval(inputs, profile, out),
            _ => profile.scope(|| raster::interval(kind, inputs, profile.subpixel_bits, out)),
        }
    }

    fn trace(&self, inputs: &[f32], profile: &Profile, out: &mut [Trace]) {
        profile.scope(|| run(inputs, |row| self.evaluate(&mut Reader::new(row), &mut Writer::new(out))));
    }

    fn derivatives(&self, inputs: &[f32]) -> Vec<Vec<Dual>> {
        let outputs = Formula::spec(self).output_len();
        (0..inputs.len())
            .map(|moved| {
                let row: Vec<Dual> = inputs
                    .iter()
                    .enumerate()
                    .map(|(k, &x)| if k == moved { Dual::variable(x.into()) } else { Dual::constant(x.into()) })
                    .collect();
                let mut out = vec![Dual::constant(0.0); outputs];
                self.evaluate(&mut Reader::new(&row), &mut Writer::new(&mut out));
                out
            })
            .collect()
    }
    fn reference_along(&self, along: &Along<'_>, inputs: &[f32], out: &mut [f64]) {
        run_along(self, along, inputs.iter().map(|&x| x.into()), out);
    }

    fn embedded_along(&self, along: &Along<'_>, inputs: &[f32], out: &mut [f32]) {
        run_along(self, along, inputs.iter().copied(), out);
    }

    fn interval_along(&self, along: &Along<'_>, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        profile.scope(|| run_along(self, along, inputs.iter().map(|&x| Accept::input(x)), out));
    }

    fn interval_between(&self, along: &Along<'_>, first: f32, last: f32, profile: &Profile) -> Accept {
        let mut out = [Accept::ANY];
        let range = std::iter::once(Accept::from_bounds(first.into(), last.into()));
        profile.scope(|| run_along(self, along, range, &mut out));
        out[0]
    }
}

/// Defines a formula of a fixed description.
#[macro_export]
macro_rules! formula {
    (
        $(#[$doc:meta])* $name:ident: $id:literal by $function:literal,
        $text:literal, $source:literal, $(normalised $normalised:literal,)?
        [$($input:expr),* $(,)?] -> [$($output:expr),* $(,)?],
        $(fit $fit:expr,)?
        $(kind $kind:expr,)?
        $(stable $bound:literal $size:ident $because:literal,)?
        |$x:ident, $out:ident| $body:block
        $(, hard [$($hard:expr),* $(,)?])? $(,)?
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        struct $name;

        impl $crate::cases::Formula for $name {
            fn spec(&self) -> $crate::cases::Spec {
                const NORMALISED: &[bool] = &[$($normalised)?];
                const FIT: &[fn(&mut [f32])] = &[$($fit)?];
                const KIND: &[$crate::cases::Kind] = &[$($kind)?];
                const INPUTS: &[$crate::cases::Input] = &[$($input),*];
                const OUTPUTS: &[$crate::cases::Output] = &[$($output),*];
                const HARD: &[$crate::cases::Hard] = &[$($($hard),*)?];
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
                    inputs: INPUTS,
                    outputs: OUTPUTS,
                    fit: FIT.first().copied(),
                    hard: HARD,
                    stable: STABLE.first().copied(),
                    is_normalised: NORMALISED.contains(&true),
                }
            }

            fn evaluate<R: $crate::Real>(
                &self,
                $x: &mut $crate::cases::Reader<'_, R>,
                $out: &mut $crate::cases::Writer<'_, R>,
            ) $body
        }
    };
}
pub use formula;
