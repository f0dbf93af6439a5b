//! What a shading language promises of its arithmetic, as data.

use std::cell::Cell;

/// A bound that grows with the argument: `base + slope·|x|` ULP.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrowingUlp {
    /// ULP at 0.
    pub base: f64,
    /// ULP per unit of |x|.
    pub slope: f64,
}

/// A driver's excess over the promised bound of an exponential on a range of its argument; a named deviation's data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Excess {
    /// The least argument concerned.
    pub from: f64,
    /// The greatest argument concerned.
    pub to: f64,
    /// How many times the promised bound is granted there.
    pub factor: f64,
}

/// The accuracy of a shading language: correct rounding up or down for `+ − ×`, and the bounds of the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// The name on the command line.
    pub name: &'static str,
    /// Where the figures come from.
    pub source: &'static str,
    /// How far `+ − ×` may be off, relatively; 0 where they are correctly rounded, up or down.
    pub relative: f64,
    /// `/`, for a divisor whose magnitude lies in [2⁻¹²⁶, 2¹²⁶]; undefined elsewhere.
    pub divide_ulp: f64,
    /// inverseSqrt; sqrt is 1 / inverseSqrt.
    pub inverse_sqrt_ulp: f64,
    /// exp.
    pub exp_ulp: GrowingUlp,
    /// exp2; pow(x, y) is exp2(y · log2(x)).
    pub exp2_ulp: GrowingUlp,
    /// log2 on [0.5, 2]: an absolute error.
    pub log2_absolute: f64,
    /// log2 elsewhere.
    pub log2_ulp: f64,
    /// Bits after the point to which a rasteriser snaps positions, at least.
    pub subpixel_bits: u32,
    /// A named deviation's excess of exp, on top of the promise.
    pub exp_excess: Option<Excess>,
    /// A named deviation's excess of exp2, on top of the promise.
    pub exp2_excess: Option<Excess>,
}

const EXPONENTIAL: GrowingUlp = GrowingUlp { base: 3.0, slope: 2.0 };

/// WGSL §"Floating point accuracy", with the forms of mix and normalize that implementations are known to use.
pub const WGSL: Profile = Profile {
    name: "wgsl",
    source: "WGSL, Floating Point Accuracy",
    relative: 0.0,
    divide_ulp: 2.5,
    inverse_sqrt_ulp: 2.0,
    exp_ulp: EXPONENTIAL,
    exp2_ulp: EXPONENTIAL,
    log2_absolute: 1.0 / 2_097_152.0,
    log2_ulp: 3.0,
    subpixel_bits: 4,
    exp_excess: None,
    exp2_excess: None,
};

/// Vulkan's table of SPIR-V precision. Its figures are WGSL's, which was written after it; inherited bounds cover algebraic
/// rearrangements, so both forms of mix and of normalize are legal here too.
pub const VULKAN: Profile =
    Profile { name: "vulkan", source: "Vulkan, Precision and Operation of SPIR-V Instructions", ..WGSL };

/// One part in 10⁵, in ULP of binary32: just below a power of two an ULP is 2⁻²⁴ of the value, just above it twice that.
const OPENGL_ULP: f64 = 1e-5 * 16_777_216.0;

/// OpenGL's floor for every operation, fixed-function ones too. It says nothing of functions apart: they are held to the same,
/// exponentials besides to what their argument's error makes of them, and log2 near 1 to one part in 10⁵ of 1.
pub const OPENGL: Profile = Profile {
    name: "opengl",
    source: "OpenGL 2.1 §2.1.1, 4.6 §2.3.4: about 1 part in 10⁵",
    relative: 1e-5,
    divide_ulp: OPENGL_ULP,
    inverse_sqrt_ulp: OPENGL_ULP,
    exp_ulp: GrowingUlp { base: OPENGL_ULP, slope: 2.0 },
    exp2_ulp: GrowingUlp { base: OPENGL_ULP, slope: 2.0 },
    log2_absolute: 1e-5,
    log2_ulp: OPENGL_ULP,
    ..WGSL
};

/// The profiles by name, the default first.
pub const PROFILES: [&Profile; 3] = [&WGSL, &VULKAN, &OPENGL];

impl Profile {
    /// The profile of that name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Self> {
        PROFILES.into_iter().find(|profile| profile.name == name)
    }

    /// The profile of that name.
    ///
    /// # Errors
    /// Where there is none: says which there are.
    pub fn named(name: &str) -> Result<&'static Self, String> {
        let names: Vec<&str> = PROFILES.iter().map(|profile| profile.name).collect();
        Self::by_name(name).ok_or_else(|| format!("no profile `{name}`; expected one of {}", names.join(", ")))
    }

    /// Evaluates `f` by the figures of this profile: the one way in which a profile reaches the operators of
    /// `Accept` and the built-in functions of `RandomLegal`.
    ///
    /// Functions that evaluate take the profile as an argument and call this around the evaluation of a formula. Outside of it
    /// there is no profile at all, and an operation that asks for one panics. Work that is handed to a pool of threads inside of a
    /// scope must enter one of its own, since another thread has none and this one may take up other work meanwhile.
    #[inline]
    pub fn scope<T>(&self, f: impl FnOnce() -> T) -> T {
        // While a scope is open its profile is borrowed: what lies at the same address is the same profile.
        if IN_FORCE.get() == std::ptr::from_ref(self).addr() { f() } else { self.enter(f) }
    }

    fn enter<T>(&self, f: impl FnOnce() -> T) -> T {
        let address = std::ptr::from_ref(self).addr();
        // Rows are evaluated one by one by the same figures, which stay where they are for the next row.
        if FIGURES.with(|figures| figures.get().has_figures_of(self)) {
            let _outer =
                Outer { relative: RELATIVE.replace(self.relative), address: IN_FORCE.replace(address), figures: None };
            return f();
        }
        let is_outermost = RELATIVE.get().is_nan();
        let figures = Some(FIGURES.replace(*self)).filter(|_| !is_outermost);
        let _outer = Outer { relative: RELATIVE.replace(self.relative), address: IN_FORCE.replace(address), figures };
        f()
    }

    /// Whether intervals are the same by both.
    #[inline]
    fn has_figures_of(&self, other: &Self) -> bool {
        let figures = |p: &Self| {
            // Every field is named, so that a new figure cannot be left out.
            let Self {
                name: _,
                source: _,
                relative,
                divide_ulp,
                inverse_sqrt_ulp,
                exp_ulp: exp,
                exp2_ulp: exp2,
                log2_absolute,
                log2_ulp,
                subpixel_bits: _,
                exp_excess: _,
                exp2_excess: _,
            } = *p;
            [
                relative,
                divide_ulp,
                inverse_sqrt_ulp,
                exp.base,
                exp.slope,
                exp2.base,
                exp2.slope,
                log2_absolute,
                log2_ulp,
            ]
            .map(f64::to_bits)
        };
        let others = |p: &Self| (p.subpixel_bits, p.exp_excess, p.exp2_excess);
        figures(self) == figures(other) && others(self) == others(other)
    }
}

/// What was in force outside of a scope, and is again at its end.
struct Outer {
    relative: f64,
    address: usize,
    figures: Option<Profile>,
}

impl Drop for Outer {
    fn drop(&mut self) {
        RELATIVE.set(self.relative);
        IN_FORCE.set(self.address);
        if let Some(figures) = self.figures {
            FIGURES.set(figures);
        }
    }
}

thread_local! {
    /// The figures in force on this thread, or those of the last scope.
    static FIGURES: Cell<Profile> = const { Cell::new(WGSL) };
    /// [`Profile::relative`] of the profile in force; NaN for none.
    static RELATIVE: Cell<f64> = const { Cell::new(f64::NAN) };
    /// Where that profile lies; 0 for none.
    static IN_FORCE: Cell<usize> = const { Cell::new(0) };
}

/// How far `+ − ×` may be off by the profile in force on this thread, relatively; NaN outside of a scope.
#[inline]
pub(crate) fn relative() -> f64 {
    RELATIVE.get()
}

/// One figure of the profile in force on this thread, apart from [`Profile::relative`].
#[inline]
pub(crate) fn current<T>(figure: impl FnOnce(&Profile) -> T) -> T {
    assert_in_force(relative());
    figure(&FIGURES.get())
}

/// Panics where [`relative`] is of no profile.
#[inline]
pub(crate) fn assert_in_force(relative: f64) {
    assert!(!relative.is_nan(), "an interval was asked for outside of `Profile::scope`, by no profile");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Accept;
    use lightmeter_reference::Real as _;

    #[test]
    fn opengl_permits_one_part_in_100000_of_every_operation_and_not_five() {
        let [x, y] = [3.25_f32, 1.7];
        let (a, b) = (f64::from(x), f64::from(y));
        type Operation = fn(Accept, Accept) -> Accept;
        let rows: [(&str, f64, Operation); 8] = [
            ("+", a + b, |a, b| a + b),
            ("−", a - b, |a, b| a - b),
            ("×", a * b, |a, b| a * b),
            ("/", a / b, |a, b| a / b),
            ("√", a.sqrt(), |a, _| a.sqrt()),
            ("1/√", a.sqrt().recip(), |a, _| a.inverse_sqrt()),
            ("2^", a.exp2(), |a, _| a.exp2()),
            ("log₂", a.log2(), |a, _| a.log2()),
        ];
        for (name, exact, operation) in rows {
            let legal = |profile: &Profile| profile.scope(|| operation(Accept::input(x), Accept::input(y)));
            let (opengl, wgsl) = (legal(&OPENGL), legal(&WGSL));
            for sign in [1.0, -1.0] {
                assert!(opengl.contains(exact * (1.0 + sign * 0.99e-5)), "{name}: {opengl:?}");
                assert!(!opengl.contains(exact * (1.0 + sign * 5e-5)), "{name}: {opengl:?}");
                assert!(!wgsl.contains(exact * (1.0 + sign * 0.99e-5)), "{name}: {wgsl:?}");
            }
        }
    }
}
