//! Cases of attenuation and spotlights. Formulas: `lightmeter_reference::attenuation`.

use super::Visitor;
use super::fit;
use super::formula::formula;
use super::spec::{Domain, Hard, Input, Output, Spec, ValueShape};
use lightmeter_reference::attenuation;

const ATTEN: Output = Output::new("atten", ValueShape::Scalar, "1");
const SPOT: Output = Output::new("spot", ValueShape::Scalar, "1");
pub(super) const KC: Input = Input::scalar("kc", "1", Domain::Uniform(0.1, 2.0));
pub(super) const KL: Input = Input::scalar("kl", "1/unit", Domain::Uniform(0.0, 1.0));
pub(super) const KQ: Input = Input::scalar("kq", "1/unit²", Domain::Uniform(0.0, 0.5));
const DISTANCE: Input = Input::scalar("d", "unit", Domain::LogUniform(1e-3, 1e3));
pub(super) const CUTOFF: Input = Input::scalar("cutoff_cosine", "1", Domain::Uniform(-0.5, 0.99));
pub(super) const EXPONENT: Input = Input::scalar("exponent", "1", Domain::Uniform(0.0, 128.0));

formula!(
    /// The polynomial of the distance.
    Polynomial: "attenuation/polynomial" by "attenuation_polynomial",
    "atten = 1 / (kc + kl·d + kq·d²)", "004",
    [KC, KL, KQ, DISTANCE] -> [ATTEN],
    |kc, kl, kq, d; out| { out.scalar(attenuation::polynomial(kc, kl, kq, d)); },
    hard [
        Hard::new("all-zero", "no value: nothing is promised", &[("kc", &[0.0]), ("kl", &[0.0]), ("kq", &[0.0])]),
        Hard::new("at-the-light", "1/kc", &[("kc", &[0.5]), ("d", &[0.0])]),
        Hard::new("far", "d² overflows: nothing is promised", &[("d", &[2e19]), ("kq", &[1.0])]),
        Hard::new("no-falloff", "kc = 1 alone gives 1", &[("kc", &[1.0]), ("kl", &[0.0]), ("kq", &[0.0])]),
        Hard::new("a-long-way-off", "no distance is too long", &[("kc", &[1.0]), ("kl", &[0.1]), ("kq", &[0.1]), ("d", &[1e5])]),
        Hard::new("as-far-as-it-squares", "no distance is too long whose square is a number", &[("kc", &[1.0]), ("kl", &[0.1]), ("kq", &[1e-20]), ("d", &[1e12])]),
    ],
);
formula!(
    /// The falloff of a distant light.
    Constant: "attenuation/constant" by "attenuation_constant",
    "atten = 1, (kc, kl, kq) = (1, 0, 0)", "004",
    [DISTANCE] -> [ATTEN],
    |d; out| { out.scalar(attenuation::constant(d)); },
    hard [
        Hard::new("at-the-light", "1 there, too", &[("d", &[0.0])]),
    ],
);
formula!(
    /// The falloff of a tube light.
    Linear: "attenuation/linear" by "attenuation_linear",
    "atten = 1/d, (0, 1, 0)", "004",
    [DISTANCE] -> [ATTEN],
    |d; out| { out.scalar(attenuation::linear(d)); },
    hard [
        Hard::new("close-to-the-light", "1e5: no distance is too short", &[("d", &[1e-5])]),
    ],
);
formula!(
    /// The falloff of a point light.
    Square: "attenuation/square" by "attenuation_square",
    "atten = 1/d², (0, 0, 1)", "004",
    [DISTANCE] -> [ATTEN],
    |d; out| { out.scalar(attenuation::square(d)); },
    hard [
        Hard::new("close-to-the-light", "1e10: no distance is too short", &[("d", &[1e-5])]),
    ],
);
formula!(
    /// From positions.
    Point: "attenuation/point" by "attenuation_point",
    "atten = 1 / (kc + kl·d + kq·d²), d = |light − p|", "004",
    [KC, KL, KQ, Input::position("light"), Input::position("p")] -> [ATTEN],
    fit fit::light,
    |kc, kl, kq, light, p; out| { out.scalar(attenuation::point(kc, kl, kq, light, p)); },
    hard [
        Hard::new("close-to-the-light", "1e5: no distance is too short", &[("kc", &[0.0]), ("kl", &[1.0]), ("kq", &[0.0]), ("light", &[0.0, 6e-6, -0.000_992]), ("p", &[0.0, 0.0, -0.001])]),
        Hard::new("a-long-way-off", "no distance is too long", &[("kc", &[1.0]), ("kl", &[0.1]), ("kq", &[0.1]), ("light", &[0.0, 6e8, 8e8]), ("p", &[0.0, 0.0, 0.0])]),
    ],
);
formula!(
    /// A spotlight's cone.
    SpotCutoff: "attenuation/spot-cutoff" by "attenuation_spot_cutoff",
    "spot = 1 for −l·axis ≥ cos(cutoff), else 0", "000 §6.4",
    [Input::direction("l"), Input::direction("axis"), CUTOFF] -> [SPOT],
    |l, axis, cutoff_cosine; out| { out.scalar(attenuation::spot_cutoff(l, axis, cutoff_cosine)); },
    hard [
        Hard::new("on-the-edge", "the edge belongs to the cone", &[("l", &[0.0, 0.0, -1.0]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[1.0])]).at_an_end(),
        Hard::new("all-round", "a cutoff of 180 degrees lights what lies behind too", &[("l", &[0.0, 0.0, 1.0]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[-1.0])]).at_an_end(),
    ],
);
formula!(
    /// A spotlight's exponent.
    SpotExponent: "attenuation/spot-exponent" by "attenuation_spot_exponent",
    "spot = max(−l·axis, 0)^e within the cone, else 0", "OpenGL 2.1 §2.14.1",
    [Input::direction("l"), Input::direction("axis"), CUTOFF, EXPONENT] -> [SPOT],
    fit toward_the_cone,
    |l, axis, cutoff_cosine, exponent; out| { out.scalar(attenuation::spot_exponent(l, axis, cutoff_cosine, exponent)); },
    hard [
        Hard::new("on-the-edge-of-a-hemisphere", "the edge belongs to the cone", ON_THE_EDGE),
        Hard::new("no-exponent", "an evenly lit cone", &[("l", &[0.0, 0.6, -0.8]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[0.5]), ("exponent", &[0.0])]),
        Hard::new("slight-exponent", "an exponent of 0.0005 is not 0", SLIGHT),
        Hard::new("barely-before-it", "however small, a cosine above 0 counts", &[("l", &[0.999_999_9, 0.0, -9e-5]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[0.0]), ("exponent", &[0.5])]),
        Hard::new("least-before-it", "1e-12 is above 0, too", &[("l", &[1.0, 0.0, -1e-12]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[0.0]), ("exponent", &[1.0])]),
        Hard::new("no-exponent-behind", "0 and 1 are both legal behind the light: 0 to the power 0", BEHIND),
        Hard::new("behind", "0 behind the light with the widest cone", &[("l", &[0.0, 0.0, 1.0]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[0.0]), ("exponent", &[2.0])]),
    ],
);

/// A direction 107° from the axis, in a cone of 120°.
const BEHIND: &[(&str, &[f32])] =
    &[("l", &[0.953_939_2, 0.0, 0.3]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[-0.5]), ("exponent", &[0.0])];

/// A direction 84° from the axis, 0.1^0.0005 as bright.
const ON_THE_EDGE: &[(&str, &[f32])] =
    &[("l", &[0.0, 1.0, 0.0]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[0.0]), ("exponent", &[0.0])];
const SLIGHT: &[(&str, &[f32])] =
    &[("l", &[0.994_987_4, 0.0, -0.1]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[0.0]), ("exponent", &[5e-4])];

/// Half of all random directions lie behind the light: turn those round.
fn toward_the_cone(_: &Spec, row: &mut [f32]) {
    let behind = (0..3).map(|k| row[k] * row[3 + k]).sum::<f32>() > 0.0;
    if behind {
        row[..3].iter_mut().for_each(|x| *x = -*x);
    }
}

formula!(
    /// The polynomial with d² first.
    PolynomialExpanded: "attenuation/polynomial-expanded" by "attenuation_polynomial_expanded",
    "atten = 1 / (kc + kl·d + kq·(d·d))", "004, taken literally",
    [KC, KL, KQ, DISTANCE] -> [ATTEN],
    |kc, kl, kq, d; out| { out.scalar(attenuation::polynomial_expanded(kc, kl, kq, d)); },
);
formula!(
    /// The polynomial by Horner's scheme with bounds.
    PolynomialBounded: "attenuation/polynomial-bounded" by "attenuation_polynomial_bounded",
    "atten = 1 / clamp(kc + d(kl + d·kq), 2⁻¹²⁶, 2¹²⁶)", "004, with a denominator that can be divided by",
    [KC, KL, KQ, DISTANCE] -> [ATTEN],
    stable 12.0 Own "two products and two sums of one sign, and a division of at most 2½ ULP",
    |kc, kl, kq, d; out| { out.scalar(attenuation::polynomial_bounded(kc, kl, kq, d)); },
    hard [
        Hard::new("no-quadratic-term-far", "a tube light at 1e20", &[("kc", &[0.0]), ("kl", &[1e-20]), ("kq", &[0.0]), ("d", &[1e20])])
            .naive("attenuation/polynomial-expanded", "0·∞ is NaN", f64::INFINITY),
        Hard::new("slight-quadratic-term-far", "kq·d² is 1e10 though d² overflows", &[("kc", &[1.0]), ("kl", &[0.0]), ("kq", &[1e-30]), ("d", &[1e20])])
            .naive("attenuation/polynomial-expanded", "d² is ∞", 1e6),
        Hard::new("steep-quadratic-term-near", "kq·d² is 1e-10 though d² underflows", &[("kc", &[0.0]), ("kl", &[0.0]), ("kq", &[1e38]), ("d", &[1e-24])])
            .naive("attenuation/polynomial-expanded", "d² is 0", f64::INFINITY),
        Hard::new("all-zero", "the greatest value there is, not ∞", &[("kc", &[0.0]), ("kl", &[0.0]), ("kq", &[0.0])])
            .naive("attenuation/polynomial-expanded", "1/0", f64::INFINITY),
        Hard::new("as-dark-as-numbers-go", "d² of 1e36 divides: nothing below 2⁻¹²⁶ is clamped", &[("kc", &[1.0]), ("kl", &[0.0]), ("kq", &[1.0]), ("d", &[1e18])]),
        Hard::new("at-a-tube-light", "the greatest value there is, not ∞", &[("kc", &[0.0]), ("kl", &[1000.0]), ("kq", &[0.0]), ("d", &[0.0])])
            .naive("attenuation/polynomial-expanded", "1/0", f64::INFINITY),
        Hard::new("almost-as-dark", "a divisor of 7e37 is below 2¹²⁶", &[("kc", &[1.0]), ("kl", &[0.0]), ("kq", &[0.5]), ("d", &[1.2e19])]),
    ],
);
formula!(
    /// From positions at any distance.
    PointScaled: "attenuation/point-scaled" by "attenuation_point_scaled",
    "atten of attenuation/polynomial-bounded at d = |(light − p)·2ᵏ|·2⁻ᵏ", "004, at any distance",
    [KC, KL, KQ, Input::position("light"), Input::position("p")] -> [ATTEN],
    fit fit::light,
    stable 40.0 Own "a distance of 16 roundings, which its square doubles",
    |kc, kl, kq, light, p; out| { out.scalar(attenuation::point_scaled(kc, kl, kq, light, p)); },
    hard [
        Hard::new("far", "5e19 away", &[("kc", &[1.0]), ("kl", &[1e-20]), ("kq", &[0.0]), ("light", &[3e19, 4e19, 0.0]), ("p", &[0.0, 0.0, 0.0])])
            .naive("attenuation/point", "the distance is ∞", 1e6),
        Hard::new("as-dark-as-numbers-go", "d² of 1e36 divides", &[("kc", &[1.0]), ("kl", &[0.0]), ("kq", &[1.0]), ("light", &[6e17, 8e17, 0.0]), ("p", &[0.0, 0.0, 0.0])]),
        Hard::new("near", "5e-24 away", &[("kc", &[0.0]), ("kl", &[1e20]), ("kq", &[0.0]), ("light", &[3e-24, 4e-24, 0.0]), ("p", &[0.0, 0.0, 0.0])])
            .naive("attenuation/point", "the distance is 0", f64::INFINITY),
    ],
);
formula!(
    /// A spotlight's exponent by the chord.
    SpotExponentByChord: "attenuation/spot-exponent-by-chord" by "attenuation_spot_exponent_by_chord",
    "spot = exp(e·ln(1 − q)), q = ½|l + axis|², within the cone, else 0", "OpenGL 2.1 §2.14.1, for narrow beams",
    [Input::direction("l"), Input::direction("axis"), CUTOFF, EXPONENT] -> [SPOT],
    fit toward_the_cone,
    stable 32.0 Unit "as lighting/cosine-power-by-chord",
    |l, axis, cutoff_cosine, exponent; out| { out.scalar(attenuation::spot_exponent_by_chord(l, axis, cutoff_cosine, exponent)); },
    hard [
        Hard::new("on-the-edge-of-a-hemisphere", "the edge belongs to the cone", ON_THE_EDGE),
        Hard::new("slight-exponent-by-chord", "an exponent of 0.0005 is not 0", SLIGHT),
        Hard::new("no-exponent-behind", "0 and 1 are both legal behind the light: 0 to the power 0", BEHIND),
        Hard::new("beam-1e4", "half as bright at 0.67°", &[("l", &[-0.011_773_7, 0.0, -0.999_930_7]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[0.5]), ("exponent", &[1e4])])
            .naive("attenuation/spot-exponent", "l·axis near 1 has no digits for the angle, which l + axis keeps", 1e3),
        Hard::new("beam-1e6", "half as bright at 0.07°", &[("l", &[-0.001_177_4, 0.0, -0.999_999_3]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[0.5]), ("exponent", &[1e6])])
            .naive("attenuation/spot-exponent", "l·axis near 1 has no digits for the angle, which l + axis keeps", 1e5),
    ],
);

pub(super) fn visit(visitor: &mut impl Visitor) {
    visitor.formula(Polynomial);
    visitor.formula(Constant);
    visitor.formula(Linear);
    visitor.formula(Square);
    visitor.formula(Point);
    visitor.formula(SpotCutoff);
    visitor.formula(SpotExponent);
    visitor.formula(PolynomialExpanded);
    visitor.formula(PolynomialBounded);
    visitor.formula(PointScaled);
    visitor.formula(SpotExponentByChord);
}
