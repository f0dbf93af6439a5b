//! Which parts of a formula a mistake is made in.

use super::alteration::At;
use super::change::{After, Before};
use super::fault::{Fault, Step};
use super::steps::steps_of;
use lightmeter_catalogue::select::Member;

/// A part of a formula that a mistake is made in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touched {
    /// A step, by its name.
    Step(&'static str),
    /// An input, by its name.
    Input(&'static str),
    /// What comes out.
    Output,
}

impl Fault {
    /// The parts of a formula that the mistake is made in; none where another formula stands in its place.
    #[must_use]
    pub fn touched(&'static self, member: &Member) -> Vec<Touched> {
        let way = self.way(&member.spec, &steps_of(member)).unwrap_or_default();
        let of_step = |step: &Step| match *step {
            Step::At(At { step, .. }) => vec![Touched::Step(step)],
            Step::Before(Before::On(input, _)) => vec![Touched::Input(input)],
            Step::Before(Before::Swap(a, b) | Before::Copy(a, b) | Before::Times(a, b) | Before::Plus(a, b)) => {
                vec![Touched::Input(a), Touched::Input(b)]
            }
            Step::After(After::On(..) | After::Colors(_) | After::All(_) | After::Copy(..) | After::Take(..)) => {
                vec![Touched::Output]
            }
            _ => vec![],
        };
        way.iter().flat_map(of_step).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::formulas;

    #[test]
    fn a_mistake_is_made_in_a_part_of_the_formula() {
        let touched = |formula: &str, mistake: &str| {
            let member = formulas().iter().find(|member| member.spec.id == formula).expect(formula);
            Fault::by_name(mistake).expect(mistake).touched(member)
        };
        assert_eq!(touched("lighting/blinn", "half-vector-as-mean"), [Touched::Step("h")]);
        assert_eq!(touched("lighting/spot", "spot-axis-reversed"), [Touched::Input("axis")]);
        assert_eq!(touched("lighting/blinn", "gamma-encoded"), [Touched::Output]);
        assert_eq!(touched("fog/exp", "blinn-for-phong"), []);
    }
}
