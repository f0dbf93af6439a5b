//! Fog with mistakes: distance, factor and mix, each of which can be wrong. Without a mistake it computes what the formula does.

use super::row::{InputRow, put};
use lightmeter_catalogue::cases::Spec;
use lightmeter_reference::departure::smoothstep;
use lightmeter_reference::fog::{self, Distance};
use lightmeter_reference::{Real, Vec3};

/// A step that goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Twist {
    /// |p| for |z|.
    Radial,
    /// |z| for |p|.
    Planar,
    /// z, which is negative before the eye.
    SignedDepth,
    Exp,
    Exp2Document,
    Exp2OpenGl,
    /// 2 to the power of what e is raised to.
    BaseTwo,
    Smoothstep,
    /// dmin forgotten: a ramp from the eye.
    FromTheEye,
    /// 1 − f.
    Inverted,
    Unclamped,
    /// 1 − (1 − f): what is small is lost in the rounding of 1.
    ByComplement,
    /// Fog and surface exchanged in the mix.
    MixedTheWrongWay,
    /// The fog's colour added.
    Added,
    /// The mix forgotten.
    NotApplied,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Factor {
    Linear,
    Smoothstep,
    FromTheEye,
    Exp,
    Exp2Document,
    Exp2OpenGl,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Length {
    Planar,
    Radial,
    Signed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mix {
    Right,
    Turned,
    Added,
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Model {
    length: Length,
    factor: Factor,
    base_two: bool,
    inverted: bool,
    clamped: bool,
    by_complement: bool,
    mix: Mix,
}

fn right(id: &str) -> Option<Model> {
    let id = id.strip_prefix("fog/")?;
    let factor = match id {
        "linear" | "linear-radial" | "linear-multiply-add" => Factor::Linear,
        "exp" | "exp-radial" | "exp-radial-scaled" => Factor::Exp,
        "exp2-document" | "exp2-document-radial" | "exp2-document-square" => Factor::Exp2Document,
        "exp2-opengl" | "exp2-opengl-radial" | "exp2-opengl-squares" => Factor::Exp2OpenGl,
        _ => return None,
    };
    let length = if id.contains("radial") { Length::Radial } else { Length::Planar };
    Some(Model {
        length,
        factor,
        base_two: false,
        inverted: false,
        clamped: true,
        by_complement: false,
        mix: Mix::Right,
    })
}

impl Model {
    fn twist(&mut self, twist: Twist) -> bool {
        let before = *self;
        let ramp = self.factor == Factor::Linear;
        match twist {
            Twist::Radial if self.length == Length::Planar => self.length = Length::Radial,
            Twist::Planar if self.length == Length::Radial => self.length = Length::Planar,
            Twist::SignedDepth if self.length == Length::Planar => self.length = Length::Signed,
            Twist::Smoothstep if ramp => self.factor = Factor::Smoothstep,
            Twist::FromTheEye if ramp => self.factor = Factor::FromTheEye,
            Twist::Exp if !ramp => self.factor = Factor::Exp,
            Twist::Exp2Document if !ramp => self.factor = Factor::Exp2Document,
            Twist::Exp2OpenGl if !ramp => self.factor = Factor::Exp2OpenGl,
            Twist::BaseTwo if !ramp => self.base_two = true,
            Twist::Inverted => self.inverted = true,
            // The other exponents are squares or lengths, of which no case makes a factor above 1.
            Twist::Unclamped if ramp || (self.factor == Factor::Exp && self.length == Length::Planar) => {
                self.clamped = false
            }
            Twist::ByComplement if !ramp => self.by_complement = true,
            Twist::MixedTheWrongWay => self.mix = Mix::Turned,
            Twist::Added => self.mix = Mix::Added,
            Twist::NotApplied => self.mix = Mix::None,
            _ => {}
        }
        *self != before
    }

    fn factor<R: Real>(&self, x: &InputRow<'_, R>, d: R) -> Option<R> {
        let one = R::literal(1.0);
        let raise = |exponent: R| if self.base_two { exponent.exp2() } else { exponent.exp() };
        let f = match self.factor {
            Factor::Linear if self.clamped => fog::linear(d, x.scalar("dmin")?, x.scalar("dmax")?),
            Factor::Linear => {
                let [dmin, dmax] = [x.scalar("dmin")?, x.scalar("dmax")?];
                (dmax - d) / (dmax - dmin)
            }
            Factor::Smoothstep => {
                let t = fog::linear(d, x.scalar("dmin")?, x.scalar("dmax")?);
                smoothstep(R::literal(0.0), one, t)
            }
            Factor::FromTheEye => {
                let dmax = x.scalar("dmax")?;
                ((dmax - d) / dmax).clamp(R::literal(0.0), one)
            }
            Factor::Exp => raise(-(x.scalar("density")? * d)),
            Factor::Exp2Document => raise(-R::product([x.scalar("density")?, d, d])),
            Factor::Exp2OpenGl => {
                let t = x.scalar("density")? * d;
                raise(-(t * t))
            }
        };
        let f = if self.clamped { f.clamp(R::literal(0.0), one) } else { f };
        let f = if self.by_complement { one - (one - f) } else { f };
        Some(if self.inverted { one - f } else { f })
    }
}

/// Whether the formula has these steps, and each makes a difference to it.
pub(super) fn concerns(spec: &Spec, twists: &[Twist]) -> bool {
    right(&spec.id).is_some_and(|mut model| twists.iter().all(|&twist| model.twist(twist)))
}

/// The formula with these steps wrong.
pub(super) fn evaluate<R: Real>(spec: &Spec, twists: &[Twist], numbers: &[R], out: &mut [R]) -> Option<()> {
    let mut model = right(&spec.id)?;
    for &twist in twists {
        model.twist(twist);
    }
    let x = InputRow::new(spec, numbers);
    let p: Vec3<R> = x.vector("p")?;
    let zero = R::literal(0.0);
    let d = match model.length {
        Length::Planar => fog::distance(p, Distance::Planar),
        Length::Radial if spec.id.ends_with("-scaled") => fog::radial_distance_scaled(p),
        Length::Radial => R::if_ge(zero, p.dot(p), || zero, || fog::distance(p, Distance::Radial)),
        Length::Signed => p.z(),
    };
    let f = model.factor(&x, d)?;
    let (fog, shaded): (Vec3<R>, Vec3<R>) = (x.vector("fog")?, x.vector("shaded")?);
    let color = match model.mix {
        Mix::Right => fog.mix(shaded, f),
        Mix::Turned => shaded.mix(fog, f),
        Mix::Added => shaded + fog.scale(R::literal(1.0) - f),
        Mix::None => shaded,
    };
    put(out, 0, lightmeter_reference::Vector([f]));
    put(out, 1, color);
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::agrees_with_formulas;

    #[test]
    fn without_a_mistake_the_model_is_the_formula() {
        let seen =
            agrees_with_formulas(|spec| right(&spec.id).is_some(), |spec, row, out| evaluate(spec, &[], row, out));
        assert!(seen == 12 * 256, "{seen}");
    }
}
